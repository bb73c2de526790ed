#pragma once
// Text formatted with roff's man(7) macros.

#include <string>

namespace credence::cli::roff {

/// A text with roff's special characters escaped: hyphens can be copied, quotes stay straight.
std::string plain(const std::string& text);
std::string bold(const std::string& text);
std::string italic(const std::string& text);

/// `.SH TITLE`, `.SS TITLE`
std::string section(const std::string& title);
std::string subsection(const std::string& title);

/// Begins a paragraph, except for the first one of a section.
inline const std::string paragraph = ".PP\n";

/// A text whose lines are filled; those that begin with a blank are set unchanged, apart.
std::string filled(const std::string& text);

/// A tagged paragraph: the tag is already roff, the text is not.
std::string tagged(const std::string& tag, const std::string& text);

/// Lines set unchanged, indented.
std::string example(const std::string& line);

}  // namespace credence::cli::roff
