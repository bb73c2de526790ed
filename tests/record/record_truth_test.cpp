// The covariance R of the truth's own errors [docs/statistics.md, Uncertain truth].

#include "record_support.hpp"

namespace credence::test::record_truth_test {

namespace {

using Write = std::function<void(const Handle& root)>;

/// Four components, a wall of two units, with R.
struct Uncertain {
    DrawnRecord drawn{60, 6, 3};
    Eigen::MatrixXd R = Eigen::Vector3d(0.04, 0.04, 0.01).asDiagonal();

    Write with(const Write& more) const {
        return [this, more](const Handle& root) {
            write_drawn(root, drawn);
            hdf5::write_text(root, "groups", "position 0:2, pose 0:3");
            hdf5::write_text(root, "component_names", "x, y, heading");
            hdf5::write_text(root, "component_units", "m, m, rad");
            more(root);
        };
    }
    Write with_text(const std::string& name, const std::string& text) const {
        return with([=](const Handle& root) { hdf5::write_text(root, name, text); });
    }
    Write with_sigma(const std::string& text) const { return with_text("truth_sigma", text); }
    /// R once, for each step, or for each trial and step.
    Write with_matrices(const hdf5::Extents& leading, std::vector<double> one) const {
        hdf5::Extents extents = leading;
        std::size_t times = 1;
        for (const hsize_t extent : leading) times *= extent;
        for (int i = 0; i < (one.size() == 3 ? 1 : 2); ++i) extents.push_back(3);
        std::vector<double> all;
        for (std::size_t i = 0; i < times; ++i) all.insert(all.end(), one.begin(), one.end());
        return with([=](const Handle& root) { write_values(root, "truth_covariance", extents, all); });
    }
};

std::string json_of(const Write& write) { return report_json(report_written(write)); }

ArmReport arm_of(const Write& write) { return report_written(write).arms.front(); }

/// Normal errors of P = 1 in two components, and what the truth adds.
DrawnRecord calibrated(int trials, int steps, const std::function<Eigen::Vector2d(int trial, int step)>& truth) {
    DrawnRecord record(trials, steps, 2);
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    for (int trial = 0; trial < trials; ++trial)
        for (int k = 0; k < steps; ++k) {
            record.covariance[record.at(trial, k)] = Eigen::Matrix2d::Identity();
            record.error[record.at(trial, k)] = Eigen::Vector2d(normal(random), normal(random)) + truth(trial, k);
        }
    return record;
}

}  // namespace

TEST_CASE("uncertain truth: every way of saying R is the same") {
    const Uncertain record;
    const std::string said = json_of(record.with_sigma("position=0.2,heading=0.1"));
    CHECK(said != json_of(record.with([](const Handle&) {})));
    const std::vector<double> one = flat(std::vector{record.R});
    const Write ways[] = {record.with_sigma("x=20cm, y=200mm, heading=0.1"),
                          record.with_matrices({}, {0.04, 0.04, 0.01}), record.with_matrices({}, one),
                          record.with_matrices({6}, one), record.with_matrices({60, 6}, one)};
    for (const Write& way : ways) {
        Json json = Json::parse(json_of(way)), expected = Json::parse(said);
        for (Json* report : {&json, &expected})  // 0.2 squared is not 0.04 to the last bit
            for (Json& group : report->front()["truth"]) group = std::round(1e9 * group["nees_ratio"].get<double>());
        CHECK(json.front()["truth"] == expected.front()["truth"]);
        CHECK(json.front()["verdict"] == expected.front()["verdict"]);
    }
    const std::string degrees = json_of(record.with_sigma("heading=90deg"));
    CHECK(degrees == json_of(record.with_sigma("heading=1.5707963267948966")));
}

TEST_CASE("uncertain truth: what is no covariance of the truth is refused by name") {
    const Uncertain record;
    const std::pair<std::string, std::string> sigmas[] = {
        {"pose=0.1", "`pose=0.1` is of components in m and in rad."},
        {"feature=0.1", "`feature=0.1` names no group or component. Give some of all, position, pose, x, y, heading"},
        {"-0.1", "`-0.1` has no standard deviation of at least 0."},
        {"small", "`small` has no standard deviation"},
        {"x=0.1deg", "`x=0.1deg` is in another unit than x."},
        {"0.1, x=0.1", "`x=0.1` is the second one of x."}};
    for (const auto& [text, said] : sigmas) check_refused(record.with_sigma(text), "/@truth_sigma: " + said);
    const std::string place = "/truth_covariance: ",
                      no_covariance = place + "trial 0, step 0 (both counted from 0) is no";
    check_refused(record.with_matrices({5}, flat(std::vector{record.R})), place + "does not fit: it is [5, 3, 3]");
    check_refused(record.with_matrices({}, {1, 1, -1}), no_covariance);
    check_refused(record.with_matrices({}, {1, 2, 0, 2, 1, 0, 0, 0, 1}), no_covariance);
    check_refused(record.with_matrices({}, {1, std::nan(""), 1}), no_covariance);
    check_refused(record.with_matrices({}, {1, 1, 0, 0, 1, 0, 0, 0, 1}),
                  place + "trial 0, step 0 (both counted from 0) is not symmetric");
    check_refused(record.with_text("truth_dependent", "yes"), "/@truth_dependent: says nothing without");
    check_refused(
        [&](const Handle& root) {
            write_values(root, "innovation", extents_of(record.drawn, {3}), flat(record.drawn.error));
            write_values(root, "innovation_covariance", extents_of(record.drawn, {3, 3}),
                         flat(record.drawn.covariance));
            hdf5::write_text(root, "truth_sigma", "0.1");
        },
        "/@truth_sigma: is of a truth, and the record has none");
}

TEST_CASE("uncertain truth: NEES by P + R is that of a record with that P, and the share of R is that of its formula") {
    const Uncertain record;
    const Record read = read_written(record.with_matrices({60, 6}, flat(std::vector{record.R})));
    REQUIRE(read.truth);
    DrawnRecord added = record.drawn, centred = record.drawn;
    double share = 0;
    for (Eigen::MatrixXd& P : added.covariance) {
        P += record.R;
        share += (P.inverse() * record.R).trace() / 3 / static_cast<double>(added.covariance.size());
    }
    centred.covariance = added.covariance;
    for (int k = 0; k < 6; ++k) {
        Eigen::VectorXd mean = Eigen::Vector3d::Zero();
        for (int trial = 0; trial < 60; ++trial) mean += added.error[added.at(trial, k)] / 60;
        for (int trial = 0; trial < 60; ++trial)
            centred.error[added.at(trial, k)] = std::sqrt(60.0 / 59) * (added.error[added.at(trial, k)] - mean);
    }
    const auto nees = [](const DrawnRecord& of) { return report_of(of).arms.front().evidence.groups.front().run.mean; };
    CHECK(read.truth->added.groups.front().run.mean == Approx(nees(added)).epsilon(1e-12));
    CHECK(read.truth->centred->groups.front().run.mean == Approx(nees(centred)).epsilon(1e-12));
    CHECK(read.truth->shares.front() == Approx(share).epsilon(1e-12));
    CHECK_FALSE(read.truth->subtracted);
}

TEST_CASE(
    "uncertain truth: the verdict holds whatever the truth's errors are like, and finds what they do not explain") {
    const auto constant = [](int, int) { return Eigen::Vector2d(0.8, -0.9); };
    const auto exact = [](int, int) { return Eigen::Vector2d(0, 0); };
    struct Case {
        DrawnRecord record;
        double P;
        std::string sigma;
        Verdict verdict;
    };
    const std::vector<Case> cases{
        {calibrated(300, 20, constant), 1, "", Verdict::optimistic},
        {calibrated(300, 20, constant), 1, "0.8", Verdict::undecided},
        {calibrated(300, 20, constant), 1, "0.05", Verdict::optimistic},   // of a bias
        {calibrated(300, 20, constant), 0.2, "0.5", Verdict::optimistic},  // of the spread, too
        {calibrated(300, 20, exact), 1, "0.01", Verdict::consistent},
        {calibrated(300, 20, exact), 2, "0.5", Verdict::pessimistic},
        {calibrated(300, 20, exact), 1, "1", Verdict::undecided},
        {calibrated(60, 20, [](int, int k) { return Eigen::Vector2d(k % 2 ? 5 : -5, 5); }), 1, "5",  // beyond 25
         Verdict::undecided}};
    for (Case one : cases) {
        CAPTURE(one.P, one.sigma);
        for (Eigen::MatrixXd& P : one.record.covariance) P *= one.P;
        const auto write = one.sigma.empty() ? Write([&](const Handle& root) { write_drawn(root, one.record); })
                                             : drawn_with(one.record, "truth_sigma", one.sigma);
        CHECK(arm_of(write).consistency.verdict == one.verdict);
    }
}

TEST_CASE("uncertain truth: errors that are smaller than P, because the truth depends on the filter, are allowed for") {
    DrawnRecord smoothed = calibrated(300, 20, [](int, int) { return Eigen::Vector2d(0, 0); });
    for (Eigen::VectorXd& e : smoothed.error) e *= std::sqrt(0.7);
    const auto verdict = [&](const std::string& sigma, const std::string& dependent) {
        return arm_of([&](const Handle& root) {
                   write_drawn(root, smoothed);
                   hdf5::write_text(root, "truth_sigma", sigma);
                   hdf5::write_text(root, "truth_dependent", dependent);
               })
            .consistency;
    };
    CHECK(verdict("0.55", "no").verdict == Verdict::pessimistic);
    CHECK(verdict("0.55", "yes").verdict == Verdict::undecided);
    CHECK(verdict("0.1", "yes").findings.front().when == "over all steps, by P - R");
    CHECK(verdict("1.1", "yes").reasons.front().starts_with("P - R is no covariance"));
}

TEST_CASE("uncertain truth: an optimistic log has a turning point, at which NEES is 1 and nothing is found") {
    DrawnRecord log = calibrated(1, 2000, [](int, int) { return Eigen::Vector2d(3, 0); });
    Eigen::MatrixXd P(2, 2);
    P << 0.1, 0.05, 0.05, 0.2;
    for (Eigen::MatrixXd& one : log.covariance) one = P;
    const auto write = [&](const std::string& name, const std::string& text) {
        return [=](const Handle& root) {
            drawn_with(log, name, text)(root);
            hdf5::write_text(root, "component_units", "m, m");
        };
    };
    const std::vector<TurningPoint> points = arm_of(write("component_names", "x, y")).consistency.turning_points;
    REQUIRE(points.size() == 1);
    CHECK((points[0].where == "all" && points[0].unit == "m"));
    Eigen::Vector2d mean(0, 0);
    for (const Eigen::VectorXd& e : log.error) mean += e / 2000;
    const Eigen::MatrixXd sum = P + points[0].right * points[0].right * Eigen::Matrix2d::Identity();
    double nees = 0;
    for (const Eigen::VectorXd& e : log.error) nees += plain_nees(e - mean, sum, {0, 1}) / 4000;
    CHECK(nees == Approx(1).epsilon(1e-9));
    const auto is_found = [&](double sigma) {
        const std::vector<Finding> found = arm_of(write("truth_sigma", to_text(sigma))).consistency.findings;
        return std::ranges::any_of(found,
                                   [](const Finding& one) { return one.where == "all" && one.about == Subject::size; });
    };
    CHECK(is_found(0.95 * points[0].vanishes));
    CHECK_FALSE(is_found(1.05 * points[0].vanishes));
}

}  // namespace credence::test::record_truth_test
