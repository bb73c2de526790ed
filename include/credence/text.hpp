#pragma once
// Module base: numbers and lists as text, and back: `to_text` gives the shortest text that reads back to the same bits.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace credence {

std::string to_text(double value);

/// The whole text as a number, `inf` and `nan` included; nothing where it is not one.
std::optional<double> to_number(std::string_view text);

/// The whole text as a whole number; `1e6` is one. Nothing where it is not one or does not fit.
std::optional<std::int64_t> to_integer(std::string_view text);

std::string trimmed(std::string_view text);

/// Whether a character may occur in names of scenarios and of a record's groups: [A-Za-z0-9_-], whatever the locale.
bool is_name_character(char c);

/// Whether every sequence of bytes is one of UTF-8 (RFC 3629), as files and JSON need it.
bool is_utf8(std::string_view text);

/// The text with characters that control a terminal (control characters but line feed and tab, changes of the direction
/// of writing) and bytes that are not UTF-8 replaced by the result of `instead` for each.
std::string with_controls_as(std::string_view text, const std::function<std::string(std::string_view)>& instead);

/// The text, such as a report, fit for a terminal: these characters are escaped as in JSON, such as `\u001b`. All
/// output of the program goes through it, because titles, names and units come from files. For a name in a message:
/// `printable`, error.hpp.
std::string shown(std::string_view text);

/// One word of a command line, quoted where a shell needs it; control characters as bash writes them, in $'...'.
std::string shell_word(const std::string& word);

/// The parts between commas, trimmed; an empty text has none.
std::vector<std::string> split_list(std::string_view text, char separator = ',');

std::string joined(const std::vector<std::string>& parts, std::string_view separator = ", ");

/// The candidate that is fewest edits away from `word`, if it is close enough to be meant; else empty.
std::string closest(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace credence
