// The content of results files for other tools, and that docs/results-format.md describes it.

#include "slam_steps.hpp"
#include "worlds/deformable/deformable.hpp"
#include "worlds/values.hpp"
#include "slam/trial/problem.hpp"

#include "results_format_page.hpp"
#include "store_study.hpp"

#include <credence/detail/worlds.hpp>
#include <credence/ini.hpp>

#include <algorithm>
#include <map>
#include <numeric>

namespace credence::test::results_format_test {

namespace {

/// The page from one heading to another.
std::string part_of_page(const std::string& page, const std::string& from, const std::string& to) {
    const std::size_t begin = page.find(from), end = page.find(to);
    REQUIRE(begin < end);
    REQUIRE(end != std::string::npos);
    return page.substr(begin, end - begin);
}

Facts without(const Facts& facts, const Facts& others) {
    Facts rest;
    std::set_difference(facts.begin(), facts.end(), others.begin(), others.end(), std::inserter(rest, rest.end()));
    return rest;
}

Facts together(Facts facts, const Facts& others) {
    facts.insert(others.begin(), others.end());
    return facts;
}

}  // namespace

TEST_CASE("results format: the documentation and the files say the same of every variable and attribute") {
    const TemporaryFolder folder;
    write_results(folder / "study.h5", made_up_study(), {});
    DeformableSettings wide = scenario("wide");
    wide.features.positions.assign(23, {0.5, 0.5});
    const Scenario own = read_scenario_text("[scenario]\nworld = spoiled\n", "test", "own"),
                   large = read_scenario_text("[scenario]\nworld = large_state\nposes = 2\n", "test", "large");
    write_trajectories(folder / "trace.h5", {replay_trial(Problem(scenario("one")), {Controller::greedy}, 1, 0),
                                             replay_trial(Problem(wide), {Controller::fixed}, 1, 0),
                                             replay_trial(own, 0, 1, 0), replay_trial(large, 0, 1, 0)}, {});
    Scenario point = scenario_of(scenario("swept_sigma-0p05_noise-constant"));
    point.sweep = {"swept", {{"sensor.sigma", "0.05"}, {"sensor.noise", "constant"}}};
    write_results(folder / "swept.h5", new_study(std::vector{point}, 1), {});
    DeformableSettings charts = scenario("charts");
    charts.arms.estimators = {Estimator::ekf, Estimator::riekf};
    write_results(folder / "charts.h5", made_up_study({charts}), {});
    Study aggregates = new_study({scenario("first")}, 1, Keep::aggregates);
    run_study(aggregates, {3, 1, {}});
    write_results(folder / "aggregates.h5", aggregates, {});
    Facts results;
    for (const char* file : {"study.h5", "swept.h5", "charts.h5", "aggregates.h5"})
        results = together(results, found_in(folder / file));
    const Facts trajectories = found_in(folder / "trace.h5");
    const std::string page = bytes_of(CREDENCE_SOURCE "/docs/results-format.md");
    const Facts common = documented(part_of_page(page, "# The files", "## What a reader")),
                of_results = documented(part_of_page(page, "## Results", "## `/run`")),
                of_trajectories = documented(part_of_page(page, "## Trajectories", "## Reading"));
    CHECK(common.size() + of_results.size() + of_trajectories.size() > 100);  // the tables were found
    // A trajectory's header and scenario are as in results, and are documented there.
    const auto shared = [](const std::string& fact) {
        return fact.starts_with("root ") || fact.starts_with("scenario ");
    };
    Facts headers;
    std::copy_if(of_results.begin(), of_results.end(), std::inserter(headers, headers.end()), shared);

    CHECK(without(results, together(common, of_results)) == Facts{});
    CHECK(without(trajectories, together(together(common, headers), of_trajectories)) == Facts{});
    CHECK(without(of_results, results) == Facts{});
    CHECK(without(of_trajectories, trajectories) == Facts{});
    CHECK(without(common, together(results, trajectories)) == Facts{});
}

TEST_CASE("results format: the documentation names the schema version and every status") {
    const std::string page = bytes_of(CREDENCE_SOURCE "/docs/results-format.md");
    CHECK(page.find("schema version " + std::to_string(schema_version) + " of the two files") != std::string::npos);
    for (const std::string& status : status_names()) CHECK(page.find(status) != std::string::npos);
}

TEST_CASE("results format: candidates and their costs are there for the controllers that plan, and only for these") {
    const std::string page = bytes_of(CREDENCE_SOURCE "/docs/results-format.md");
    const std::string row = matches(page, R"(\n(\| `candidate` [^\n]*))").at(0);
    for (std::size_t c = 0; c < controller_names().size(); ++c) {
        const auto controller = static_cast<Controller>(c);
        CAPTURE(controller_names()[c]);
        DeformableSettings settings = scenario("one");
        settings.arms.controllers = {controller};
        if (controller == Controller::waypoints) settings.waypoints = {{2, 0}};
        const Trajectory trajectory = replay_trial(Problem(settings), {controller}, 1, 0);
        CHECK(std::any_of(trajectory.dimensions.begin(), trajectory.dimensions.end(), [](const auto& dimension) {
                  return dimension.name == "candidate";
              }) == plans(controller));
        CHECK((row.find("`" + controller_names()[c] + "`") == std::string::npos) == plans(controller));
    }
}

TEST_CASE("results format: the costs of candidates are in the unit of their criterion") {
    const std::map<Criterion, std::string> units{
        {Criterion::trace, "dm^2 + rad^2"}, {Criterion::max_eigenvalue, "dm^2 + rad^2"},
        {Criterion::pose_trace, "dm^2 + rad^2"}, {Criterion::features_trace, "dm^2"},
        {Criterion::log_det, "1"}, {Criterion::pose_log_det, "1"}};
    for (const auto& [criterion, unit] : units) {
        DeformableSettings settings = scenario("one");
        settings.planner.criterion = criterion;
        const Trajectory trajectory = replay_trial(Problem(settings), {Controller::greedy}, 1, 0);
        CHECK(std::find_if(trajectory.variables.begin(), trajectory.variables.end(), [](const auto& variable) {
                  return variable.name == "candidate_cost";
              })->unit == unit);
    }
}

TEST_CASE("results format: the moments of a trial begin with its mean NEES of the whole state") {
    const TemporaryFolder folder;
    Study study = new_study({scenario("first")}, 1);
    run_study(study, {3, 1, {}});
    write_results(folder / "study.h5", study, {});
    const hdf5::Handle root = hdf5::open_file(folder / "study.h5");
    const hdf5::Handle scenario_group = hdf5::open_group(root, "first");
    const hdf5::Handle arm = hdf5::open_group(scenario_group, hdf5::link_names(scenario_group).front());
    const std::vector<double> moments = hdf5::Dataset(arm, "detailed_moments").read<double>();
    const std::vector<float> nees = hdf5::Dataset(arm, "detailed_nees").read<float>();
    const std::size_t each = moments.size() / 3, steps = nees.size() / 3;
    for (std::size_t trial = 0; trial < 3; ++trial) {
        const auto first = nees.begin() + static_cast<std::ptrdiff_t>(trial * steps);
        // The file keeps each step's NEES as a float.
        CHECK(moments[trial * each] == Approx(std::accumulate(first, first + static_cast<std::ptrdiff_t>(steps), 0.0) /
                                              static_cast<double>(steps))
                                           .epsilon(1e-6));
    }
}

TEST_CASE("store: every variable has a long name, units and dimension scales in its own group") {
    const TemporaryFolder folder;
    write_results(folder / "study.h5", made_up_study(), run_facts);
    const hdf5::Handle root = hdf5::open_file(folder / "study.h5");
    const hdf5::Handle group = hdf5::open_group(hdf5::open_group(root, "first"), "greedy.ekf");
    const std::vector<std::string> names = hdf5::link_names(group);
    CHECK(names.front() == "trial");
    for (const std::string& name : names) {
        INFO(name);
        if (name == without_diverged) continue;
        const hdf5::Handle dataset(H5Dopen2(group.id(), name.c_str(), H5P_DEFAULT), H5Dclose, name, "missing");
        CHECK(!hdf5::read_text(dataset, "long_name").empty());
        CHECK(!hdf5::read_text(dataset, "units").empty());
        if (H5DSis_scale(dataset.id()) > 0) continue;
        using Names = std::vector<std::string>;
        const std::vector<std::string> expected =
            name == "status_count"                ? Names{"status_code"}
            : name == "column_count"              ? Names{"column"}
            : name.starts_with("column_")         ? Names{"column", "part"}
            : name.ends_with("_below") || name.ends_with("_above") || name == "difference_count"
                ? Names{"subtracted_arm", "column"}
            : name.starts_with("difference_")     ? Names{"subtracted_arm", "column", "part"}
            : name == "whiteness_count"           ? Names{"lag"}
            : name.starts_with("whiteness_")      ? Names{"lag", "part"}
            : name == "detailed_nees"             ? Names{"detailed_trial", "step"}
            : name == "detailed_error"            ? Names{"detailed_trial", "step", "component"}
            : name == "detailed_moments"          ? Names{"detailed_trial", "moment"}
            : name == "nees_cells"                ? Names{"step", "cell"}
            : name.ends_with("_covered")          ? Names{"step", "level"}
            : name.ends_with("_run_square_total") ? std::vector<std::string>{"part"}
            : name.ends_with("_total")            ? std::vector<std::string>{"step", "part"}
                                                  : std::vector<std::string>{"trial"};
        for (unsigned axis = 0; axis < hdf5::Dataset(group, name).extents().size(); ++axis) {
            const hdf5::Handle scale(H5Dopen2(group.id(), expected[axis].c_str(), H5P_DEFAULT), H5Dclose, name, "");
            CHECK(H5DSget_num_scales(dataset.id(), axis) == 1);
            CHECK(H5DSis_attached(dataset.id(), scale.id(), axis) > 0);
        }
    }
}

TEST_CASE("store: what outside tools need to know is in the file") {
    const TemporaryFolder folder;
    write_results(folder / "study.h5", made_up_study(), run_facts);
    const hdf5::Handle root = hdf5::open_file(folder / "study.h5");
    CHECK(hdf5::read_text(root, "root_seed_text") == "18446744073709551615");
    const hdf5::Handle group = hdf5::open_group(hdf5::open_group(root, "first"), "fixed.ekf"),
                       linear = hdf5::open_group(hdf5::open_group(root, "second"), "fixed.kf");
    const auto variable = [&](const char* name) {
        return hdf5::Handle(H5Dopen2(group.id(), name, H5P_DEFAULT), H5Dclose, name, "missing");
    };
    CHECK(hdf5::read_text(variable("status"), "flag_meanings") ==
          "completed diverged covariance_not_positive_definite non_finite");
    CHECK(hdf5::read_text(variable("trace_P"), "units") == "dm^2 + rad^2");
    CHECK(hdf5::read_text(variable("trace_P_step_square_total"), "units") == "(dm^2 + rad^2)^2");
    CHECK(hdf5::read_text(variable("nees_pose_total"), "role") == "nees");
    CHECK(hdf5::read_text(variable("nees_pose_total"), "series") == "nees_pose");
    CHECK(hdf5::read_number<std::int32_t>(variable("nees_pose_total"), "dimension") == 3);
    CHECK(hdf5::read_text(variable("nis_rows_run_square_total"), "role") == "rows");
    CHECK(hdf5::read_text(variable("component"), "component_names") == "theta r_x r_y f0_x f0_y f1_x f1_y f2_x f2_y");
    CHECK(hdf5::read_text(variable("component"), "component_units") == "rad dm dm dm dm dm dm dm dm");
    CHECK(hdf5::read_text(variable("detailed_error"), "units") == "see component_units");
    const hdf5::Handle error(H5Dopen2(linear.id(), "detailed_error", H5P_DEFAULT), H5Dclose, "", "missing");
    CHECK(hdf5::read_text(error, "units") == "dm");
    // NaN has the same bits whatever made it: made_up_study put one with its sign set.
    CHECK(!std::signbit(hdf5::Dataset(group, "trace_P").read<double>()[1]));
}

}  // namespace credence::test::results_format_test
