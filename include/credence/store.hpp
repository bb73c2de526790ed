#pragma once
// Room 12: files. The results file is described in docs/results-format.md.

#include <credence/recorded_noise.hpp>
#include <credence/study.hpp>
#include <credence/trajectory.hpp>

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

/// Throws InputError where a results file could not be put at `path`: folder missing or not writable, or something is
/// there already and `overwrite` is false; `way_out` is the remedy for that. Writes nothing.
void check_output(const std::string& path, bool overwrite, const std::string& way_out = "Give another name");

/// Writes a text to `path` in the same way as results: whole, or not at all. Throws Failure where the system refuses.
void write_text_file(const std::string& path, const std::string& text);

/// Writes the study to `path`: built in memory, written aside, synced and renamed, so that the name never stands for
/// half a file. Replaces what is there. Throws Failure where the system refuses (no space ...), leaving what was there.
void write_results(const std::string& path, const Study& study, const RunFacts& run);

/// Reads a results file back. Throws InputError, naming the file and the place, where it is not one, was made by
/// another schema version, is damaged, or does not agree with itself. Scenarios are read back from their text.
StoredStudy read_results(const std::string& path);

/// Reads a noise record: `odometry` [K, 3], `walk`, `deformation`, `measurement` [K, M, 2], optionally `edge` [K, E,
/// 2]. Throws InputError where something is missing, has another shape or type, or is not finite.
NoiseRecord read_noise_record(const std::string& path);

/// Writes trajectories of single trials, a group per scenario and within it a group per arm.
void write_trajectories(const std::string& path, const std::vector<Trajectory>& trajectories, const RunFacts& run);

}  // namespace credence
