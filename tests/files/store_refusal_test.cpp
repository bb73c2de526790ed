// Damaged, foreign and hostile files are refused by name and place, before anything is computed.
// Kind: foreign files.

#include "store_damage.hpp"
#include "of_scenarios.hpp"

#include <sys/stat.h>

namespace credence::test::store_refusal_test {

namespace {

const std::string arm = "/first/greedy.ekf";

const std::vector<Damage> header_damages{
    {"is not a results file", with_text("/", "format", "credence trajectories")},
    {"is not a results file", without_attribute("/", "format")},
    {"/@schema_version: is 9, this program's is 5", with_number<std::int32_t>("/", "schema_version", 9)},
    {"/@schema_version: holds 64-bit integers, not 32-bit", with_number<std::int64_t>("/", "schema_version", 1)},
    {"/@schema_version: is missing", without_attribute("/", "schema_version")},
    {"/@root_seed_text: is not root_seed=", with_text("/", "root_seed_text", "7")},
    {"/@study_hash: does not belong", [](auto& r) {
         set_number<std::uint64_t>(r, "/", "root_seed", 7);
         set_text(r, "/", "root_seed_text", "7");
     }},
    {"/@study_hash: does not belong", without("/second")},
    {"/@study_hash: is not text of a fixed length", [](auto& r) { write_variable_text(r); }},
    {"/@complete: is neither 0 nor 1", with_number<std::int8_t>("/", "complete", 2)},
    {"/@complete: is not a scalar", [](auto& r) {
         H5Adelete(r.id(), "complete");
         hdf5::write_numbers<std::int8_t>(r, "complete", {1});
     }},
    {"/trial: ends within a block", with_number<std::int64_t>("/", "trials", 300)},
    {"/@trials: is no number of trials", with_number<std::int64_t>("/", "trials", -1)},
    {"/@trials: is missing", without_attribute("/", "trials")},
    {"/run: is missing", without("/run")},
    {"/run: is no readable group", replaced<double>("/run", {1})},
    {"/run@fact: is not text", with_number<double>("/run", "fact", 1)},
};

const std::vector<Damage> scenario_damages{
    {"/first@scenario: is missing", without_attribute("/first", "scenario")},
    {"/first@scenario:2: broken line", with_text("/first", "scenario", "[scenario]\nposes 3\n")},
    {"/first@scenario: does not agree", with_text("/first", "scenario", scenario_text(scenario("x")))},
    {"/first@title: does not agree", with_text("/first", "title", "another")},
    {"/first@length_unit: does not agree", with_text("/first", "length_unit", "m")},
    {"/first/greedy.ekf: does not belong here",
     with_text("/first", "scenario", text_of("first", "arms.controllers", "fixed"))},
    {"/step: has extents [3], not [4]", with_text("/first", "scenario", text_of("first", "scenario.poses", "5"))},
    {"/nees_feature_1_covered: does not belong here",
     with_text("/first", "scenario", text_of("first", "features.positions", "0 0"))},
    {arm + ": is missing", without(arm)},
    {"/first/more: does not belong here", [](auto& r) { hdf5::new_group(r, "/first/more"); }},
    {"/data: is no readable group", replaced<double>("/data", {1})},
    {"/soft: is a link", [](auto& r) { H5Lcreate_soft("/first", r.id(), "/soft", H5P_DEFAULT, H5P_DEFAULT); }},
    {"/external: is a link",
     [](auto& r) { H5Lcreate_external("other.h5", "/", r.id(), "/external", H5P_DEFAULT, H5P_DEFAULT); }},
    {"/bell\\u001b[31m: is a link",
     [](auto& r) { H5Lcreate_soft("/first", r.id(), "/bell\x1b[31m", H5P_DEFAULT, H5P_DEFAULT); }},
};

const std::vector<Damage> arm_damages{
    {arm + "@counted_trials: counts 2 trials, but the totals are of 4",
     with_number<std::int64_t>(arm, "counted_trials", 2)},
    {arm + "/trace_P: is missing", without(arm + "/trace_P")},
    {arm + "/extra: does not belong here", replaced<double>(arm + "/extra", {1})},
    {arm + "/trace_P: is no readable dataset",
     [](auto& r) {
         remove(r, arm + "/trace_P");
         hdf5::new_group(r, arm + "/trace_P");
     }},
    {arm + "/trace_P: holds 32-bit integers, not 64-bit floats", replaced<std::int32_t>(arm + "/trace_P", {5})},
    {arm + "/unseen: holds 64-bit floats, not 32-bit integers", replaced<double>(arm + "/unseen", {5})},
    {arm + "/trace_P: has extents [5, 1], not [5]", replaced<double>(arm + "/trace_P", {5, 1})},
    {arm + "/trace_P: has extents [4], not [5]", replaced<double>(arm + "/trace_P", {4})},
    {arm + "/status: holds 4, which is no status", replaced<std::int8_t>(arm + "/status", {5}, {0, 2, 0, 4, 0})},
    {arm + "/status: holds -1, which is no status", replaced<std::int8_t>(arm + "/status", {5}, {0, 2, 0, -1})},
    {arm + "/trial: does not count on by one", replaced<std::int64_t>(arm + "/trial", {5}, {0, 1, 3, 4, 5})},
    {arm + "/trial: does not go on with a block", replaced<std::int64_t>(arm + "/trial", {5}, {1, 2, 3, 4, 5})},
    {arm + "/trial: does not go on with a block", replaced<std::int64_t>(arm + "/trial", {6}, {0, 1, 2, 3, 4, 5})},
    {arm + "/trial: ends within a block", replaced<std::int64_t>(arm + "/trial", {4}, {0, 1, 2, 3})},
    {arm + "/trial: is not the same in every arm", replaced<std::int64_t>(arm + "/trial", {0})},
    {arm + "/step: has extents [2], not [3]", replaced<std::int32_t>(arm + "/step", {2}, {1, 2})},
    {arm + "/step: is not a list", replaced<std::int32_t>(arm + "/step", {3, 1}, {1, 2, 3})},
    {arm + "/part: is empty", replaced<std::int32_t>(arm + "/part", {0})},
    {arm + "/nees_total: has extents [3, 1]", replaced<double>(arm + "/nees_total", {3, 1})},
    {arm + "/nees_total: its parts do not follow", replaced<double>(arm + "/nees_total", {3, 3}, {0, 1})},
    {arm + "/nees_total: its parts do not follow", replaced<double>(arm + "/nees_total", {3, 3}, {1, 1})},
    {arm + "/nees_total: its parts do not follow", replaced<double>(arm + "/nees_total", {3, 3}, {9e299, 9e299})},
    {arm + "/nis_rows_total: holds 64-bit floats", replaced<double>(arm + "/nis_rows_total", {3})},
    {arm + "/level: does not hold the levels", replaced<double>(arm + "/level", {4}, {0.5, 0.9, 0.96})},
    {arm + "/nees_covered: its counts do not rise",
     replaced<std::int64_t>(arm + "/nees_covered", {3, 4}, {1, 3, 2, 4, 0, 0, 0, 0, 0, 0, 0, 0})},
    {arm + "/nees_covered: its counts do not rise",
     replaced<std::int64_t>(arm + "/nees_covered", {3, 4}, {1, 2, 3, 5})},
    {arm + "/nees_covered: its counts do not rise",
     replaced<std::int64_t>(arm + "/nees_covered", {3, 4}, {-1, 2, 3, 4})},
    {arm + "/nees_cells: its counts do not add up", replaced<std::int64_t>(arm + "/nees_cells", {3, 4096}, {3})},
    {arm + "/nees_cells: its counts do not add up", replaced<std::int64_t>(arm + "/nees_cells", {3, 4096}, {5, -1})},
    {arm + "/cell: does not count on", replaced<std::int32_t>(arm + "/cell", {4096}, {0, 2})},
    {arm + "/lag: has extents [3], not [2]", replaced<std::int32_t>(arm + "/lag", {3}, {1, 2, 3})},
    {arm + "/whiteness_count: is negative", replaced<std::int64_t>(arm + "/whiteness_count", {2}, {1, -1})},
    {arm + "/whiteness_total: its parts do not follow", replaced<double>(arm + "/whiteness_total", {2, 3}, {0, 1})},
    {arm + "/detailed_trial: has extents [4], not [5]",
     replaced<std::int64_t>(arm + "/detailed_trial", {4}, {0, 1, 2, 3})},
    {arm + "/component: does not count on", replaced<std::int32_t>(arm + "/component", {9}, {1})},
    {arm + "/detailed_error: holds 64-bit floats, not 32-bit floats",
     replaced<double>(arm + "/detailed_error", {5, 3, 9})},
    {arm + "/detailed_nees: has extents [3, 5], not [5, 3]", replaced<float>(arm + "/detailed_nees", {3, 5})},
    {arm + "/trial: [1099511627776] does not fit", [](auto& r) { promise_terabytes(r, arm + "/trial"); }},
    {arm + "/trace_P: keeps its values in other files", [](auto& r) { keep_elsewhere(r, arm + "/trace_P"); }},
};

}  // namespace

TEST_CASE("store: a header that is not of this program, this version or this study is refused") {
    require_refused(made_up_study(), header_damages);
}

TEST_CASE("store: scenarios that do not agree with their text are refused") {
    require_refused(made_up_study(), scenario_damages);
}

TEST_CASE("store: columns and totals that do not agree with the scenario or each other are refused") {
    require_refused(made_up_study(), arm_damages);
}

TEST_CASE("store: what is not a whole HDF5 file is refused") {
    const TemporaryFolder folder;
    const std::string path = folder / "file.h5";
    write_results(path, made_up_study(), {});
    const std::string good = bytes_of(path);
    const auto said = [&](const std::string& bytes) {
        put_bytes(path, bytes);
        return refusal<InputError>([&] { read_results(path); });
    };
    CHECK(said("").find("is not an HDF5 file") != std::string::npos);
    CHECK(said("trial,trace_P\n0,0.1\n").find("is not an HDF5 file") != std::string::npos);
    CHECK(said("x" + good).find("is not an HDF5 file") != std::string::npos);
    for (const std::size_t kept : {std::size_t{8}, std::size_t{100}, good.size() / 2, good.size() - 1}) {
        INFO("the first " << kept << " of " << good.size() << " bytes");
        CHECK(said(good.substr(0, kept)).find("is truncated or damaged") != std::string::npos);
    }
    CHECK(said(good).empty());
    CHECK(refusal<InputError>([&] { read_results(folder / "none.h5"); }).find("cannot be found") != std::string::npos);
    CHECK(refusal<InputError>([&] { read_results(folder / ""); }).find("is not a regular file") != std::string::npos);
    REQUIRE(mkfifo((folder / "pipe").c_str(), 0600) == 0);
    const std::string of_pipe = refusal<InputError>([&] { read_results(folder / "pipe"); });
    CHECK(of_pipe.find("is not a regular file") != std::string::npos);
}

}  // namespace credence::test::store_refusal_test
