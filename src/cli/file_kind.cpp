#include "cli/command.hpp"

#include "files/hdf5/read.hpp"
#include "files/record.hpp"
#include "base/readable_file.hpp"
#include "base/text_stream.hpp"
#include "base/wording.hpp"
#include "files/results/format.hpp"

#include <credence/error.hpp>
#include <credence/text.hpp>

#include <algorithm>

namespace credence::cli {

namespace {

/// The kind of an HDF5 file.
FileKind kind_of_contents(const std::string& path) {
    try {
        const hdf5::QuietErrors quiet;
        const hdf5::Handle root = hdf5::open_file(path);
        const std::string format = hdf5::has_attribute(root, "format") ? hdf5::read_text(root, "format") : "";
        if (format == results_format) return FileKind::results;
        if (format == trajectories_format) return FileKind::trajectories;
        if (hdf5::has_link(root, "error") || hdf5::has_link(root, "covariance") || hdf5::has_attribute(root, "arms"))
            return FileKind::record;
        if (hdf5::has_link(root, "odometry") && hdf5::has_link(root, "measurement")) return FileKind::noise;
    } catch (const hdf5::Error&) {
    }
    return FileKind::unknown;
}

bool is_assignment(const std::string& line) {
    const std::string key = trimmed(line.substr(0, line.find('=')));
    return key.size() < line.size() && key.find('.') != std::string::npos &&
           std::ranges::all_of(key, [](char c) { return is_name_character(c) || c == '.'; });
}

/// Whether the first line that is neither empty nor a comment is `[section]` or `section.key = value`.
bool is_scenario(const std::string& text) {
    std::istringstream lines = stream_of(without_mark(text));
    for (std::string line; std::getline(lines, line);)
        if (const std::string bare = trimmed(line.substr(0, line.find('#'))); !bare.empty())
            return (bare.front() == '[' && bare.back() == ']' && is_utf8(bare)) || is_assignment(bare);
    return false;
}

struct Words {
    std::string name, advice;
};

Words words_of(FileKind kind, const std::string& path) {
    const Words words[] = {
        {"a scenario", as_command({"run", path}) + " runs it"},
        {"a results file", as_command({"report", path}) + " reads it"},
        {"the trajectory file of a replay", "`python -m credence.pictures` and whatever opens HDF5 read it"},
        {"a record", as_command({"judge", path}) + " reads it"},
        {"a noise record", as_command({"replay", "SCENARIO.ini", "--noise", path}) + " reads it"},
        {"the journal of a run",
         as_command({"watch", path}) + " follows it, and " + as_command({"run", "--resume"}) + " resumes it"},
    };
    return words[static_cast<std::size_t>(kind)];
}

}  // namespace

FileKind kind_of(const std::string& given) {
    const std::string path = record_file(given);
    std::string start;
    try {
        constexpr std::size_t enough = 4096;
        start = start_of_file(path, enough);
    } catch (const Unreadable&) {
        return FileKind::unknown;
    }
    if (start.starts_with("credence-journal")) return FileKind::journal;
    if (start.starts_with("\x89HDF")) return kind_of_contents(path);
    return is_scenario(start) ? FileKind::scenario : FileKind::unknown;
}

void check_kind(const std::string& path, const std::vector<FileKind>& accepted) {
    const FileKind kind = kind_of(path);
    if (kind == FileKind::unknown || std::count(accepted.begin(), accepted.end(), kind) > 0) return;
    const Words words = words_of(kind, path);
    throw InputError("cannot read " + path, "it is " + words.name + ", not " + words_of(accepted.front(), path).name,
                     words.advice);
}

}  // namespace credence::cli
