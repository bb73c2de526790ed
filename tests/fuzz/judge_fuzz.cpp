// Files as records for judge: each is refused by an InputError of one line, or gets its verdict.

#include "hdf5_target.hpp"

#include <credence/record.hpp>
#include <credence/report.hpp>

using namespace credence;
using namespace credence::fuzz;

namespace {

bool is_small(const ScenarioResults& results) {
    return results.trials <= 64 && results.steps() <= 16 && results.state_size() <= 16 &&
           results.all_series.size() <= 64;
}

void judge_file(const std::string& path, bool with_report) {
    Record record = read_record(path);
    const ArmResults& arm = record.results.arms.at(0);
    const std::vector<std::int64_t>& statuses = arm.totals.trials.statuses;
    const std::int64_t completed = statuses[static_cast<std::size_t>(Status::completed)];
    require(completed + record.trouble_count == record.results.trials, "every trial completes or is in trouble");
    require(arm.totals.trials.counted() == completed, "the others are not in the figures");
    if (!with_report || !is_small(record.results)) return;
    const Report report = make_record_report(std::move(record), path, 0.05);
    require(!report_text(report).empty() && !report_json(report).empty() && !report_csv(report).empty(),
            "there is a report");
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t room, unsigned seed) {
    return mutate_hdf5(data, size, room, seed);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return try_file(data, size, [&](const std::string& path) { judge_file(path, is_chosen({data, size})); });
}
