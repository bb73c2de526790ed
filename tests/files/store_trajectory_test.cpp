// Files: recorded noise and trajectories of single trials.

#include "slam_steps.hpp"
#include "worlds/deformable/deformable.hpp"
#include "slam/trial/problem.hpp"

#include "files/hdf5/read.hpp"
#include "store_damage.hpp"
#include "of_scenarios.hpp"

namespace credence::test::store_trajectory_test {

namespace {

Handle group_of(const Handle& root, const std::string& scenario_name, const std::string& arm) {
    return hdf5::open_group(hdf5::open_group(root, scenario_name), arm);
}

template <class T = double>
std::vector<T> values(const Handle& group, const std::string& name, const hdf5::Extents& extents) {
    const hdf5::Dataset dataset(group, name);
    dataset.require_extents(extents);
    return dataset.read<T>();
}

/// A noise record as h5py would write it.
void write_record(const std::string& path, const std::function<void(const Handle&)>& change) {
    const Handle root(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose, path, "");
    double next = 0;
    const auto put = [&](const char* name, const hdf5::Extents& extents) {
        std::vector<double> values(extents[0] * extents[1] * (extents.size() > 2 ? extents[2] : 1));
        for (double& value : values) value = next += 0.25;
        hdf5::write_dataset(root, name, hdf5::type_of<double>(), values.data(), extents, {"", ""});
    };
    put("odometry", {7, 3});
    for (const char* name : {"walk", "deformation", "measurement"}) put(name, {7, 2, 2});
    put("edge", {7, 1, 2});
    change(root);
}

}  // namespace

TEST_CASE("store: a noise record reads back, in any size and order of floats") {
    const TemporaryFolder folder;
    const std::string path = folder / "noise.h5";
    write_record(path, [](auto&) {});
    const NoiseRecord record = read_noise_record(path);
    CHECK(record.poses == 7);
    CHECK(record.features == 2);
    CHECK(record.edges == 1);
    CHECK(record.odometry.size() == 21);
    CHECK(record.odometry[1] == 0.5);
    CHECK(record.walk.front() == 0.25 * 22);
    CHECK(record.deformation.front() == 0.25 * (22 + 28));
    CHECK(record.measurement.back() == 0.25 * (21 + 3 * 28));
    CHECK(record.edge.back() == 0.25 * (21 + 3 * 28 + 14));
    write_record(path, [](const Handle& root) {
        remove(root, "edge");
        remove(root, "odometry");
        const std::vector<double> numbers(21, 1.5);
        hdf5::write_dataset(root, "odometry", {H5T_IEEE_F32BE, H5T_NATIVE_DOUBLE}, numbers.data(), {7, 3}, {"", ""});
    });
    CHECK(read_noise_record(path).edges == 0);
    CHECK(read_noise_record(path).odometry == std::vector<double>(21, 1.5));
}

TEST_CASE("store: noise records that are incomplete, of other dimensions or type, or not finite are refused") {
    const std::vector<Damage> damages{
        {"/walk: is missing", without("walk")},
        {"/odometry: has extents [7, 2], not [7, 3]", replaced<double>("odometry", {7, 2})},
        {"/odometry: has extents [21], not 2 of them", replaced<double>("odometry", {21})},
        {"/odometry: has extents [0, 3], of which", replaced<double>("odometry", {0, 3})},
        {"/odometry: has extents [100001, 3], of which", replaced<double>("odometry", {100001, 3})},
        {"/walk: has extents [7, 65, 2], of which", replaced<double>("walk", {7, 65, 2})},
        {"/walk: has extents [6, 2, 2], not [7, 2, 2]", replaced<double>("walk", {6, 2, 2})},
        {"/deformation: has extents [7, 3, 2], not [7, 2, 2]", replaced<double>("deformation", {7, 3, 2})},
        {"/measurement: holds 32-bit integers, not floats", replaced<std::int32_t>("measurement", {7, 2, 2})},
        {"/measurement: holds nan at [1, 0, 1]", replaced<double>("measurement", {7, 2, 2}, {0, 0, 0, 0, 0, NAN})},
        {"/edge: holds inf at [0, 0, 0]", replaced<double>("edge", {7, 1, 2}, {INFINITY})},
        {"/edge: has extents [7, 1, 3], not [7, 1, 2]", replaced<double>("edge", {7, 1, 3})},
        {"/walk: is a link", [](auto& r) {
             remove(r, "walk");
             H5Lcreate_external("other.h5", "/walk", r.id(), "walk", H5P_DEFAULT, H5P_DEFAULT);
         }},
    };
    require_refused(damages, write_record, read_noise_record);
}

TEST_CASE("store: a trajectory is in its file as it was") {
    const TemporaryFolder folder;
    const Trajectory greedy = replay_trial(Problem(scenario("one")), {Controller::greedy}, 1, 0);
    const std::vector<TrajectoryStep> steps = steps_of(greedy);
    write_trajectories(folder / "trace.h5", {greedy}, run_facts);
    const Handle root = hdf5::open_file(folder / "trace.h5"), group = group_of(root, "one", "greedy.ekf");
    const std::size_t candidates = steps.back().candidate_cost.size();
    const auto truth = values(group, "truth", {4, 9}), mean = values(group, "mean", {4, 9});
    const auto P = values(group, "covariance", {4, 9, 9}), predicted = values(group, "predicted_covariance", {4, 9, 9});
    const auto nees = values(group, "nees", {4}), cost = values(group, "candidate_cost", {4, candidates});
    const auto S = values(group, "innovation_covariance", {4, 12, 12}), z = values(group, "measurement", {4, 3, 2});
    const auto move = values(group, "control_move", {4, 2});
    const auto seen = values<std::int8_t>(group, "seen", {4, 3});
    const auto rows = values<std::int32_t>(group, "rows", {4});
    for (std::size_t k = 0; k < 4; ++k) {
        const TrajectoryStep& step = steps[k];
        for (Eigen::Index i = 0; i < 9; ++i) {
            CHECK(truth[9 * k + static_cast<std::size_t>(i)] == step.truth[i]);
            CHECK(mean[9 * k + static_cast<std::size_t>(i)] == step.mean[i]);
            CHECK(P[81 * k + static_cast<std::size_t>(i)] == step.covariance(0, i));
        }
        if (k == 0) continue;
        CHECK(predicted[81 * k + 9 * 3 + 8] == step.predicted_covariance(3, 8));
        CHECK(nees[k] == step.nees);
        CHECK(rows[k] == step.rows);
        CHECK(move[2 * k + 1] == step.control.move.y);
        CHECK(cost[candidates * (k + 1) - 1] == step.candidate_cost.back());
        for (std::size_t j = 0; j < 3; ++j) CHECK(seen[3 * k + j] == (step.seen[j] ? 1 : 0));
        for (std::size_t j = 0; j < 3; ++j) CHECK(std::isnan(z[6 * k + 2 * j]) == !step.seen[j]);
        CHECK(S[144 * k + 12 * 6 + 8] == step.innovation_covariance(6, 8));
    }
    CHECK(values<std::int32_t>(group, "edge_to", {3}) == std::vector<std::int32_t>{1, 2, 2});
}

TEST_CASE(
    "store: a trajectory has the sigma of a feature's range also where it was not seen, and no measurement there") {
    const TemporaryFolder folder;
    DeformableSettings ranged = scenario("one");
    ranged.sensor.noise = RangeNoise::ranged;
    ranged.sensor.range_max = 0.6;
    write_trajectories(folder / "trace.h5", {replay_trial(Problem(ranged), {Controller::fixed}, 1, 0)}, {});
    const Handle root = hdf5::open_file(folder / "trace.h5"), group = group_of(root, "one", "fixed.ekf");
    const auto truth = values(group, "truth", {4, 9}), sigma = values(group, "measurement_sigma", {4, 3}),
               z = values(group, "measurement", {4, 3, 2});
    const auto seen = values<std::int8_t>(group, "seen", {4, 3});
    CHECK(std::count(seen.begin() + 3, seen.end(), 0) > 0);
    for (std::size_t k = 1; k < 4; ++k)
        for (std::size_t j = 0; j < 3; ++j) {
            const double *at = truth.data() + 9 * k, *feature = at + 3 + 2 * j;
            const double q = std::hypot(feature[0] - at[1], feature[1] - at[2]);
            CHECK(sigma[3 * k + j] == Approx(0.01 + 0.08 * std::max(0.0, q - 0.1) / 0.5).epsilon(1e-12));
            CHECK(std::isnan(z[6 * k + 2 * j]) == (seen[3 * k + j] == 0));
        }
}

TEST_CASE("store: a trajectory has nothing but NaN and -1 where no step led to") {
    const TemporaryFolder folder;
    const Trajectory trajectory = replay_trial(Problem(scenario("one")), {Controller::greedy}, 1, 0);
    write_trajectories(folder / "trace.h5", {trajectory}, {});
    const Handle root = hdf5::open_file(folder / "trace.h5"), group = group_of(root, "one", "greedy.ekf");
    for (const char* name :
         {"predicted_mean", "predicted_covariance", "nees", "nis", "control_turn", "control_move", "measurement_sigma",
          "measurement", "innovation", "innovation_covariance", "candidate_cost"}) {
        INFO(name);
        const std::vector<double> all = hdf5::Dataset(group, name).read<double>();
        const auto second_pose = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 4);
        CHECK(std::all_of(all.begin(), second_pose, [](double value) { return std::isnan(value); }));
        CHECK(!std::all_of(second_pose, all.end(), [](double value) { return std::isnan(value); }));
    }
    for (const char* name : {"truth", "mean", "covariance", "trace_P"})
        CHECK(!std::isnan(hdf5::Dataset(group, name).read<double>().front()));
    CHECK(values<std::int32_t>(group, "rows", {4})[0] == -1);
    CHECK(values<std::int8_t>(group, "seen", {4, 3})[2] == -1);
}

TEST_CASE("store: trajectories lie in groups by scenario and arm, with the trial's columns") {
    const TemporaryFolder folder;
    std::vector<Trajectory> trajectories;
    for (const DeformableSettings& one : {scenario("first"), scenario("second", "translation")})
        for (const Arm& arm : arms_of(one)) trajectories.push_back(replay_trial(Problem(one), arm, 1, 0));
    trajectories[1].column_values[column_status] = 2;
    write_trajectories(folder / "trace.h5", trajectories, run_facts);
    const Handle root = hdf5::open_file(folder / "trace.h5");
    CHECK(hdf5::read_text(root, "format") == "credence trajectories");
    CHECK(hdf5::link_names(root) == std::vector<std::string>{"first", "second", "run"});
    const Handle greedy = group_of(root, "first", "greedy.ekf");
    CHECK(hdf5::read_number<double>(greedy, "trace_P") == trajectories[1].column_values[column_trace_P]);
    CHECK(hdf5::read_number<std::int32_t>(greedy, "unseen") == trajectories[1].column_values[column_unseen]);
    CHECK(hdf5::read_number<std::int8_t>(greedy, "status") == 2);
    CHECK(hdf5::read_text(greedy, "status_text") == "covariance_not_positive_definite");
    CHECK(!hdf5::has_link(group_of(root, "second", "fixed.kf"), "candidate"));
    const Handle component(H5Dopen2(greedy.id(), "component", H5P_DEFAULT), H5Dclose, "", "");
    CHECK(hdf5::read_text(component, "component_names") == "theta r_x r_y f0_x f0_y f1_x f1_y f2_x f2_y");
    CHECK(hdf5::read_text(component, "component_units") == "rad dm dm dm dm dm dm dm dm");
}

TEST_CASE("store: innovations beyond the kept size are left out, and the file says so") {
    const TemporaryFolder folder;
    DeformableSettings wide = scenario("wide", "translation");
    wide.features.positions.assign(23, {0.5, 0.5});  // 2 (23 + 23 * 22 / 2) = 552 rows
    wide.poses = 2;
    const Trajectory trajectory = replay_trial(Problem(wide), {Controller::fixed, Estimator::kf}, 1, 0);
    write_trajectories(folder / "trace.h5", {trajectory}, {});
    const Handle root = hdf5::open_file(folder / "trace.h5"), group = group_of(root, "wide", "fixed.kf");
    CHECK(!hdf5::has_link(group, "innovation"));
    CHECK(!hdf5::has_link(group, "row"));
    CHECK(hdf5::read_text(group, "innovation_omitted") == "552 rows, more than the 512 that are kept");
}

}  // namespace credence::test::store_trajectory_test
