// Fuzz target for journals: each is refused by an InputError of one line, or its content can be used. Checksums always
// fit, so that the data after them are reached.

#include "require.hpp"
#include "scratch_file.hpp"

#include "files/journal/commit.hpp"
#include "../of_scenarios.hpp"

#include <credence/error.hpp>
#include <credence/ini.hpp>
#include "files/stored_run.hpp"
#include "report/watch/watch.hpp"

#include <cstring>
#include <random>

using namespace credence;
using namespace credence::fuzz;

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t room);

namespace {

/// The study of the seeds [journal.ini]; the journal says what it keeps.
Study asked(Keep keep) { return new_study({read_deformable(CREDENCE_FUZZ_SCENARIO, {})}, 1, keep); }

template <class T>
T number_at(const std::uint8_t* data, std::size_t position) {
    T value;
    std::memcpy(&value, data + position, sizeof value);
    return value;
}

/// Writes the checksum of data[begin, end) after it, where it fits.
void seal(std::uint8_t* data, std::size_t size, std::size_t begin, std::size_t end) {
    if (end < begin || end > size || size - end < sizeof(std::uint32_t)) return;
    const std::uint32_t crc = checksum(data + begin, end - begin);
    std::memcpy(data + end, &crc, sizeof crc);
}

/// The end of the header, and every commit up to the end of its payload.
std::vector<std::size_t> seams(const std::uint8_t* data, std::size_t size) {
    constexpr std::size_t length_at = 20, payload_at = 8;
    std::vector<std::size_t> ends;
    if (size < header_prefix) return ends;
    std::size_t end = header_prefix + number_at<std::uint32_t>(data, length_at) + sizeof(std::uint32_t);
    while (end <= size) {
        ends.push_back(end);
        if (size - end < commit_head_size) break;
        const auto payload = number_at<std::uint64_t>(data, end + payload_at);
        if (payload > size - end) break;
        end += commit_head_size + payload + commit_tail_size;
    }
    return ends;
}

void repair(std::uint8_t* data, std::size_t size) {
    std::size_t begin = 0;
    for (const std::size_t end : seams(data, size)) {
        seal(data, size, begin, end - sizeof(std::uint32_t));
        begin = end;
    }
}

void use(Study& study) {
    for (const ScenarioResults& results : study.scenarios)
        for (const ArmResults& arm : results.arms) {
            require(arm.nees.size() == static_cast<std::size_t>(results.detailed() * results.steps()), "details fit");
            require(results.keep == Keep::trials || arm.totals.trials.trials() == results.trials,
                    "aggregates are of all trials");
            for (std::size_t c = 0; c < results.columns.size() && results.keep == Keep::trials; ++c)
                require(column_values(results, arm, c).size() == static_cast<std::size_t>(results.trials),
                        "a column has its rows");
        }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t room, unsigned seed) {
    std::minstd_rand random(seed);
    const std::vector<std::size_t> ends = seams(data, size);
    if (ends.empty() || random() % 4 == 0) {
        size = LLVMFuzzerMutate(data, size, room);
    } else {
        // The numbers at the start of a commit, or those of its totals; its values would take nearly all the changes.
        const std::size_t begin = ends[random() % ends.size()];
        const std::size_t first =
            std::min(size - 1, begin + (random() % 2 ? random() % 64 : random() % (size - begin + 1)));
        LLVMFuzzerMutate(data + first, std::min<std::size_t>(size - first, 16),
                         std::min<std::size_t>(size - first, 16));
    }
    if (random() % 8 > 0) repair(data, size);
    return size;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const Study trials = asked(Keep::trials), aggregates = asked(Keep::aggregates);
    const ScratchFile file(data, size);
    const std::string results = file.path() + ".results";
    std::filesystem::rename(file.path(), results + ".journal");
    try {
        const Snapshot snapshot = RunWatch(results).snapshot();
        require(watch_text(snapshot).starts_with(results) && !watch_json(snapshot).empty(), "a snapshot can be shown");
    } catch (const InputError& error) {
        require_one_line(error.what());
    }
    try {
        const Keep keep = stored_definition(results).keep;
        StoredRun run(results, keep == Keep::aggregates ? aggregates : trials, Start::resume);
        use(run.study());
    } catch (const InputError& error) {
        require_one_line(error.what());
    }
    std::filesystem::remove(results + ".journal");
    return 0;
}
