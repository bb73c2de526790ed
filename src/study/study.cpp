#include <credence/error.hpp>
#include <credence/record.hpp>
#include <credence/study.hpp>

#include "record/results.hpp"
#include "study/block_results.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace credence {

Study new_study(const std::vector<Scenario>& scenarios, std::uint64_t root_seed, Keep keep) {
    Study study{root_seed, {}, 0, false};
    std::set<std::string> names;
    for (const Scenario& scenario : scenarios) {
        if (!names.insert(scenario.name).second)
            throw invalid_value("scenario.name", scenario.name, "two scenarios of the run have it",
                                "Give each its own name");
        study.scenarios.push_back(results_without_totals(scenario, keep));
    }
    return study;
}

bool last_would_grow(const ScenarioResults& results, std::int64_t trials) {
    return !results.blocks.empty() &&
           block_rows(results, results.blocks.size() - 1) < trials_in_block(trials, results.blocks.back());
}

Keep keep_of(const Study& study) { return study.scenarios.empty() ? Keep::trials : study.scenarios.front().keep; }

BlockRanges missing_blocks(const ScenarioResults& results, std::int64_t trials, const Shard& shard) {
    BlockRanges asked;
    if (shard.count == 1)
        asked = BlockRanges::below(block_count(trials));
    else
        for (std::int64_t block = shard.index; block < block_count(trials); block += shard.count) asked.add(block);
    BlockRanges missing = asked.without(results.blocks);
    if (last_would_grow(results, trials)) missing.add(results.blocks.back());
    return missing;
}

std::int64_t least_trials(const Study& study) {
    std::int64_t least = study.trials;
    for (const ScenarioResults& results : study.scenarios) least = std::max(least, trials_up_to(results));
    return least;
}

Study study_of(Record record) {
    Study study;
    ScenarioResults& results = record.results;
    results.blocks = BlockRanges::below(block_count(results.trials));
    if (results.columns[RecordColumn::unseen].type == ColumnType::integer) {  // not one of the record's own
        results.columns.erase(results.columns.begin() + RecordColumn::unseen);
        std::vector<std::vector<double>>& columns = results.arms.front().columns.in_memory();
        columns.erase(columns.begin() + RecordColumn::unseen);
        std::vector<ExactMoments>& totals = results.arms.front().totals.trials.columns;
        totals.erase(totals.begin() + RecordColumn::unseen);
    }
    study.trials = results.trials;
    study.scenarios.push_back(std::move(results));
    return study;
}

}  // namespace credence
