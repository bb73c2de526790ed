#pragma once
// Text as the macros man(7) of roff want it.

#include <string>

namespace credence::cli::roff {

/// A text of which roff takes every character as it is: hyphens stay hyphens that can be copied, quotes stay straight.
std::string plain(const std::string& text);
std::string bold(const std::string& text);
std::string italic(const std::string& text);

/// `.SH TITLE`, `.SS TITLE`
std::string section(const std::string& title);
std::string subsection(const std::string& title);

/// Begins a paragraph, but for the first one of a section.
inline const std::string paragraph = ".PP\n";

/// A text whose lines are filled; those that begin with a blank stay as they are, set apart.
std::string filled(const std::string& text);

/// A tagged paragraph: the tag is roff already, the text is not.
std::string tagged(const std::string& tag, const std::string& text);

/// Lines set as they are, indented.
std::string example(const std::string& line);

}  // namespace credence::cli::roff
