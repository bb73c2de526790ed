#pragma once
// Room 13: what people read. A report is computed once from a study and then rendered as text, JSON or CSV.

#include <credence/consistency.hpp>
#include <credence/store.hpp>

#include <optional>
#include <string>
#include <vector>

namespace credence {

/// A published single-run figure and its place in our distribution, in percent (mid-rank).
struct PublishedPlace {
    double value = 0, percentile = 0;
};

/// One per-trial figure of one arm.
struct FigureReport {
    std::string name, unit;
    Summary summary;
    std::optional<PublishedPlace> published;
};

struct ArmReport {
    std::string scenario, arm;
    std::int64_t trials = 0, failed = 0, diverged = 0;
    std::vector<FigureReport> figures;      ///< the real and integer columns, in their order, status columns left out
    Consistency consistency;
};

/// Planned against fixed: greedy - fixed of the same estimator, by trial.
struct PairReport {
    std::string scenario, name;             ///< such as `greedy.ekf - fixed.ekf`
    std::vector<FigureReport> figures;      ///< of the differences
};

struct Report {
    std::string study_hash;
    std::uint64_t root_seed = 0;
    bool complete = true;
    double margin = 0;
    std::vector<Scenario> scenarios;
    std::vector<ArmReport> arms;
    std::vector<PairReport> pairs;
};

/// Figures of failed trials are left out (they are NaN); their number is given beside.
Report make_report(const Study& study, double margin);

std::string report_text(const Report& report);
/// An array with an object per scenario and arm; NaN is null.
std::string report_json(const Report& report);
/// A row per scenario, arm and figure; and one per pair and figure.
std::string report_csv(const Report& report);

/// Throws Failure naming the arms that are not `consistent`.
void require_consistent(const Report& report);

}  // namespace credence
