// Records for `judge`: what cannot be judged is refused by dataset, trial and step, in words for the program
// that wrote it.
// Kind: foreign files.

#include "judgement_support.hpp"

#include <limits>

namespace credence::test::judgement_refusal_test {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Position of [trial, step, 0, 0] of a matrix in the plain record.
constexpr std::size_t matrix_at(std::size_t trial, std::size_t step) { return (trial * 4 + step) * 4; }

Change value(const std::string& name, std::size_t at, double value) {
    return [=](const Handle& root) { set_value(root, name, at, value); };
}

Change groups(const std::string& text) {
    return [=](const Handle& root) { hdf5::write_text(root, "groups", text); };
}

template <class T = double>
Change extents(const std::string& name, const hdf5::Extents& extents,
                                           const std::string& other = {}, const hdf5::Extents& other_extents = {}) {
    return [=](const Handle& root) {
        replace<T>(root, name, extents, {});
        if (!other.empty()) replace<T>(root, other, other_extents, {});
    };
}

using Three = const hsize_t (&)[3];

/// `error` anew and without values, of this size and in such chunks; with a filter that this HDF5 does not have
/// (Zstandard's number).
Handle chunked_error(const Handle& root, Three size, Three chunk, bool unknown_filter) {
    remove(root, "error");
    const Handle space(H5Screate_simple(3, size, nullptr), H5Sclose, "", "");
    const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "", "");
    H5Pset_chunk(properties.id(), 3, chunk);
    if (unknown_filter) H5Pset_filter(properties.id(), 32015, H5Z_FLAG_OPTIONAL, 0, nullptr);
    return {H5Dcreate2(root.id(), "error", H5T_IEEE_F64LE, space.id(), H5P_DEFAULT, properties.id(), H5P_DEFAULT),
            H5Dclose, "", "cannot make the dataset"};
}

void write_with_unknown_filter(const Handle& root) {
    const hsize_t size[] = {3, 4, 2};
    const Handle dataset = chunked_error(root, size, size, true);
    const std::vector<double> values(24, 0.5);
    H5Dwrite(dataset.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
}

/// Room for many trials, in chunks of which only the first was written.
void claim_trials(const Handle& root) {
    const hsize_t size[] = {100000, 1, 2}, chunk[] = {64, 1, 2}, first[] = {0, 0, 0};
    const Handle dataset = chunked_error(root, size, chunk, false);
    const Handle space(H5Dget_space(dataset.id()), H5Sclose, "", "");
    const Handle memory(H5Screate_simple(3, chunk, nullptr), H5Sclose, "", "");
    H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, first, nullptr, chunk, nullptr);
    const std::vector<double> values(128, 0.5);
    H5Dwrite(dataset.id(), H5T_NATIVE_DOUBLE, memory.id(), space.id(), H5P_DEFAULT, values.data());
}

const std::vector<Damage> value_damages{
    {"/covariance: trial 0, step 1 (both counted from 0) is not symmetric: [0, 1] is 0.25, [1, 0] is 0. Write (P + P')",
     value("covariance", matrix_at(0, 1) + 1, 0.25)},
    {"/covariance: trial 1, step 1 (both counted from 0) is not symmetric: [0, 1] is 0, [1, 0] is 2e-09",
     value("covariance", matrix_at(1, 1) + 2, 2e-9)},
    {"/innovation_covariance: trial 1, step 3 (both counted from 0) is not symmetric: [0, 1] is 0.5, [1, 0] is 0",
     value("innovation_covariance", matrix_at(1, 3) + 1, 0.5)},
};

const std::vector<Damage> shape_damages{
    {"/error: is missing. Write `error` [trial, step, n], `truth` and `estimate`", without("error")},
    {"/covariance: is missing. Write it as [trial, step, n, n], or as", without("covariance")},
    {"/innovation: is missing, but /innovation_covariance is there. Write both, or neither", without("innovation")},
    {"/innovation_covariance: is missing, but /innovation is there", without("innovation_covariance")},
    {"/covariance: has the order of its dimensions reversed, as MATLAB, Octave and Julia write them: it is "
     "[2, 2, 4, 3] and /error [2, 4, 3]. h5dump must show the trials first. Before you write them, turn them "
     "round: permute(error, [3 2 1]) and permute(covariance, [4 3 2 1]), and",
     extents("error", {2, 4, 3}, "covariance", {2, 2, 4, 3})},
    {"permute(error, [2 1]) and permute(covariance, [3 2 1]), and",
     extents("error", {2, 4}, "covariance", {2, 2, 4})},
    {"/innovation_covariance: has the order of its dimensions reversed",
     extents("innovation", {5, 4, 3}, "innovation_covariance", {5, 5, 4, 3})},
    {"/covariance: does not fit: it is [3, 4, 2, 3] and /error [3, 4, 2]. Write error as [trial, step, size] and",
     extents("covariance", {3, 4, 2, 3})},
    {"/covariance: does not fit: it is [4, 2, 2] and /error [3, 4, 2]", extents("covariance", {4, 2, 2})},
    {"/error: is [12]. Write it as [trial, step, n]", extents("error", {12}, "covariance", {12})},
    {"/error: is [12]. Write it as [trial, step, n]", extents("error", {12}, "covariance", {12, 12})},
    {"/error: is [1, 3, 4, 2]. Write it", extents("error", {1, 3, 4, 2}, "covariance", {1, 3, 4, 2, 2})},
    {"/innovation: does not fit: it is [2, 4, 2] and /error [3, 4, 2]. Write it as [trial, step, row], with NaN",
     extents("innovation", {2, 4, 2}, "innovation_covariance", {2, 4, 2, 2})},
    {"/innovation: does not fit: it is [4, 2] and /error",
     extents("innovation", {4, 2}, "innovation_covariance", {4, 2, 2})},
    {"/error: is [0, 4, 2]: no trials. Write at least one", extents("error", {0, 4, 2}, "covariance", {0, 4, 2, 2})},
    {"/error: is [3, 0, 2]: no steps", extents("error", {3, 0, 2}, "covariance", {3, 0, 2, 2})},
    {"/error: is [3, 4, 0]: no components", extents("error", {3, 4, 0}, "covariance", {3, 4, 0, 0})},
    {"/innovation: is [3, 4, 0]: no rows", extents("innovation", {3, 4, 0}, "innovation_covariance", {3, 4, 0, 0})},
    {"/error: is [1, 1, 1001]: more than 1000 components. Write fewer",
     extents<float>("error", {1, 1, 1001}, "covariance", {1, 1, 1001, 1001})},
    {"/error: is [1, 10000001, 1]: more than 10000000 steps",
     extents<float>("error", {1, 10000001, 1}, "covariance", {1, 10000001, 1, 1})},
    {"/innovation: is [1, 1, 2001]: more than 2000 rows", [](auto& r) {
         extents("error", {1, 1, 2}, "covariance", {1, 1, 2, 2})(r);
         extents<float>("innovation", {1, 1, 2001}, "innovation_covariance", {1, 1, 2001, 2001})(r);
     }},
    {"/error: does not hold floating-point numbers. Write it as doubles",
     extents<std::int32_t>("error", {3, 4, 2})},
    {"/error: is a group, not a dataset, as Octave's save makes it. Write a dataset", [](auto& r) {
         remove(r, "error");
         hdf5::new_group(r, "error");
     }},
    {"/error: is compressed by a filter that is not installed, 32015", write_with_unknown_filter},
    {"/error: [1099511627776] does not fit into what is stored", [](auto& r) { promise_terabytes(r, "/error"); }},
    {"/error: [100000, 1, 2] does not fit into what is stored", claim_trials},
    {"/error: keeps its values in other files", [](auto& r) { keep_elsewhere(r, "/error"); }},
    {"/error: is a link to somewhere else", [](auto& r) {
         remove(r, "error");
         H5Lcreate_soft("/innovation", r.id(), "/error", H5P_DEFAULT, H5P_DEFAULT);
     }},
};

Change steps(const hdf5::Extents& extents, const std::vector<std::int32_t>& values) {
    return [=](const Handle& root) {
        hdf5::write_dataset(root, "steps", hdf5::type_of<std::int32_t>(), values.data(), extents, {"", ""});
    };
}

const std::vector<Damage> step_damages{
    {"/steps: does not fit: it is [2], and there are 3 trials. Write it as [trial]", steps({2}, {4, 4})},
    {"/steps: does not fit: it is [3, 1], and there are 3 trials", steps({3, 1}, {4, 4, 4})},
    {"/steps: trial 1 (counted from 0) has 5 steps. Write whole numbers from 1 to 4", steps({3}, {4, 5, 4})},
    {"/steps: trial 2 (counted from 0) has 0 steps. Write whole numbers", steps({3}, {4, 4, 0})},
    {"/steps: trial 0 (counted from 0) has 2.5 steps", [](auto& r) {
         const std::vector<double> values{2.5, 4, 4};
         hdf5::write_dataset(r, "steps", hdf5::type_of<double>(), values.data(), {3}, {"", ""});
     }},
    {"/steps: trial 0 (counted from 0) has nan steps", [](auto& r) {
         const std::vector<double> values{nan, 4, 4};
         hdf5::write_dataset(r, "steps", hdf5::type_of<double>(), values.data(), {3}, {"", ""});
     }},
};

const std::vector<Damage> group_damages{
    {"/@groups: broken entry `pose`. Write the groups as NAME and its components, counted from 0", groups("pose")},
    {"/@groups: broken entry `pose 0-1`", groups("pose 0-1")},
    {"/@groups: `0:1` is no name for a group", groups("0:1 1")},
    {"/@groups: `a:b` is no name for a group", groups("a:b 0:1")},
    {"/@groups: broken entry `a 0:1 b 1:2`", groups("a 0:1 b 1:2")},
    {"/@groups: broken entry ``", groups("a 0:1,")},
    {"/@groups: broken entry `a x:1`", groups("a x:1")},
    {"/@groups: `a\\u001b[31m` is no name for a group", groups("a\x1b[31m 0;1")},
    {"/@groups: `f(1)` is no name for a group. Use letters, digits, _ and -", groups("f(1) 0:1")},
    {"/@groups: `all` cannot name a group", groups("all 0:2")},
    {"/@groups: names two groups `a`", groups("a 0:1, a 1:2")},
    {"/@groups: `a 1:1` has no component `1:1`", groups("a 1:1")},
    {"/@groups: `a 2:1` has no component", groups("a 2:1")},
    {"/@groups: `a -1:1` has no component", groups("a -1:1")},
    {"/@groups: `a 1:3` goes beyond the 2 components of the state. Write the groups", groups("a 0:1, a 1:3")},
    {"/@groups: has more than 1000 groups", [](auto& r) {
         std::string text;
         for (int i = 0; i <= 1000; ++i) text += (i ? "," : "") + std::string("b") + std::to_string(i) + " 0:1";
         hdf5::write_text(r, "groups", text);
     }},
    {"/@groups: is not text", [](auto& r) { hdf5::write_number<double>(r, "groups", 3); }},
    {"/@groups: is missing, but there is a `groups` elsewhere. Make it an attribute of the root",
     [](auto& r) { hdf5::new_group(r, "groups"); }},
    {"/@blocks: is of a record of release 0.2 or earlier. Write it as the attribute `groups`",
     [](auto& r) { hdf5::write_text(r, "blocks", "a 0:1"); }},
    {"/@record_version: is 1. Write 2, or use a newer credence",
     [](auto& r) { hdf5::write_number<std::int32_t>(r, "record_version", 1); }},
};

void require_refused(const std::vector<Damage>& damages) {
    test::require_refused(damages, write_plain_record, [](const std::string& path) { read_record(path); });
}

}  // namespace

TEST_CASE("record: the plain record itself is judged, and what else a file holds is ignored") {
    const TemporaryFolder folder;
    const double one = 1;
    write_plain_record(folder / "record.h5", [&](const Handle& root) {
        hdf5::write_text(root, "groups", " pose 0:1 ,rest  1:2");
        hdf5::write_text(root, "author", "somebody");
        hdf5::new_group(root, "notes");
        hdf5::write_dataset(root, "times", hdf5::type_of<double>(), &one, {1}, {"", "s"});
    });
    const Record record = read_record(folder / "record.h5");
    CHECK(record.trouble_count == 0);
    CHECK(record.results.arms.front().totals.trials.counted() == 3);
    CHECK(record.results.all_series[2].part == "rest");
}

TEST_CASE("record: a covariance that is not symmetric is refused by dataset, trial and step") {
    require_refused(value_damages);
}

TEST_CASE("record: declared steps that no trial can have are refused") { require_refused(step_damages); }

TEST_CASE("record: datasets that do not fit together, reversed dimensions among them, are refused") {
    require_refused(shape_damages);
}

TEST_CASE("record: invalid groups are refused") { require_refused(group_damages); }

TEST_CASE("record: what is no HDF5 file is refused, a MATLAB workspace by its name") {
    const TemporaryFolder folder;
    const std::string path = folder / "record.h5";
    const auto said = [&] { return refusal<InputError>([&] { read_record(path); }); };
    CHECK(said() == path + ": the file: cannot be found. Check the path.");
    put_bytes(path, "trial,step\n");
    CHECK(said() == path + ": the file: is not an HDF5 file. Give an HDF5 file.");
    put_bytes(path, "MATLAB 7.3 MAT-file, Platform: GLNXA64");
    CHECK(said() ==
          path + ": the file: is a MATLAB workspace. Write the record with h5create, h5write and h5writeatt.");
    write_plain_record(path);
    put_bytes(path, bytes_of(path).substr(0, 900));
    CHECK(said().find("is truncated or damaged") != std::string::npos);
}

}  // namespace credence::test::judgement_refusal_test
