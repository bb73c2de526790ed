// Files as results: each is refused by an InputError of one line, or what was read can be reported.

#include "hdf5_target.hpp"
#include "study_hash_repair.hpp"

#include <credence/report.hpp>
#include <credence/detail/store.hpp>

using namespace credence;
using namespace credence::fuzz;

namespace {

bool is_small(const Study& study) {
    std::size_t arms = 0;
    for (const ScenarioResults& results : study.scenarios) {
        if (results.trials > 64 || results.steps() > 16 || results.state_size() > 16) return false;
        arms += results.arms.size();
    }
    return arms <= 4;
}

void read_file(const std::string& path, bool with_report) {
    const StoredStudy stored = read_results(path);
    if (with_report && is_small(stored.study))
        require(!report_text(make_report(stored.study, 0.05)).empty(), "there is a report");
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t room, unsigned seed) {
    return mutate_hdf5(data, size, room, seed, repair_study_hash);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return try_file(data, size, [&](const std::string& path) { read_file(path, is_chosen({data, size})); });
}
