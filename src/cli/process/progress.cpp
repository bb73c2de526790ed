#include "cli/process/progress.hpp"

#include "base/formatted.hpp"

#include <unistd.h>

#include <filesystem>
#include <iostream>
#include <system_error>

namespace credence::cli {

namespace {

std::function<void(const Progress&)> progress_listener;

}  // namespace

std::string bytes_text(std::int64_t bytes) {
    const double value = static_cast<double>(bytes);
    if (value < 1e6) return formatted("%.0f kB", value / 1e3);
    if (value < 1e9) return formatted("%.1f MB", value / 1e6);
    return formatted("%.1f GB", value / 1e9);
}

std::string file_size_text(const std::string& path) {
    std::error_code trouble;
    const std::uintmax_t size = std::filesystem::file_size(path, trouble);
    return trouble ? "of unknown size" : bytes_text(static_cast<std::int64_t>(size));
}

void listen_to_progress(std::function<void(const Progress&)> listener) { progress_listener = std::move(listener); }

ProgressLine::ProgressLine(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {
    next_ = terminal_ ? 0.5 : 10;
}

void ProgressLine::operator()(const Progress& progress) {
    if (progress_listener) return progress_listener(progress);
    if (quiet_ || progress.done == 0 || progress.seconds < next_) return;
    next_ = progress.seconds + (terminal_ ? 0.2 : 30);
    const double rate = static_cast<double>(progress.done) / progress.seconds;
    const double left = static_cast<double>(progress.total - progress.done) / rate;
    const double share = 100 * static_cast<double>(progress.done) / static_cast<double>(progress.total);
    std::cerr << (terminal_ ? "\r\033[K" : "") << progress.done << " of " << progress.total << " trials ("
              << formatted("%.0f %%), %.0f trials/s, ", share, rate)
              << duration_text(left) << " left" << (terminal_ ? "" : "\n") << std::flush;
    drawn_ = terminal_;
}

void ProgressLine::finish() {
    if (drawn_) std::cerr << "\r\033[K" << std::flush;
    drawn_ = false;
}

}  // namespace credence::cli
