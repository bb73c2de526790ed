#include "study/run.hpp"

#include <utility>

namespace credence {

Schedule::Schedule(Study& study, const RunOptions& options) : trials_(options.trials) {
    for (std::size_t s = 0; s < study.scenarios.size(); ++s) {
        ScenarioResults& results = study.scenarios[s];
        OfScenario& one = scenarios_.emplace_back(
            OfScenario{results.blocks, missing_blocks(results, options.trials, options.shard)});
        if (last_would_grow(results, options.trials)) {
            const std::size_t last = results.blocks.size() - 1;
            one.partial = {{s, results.blocks.back()}, static_cast<int>(block_rows(results, last))};
            one.done.remove(results.blocks.back());
        }
        progress_.total += trials_in(one.missing, options.trials);
        task_count_ += one.left = one.missing.size();
        BlockRanges planned = one.missing;
        planned.add(one.done);
        set_blocks(results, std::move(planned), options.trials);
    }
}

std::optional<Task> Schedule::next() {
    if (next_ >= task_count_) return std::nullopt;
    std::size_t place = next_++;
    for (std::size_t s = 0; s < scenarios_.size(); place -= scenarios_[s++].missing.size())
        if (place < scenarios_[s].missing.size()) return Task{s, scenarios_[s].missing[place]};
    return std::nullopt;
}

bool Schedule::finish(const Task& task) {
    OfScenario& one = scenarios_[task.scenario];
    one.done.add(task.block);
    progress_.done += trials_in_block(trials_, task.block);
    return --one.left == 0;
}

void Schedule::leave_out_missing(Study& study) {
    for (std::size_t s = 0; s < study.scenarios.size(); ++s)
        set_blocks(study.scenarios[s], std::move(scenarios_[s].done), trials_);
}

}  // namespace credence
