// Checksums of the datasets of results files.
// Kind: foreign files.

#include "files/hdf5/read.hpp"
#include "files/system/checksum.hpp"
#include "of_scenarios.hpp"
#include "store_damage.hpp"

#include <map>

namespace credence::test::checksum_test {

namespace {

using Visit = std::function<void(const std::string& path, const Handle& dataset)>;

void for_each_dataset(const Handle& group, const std::string& path, const Visit& visit) {
    for (const std::string& name : hdf5::link_names(group)) {
        const Handle object = open(group, name);
        const bool is_group = H5Iget_type(object.id()) == H5I_GROUP;
        if (is_group)
            for_each_dataset(object, path + "/" + name, visit);
        else
            visit(path + "/" + name, object);
    }
}

/// A study of two scenarios in the file `path`.
void write_small(const std::string& path, Keep keep) {
    Study study = new_study({scenario("one", "heading"), scenario("two", "translation")}, 1, keep);
    run_study(study, {300, 1, {}});
    write_results(path, study, {});
}

}  // namespace

TEST_CASE("checksum: the check value of the CRC-32 of Ethernet, zlib and PNG") {
    const std::string digits = "123456789";
    CHECK(checksum(digits.data(), digits.size()) == 0xcbf43926);
    CHECK(checksum(digits.data() + 4, 5, checksum(digits.data(), 4)) == 0xcbf43926);
}

TEST_CASE("checksum: one changed bit of a dataset is refused by the dataset's name") {
    const TemporaryFolder folder;
    const std::string good = folder / "good.h5", bad = folder / "bad.h5";
    for (const Keep keep : {Keep::trials, Keep::aggregates}) {
        write_small(good, keep);
        std::map<std::string, std::size_t> middle;  // byte of each dataset
        for_each_dataset(hdf5::open_file(good), "", [&](const std::string& path, const Handle& dataset) {
            middle[path] = H5Dget_offset(dataset.id()) + H5Dget_storage_size(dataset.id()) / 2;
        });
        CHECK(middle.size() > 100);
        const std::string bytes = bytes_of(good);
        std::size_t place = 0;
        for (const auto& [path, at] : middle) {
            if (place++ % 43 != 0) continue;  // tests/durability/corruption.py has all of them
            CAPTURE(path);
            std::string changed = bytes;
            changed[at] = static_cast<char>(changed[at] ^ 1);
            put_bytes(bad, changed);
            const std::string said = refusal<InputError>([&] { read_results(bad); });
            CHECK(said.find(path + ": is damaged: its values do not have their checksum") != std::string::npos);
        }
    }
}

TEST_CASE("checksum: a value that changes after the file was checked is not read") {
    const TemporaryFolder folder;
    const std::string path = folder / "x.h5";
    write_small(path, Keep::trials);
    std::size_t at = 0;
    for_each_dataset(hdf5::open_file(path), "", [&](const std::string& name, const Handle& dataset) {
        if (name == "/one/fixed.ekf/mean_trace_P") at = H5Dget_offset(dataset.id()) + 290 * sizeof(double);
    });
    REQUIRE(at > 0);
    const Study study = read_results(path).study;
    std::string changed = bytes_of(path);
    changed[at] = static_cast<char>(changed[at] ^ 1);
    put_bytes(path, changed);
    const ScenarioResults& results = study.scenarios[0];
    std::size_t column = 0;
    while (results.columns[column].name != "mean_trace_P") ++column;
    CHECK(results.arms[0].columns.values(column, 0, 256).size() == 256);
    for (const std::int64_t first : {256, 290, 299, 0})
        CHECK(refusal<InputError>([&] { results.arms[0].columns.values(column, first, 300 - first); }) ==
              path + ": /one/fixed.ekf/mean_trace_P: is damaged: its values have changed since they were checked. " +
                  "Run the study again, or give an undamaged copy.");
    CHECK_THROWS_AS(results.arms[0].columns.values(column, 0, 301), InputError);
}

TEST_CASE("checksum: a file that was written before there were any reads back") {
    const TemporaryFolder folder;
    write_small(folder / "new.h5", Keep::trials);
    std::size_t forgotten = 0;
    damaged_copy(folder / "new.h5", folder / "old.h5", [&](const Handle& root) {
        for_each_dataset(root, "", [&](const std::string&, const Handle& dataset) {
            forget_checksum(dataset);
            ++forgotten;
        });
    });
    CHECK(forgotten > 100);
    const Study now = read_results(folder / "new.h5").study, then = read_results(folder / "old.h5").study;
    CHECK(study_hash(then) == study_hash(now));
    for (std::size_t s = 0; s < now.scenarios.size(); ++s)
        for (std::size_t a = 0; a < now.scenarios[s].arms.size(); ++a)
            CHECK(then.scenarios[s].arms[a].columns.values(0, 0, 300) ==
                  now.scenarios[s].arms[a].columns.values(0, 0, 300));
}

TEST_CASE("hdf5: where HDF5 gets no memory, the message says so") {
    const hdf5::QuietErrors quiet;
    H5Epush2(H5E_DEFAULT, __FILE__, __func__, __LINE__, H5E_ERR_CLS, H5E_RESOURCE, H5E_NOSPACE, "no room");
    CHECK(hdf5::failure("/x", "is no group").complaint().subject == "HDF5 got no memory");
    H5Eclear2(H5E_DEFAULT);
    CHECK(hdf5::failure("/x", "is no group").complaint().subject == "is no group");
}

}  // namespace credence::test::checksum_test
