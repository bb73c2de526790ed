#include "trials.hpp"

#include <cmath>
#include "worlds/deformable/deformable.hpp"
#include <credence/text.hpp>
#include <memory>

#include "baseline.hpp"
#include "counted_target.hpp"
#include "targets.hpp"

namespace credence::bench {

namespace {

constexpr std::int64_t peak_rounds = 1024;

using MakeBaseline = std::unique_ptr<Baseline> (*)(const ProblemView&, Controller, Draws);

/// One trial an iteration.
void add_baseline(const Row& row, const std::string& name, MakeBaseline make, const Effort& effort) {
    const std::shared_ptr<Baseline> baseline = make(row.problem.view(), row.controller, Draws::standard);
    if (!baseline) return;
    add("trial/" + row.name + "/" + name, effort, [baseline](benchmark::State& state) {
        std::int64_t trial = 0;
        double columns[compared_columns];
        for (auto _ : state) {
            baseline->run(1, trial++, columns);
            benchmark::DoNotOptimize(columns);
        }
        state.SetItemsProcessed(state.iterations());
    });
}

/// The first block that is timed. A study's first 4096 trials are detailed, which costs once as much as some thousand
/// other trials: this does not matter for a study of a million [docs/performance.md].
constexpr std::int64_t usual_block = 1000;

/// One block an iteration.
void add_unit(const std::string& name, const Row& row, const Target& target, const Effort& effort) {
    add(name, effort, [&row, target](benchmark::State& state) {
        std::int64_t index = usual_block;
        for (auto _ : state) benchmark::DoNotOptimize(run_block(row.problem, 1, index++, row.trials, target));
        state.SetItemsProcessed(state.iterations() * row.trials);
    });
}

/// Operations per step of one trial, statistics included.
double operations_per_step(const Row& row) {
    const int trials = std::min(row.trials, row.features() <= 3 ? 32 : row.features() <= 8 ? 8 : 1);
    const std::uint64_t before = counted_operations();
    run_block(row.problem, 1, usual_block, trials, counted_target());
    return static_cast<double>(counted_operations() - before) / (trials * (row.problem.view().poses - 1));
}

Json microseconds_of(const std::map<std::string, Samples>& samples, const std::string& name, int steps) {
    const auto found = samples.find(name);
    return found == samples.end() ? Json() : Json(1e6 * median(found->second.cpu) / steps);
}

/// GFLOP/s of multiply-adds, measured among the row's own benchmarks: the clock drifts. NaN where it is no peak.
double peak_of(const std::map<std::string, Samples>& samples, const std::string& target) {
    for (const Kernels& kernels : runnable_kernels())
        if (kernels.target == target && kernels.hardware_fma)
            return bench::peak_of(samples.at("peak-" + target), kernels);
    return std::nan("");
}

/// Whether this core executes the best target's packs in full width: then their peak is twice that of packs half as
/// wide.
bool full_width(const std::map<std::string, Samples>& samples) {
    constexpr double between_half_and_full = 1.5;
    return best_target().name == "v4" && peak_of(samples, "v4") > between_half_and_full * peak_of(samples, "v3");
}

/// The bar on this core: half of it where the core is narrower.
std::string bar_text(const Bar& bar, bool full) {
    if (bar.A == 0) return "-";
    const double share = full ? 1 : 0.5;
    return to_text(share * bar.A) + (bar.B == 0 ? "" : " / " + to_text(share * bar.B));
}

Json ratio(const Json& theirs, double ours) { return theirs.is_null() ? Json() : Json(theirs.get<double>() / ours); }

}  // namespace

void add_peak(const std::string& name, const Kernels& kernels, const Effort& effort) {
    add(name, effort, [kernels](benchmark::State& state) {
        for (auto _ : state) benchmark::DoNotOptimize(kernels.multiply_adds(peak_rounds));
        state.SetItemsProcessed(state.iterations() * peak_rounds * kernels.chains * kernels.lanes);
    });
}

double peak_of(const Samples& samples, const Kernels& kernels) {
    return 2e-9 * static_cast<double>(peak_rounds) * kernels.chains * kernels.lanes / median(samples.cpu);
}

bool has_dynamic(const Row& row) {
    return row.features() <= (row.controller == Controller::fixed ? 16 : 8);  // it takes minutes beyond
}

void add_trials(const std::deque<Row>& rows, const Effort& effort) {
    for (const Row& row : rows) {
        if (has_dynamic(row)) add_baseline(row, "A", make_dynamic, effort);
        add_baseline(row, "B", make_fixed, effort);
        for (const Target& target : measured_targets())
            if (!effort.quick || row.features() <= 8 || target.name == best_target().name)
                add_unit("trial/" + row.name + "/" + target.name, row, target, effort);
        for (const Kernels& kernels : runnable_kernels())
            add_peak("trial/" + row.name + "/peak-" + kernels.target, kernels, effort);
    }
}

void add_estimators(const Effort& effort) {
    for (const Row& row : estimator_rows()) add_unit("estimator/" + row.name, row, best_target(), effort);
}

Table estimators_table() {
    Table table{"estimators", "Estimators, straight path, constant sigma", {"arm", "us/step", "trials/s"}, {}};
    const std::map<std::string, Samples> samples = measure("estimator");
    for (const Row& row : estimator_rows()) {
        const double seconds = median(samples.at(row.name).cpu) / row.trials;
        table.rows.push_back({row.name, 1e6 * seconds / (row.problem.view().poses - 1), 1 / seconds});
    }
    return table;
}

std::vector<Table> trial_tables(const std::string& key, const std::string& title, const std::deque<Row>& rows) {
    const std::vector<Target> targets = measured_targets();
    const std::string best = targets.front().name;
    Table table{key,
                title + ", unit " + best,
                {"row", "A us/step", "B us/step", "us/step", "trials/s", "x A", "x B", "bar", "operations/step",
                 "GFLOP/s", "% of peak"},
                {}};
    Table others{key + "_targets", title + ", other targets", {"row"}, {}};
    for (std::size_t u = 1; u < targets.size(); ++u)
        for (const char* what : {" us/step", " x A", " x B", " % of peak"})
            others.columns.push_back(targets[u].name + what);
    for (const Row& row : rows) {
        const std::map<std::string, Samples> samples = measure("trial/" + row.name);
        const int steps = row.problem.view().poses - 1;
        const Json A = microseconds_of(samples, "A", steps), B = microseconds_of(samples, "B", steps);
        const double operations = operations_per_step(row);
        others.rows.push_back({row.name});
        for (const Target& target : targets) {
            const Json measured = microseconds_of(samples, target.name, row.steps());
            const double ours = measured.is_null() ? std::nan("") : measured.get<double>();
            const double rate = operations / ours / 1e3, share = 100 * rate / peak_of(samples, target.name);
            if (target.name == best)
                table.rows.push_back({row.name, A, B, ours, 1e6 / (ours * steps), ratio(A, ours), ratio(B, ours),
                                      bar_text(row.bar, full_width(samples)), operations, rate, share});
            else
                for (const Json& cell : {measured, ratio(A, ours), ratio(B, ours), Json(share)})
                    others.rows.back().push_back(cell);
        }
    }
    return {table, others};
}

}  // namespace credence::bench
