// A record in memory is read as the same record in a file.

#include <credence/error.hpp>
#include <credence/report.hpp>
#include <limits>

#include "record_support.hpp"

namespace credence::test::record_arrays_test {

using Catch::Contains;

namespace {

/// All that is said of a record, every number with all its bits.
std::string said(Record record) { return report_json(make_record_report(std::move(record), "record", Limits())); }

/// Values laid out with gaps: `spread` elements from each to the next along the last axis.
template <class T>
struct Laid {
    std::vector<T> values;
    RecordArray array;

    Laid(const std::string& path, const hdf5::Extents& extents, const std::vector<double>& plain,
         std::int64_t spread = 1)
        : values(plain.size() * static_cast<std::size_t>(spread), T(-7)) {
        for (std::size_t i = 0; i < plain.size(); ++i)
            values[i * static_cast<std::size_t>(spread)] = static_cast<T>(plain[i]);
        array = {path,
                 values.data(),
                 sizeof(T) == 4 ? RecordArray::Type::real32 : RecordArray::Type::real64,
                 {},
                 {},
                 static_cast<double>(std::numeric_limits<T>::epsilon())};
        std::int64_t stride = spread;
        for (auto extent = extents.rbegin(); extent != extents.rend(); ++extent) {
            array.extents.insert(array.extents.begin(), static_cast<std::int64_t>(*extent));
            array.strides.insert(array.strides.begin(), stride);
            stride *= static_cast<std::int64_t>(*extent);
        }
    }
};

}  // namespace

TEST_CASE("record: arrays of doubles with any strides, and their attributes, are read as from a file") {
    const DrawnRecord drawn(300, 4, 3, 2);
    const std::string groups = "pose 0 2, speed 1", rows = "gps 0, baro 1";
    const std::string file = said(read_written([&](const Handle& root) {
        write_drawn(root, drawn);
        hdf5::write_text(root, "groups", groups);
        hdf5::write_text(root, "row_groups", rows);
    }));
    for (const std::int64_t spread : {1, 3}) {
        const Laid<double> error("error", extents_of(drawn, {3}), flat(drawn.error), spread),
            covariance("covariance", extents_of(drawn, {3, 3}), flat(drawn.covariance)),
            innovation("innovation", extents_of(drawn, {2}), flat(drawn.innovation)),
            S("innovation_covariance", extents_of(drawn, {2, 2}), flat(drawn.innovation_covariance), spread);
        const RecordArrays arrays{
            {error.array, covariance.array, innovation.array, S.array}, {{"groups", groups}, {"row_groups", rows}}, {}};
        CHECK(said(read_record(arrays, "record.h5")) == file);
    }
}

TEST_CASE("record: arrays of singles, and of NEES with their dimension, are read as from a file") {
    const DrawnRecord drawn(50, 4, 2);
    const hdf5::Extents vectors = extents_of(drawn, {2}), matrices = extents_of(drawn, {2, 2});
    const Laid<float> error("error", vectors, flat(drawn.error)),
        covariance("covariance", matrices, flat(drawn.covariance));
    CHECK(said(read_record({{error.array, covariance.array}, {}, {}}, "record.h5")) ==
          said(read_written([&](const Handle& root) {
              write_values<float>(root, "error", vectors, flat(drawn.error));
              write_values<float>(root, "covariance", matrices, flat(drawn.covariance));
          })));

    std::vector<double> values;
    for (std::size_t i = 0; i < drawn.error.size(); ++i)
        values.push_back(plain_nees(drawn.error[i], drawn.covariance[i], {0, 1}));
    const Laid<double> nees("nees", extents_of(drawn, {}), values);
    CHECK(said(read_record({{nees.array}, {}, {{"nees", 2}}}, "record.h5")) ==
          said(read_written([&](const Handle& root) {
              write_values(root, "nees", extents_of(drawn, {}), values);
              const Handle dataset(H5Dopen2(root.id(), "nees", H5P_DEFAULT), H5Dclose, "nees", "no dataset");
              hdf5::write_number<std::int32_t>(dataset, "dimension", 2);
          })));
}

TEST_CASE("record: what a list in memory holds is taken as it is: a name has its spaces, and a comma parts nothing") {
    const DrawnRecord drawn(300, 4, 3);
    const Laid<double> error("error", extents_of(drawn, {3}), flat(drawn.error)),
        covariance("covariance", extents_of(drawn, {3, 3}), flat(drawn.covariance));
    RecordArrays arrays{{error.array, covariance.array}, {{"groups", "pose 0 2, speed 1"}}, {}};
    const std::string text = said(read_record(arrays, "record"));
    arrays.texts.clear();
    const auto with = [&](const std::string& name, const std::vector<std::vector<std::string>>& list) {
        arrays.lists = {{name, list}};
        return said(read_record(arrays, "record"));
    };
    CHECK(with("groups", {{"pose", "0", "2"}, {"speed", "1"}}) == text);
    CHECK_THROWS_WITH(with("groups", {{"speed 1", "2"}}), Contains("`speed 1` is no name for a group"));
    CHECK_THROWS_WITH(with("groups", {{"pose 0:3, x", "2"}}), Contains("`pose 0:3, x` is no name for a group"));
    CHECK_THROWS_WITH(with("component_names", {{"x, y"}, {"z"}}), Contains("has 2 entries, and the state has 3"));
    CHECK_THAT(with("component_names", {{"East (m)"}, {"ref[2]"}, {"H\u00f6he \u00b0"}}), Contains("H\u00f6he \u00b0"));
    for (const char* bad : {"a,b", "a/b", "a=b", "a\"b", "a\nb", ""})
        CHECK_THROWS_WITH(with("component_names", {{bad}, {"y"}, {"z"}}), Contains("is no name for a component"));
}

TEST_CASE("record: what is refused of arrays is mended by arrays") {
    const Laid<double> error("error", {2, 4, 3}, std::vector<double>(24)),
        covariance("covariance", {2, 2, 4, 3}, std::vector<double>(48));
    CHECK_THROWS_WITH(read_record({{error.array, covariance.array}, {}, {}}, "record"),
                      Contains("Give the trials first: error.transpose() and covariance.transpose(), and"));
}

TEST_CASE("record: arrays that do not fit are refused by their names") {
    const DrawnRecord drawn(2, 4, 3);
    const Laid<double> error("error", extents_of(drawn, {3}), flat(drawn.error)),
        covariance("covariance", {2, 4, 3, 2}, std::vector<double>(48)), scalar("covariance", {}, {1});
    CHECK_THROWS_WITH(read_record({{error.array, covariance.array}, {}, {}}, "record"),
                      Contains("covariance: does not fit: it is [2, 4, 3, 2] and error [2, 4, 3]. Write error as"));
    CHECK_THROWS_AS(read_record({{error.array}, {}, {}}, "record"), InputError);
    CHECK_THROWS_WITH(read_record({{error.array, scalar.array}, {}, {}}, "record"),
                      Contains("covariance: has no extents"));
}

}  // namespace credence::test::record_arrays_test
