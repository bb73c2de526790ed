// Components that a record knows exactly, such as the height, roll and pitch of a planar robot: they are left out, and
// the rest is judged as a record without them is.

#include <credence/report.hpp>

#include "record_support.hpp"

namespace credence::test::record_known_test {

namespace {

const std::vector<int> flat_components{0, 1, 5}, known_components{2, 3, 4};
const std::string names = "x, y, z, roll, pitch, yaw", flat_names = "x, y, yaw";
const std::string left_out =
    "Not in the state, because their errors and variances are 0 at every step: z, roll, pitch.";

DrawnRecord planar() { return DrawnRecord(40, 3, 3, 2, 5); }

/// The planar record as one of poses in space.
DrawnRecord in_space(const DrawnRecord& planar) {
    DrawnRecord drawn = planar;
    drawn.n = 6;
    for (std::size_t i = 0; i < planar.error.size(); ++i) {
        drawn.error[i] = Eigen::VectorXd::Zero(6);
        drawn.covariance[i] = Eigen::MatrixXd::Zero(6, 6);
        for (Eigen::Index a = 0; a < 3; ++a) {
            const int at = flat_components[static_cast<std::size_t>(a)];
            drawn.error[i](at) = planar.error[i](a);
            for (Eigen::Index b = 0; b < 3; ++b)
                drawn.covariance[i](at, flat_components[static_cast<std::size_t>(b)]) = planar.covariance[i](a, b);
        }
    }
    return drawn;
}

/// The record that is judged, as JSON, and what it says that it cannot judge.
struct Judged {
    Json report;
    std::vector<std::string> sentences;
    std::int64_t troubles = 0;
};

Judged judged(Record record) {
    Judged one{{}, record.results.not_judged, record.trouble_count};
    one.report = Json::parse(report_json(make_record_report(std::move(record), "record", Limits())));
    one.report[0].erase("not_judged");
    return one;
}

Judged judged(const DrawnRecord& drawn, const std::string& component_names, const std::string& groups,
              const std::function<void(const Handle&, const DrawnRecord&)>& write = write_drawn) {
    return judged(read_written([&](const Handle& root) {
        write(root, drawn);
        hdf5::write_text(root, "component_names", component_names);
        if (!groups.empty()) hdf5::write_text(root, "groups", groups);
    }));
}

/// Covariances of the groups alone: `pose` of every component but the last, and `turn` of the last.
void write_of_groups(const Handle& root, const DrawnRecord& drawn) {
    write_errors(root, drawn);
    std::vector<Eigen::MatrixXd> pose, turn;
    for (const Eigen::MatrixXd& P : drawn.covariance) {
        pose.push_back(P.topLeftCorner(drawn.n - 1, drawn.n - 1));
        turn.push_back(P.bottomRightCorner(1, 1));
    }
    const Handle groups = hdf5::new_group(root, "group");
    for (const auto& [name, matrices] : {std::pair{"pose", pose}, std::pair{"turn", turn}}) {
        const int d = static_cast<int>(matrices.front().rows());
        write_values(hdf5::new_group(groups, name), "covariance", extents_of(drawn, {d, d}), flat(matrices));
    }
}

}  // namespace

TEST_CASE("record: components with an error and a variance of 0 at every step are left out, and the rest is judged") {
    const Judged space = judged(in_space(planar()), names, "pose 0:3 5, tilt 3 4, turn 4 5"),
                 plane = judged(planar(), flat_names, "pose 0:3, turn 2");
    CHECK(space.troubles == 0);
    CHECK(space.report == plane.report);
    CHECK(space.sentences == std::vector<std::string>{left_out, "Groups of nothing else are left out: tilt."});
    CHECK(plane.sentences.empty());
}

TEST_CASE("record: components that are known exactly are left out of variances and of groups' covariances") {
    const Judged space = judged(in_space(planar()), names, "pose 0 1 2 5", write_variances),
                 plane = judged(planar(), flat_names, "pose 0:3", write_variances);
    CHECK(space.troubles == 0);
    CHECK(space.report == plane.report);
    REQUIRE(space.sentences.size() == plane.sentences.size() + 1);
    CHECK(space.sentences[0] == left_out);
    const Judged groups = judged(in_space(planar()), names, "pose 0:5, turn 5", write_of_groups),
                 flat_groups = judged(planar(), flat_names, "pose 0:2, turn 2", write_of_groups);
    CHECK(groups.troubles == 0);
    CHECK(groups.report == flat_groups.report);
    CHECK(groups.sentences[0] == left_out);
}

TEST_CASE("record: a component that is known only where it is in the state is left out too") {
    DrawnRecord drawn = in_space(planar());
    for (int trial = 0; trial < drawn.trials; ++trial) drawn.hide(trial, 0, 2);
    const Judged space = judged(drawn, names, ""), plane = judged(planar(), flat_names, "");
    CHECK(space.report == plane.report);
    CHECK(space.sentences == std::vector<std::string>{left_out});
}

TEST_CASE("record: what is known at some steps only, has an error, or is the whole state, is not left out") {
    const auto failed = [](const std::function<void(DrawnRecord&)>& change) {
        DrawnRecord drawn = in_space(planar());
        change(drawn);
        const Judged one = judged(drawn, names, "");
        CHECK(one.sentences.empty());
        return one.troubles;
    };
    CHECK(failed([](DrawnRecord& d) {  // a start that is known exactly
              for (std::size_t i = 0; i < d.error.size(); ++i)
                  for (const int j : known_components) {
                      if (i % 3 == 0) continue;
                      d.error[i](j) = 0.1;
                      d.covariance[i](j, j) = 1;
                  }
          }) == 40);
    CHECK(failed([](DrawnRecord& d) {  // believed exactly, and wrong
              for (const int j : known_components) d.error.back()(j) = 0.1;
          }) == 40);
    CHECK(failed([](DrawnRecord& d) {
              for (const int j : known_components) d.covariance.back()(j, j) = 1e-9;
          }) == 40);
    CHECK(failed([](DrawnRecord& d) {  // a variance of 0 beside a covariance that is not
              for (const int j : known_components) d.covariance.back()(j, 0) = d.covariance.back()(0, j) = 0.1;
          }) == 40);
    CHECK(failed([](DrawnRecord& d) {
              for (Eigen::VectorXd& e : d.error) e.setZero();
              for (Eigen::MatrixXd& P : d.covariance) P.setZero();
          }) == 40);
}

TEST_CASE("record: planar poses of SE(3) are judged as poses in the plane, in either chart and from memory") {
    const DrawnRecord plane = planar();
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-3, 3);
    std::vector<double> truth, estimate, flat_truth, flat_estimate;
    const auto add = [](double x, double y, double yaw, std::vector<double>& space, std::vector<double>& flat) {
        space.insert(space.end(), {x, y, 0.3, std::cos(yaw / 2), 0, 0, std::sin(yaw / 2)});
        flat.insert(flat.end(), {x, y, yaw});
    };
    for (const Eigen::VectorXd& error : plane.error) {
        const double x = uniform(random), y = uniform(random), yaw = uniform(random);
        add(x, y, yaw, truth, flat_truth);
        add(x + 0.1 * error(0), y + 0.1 * error(1), yaw + 0.1 * error(2), estimate, flat_estimate);
    }
    const TemporaryFolder folder;
    for (const std::string chart : {"local", "global"}) {
        CAPTURE(chart);
        const auto read = [&](const std::string& manifold, int q, const std::vector<double>& true_poses,
                              const std::vector<double>& estimates, const DrawnRecord& drawn) {
            const std::string path = folder / manifold + chart;
            write_file(path, [&](const Handle& root) {
                write_values(root, "truth", extents_of(drawn, {q}), true_poses);
                write_values(root, "estimate", extents_of(drawn, {q}), estimates);
                write_values(root, "covariance", extents_of(drawn, {drawn.n, drawn.n}), flat(drawn.covariance));
                hdf5::write_text(root, "manifold", manifold);
                hdf5::write_text(root, "chart", chart);
                hdf5::write_text(root, "quaternion", "wxyz");
            });
            return read_record(path);
        };
        const Record space = read("SE3", 7, truth, estimate, in_space(plane)),
                     flat = read("SE2", 3, flat_truth, flat_estimate, plane);
        CHECK(space.trouble_count == 0);
        CHECK(space.results.not_judged ==
              std::vector<std::string>{"Not in the state, because their errors and variances are 0 at every step: "
                                       "translation_z, rotation_x, rotation_y."});
        const Record other = space.in_other_charts[0](), flat_other = flat.in_other_charts[0]();
        for (std::size_t k = 0; k < 3; ++k)  // the exponentials of the plane and of space differ in rounding
            for (const auto& [a, b] : {std::pair{&space, &flat}, std::pair{&other, &flat_other}})
                CHECK(relative(totals_named(*a, "nees").sum[k].rounded(), totals_named(*b, "nees").sum[k].rounded()) <
                      1e-10);
    }
    const DrawnRecord space = in_space(plane);
    const std::vector<double> error = flat(space.error), covariance = flat(space.covariance);
    const RecordArrays arrays{
        {{"error", error.data(), RecordArray::Type::real64, {40, 3, 6}, {18, 6, 1}, 1e-16},
         {"covariance", covariance.data(), RecordArray::Type::real64, {40, 3, 6, 6}, {108, 36, 6, 1}, 1e-16}},
        {{"component_names", names}},
        {}};
    const Judged in_memory = judged(read_record(arrays, "record"));
    CHECK(in_memory.troubles == 0);
    CHECK(in_memory.sentences == std::vector<std::string>{left_out});
}

}  // namespace credence::test::record_known_test
