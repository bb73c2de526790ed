// The cost of the statistics: the engine beside the engine without all but NEES, NIS and trace(P) [bare.cmake].

#include "statistics.hpp"

#include "worlds/deformable/deformable.hpp"
#include "numeric/chi_square.hpp"

namespace credence {

#ifdef CREDENCE_X86_TARGETS
CREDENCE_DECLARE_TARGET(bare)
#endif

namespace bench {

namespace {

constexpr std::int64_t usual_block = 1000;  ///< beyond the detailed trials

std::string group_of(const Row& row) { return "statistics/" + row.name; }

void add_block(const Row& row, const std::string& name, const Target& target, const Effort& effort) {
    add(group_of(row) + "/" + name, effort, [&row, target](benchmark::State& state) {
        std::int64_t index = usual_block;
        for (auto _ : state) benchmark::DoNotOptimize(run_block(row.problem, 1, index++, row.trials, target));
    });
}

/// Sorting NEES into cells, which the engine without statistics does as well.
void add_cells(const Row& row, const Effort& effort) {
    const auto cells = equiprobable_cells(row.problem.view().state_size);
    std::vector<double> nees;
    const Block block = run_block(row.problem, 1, usual_block, row.trials);
    for (const std::uint16_t cell : block.arms.front().cells)
        nees.push_back(cell == no_cell ? 0 : cells->upper()[cell] * 0.999);
    add(group_of(row) + "/cells", effort, [cells, nees](benchmark::State& state) {
        std::vector<std::uint16_t> found(nees.size());
        for (auto _ : state) {
            for (std::size_t i = 0; i < nees.size(); ++i) found[i] = static_cast<std::uint16_t>(cells->cell(nees[i]));
            benchmark::DoNotOptimize(found.data());
            benchmark::ClobberMemory();
        }
    });
}

/// Its instruction set is that of the best target.
bool has_bare_unit() {
#ifdef CREDENCE_X86_TARGETS
    return best_target().name == "v4";
#else
    return false;
#endif
}

}  // namespace

void add_statistics(const std::deque<Row>& rows, const Effort& effort) {
#ifdef CREDENCE_X86_TARGETS
    if (!has_bare_unit()) return;
    for (const Row& row : rows) {
        add_block(row, "all", best_target(), effort);
        add_block(row, "bare", CREDENCE_LIST_TARGET(bare, 8), effort);
        add_cells(row, effort);
    }
#else
    (void)rows, (void)effort;
#endif
}

Table statistics_table(const std::deque<Row>& rows) {
    Table table{"statistics",
                "Cost of the statistics, unit v4, trials beyond the first 4096",
                {"row", "us/step", "with NEES, NIS and trace(P) only", "cost %"},
                {}};
    if (!has_bare_unit()) return table;
    for (const Row& row : rows) {
        const std::map<std::string, Samples> samples = measure(group_of(row));
        const auto microseconds = [&](const char* name) {
            return 1e6 * median(samples.at(name).cpu) / row.steps();
        };
        const double all = microseconds("all"), bare = microseconds("bare") - microseconds("cells");
        table.rows.push_back({row.name, all, bare, 100 * (all / bare - 1)});
    }
    return table;
}

}  // namespace bench
}  // namespace credence
