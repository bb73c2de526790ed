// Room 12, files: what other tools find in them, and that docs/results-format.md tells it.

#include <credence/problem.hpp>

#include "../src/hdf5_read.hpp"
#include "store_study.hpp"

#include <hdf5_hl.h>

#include <set>

using namespace credence;
using namespace credence::test;

namespace {

/// Names of variables and attributes below an object, as the documentation writes them.
void collect_names(const hdf5::Handle& object, std::set<std::string>& names) {
    for (const std::string& name : hdf5::attribute_names(object)) names.insert(name);
    if (H5Iget_type(object.id()) == H5I_DATASET) return;
    for (const std::string& name : hdf5::link_names(object)) {
        if (name == "run") continue;
        const hdf5::Handle child(H5Oopen(object.id(), name.c_str(), H5P_DEFAULT), H5Oclose, name, "cannot open it");
        collect_names(child, names);
        if (H5Iget_type(child.id()) != H5I_DATASET) continue;
        if (H5Aexists(child.id(), "figure") > 0) {
            const std::string figure = hdf5::read_text(child, "figure");
            names.insert("F" + name.substr(figure.size()));
            const auto is = [&](const std::string& start) { return figure.starts_with(start); };
            names.insert(is("nees_feature_")            ? "nees_feature_J"
                         : is("squared_error_feature_") ? "squared_error_feature_J"
                         : is("variance_feature_")      ? "variance_feature_J"
                         : is("standardised_error_")    ? "standardised_error_COMPONENT"
                                                        : figure);
        } else if (name.ends_with("_covered")) {
            names.insert("F_covered");
        } else {
            names.insert(name);
        }
    }
}

}  // namespace

TEST_CASE("results format: the documentation names every variable and attribute") {
    const TemporaryFolder folder;
    write_results(folder / "study.h5", made_up_study(), {});
    Scenario wide = scenario("wide");
    wide.features.positions.assign(23, {0.5, 0.5});
    write_trajectories(folder / "trace.h5", {replay_trial(Problem(scenario("one")), {Controller::greedy}, 1, 0),
                                             replay_trial(Problem(wide), {Controller::fixed}, 1, 0)}, {});
    std::set<std::string> names;
    for (const char* file : {"study.h5", "trace.h5"}) collect_names(hdf5::open_file(folder / file), names);
    for (const char* of_hdf5 : {"CLASS", "NAME", "REFERENCE_LIST", "DIMENSION_LIST"}) CHECK(names.erase(of_hdf5) == 1);
    CHECK(names.count("candidate_cost") + names.count("innovation_omitted") + names.count("F_run_square_total") == 3);

    const std::string page = bytes_of(CREDENCE_SOURCE "/docs/results-format.md");
    CHECK(page.find("schema version " + std::to_string(schema_version) + " of the two files") != std::string::npos);
    for (const std::string& name : names) {
        INFO(name);
        CHECK((page.find("`" + name + "`") != std::string::npos || page.find("`" + name + " ") != std::string::npos));
    }
    for (const std::string& status : status_names()) CHECK(page.find(status) != std::string::npos);
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
        const hdf5::Handle dataset(H5Dopen2(group.id(), name.c_str(), H5P_DEFAULT), H5Dclose, name, "missing");
        CHECK(!hdf5::read_text(dataset, "long_name").empty());
        CHECK(!hdf5::read_text(dataset, "units").empty());
        if (H5DSis_scale(dataset.id()) > 0) continue;
        using Names = std::vector<std::string>;
        const std::vector<std::string> expected = name == "whiteness_count"            ? Names{"lag"}
                                                  : name.starts_with("whiteness_")     ? Names{"lag", "part"}
                                                  : name == "detailed_nees"            ? Names{"detailed_trial", "step"}
                                                  : name == "detailed_error"   ? Names{"detailed_trial", "step", "component"}
                                                  : name == "nees_cells"       ? Names{"step", "cell"}
                                                  : name.ends_with("_covered") ? Names{"step", "level"}
                                                  : name.ends_with("_run_square_total") ? std::vector<std::string>{"part"}
                                                  : name.ends_with("_total") ? std::vector<std::string>{"step", "part"}
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
    const hdf5::Handle group = hdf5::open_group(hdf5::open_group(root, "first"), "fixed.ekf");
    const auto variable = [&](const char* name) {
        return hdf5::Handle(H5Dopen2(group.id(), name, H5P_DEFAULT), H5Dclose, name, "missing");
    };
    CHECK(hdf5::read_text(variable("status"), "flag_meanings") ==
          "completed diverged covariance_not_positive_definite non_finite");
    CHECK(hdf5::read_text(variable("trace_P"), "units") == "dm^2 + rad^2");
    CHECK(hdf5::read_text(variable("trace_P_step_square_total"), "units") == "(dm^2 + rad^2)^2");
    CHECK(hdf5::read_text(variable("nees_pose_total"), "role") == "nees");
    CHECK(hdf5::read_text(variable("nees_pose_total"), "figure") == "nees_pose");
    CHECK(hdf5::read_number<std::int32_t>(variable("nees_pose_total"), "dimension") == 3);
    CHECK(hdf5::read_text(variable("nis_rows_run_square_total"), "role") == "rows");
    // NaN has the same bits whatever made it: made_up_study put one with its sign set.
    CHECK(!std::signbit(hdf5::Dataset(group, "trace_P").read<double>()[1]));
}
