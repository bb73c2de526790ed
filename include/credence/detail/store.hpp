#pragma once
// Module files: reading and writing results files and other files. docs/results-format.md describes the results file.

#include <credence/detail/recorded_noise.hpp>
#include <credence/study.hpp>
#include <credence/detail/trajectory.hpp>

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace credence {

/// Facts of the machine and the clock, as name and text. They are stored only in the group /run.
using RunFacts = std::vector<std::pair<std::string, std::string>>;

struct StoredStudy {
    Study study;
    RunFacts run;
};

/// The identity of a file and the time of its last change: if two differ, they are different files, or the content
/// changed.
struct FileIdentity {
    std::uint64_t device = 0, inode = 0;
    std::int64_t size = 0, written = 0;  ///< `written` in nanoseconds, by the file system's clock

    bool operator==(const FileIdentity&) const = default;
};
/// The identity of the regular file that a name leads to; nothing where there is none. Throws Failure where the system
/// cannot say.
std::optional<FileIdentity> identity_of(const std::string& path);

/// A file to be written, and the existing one that it may replace.
struct Output {
    /// An output that may replace any existing file.
    Output(const std::string& path);

    std::string path;                   ///< as it was given
    std::string target;                 ///< where its symbolic links lead to
    std::optional<FileIdentity> there;  ///< the file that may be replaced; nothing: no file
};

/// Throws InputError where a file could not be written at `path`: folder missing or not writable, or a file exists
/// there already and `overwrite` is false; `way_out` is the remedy for that. Writes nothing. The returned output may
/// replace the file that exists now, and none that appears later.
Output check_output(const std::string& path, bool overwrite, const std::string& way_out = "Give another name");

/// Writes a text in the same way as results: completely or not at all. Throws Failure where the system refuses.
void write_text_file(const Output& output, const std::string& text);

/// Writes the study: built in memory, written aside, synced and renamed, so that the name never leads to an incomplete
/// file. `check` is called after writing and before renaming; it throws to cancel this. Throws Failure where the system
/// refuses (no space ...), or another file exists than the output may replace; the existing file is then unchanged.
void write_results(const Output& output, const Study& study, const RunFacts& run,
                   const std::function<void()>& check = {});

/// Reads a results file back. Throws InputError, naming the file and the place, where it is not a results file, was
/// made by another schema version, is damaged, or is inconsistent. Scenarios are read back from their text. Totals and
/// details beyond `most_totals` bytes are checked and stay in the file [load_totals].
StoredStudy read_results(const std::string& path, std::int64_t most_totals = std::numeric_limits<std::int64_t>::max());

/// The same, but totals and details stay in the file and are not checked before load_totals() reads them, which then
/// throws.
StoredStudy read_results_without_totals(const std::string& path);

/// Reads a noise record: `odometry` [K, 3], `walk`, `deformation`, `measurement` [K, M, 2], optionally `edge` [K, E,
/// 2]. Throws InputError where a dataset is missing, has other dimensions or another type, or is not finite.
NoiseRecord read_noise_record(const std::string& path);

/// Writes trajectories of single trials, a group per scenario and within it a group per arm.
void write_trajectories(const Output& output, const std::vector<Trajectory>& trajectories, const RunFacts& run);

}  // namespace credence
