#pragma once
// A text that is redrawn repeatedly on a terminal.

#include <string>

namespace credence::cli {

/// Whether the standard output is a terminal with cursor control.
bool can_draw();

/// While an object exists, the terminal shows its alternate screen; its destructor restores the former content.
class Screen {
public:
    Screen();
    ~Screen();
    Screen(const Screen&) = delete;
    Screen& operator=(const Screen&) = delete;

    /// Shows as much of the text as fits the terminal, replacing the last one.
    void draw(const std::string& text);
};

/// The first `lines` lines of a text, each cut to `columns` characters; a last line says where lines are left out.
/// Every character is assumed to be one column wide.
std::string cut_to_fit(const std::string& text, int lines, int columns);

}  // namespace credence::cli
