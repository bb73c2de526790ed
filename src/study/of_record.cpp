// A record as a study.

#include <credence/record.hpp>
#include <credence/study.hpp>

#include "record/results.hpp"

#include <utility>

namespace credence {

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
