#pragma once
// Progress of long work: a line that is redrawn on a terminal, otherwise a line now and then; nothing with --quiet.

#include <credence/study.hpp>

#include "report/format.hpp"

#include <functional>

namespace credence::cli {

/// Receives all progress from now on, whether a command is quiet or not, and the line is not drawn; empty: the line is.
/// For those who call the program's functions from a program of their own.
void listen_to_progress(std::function<void(const Progress&)> listener);

class ProgressLine {
public:
    explicit ProgressLine(bool quiet);
    void operator()(const Progress& progress);
    /// Clears the line on a terminal.
    void finish();

private:
    bool quiet_, terminal_, drawn_ = false;
    double next_ = 0;  ///< seconds at which the next line is due
};

/// `12.3 MB`
std::string bytes_text(std::int64_t bytes);

/// The size of a file that was written, in the same way. A finished command must not fail because it is unknown.
std::string file_size_text(const std::string& path);

}  // namespace credence::cli
