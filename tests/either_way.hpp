#pragma once
// Reports and evidence of results in memory, and of the same ones read back from their file: both must say the same.

#include <credence/detail/store.hpp>
#include <credence/report.hpp>
#include <credence/slam_columns.hpp>

#include "catch.hpp"
#include "report/compare/compare.hpp"
#include "temporary_folder.hpp"

#include <string>
#include <vector>

namespace credence::test {

inline std::string page_of(const Report& report) { return report_html(report, {"r.h5", {}, "test"}); }

/// How often a text has a part.
inline std::size_t count_of(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
}

/// Every format of it.
inline std::vector<std::string> renderings(const Report& report) {
    return {report_json(report), report_text(report), report_csv(report), page_of(report)};
}
inline std::vector<std::string> renderings(const CompareReport& report) {
    return {compare_json(report), compare_text(report), compare_csv(report), compare_html(report, "test")};
}

inline Study read_back(const Study& study) {
    const TemporaryFolder folder;  // the results keep the file open
    write_results(folder / "r.h5", study, {});
    return read_results(folder / "r.h5", 0).study;
}

/// Makes trials of an arm look as the engine stores those that failed; recount() then counts them.
inline void fail_trials(ScenarioResults& results, std::size_t arm, std::size_t first, std::size_t count,
                        Status status = Status::non_finite, int pose = 3) {
    for (std::size_t i = first; i < first + count; ++i) {
        std::vector<double> values;
        for (const auto& column : results.arms[arm].columns.in_memory()) values.push_back(column[i]);
        values[column_status] = static_cast<double>(status);
        values[column_status_pose] = pose;
        fill_failed(results.columns, values.data());
        for (std::size_t c = 0; c < values.size(); ++c) results.arms[arm].columns.in_memory()[c][i] = values[c];
    }
}

/// `make` gives a report of a study; `stored` is the study read back.
template <class Make>
auto either_way(const Study& study, const Study& stored, const Make& make) {
    const auto in_memory = make(study), read = make(stored);
    CHECK(renderings(read) == renderings(in_memory));
    return read;
}

inline Report report_either_way(const Study& study, const Study& stored, const Limits& limits) {
    return either_way(study, stored, [&](const Study& either) { return make_report(either, limits); });
}
inline Report report_either_way(const Study& study, const Limits& limits) {
    return report_either_way(study, read_back(study), limits);
}

/// Of the first arm of a scenario that was run.
inline Evidence evidence_either_way(const ScenarioResults& results) {
    Study study;
    study.trials = results.trials;
    study.complete = true;
    study.scenarios = {results};
    const Study stored = read_back(study);
    report_either_way(study, stored, {});
    const WithTotals read(stored.scenarios.front());
    return evidence_of(*read, (*read).arms.front());
}

}  // namespace credence::test
