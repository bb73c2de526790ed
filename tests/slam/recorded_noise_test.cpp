// Recorded noise: its layout, and the draws that it must cover.
// Kind: foreign files.

#include "catch.hpp"
#include "support.hpp"

#include "slam_steps.hpp"
#include "worlds/deformable/deformable.hpp"

namespace credence::test::recorded_noise_test {

namespace {

constexpr int poses = 20, features = 3, edges = 3;

/// A noise record whose every number encodes its place: 1000 array + 100 row ... in the order of the file.
NoiseRecord telling_record() {
    NoiseRecord record;
    record.poses = poses, record.features = features, record.edges = edges;
    const auto fill = [](std::vector<double>& values, int base, int count) {
        for (int i = 0; i < count; ++i) values.push_back(10000 * base + i);
    };
    fill(record.odometry, 1, poses * 3);
    fill(record.walk, 2, poses * features * 2);
    fill(record.deformation, 3, poses * features * 2);
    fill(record.measurement, 4, poses * features * 2);
    fill(record.edge, 5, poses * edges * 2);
    return record;
}

std::string refused(const NoiseRecord& record, const Settings& settings) {
    return refusal([&] { check_covers(record, scenario_with(settings), "some.h5"); });
}

}  // namespace

TEST_CASE("recorded noise: rows are poses, then features, then axes") {
    const NoiseRecord record = telling_record();
    const RecordedDraws draws(record);
    const auto check = [&](Source source, int base, int width) {
        for (int k = 0; k < poses; ++k)
            for (int j = 0; j < width; ++j) {
                const Vector2<double> draw = draws.normal(source, k, j);
                CHECK(draw.x == 10000 * base + 2 * (k * width + j));
                CHECK(draw.y == draw.x + 1);
            }
    };
    check(Source::walk, 2, features);
    check(Source::deformation, 3, features);
    check(Source::measurement, 4, features);
    check(Source::edge, 5, edges);
    for (int k = 0; k < poses; ++k) {
        CHECK(draws.normal(Source::odometry_heading, k, 0).x == 10000 + 3 * k);
        CHECK(draws.normal(Source::odometry_position, k, 0).x == 10000 + 3 * k + 1);
        CHECK(draws.normal(Source::odometry_position, k, 0).y == 10000 + 3 * k + 2);
    }
    CHECK(draws.uniform(Source::detection, 1, 1) == 0);  // what is in range is seen
}

TEST_CASE("recorded noise: a record that fits is taken") {
    CHECK(refused(telling_record(), {}) == "");
    CHECK(refused(telling_record(), {{"scenario.poses", "10"}, {"features.positions", "1 1"}}) == "");
    CHECK(refused(telling_record(), {{"truth.edge_noise", "independent"}}) == "");
    NoiseRecord bare = telling_record();
    bare.edges = 0;
    bare.edge.clear();
    CHECK(refused(bare, {}) == "");
    CHECK(refused(bare, {{"truth.edge_noise", "independent"}, {"edges.graph", "none"}}) == "");
}

TEST_CASE("recorded noise: a record that does not cover the scenario is refused, naming the file and the remedy") {
    NoiseRecord bare = telling_record();
    bare.edges = 0;
    bare.edge.clear();
    const std::vector<std::pair<std::string, std::string>> refusals{
        {refused(telling_record(), {{"scenario.poses", "21"}}), "scenario.poses"},
        {refused(telling_record(), {{"features.positions", "1 1, 2 2, 3 3, 4 4"}}), "features.positions"},
        {refused(telling_record(), {{"truth.edge_noise", "independent"}, {"edges.graph", "chain"}}), "edge"},
        {refused(bare, {{"truth.edge_noise", "independent"}}), "edge"},
        {refused(telling_record(), {{"sensor.detection", "0.5"}}), "sensor.detection"},
    };
    for (const auto& [message, remedy] : refusals) {
        CAPTURE(remedy);
        CHECK(message.find("some.h5") != std::string::npos);
        CHECK(message.find(remedy) != std::string::npos);
    }
}

}  // namespace credence::test::recorded_noise_test
