#include <credence/study.hpp>

#include <credence/error.hpp>

#include <algorithm>
#include <set>

namespace credence {

Study new_study(const std::vector<Declaration>& scenarios, std::uint64_t root_seed) {
    Study study{root_seed, {}, 0, false};
    std::set<std::string> names;
    for (const Declaration& scenario : scenarios) {
        if (!names.insert(scenario.name).second)
            throw invalid_value("scenario.name", scenario.name, "two scenarios of the run have it",
                                "Give each its own name");
        study.scenarios.push_back(empty_results(scenario));
    }
    return study;
}

bool last_would_grow(const ScenarioResults& results, std::int64_t trials) {
    return !results.blocks.empty() &&
           block_rows(results, results.blocks.size() - 1) < trials_in_block(trials, results.blocks.back());
}

std::vector<std::int64_t> missing_blocks(const ScenarioResults& results, std::int64_t trials, const Shard& shard) {
    std::vector<std::int64_t> missing;
    auto there = results.blocks.begin();
    for (std::int64_t block = shard.index; block < block_count(trials); block += shard.count) {
        there = std::lower_bound(there, results.blocks.end(), block);
        if (there == results.blocks.end() || *there != block) missing.push_back(block);
    }
    if (last_would_grow(results, trials))
        missing.insert(std::lower_bound(missing.begin(), missing.end(), results.blocks.back()), results.blocks.back());
    return missing;
}

std::int64_t least_trials(const Study& study) {
    std::int64_t least = study.trials;
    for (const ScenarioResults& results : study.scenarios)
        if (!results.blocks.empty())
            least = std::max(least, results.blocks.back() * block_size + block_rows(results, results.blocks.size() - 1));
    return least;
}

}  // namespace credence
