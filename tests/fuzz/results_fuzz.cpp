// Files as results: each is refused by an InputError of one line, or what was read can be reported.

#include "hdf5_checksums.hpp"
#include "hdf5_mutator.hpp"
#include "other_files.hpp"
#include "require.hpp"
#include "scratch_file.hpp"
#include "study_hash_repair.hpp"

#include <credence/error.hpp>
#include <credence/report.hpp>
#include <credence/detail/store.hpp>

using namespace credence;
using namespace credence::fuzz;

namespace {

/// A report takes bootstraps, longer than reading: it is computed for one in eight inputs, and only for small ones.
bool is_chosen(std::span<const std::uint8_t> image) { return metadata_checksum(image) % 8 == 0; }
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
    const ScratchFile file(data, size);
    const OnlyFile only(file.path());
    try {
        read_file(file.path(), is_chosen({data, size}));
    } catch (const InputError& error) {
        require_one_line(error.what());
    }
    require_all_closed();
    return 0;
}
