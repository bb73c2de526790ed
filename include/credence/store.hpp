#pragma once
// Module files: files. The results file is described in docs/results-format.md.

#include <credence/recorded_noise.hpp>
#include <credence/study.hpp>
#include <credence/trajectory.hpp>

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace credence {

/// Facts of the machine and the clock, as name and text. They go into the group /run and nowhere else.
using RunFacts = std::vector<std::pair<std::string, std::string>>;

struct StoredStudy {
    Study study;
    RunFacts run;
};

/// Which file it is, and when it was written last: two that differ are other files, or one of which the content changed.
struct FileIdentity {
    std::uint64_t device = 0, inode = 0;
    std::int64_t size = 0, written = 0;  ///< `written` in nanoseconds, by the file system's clock

    bool operator==(const FileIdentity&) const = default;
};
/// Of the regular file that a name leads to; nothing where there is none.
std::optional<FileIdentity> identity_of(const std::string& path);

/// A file to be written, and the one that it may replace.
struct Output {
    /// Whatever is there now may be replaced.
    Output(const std::string& path);

    std::string path;                   ///< as it was given
    std::string target;                 ///< where its symbolic links lead to
    std::optional<FileIdentity> there;  ///< what may be replaced; nothing: no file
};

/// Throws InputError where a file could not be put at `path`: folder missing or not writable, or something is there
/// already and `overwrite` is false; `way_out` is the remedy for that. Writes nothing. The output that it returns
/// replaces what is there now and nothing that appears later.
Output check_output(const std::string& path, bool overwrite, const std::string& way_out = "Give another name");

/// Writes a text in the same way as results: whole, or not at all. Throws Failure where the system refuses.
void write_text_file(const Output& output, const std::string& text);

/// Writes the study: built in memory, written aside, synced and renamed, so that the name never stands for half a file.
/// `check` is called when all is written and not renamed yet, and throws where that must not be. Throws Failure where the
/// system refuses (no space ...), or another file is there than the output may replace, leaving what was there.
void write_results(const Output& output, const Study& study, const RunFacts& run,
                   const std::function<void()>& check = {});

/// Reads a results file back. Throws InputError, naming the file and the place, where it is not one, was made by
/// another schema version, is damaged, or does not agree with itself. Scenarios are read back from their text. Totals and
/// details beyond `most_totals` bytes are looked at and stay in the file [load_totals].
StoredStudy read_results(const std::string& path,
                         std::int64_t most_totals = std::numeric_limits<std::int64_t>::max());

/// The same, but totals and details stay in the file and are not looked at before load_totals() does, which throws then.
StoredStudy read_results_without_totals(const std::string& path);

/// Reads a noise record: `odometry` [K, 3], `walk`, `deformation`, `measurement` [K, M, 2], optionally `edge` [K, E,
/// 2]. Throws InputError where something is missing, has another shape or type, or is not finite.
NoiseRecord read_noise_record(const std::string& path);

/// Writes trajectories of single trials, a group per scenario and within it a group per arm.
void write_trajectories(const Output& output, const std::vector<Trajectory>& trajectories, const RunFacts& run);

}  // namespace credence
