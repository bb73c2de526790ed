// A run, replayed, written as a record and read by `judge`: the same verdict and numbers as the run's.

#include <credence/consistency.hpp>
#include <credence/record.hpp>
#include "files/results/format.hpp"
#include "slam/trial/problem.hpp"
#include "slam_steps.hpp"
#include "worlds/deformable/deformable.hpp"

#include "store_study.hpp"
#include "support.hpp"

#include <hdf5_hl.h>

#include <cmath>

namespace credence::test::judgement_run_test {

namespace {

constexpr std::uint64_t seed = 3;

struct Values {
    std::vector<double> error, covariance, innovation, innovation_covariance;

    void add(const TrajectoryStep& step) {
        const auto append = [](std::vector<double>& to, const auto& from) {
            for (Eigen::Index i = 0; i < from.rows(); ++i)
                for (Eigen::Index j = 0; j < from.cols(); ++j) to.push_back(from(i, j));
        };
        append(error, step.mean - step.truth);
        append(covariance, step.covariance);
        append(innovation, step.innovation);
        append(innovation_covariance, step.innovation_covariance);
    }
};

/// Writes the trajectories of trials 0 ... trials - 1 as anybody would.
void write_record(const std::string& path, const DeformableSettings& scenario, std::uint64_t trials) {
    const Problem problem(scenario);
    Values values;
    for (std::uint64_t trial = 0; trial < trials; ++trial) {
        const Trajectory trajectory =
            replay_trial(problem, {Controller::fixed}, seed, static_cast<std::int64_t>(trial));
        const std::vector<TrajectoryStep> all = steps_of(trajectory);
        for (std::size_t k = 1; k < all.size(); ++k) values.add(all[k]);
    }
    const hsize_t steps = static_cast<hsize_t>(scenario.poses - 1), n = static_cast<hsize_t>(state_size(scenario)),
                  m = values.innovation.size() / trials / steps;
    const hsize_t of_state[] = {trials, steps, n, n}, of_rows[] = {trials, steps, m, m};
    const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    H5LTmake_dataset_double(file, "error", 3, of_state, values.error.data());
    H5LTmake_dataset_double(file, "covariance", 4, of_state, values.covariance.data());
    H5LTmake_dataset_double(file, "innovation", 3, of_rows, values.innovation.data());
    H5LTmake_dataset_double(file, "innovation_covariance", 4, of_rows, values.innovation_covariance.data());
    H5LTset_attribute_string(file, "/", "groups", groups_text(state_groups(scenario)).c_str());
    H5Fclose(file);
}

Evidence evidence_of_run(const DeformableSettings& scenario, std::int64_t trials) {
    Study study = new_study({scenario}, seed);
    run_study(study, {trials, 1, {}});
    return evidence_of(study.scenarios.front(), study.scenarios.front().arms.front());
}

/// To the rounding of a joint update against the sequential one, NaN like NaN.
void check_near(double ours, double record) { CHECK(relative(ours, record) < 1e-8); }
void check_near(const std::vector<double>& ours, const std::vector<double>& record) {
    REQUIRE(ours.size() == record.size());
    for (std::size_t i = 0; i < ours.size(); ++i) check_near(ours[i], record[i]);
}

void check_blocks(const Evidence& run, const Evidence& record) {
    REQUIRE(run.groups.size() == record.groups.size());
    for (std::size_t b = 0; b < run.groups.size(); ++b) {
        const GroupEvidence &ours = run.groups[b], &theirs = record.groups[b];
        INFO(ours.name);
        CHECK(ours.name == theirs.name);
        check_near(ours.run.mean, theirs.run.mean);
        check_near(ours.run.standard_error, theirs.run.standard_error);
        check_near(ours.anees.ratio, theirs.anees.ratio);
        check_near(ours.anees.degrees, theirs.anees.degrees);
        check_near(ours.variance_ratio, theirs.variance_ratio);
        check_near(ours.accuracy.rmse, theirs.accuracy.rmse);
        check_near(ours.accuracy.ratio, theirs.accuracy.ratio);
        for (std::size_t level = 0; level < ours.coverage.size(); ++level)
            CHECK(ours.coverage[level].share == theirs.coverage[level].share);
    }
}

}  // namespace

TEST_CASE("judge: a run's trajectories, written as a record, give the run's evidence and verdict") {
    const TemporaryFolder folder;
    for (const Settings& world : {Settings{{"features.path", "circle"}},
                                  Settings{{"model.process", "translation"},
                                           {"edges.graph", "chain"},
                                           {"sensor.range_min", "0"},
                                           {"sensor.range_max", "inf"}},
                                  Settings{{"noise.heading", "0.05"},
                                           {"filter.covariance", "0.5"},
                                           {"edges.graph", "none"},
                                           {"sensor.range_min", "0"},
                                           {"sensor.range_max", "inf"}}}) {
        CAPTURE(described(world));
        const DeformableSettings scenario = scenario_with(scenario_with(world), {{"arms.controllers", "fixed"}});
        constexpr int trials = 40;
        write_record(folder / "record.h5", scenario, trials);
        const Record judged = read_record(folder / "record.h5");
        CHECK(judged.trouble_count == 0);
        const Evidence run = evidence_of_run(scenario, trials),
                       record = evidence_of(judged.results, judged.results.arms.front());
        check_blocks(run, record);
        REQUIRE(record.nis.size() == 1);  // a record does not distinguish features from edges
        check_near(run.nis.front().nis.ratio, record.nis.front().nis.ratio);
        CHECK(run.nis.front().degrees == record.nis.front().degrees);
        REQUIRE(run.whiteness.size() == record.whiteness.size());
        // A record counts a lag in measurements of the row: the same if all are made.
        const bool all_seen = run.whiteness.front().count == record.whiteness.front().count;
        CHECK(all_seen == (scenario.features.path != Path::circle));
        for (std::size_t lag = 0; lag < run.whiteness.size() && all_seen; ++lag) {
            CHECK(run.whiteness[lag].count == record.whiteness[lag].count);
            CHECK(run.whiteness[lag].correlation == Approx(record.whiteness[lag].correlation).margin(1e-9));
        }
        for (std::size_t j = 0; j < run.bias.size(); ++j)
            for (std::size_t k = 0; k < run.bias[j].step.size(); ++k)
                CHECK(run.bias[j].step[k].mean == Approx(record.bias[j].step[k].mean).margin(1e-9));
        for (std::size_t k = 0; k < run.distribution.distance.size(); ++k) {
            // The run has it on 4096 cells.
            CHECK(run.distribution.distance[k] <= record.distribution.distance[k] + 1e-12);
            CHECK(run.distribution.distance[k] >= record.distribution.distance[k] - 1.0 / 4096);
        }
        CHECK(run.credibility.nci == Approx(record.credibility.nci).epsilon(1e-5));  // errors kept in single precision
        CHECK(run.credibility.inclination == Approx(record.credibility.inclination).epsilon(1e-4));
        CHECK(judge(run, 0.05).verdict == judge(record, 0.05).verdict);
    }
}

}  // namespace credence::test::judgement_run_test
