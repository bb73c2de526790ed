#include "cli/process/screen.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <vector>

namespace credence::cli {

namespace {

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        lines.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return lines;
}

/// Bytes of the first `columns` characters of UTF-8.
std::size_t bytes_of(const std::string& line, int columns) {
    std::size_t at = 0;
    for (; at < line.size(); ++at)
        if ((static_cast<unsigned char>(line[at]) & 0xc0) != 0x80 && columns-- == 0) break;
    return at;
}

}  // namespace

bool can_draw() {
    const char* terminal = std::getenv("TERM");
    return isatty(STDOUT_FILENO) == 1 && terminal != nullptr && std::string(terminal) != "dumb";
}

std::string cut_to_fit(const std::string& text, int lines, int columns) {
    std::vector<std::string> all = lines_of(text);
    if (const int left_out = static_cast<int>(all.size()) - lines; left_out > 0) {
        all.resize(static_cast<std::size_t>(std::max(0, lines - 1)));
        all.push_back("... " + std::to_string(left_out + 1) + " more lines (--once prints all)");
    }
    std::string fitting;
    for (std::size_t i = 0; i < all.size(); ++i)
        fitting += (i > 0 ? "\n" : "") + all[i].substr(0, bytes_of(all[i], columns));
    return fitting;
}

// ECMA-48, and the alternate screen, which xterm introduced and other terminals have too.
Screen::Screen() { std::cout << "\033[?1049h\033[?25l" << std::flush; }
Screen::~Screen() { std::cout << "\033[?25h\033[?1049l" << std::flush; }

void Screen::draw(const std::string& text) {
    winsize size{};
    if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_row == 0 || size.ws_col == 0) size = {24, 80, 0, 0};
    std::cout << "\033[H\033[J" << cut_to_fit(text, size.ws_row, size.ws_col) << std::flush;
}

}  // namespace credence::cli
