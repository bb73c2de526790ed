// Checks that all contenders simulate the same trials: their columns, trial by trial, in the run that reports their
// ratios.

#include <cmath>
#include "worlds/deformable/deformable.hpp"
#include <sstream>
#include <stdexcept>

#include "baseline.hpp"
#include "counted_target.hpp"
#include "targets.hpp"
#include "trials.hpp"

namespace credence::bench {

namespace {

constexpr std::uint64_t root_seed = 1;
constexpr double tolerance = 1e-9;  // relative: the joint update's rounding is far below it, any error far above

[[noreturn]] void disagree(const Row& row, const std::string& who, int trial, int column, double theirs, double ours) {
    std::ostringstream text;
    text.precision(17);
    text << who << " disagrees with credence: row=" << row.name << " trial=" << trial
         << " column=" << trial_columns(row.problem.scenario())[static_cast<std::size_t>(column)].name << " (" << theirs
         << ", credence has " << ours << ").";
    throw std::runtime_error(text.str());
}

bool agree(double a, double b, double relative) {
    return a == b || std::fabs(a - b) <= relative * std::fabs(b) || (std::isnan(a) && std::isnan(b));
}

void compare(const Row& row, const std::string& who, const std::unique_ptr<Baseline>& baseline,
             const std::vector<double>& columns, int trials) {
    if (!baseline) return;
    for (int trial = 0; trial < trials; ++trial) {
        double own[compared_columns];
        baseline->run(root_seed, trial, own);
        for (int c = 0; c < compared_columns; ++c) {
            const double ours = columns[static_cast<std::size_t>(c * trials + trial)];
            if (!agree(own[c], ours, tolerance)) disagree(row, who, trial, c, own[c], ours);
        }
    }
}

/// Other targets, the counted one among them, must give the same bits.
void compare(const Row& row, const Target& target, const std::vector<double>& columns, int trials) {
    const std::vector<double> own = run_block(row.problem, root_seed, 0, trials, target).arms.front().columns;
    for (std::size_t i = 0; i < columns.size(); ++i)
        if (!agree(own[i], columns[i], 0))
            disagree(row, target.name, static_cast<int>(i) % trials, static_cast<int>(i) / trials, own[i], columns[i]);
}

}  // namespace

void require_agreement(const std::deque<Row>& rows, const Effort& effort) {
    for (const Row& row : rows) {
        const ProblemView& view = row.problem.view();
        const int M = row.features(), trials = M <= 3 ? effort.of(64, 8) : M <= 8 ? 8 : 2;
        const std::vector<double> columns = run_block(row.problem, root_seed, 0, trials).arms.front().columns;
        if (has_dynamic(row)) compare(row, "A", make_dynamic(view, row.controller, Draws::keyed), columns, trials);
        compare(row, "B", make_fixed(view, row.controller, Draws::keyed), columns, trials);
        for (const Target& target : measured_targets()) compare(row, target, columns, trials);
        compare(row, counted_target(), columns, trials);
    }
}

}  // namespace credence::bench
