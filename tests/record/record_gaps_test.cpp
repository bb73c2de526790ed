// Steps that are missing within the runs of a record are counted, and said first.

#include <credence/report.hpp>
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "record_support.hpp"

namespace credence::test::record_gaps_test {

using Catch::Contains;

namespace {

constexpr int trials = 300, steps = 20;

void leave_out(DrawnRecord& record, int trial, int step) {
    for (int j = 0; j < record.n; ++j) record.hide(trial, step, j);
}

/// Errors of half of each run grow and shrink again, so that large ones have large neighbours.
DrawnRecord with_waves() {
    DrawnRecord record(trials, steps, 2);
    for (int i = 0; i < trials; ++i)
        for (int k = 0; k < steps; ++k) record.error[record.at(i, k)] *= 1 + std::max(0.0, std::sin(0.9 * k + i));
    return record;
}

double nees(const DrawnRecord& record, int trial, int step) {
    return plain_nees(record.error[record.at(trial, step)], record.covariance[record.at(trial, step)], {0, 1});
}

}  // namespace

TEST_CASE("gaps: the first line has the share of missing steps, the trial and the steps that lack most") {
    DrawnRecord record(trials, steps, 2);
    for (int i = 0; i < trials; ++i)
        if (i % 2 == 0) leave_out(record, i, 6);
    for (int k = 2; k < steps - 1; ++k)
        if (k != 6) leave_out(record, 17, k);
    const Report report = report_of(record);
    const RecordGaps& gaps = report.arms.front().gaps;
    CHECK(gaps.steps == trials * steps);
    CHECK(gaps.missing == 150 + 16);
    CHECK(gaps.runs == 151);
    CHECK(gaps.by_step[6] == 150);
    CHECK(gaps.by_step[0] == 0);
    const std::string text = report_text(report);
    CHECK(text.starts_with("note: 3 % of the steps of record/record are missing (166 of 6000, in 151 of 300 trials)"));
    CHECK_THAT(text.substr(0, text.find("\nrecord ")),
               Contains("Trial 17 lacks most, 16.") && Contains("missing: step 7, in up to 150"));
    CHECK_THAT(report_html(report, {"record.h5", {}, "test"}), Contains("166 of 6000, in 151 of 300 trials"));
    const auto json = nlohmann::json::parse(report_json(report)).front()["missing_steps"];
    CHECK(json["missing"] == 166);
    CHECK(json["share"].get<double>() == Approx(166.0 / 6000));
    CHECK(json["worst_trial"]["trial"] == 17);
    CHECK(report.arms.front().consistency.hints.empty());
    CHECK_THAT(report_text(report_of(DrawnRecord(trials, steps, 2))), !Contains("missing"));
}

TEST_CASE("gaps: a hint where they lie beside large errors, and none where they lie anywhere") {
    DrawnRecord by_size = with_waves(), anywhere = with_waves();
    for (int i = 0; i < trials; ++i)
        for (int k = 0; k + 1 < steps; ++k) {
            if (nees(by_size, i, k) > 10) leave_out(by_size, i, k);
            if ((7 * i + 3 * k) % 11 == 0) leave_out(anywhere, i, k);
        }
    CHECK_THAT(report_text(report_of(by_size)), Contains("hint: steps are missing beside large errors: NEES/dim is "));
    CHECK_THAT(report_text(report_of(anywhere)), Contains("9 % of the steps") && !Contains("beside large errors"));
}

TEST_CASE("units: squares of different units are not added, and those of one have its unit") {
    const DrawnRecord record(50, 4, 3);
    const auto report_with = [&](const std::string& units) {
        return report_written([&](const Handle& root) {
            write_drawn(root, record);
            hdf5::write_text(root, "groups", "pose 0:3");
            if (!units.empty()) hdf5::write_text(root, "component_units", units);
        });
    };
    const auto sums = [&](int components) {
        double error = 0, variance = 0;
        for (int i = 0; i < 50; ++i)
            for (int k = 0; k < 4; ++k) {
                error += record.error[record.at(i, k)].head(components).squaredNorm() / 50;
                if (k == 3) variance += record.covariance[record.at(i, k)].diagonal().head(components).sum() / 50;
            }
        return std::pair(variance, error);
    };
    for (const auto& [units, unit, components] : {std::tuple{"m, m, rad", "m^2", 2}, std::tuple{"m, m, m", "m^2", 3},
                                                  std::tuple{"", "unit of error squared", 3}}) {
        const Report report = report_with(units);
        const std::vector<ColumnReport>& columns = report.arms.front().columns;
        const auto [variance, error] = sums(components);
        CAPTURE(units);
        for (const ColumnReport& column : columns) {
            if (column.name == "trace_P") CHECK(column.summary.mean == Approx(variance).epsilon(1e-12));
            if (column.name == "pose_error") CHECK(column.summary.mean == Approx(error).epsilon(1e-12));
            if (column.name == "trace_P" || column.name == "pose_error") CHECK(column.unit == unit);
        }
        const std::string text = report_text(report);
        CHECK((text.find("Squares of different units are not added") != std::string::npos) == (components == 2));
    }
}

}  // namespace credence::test::record_gaps_test
