// The published numbers, on the recorded noise that they were made with [docs/model.md, Published numbers]. The records
// stay outside the project; CREDENCE_SHARED_DATA is their folder, an absolute path.

#include "catch.hpp"
#include "store_study.hpp"
#include "support.hpp"

#include <credence/detail/store.hpp>

#include <cstdio>
#include <filesystem>

namespace credence::test::published_long_test {

namespace {

/// A noise record of the shared data, or nothing where it is missing; the test then says so and succeeds.
std::optional<NoiseRecord> shared_record(const std::string& name) {
    const std::filesystem::path path = std::filesystem::path(CREDENCE_SHARED_DATA) / name;
    if (std::filesystem::exists(path)) return read_noise_record(path);
    WARN("SKIPPED: " << path << " is not there");
    return std::nullopt;
}

Run replay(const Settings& settings, Controller controller, const NoiseRecord& record) {
    const DeformableSettings scenario = scenario_with(settings);
    check_covers(record, scenario, "the record");
    const RecordedDraws draws(record);
    return run_arm(scenario, controller,
                   {[draws](Source source, int pose, int index) { return draws.normal(source, pose, index); },
                    [draws](Source source, int pose, int index) { return draws.uniform(source, pose, index); }});
}

std::string four_decimals(double value) {
    char text[64];
    std::snprintf(text, sizeof text, "%.4f", value);
    return text;
}

struct Cell {
    const char *path, *noise;
    Controller controller;
    const char* trace_P;
    int unseen;
};

constexpr Controller fixed = Controller::fixed, greedy = Controller::greedy;
constexpr Cell cells[] = {
    {"straight", "constant", fixed, "0.1061", 3}, {"straight", "constant", greedy, "0.1061", 3},
    {"straight", "ranged", fixed, "0.1124", 3},   {"straight", "ranged", greedy, "0.1124", 3},
    {"circle", "constant", fixed, "0.1061", 47},  {"circle", "constant", greedy, "0.1063", 11},
    {"circle", "ranged", fixed, "0.1068", 47},    {"circle", "ranged", greedy, "0.1034", 1},
};

Settings settings_of(const Cell& cell) {
    return {{"model.process", "translation"}, {"features.path", cell.path}, {"sensor.noise", cell.noise}};
}

}  // namespace

TEST_CASE("published: the table of results, trace(P) to all its digits and the unseen features") {
    const std::optional<NoiseRecord> record = shared_record("noise-translation.h5");
    if (!record) return;
    for (const Cell& cell : cells) {
        CAPTURE(described(settings_of(cell)), static_cast<int>(cell.controller));
        const Run run = replay(settings_of(cell), cell.controller, *record);
        CHECK(four_decimals(run.columns[column_trace_P]) == cell.trace_P);
        CHECK(run.columns[column_unseen] == cell.unseen);
    }
}

TEST_CASE("published: docs/model.md has the same numbers") {
    const std::string page = bytes_of(CREDENCE_SOURCE "/docs/model.md");
    const auto text = [](const Cell& cell) {
        return std::string(cell.trace_P) + " / " + std::to_string(cell.unseen) + " |";
    };
    for (std::size_t i = 0; i < std::size(cells); i += 2) {
        const std::string noise = cells[i].noise == std::string("constant") ? "constant σ_feat" : cells[i].noise;
        const std::string row =
            std::string("\n| ") + cells[i].path + ", " + noise + " | " + text(cells[i]) + " " + text(cells[i + 1]);
        CAPTURE(row);
        CHECK(page.find(row) != std::string::npos);
    }
    CHECK(page.find("pose error: straight 0.1629, circle 0.1460") != std::string::npos);
}

TEST_CASE("published: pose errors of the heading model") {
    const std::optional<NoiseRecord> record = shared_record("noise-heading.h5");
    if (!record) return;
    const auto pose_error = [&](const char* path) {
        return replay({{"noise.heading", "0.01"}, {"features.path", path}}, fixed, *record).columns[column_pose_error];
    };
    CHECK(four_decimals(pose_error("straight")) == "0.1629");
    CHECK(four_decimals(pose_error("circle")) == "0.1460");
}

TEST_CASE("published: the oracle agrees on the recorded noise") {
    const std::optional<NoiseRecord> record = shared_record("noise-translation.h5");
    if (!record) return;
    const RecordedDraws draws(*record);
    const oracle::Noise noise{[draws](Source source, int pose, int index) {
                                  const Vector2<double> draw = draws.normal(source, pose, index);
                                  return Eigen::Vector2d(draw.x, draw.y);
                              },
                              [](Source, int, int) { return 0.0; }};
    for (const Cell& cell : cells) {
        const oracle::Trial theirs = oracle::run(scenario_with(settings_of(cell)), cell.controller, noise);
        const Difference worst = difference(replay(settings_of(cell), cell.controller, *record), theirs);
        CAPTURE(described(settings_of(cell)));
        CHECK(worst.same_control);
        CHECK(worst.same_unseen);
        CHECK(worst.covariance < 1e-12);  // see filter_oracle_test.cpp
        CHECK(worst.nees < 1e-10);
    }
}

}  // namespace credence::test::published_long_test
