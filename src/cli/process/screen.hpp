#pragma once
// A text that is drawn again and again on a terminal.

#include <string>

namespace credence::cli {

/// Whether the standard output is a terminal that can be drawn on.
bool can_draw();

/// While there is one, a page of its own; what the terminal showed before is back when it goes.
class Screen {
public:
    Screen();
    ~Screen();
    Screen(const Screen&) = delete;
    Screen& operator=(const Screen&) = delete;

    /// As much of the text as the terminal has room for, in place of what was drawn before.
    void draw(const std::string& text);
};

/// The first `lines` lines of a text, each cut to `columns` characters; a last line says where some are left out. Every
/// character is taken to be one column wide.
std::string cut_to_fit(const std::string& text, int lines, int columns);

}  // namespace credence::cli
