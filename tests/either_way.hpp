#pragma once
// Reports and evidence of results in memory, and of the same ones read back from their file: both must say the same.

#include <credence/detail/store.hpp>
#include <credence/report.hpp>

#include "catch.hpp"
#include "report/compare/compare.hpp"
#include "temporary_folder.hpp"

#include <string>
#include <vector>

namespace credence::test {

/// Every format of it.
inline std::vector<std::string> renderings(const Report& report) {
    return {report_json(report), report_text(report), report_csv(report), report_html(report, {"r.h5", {}, "test"})};
}
inline std::vector<std::string> renderings(const CompareReport& report) {
    return {compare_json(report), compare_text(report), compare_csv(report), compare_html(report, "test")};
}

inline Study read_back(const Study& study) {
    const TemporaryFolder folder;  // the results keep the file open
    write_results(folder / "r.h5", study, {});
    return read_results(folder / "r.h5", 0).study;
}

/// `make` gives a report of a study.
template <class Make>
auto either_way(const Study& study, const Make& make) {
    const auto in_memory = make(study), read = make(read_back(study));
    CHECK(renderings(read) == renderings(in_memory));
    return read;
}

inline Report report_either_way(const Study& study, const Limits& limits) {
    return either_way(study, [&](const Study& either) { return make_report(either, limits); });
}

/// Of the first arm of a scenario that was run.
inline Evidence evidence_either_way(const ScenarioResults& results) {
    Study study;
    study.trials = results.trials;
    study.complete = true;
    study.scenarios = {results};
    report_either_way(study, {});
    study = read_back(study);
    const WithTotals read(study.scenarios.front());
    return evidence_of(*read, (*read).arms.front());
}

}  // namespace credence::test
