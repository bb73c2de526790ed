// Columns of a record's own, and the name of its arm. Kind: foreign files.

#include <credence/error.hpp>
#include <credence/report.hpp>

#include <nlohmann/json.hpp>

#include "record_support.hpp"

namespace credence::test::record_columns_test {

using Catch::Contains;
using nlohmann::json;

namespace {

using Write = std::function<void(const Handle& column)>;

/// A record with what is written into its group `column`.
Record with_columns(const DrawnRecord& drawn, const Write& write, const std::string& arm = "") {
    return read_written([&](const Handle& root) {
        write_drawn(root, drawn);
        if (!arm.empty()) hdf5::write_text(root, "arm", arm);
        write(hdf5::new_group(root, "column"));
    });
}

std::vector<double> numbers(std::size_t count, double scale) {
    std::vector<double> values(count);
    for (std::size_t i = 0; i < count; ++i) values[i] = scale * static_cast<double>(i);
    return values;
}

}  // namespace

TEST_CASE("record: a column of its own is in the text, JSON, CSV and page, with its unit and the mean of its numbers") {
    const DrawnRecord drawn(40, 3, 2);
    std::vector<double> values = numbers(40, 0.5);
    values[3] = std::numeric_limits<double>::quiet_NaN();
    values[5] = std::numeric_limits<double>::infinity();  // no number that could be averaged
    const Record record = with_columns(drawn, [&](const Handle& column) {
        hdf5::write_dataset(column, "rmse", hdf5::type_of<double>(), values.data(), {40}, {"", "m"});
    });
    const Report report = make_record_report(Record(record), "record.h5", Limits());
    const double expected = (0.5 * 40 * 39 / 2 - 1.5 - 2.5) / 38;
    const json said = json::parse(report_json(report))[0]["rmse"];
    CHECK(said["mean"].get<double>() == Approx(expected).epsilon(1e-14));
    CHECK(said["n"] == 38);
    CHECK(said["unit"] == "m");
    CHECK_THAT(report_text(report), Contains("  rmse [m]\n"));
    CHECK_THAT(report_csv(report), Contains(",record,40,0,rmse,m,"));
    CHECK_THAT(report_html(report, {"record.h5", {}, "test"}), Contains("rmse"));
}

TEST_CASE("record: what is said of a record is the same beside a column of its own, and a failed trial has no number") {
    DrawnRecord drawn(30, 3, 2);
    drawn.error[3 * 7][0] = std::numeric_limits<double>::infinity();
    const auto said = [](const Record& record) {
        return json::parse(report_json(make_record_report(Record(record), "record.h5", Limits())))[0];
    };
    const json plain = said(read_written([&](const Handle& root) { write_drawn(root, drawn); }));
    json with = said(with_columns(
        drawn, [](const Handle& column) { write_values(column, "rmse", {30}, numbers(30, 1)); }));
    CHECK(with["rmse"]["mean"].get<double>() == Approx((30.0 * 29 / 2 - 7) / 29).epsilon(1e-14));
    with.erase("rmse");
    CHECK(with == plain);
}

TEST_CASE("record: an `unseen` of its own takes the place of the one that is not known") {
    const Record record = with_columns(
        DrawnRecord(30, 3, 2), [](const Handle& column) { write_values(column, "unseen", {30}, numbers(30, 1)); });
    const std::string text = report_text(make_record_report(Record(record), "record.h5", Limits()));
    CHECK(text.find("  unseen\n") < text.find("  pose error"));
    CHECK_THAT(text, Contains("    record   14.5"));
}

TEST_CASE("record: a column that is called as another member of the JSON leaves that one alone") {
    const Record record = with_columns(DrawnRecord(30, 3, 2), [](const Handle& column) {
        for (const char* name : {"verdict", "trials", "groups"}) write_values(column, name, {30}, numbers(30, 1));
    });
    const json said = json::parse(report_json(make_record_report(Record(record), "record.h5", Limits())))[0];
    CHECK(said["trials"] == 30);
    CHECK(said["verdict"].is_string());
    CHECK(said["groups"].is_array());
    for (const char* name : {"column verdict", "column trials", "column groups"}) CHECK(said[name]["mean"] == 14.5);
}

TEST_CASE("record: columns of other lengths, and with names that every record has, are refused by name") {
    const DrawnRecord drawn(30, 3, 2);
    const auto read = [&](const std::string& name, const hdf5::Extents& extents) {
        return with_columns(drawn, [&](const Handle& column) {
            std::size_t size = 1;
            for (const auto extent : extents) size *= extent;
            write_values(column, name, extents, numbers(size, 1));
        });
    };
    CHECK_THROWS_WITH(read("rmse", {29}), Contains("/column/rmse: does not fit: it is [29], and there are 30 trials"));
    CHECK_THROWS_WITH(read("rmse", {30, 2}), Contains("/column/rmse: does not fit"));
    for (const char* name : {"trace_P", "nees_ratio", "status"})
        CHECK_THROWS_WITH(read(name, {30}), Contains("is no name for a column of one's own, or one that every record"));
    CHECK_THROWS_WITH(read("a\x1b[31m", {30}), Contains("is no name for a column"));
    CHECK_THROWS_WITH(with_columns(drawn, [](const Handle& column) { hdf5::new_group(column, "rmse"); }),
                      Contains("/column/rmse: is a group, not a dataset"));
}

TEST_CASE("record: an arm is called by its name, and its scenario by what the files of several arms share") {
    const auto none = [](const Handle&) {};
    Record planned = with_columns(DrawnRecord(30, 3, 2), none, "planned");
    CHECK(planned.results.arms.front().name == "planned");
    CHECK(with_columns(DrawnRecord(30, 3, 2), none, "a/b").results.arms.front().name == "record");
    const TemporaryFolder folder;
    const auto written = [&](const std::string& name, const std::string& arm) {
        const std::string path = folder / name;
        write_file(path, [&](const Handle& root) {
            write_drawn(root, DrawnRecord(30, 3, 2));
            hdf5::write_text(root, "arm", arm);
        });
        return make_record_report(read_record(path), path, Limits());
    };
    std::vector<Report> reports;
    reports.push_back(written("slam.planned.h5", "planned"));
    reports.push_back(written("slam.fixed.h5", "fixed"));
    reports.push_back(written("other.h5", "fixed"));
    const Report report = together(std::move(reports));
    CHECK(report.scenarios.size() == 2);
    CHECK(report.arms[1].scenario + "/" + report.arms[1].arm == "slam/fixed");
    CHECK(report.arms[2].scenario + "/" + report.arms[2].arm == "other/fixed");
}

}  // namespace credence::test::record_columns_test
