#include <credence/text.hpp>

#include <credence/error.hpp>

#include "base/formatted.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

namespace credence {

std::string to_text(double value) {
    char buffer[64];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
    return std::string(buffer, end);
}

std::optional<double> to_number(std::string_view text) {
    if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

std::optional<std::int64_t> to_integer(std::string_view text) {
    std::int64_t exact = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), exact);
    if (error == std::errc() && end == text.data() + text.size()) return exact;
    const std::optional<double> value = to_number(text);
    if (!value || std::nearbyint(*value) != *value || std::abs(*value) > 9007199254740992.0) return std::nullopt;
    return static_cast<std::int64_t>(*value);
}

std::string trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return std::string(text.substr(first, text.find_last_not_of(" \t\r") - first + 1));
}

bool is_name_character(char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_' || c == '-';
}

namespace {

/// A character of UTF-8 (RFC 3629); of length 0 where the bytes are not one.
struct Character {
    std::size_t length = 0;
    unsigned long code = 0;
};

Character character_at(std::string_view text, std::size_t at) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[at + i]); };
    const unsigned lead = byte(0);
    const std::size_t length = lead < 0x80 ? 1 : lead >> 5 == 6 ? 2 : lead >> 4 == 14 ? 3 : lead >> 3 == 30 ? 4 : 0;
    if (length == 0 || at + length > text.size()) return {};
    unsigned long code = length == 1 ? lead : lead & (0x7fu >> length);
    for (std::size_t k = 1; k < length; ++k) {
        if (byte(k) >> 6 != 2) return {};
        code = code << 6 | (byte(k) & 0x3fu);
    }
    constexpr unsigned long shortest[] = {0, 0, 0x80, 0x800, 0x10000};
    if (code < shortest[length] || code > 0x10ffff || (code >= 0xd800 && code < 0xe000)) return {};
    return {length, code};
}

/// Control characters of ASCII and of Latin-1 (some terminals obey U+009B as they do ESC [), line separators, and
/// characters that change the direction of writing, by which a displayed text can differ from its content.
bool is_control(unsigned long code) {
    return code < 0x20 || (code >= 0x7f && code < 0xa0) || (code >= 0x2028 && code <= 0x202e) ||
           (code >= 0x2066 && code <= 0x2069);
}

/// Two digits.
std::string hexadecimal(char byte) {
    return formatted("%02x", static_cast<unsigned>(static_cast<unsigned char>(byte)));
}

/// `\u009b`, as in JSON; `\xff` for a byte that is not UTF-8, for which JSON has no escape.
std::string escape(std::string_view piece) {
    const Character character = character_at(piece, 0);
    if (character.length == 0) return "\\x" + hexadecimal(piece.front());
    return formatted("\\u%04lx", character.code);
}

char small(char letter) { return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter; }

std::size_t edit_distance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t substituted = diagonal + (small(a[i - 1]) == small(b[j - 1]) ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
        }
    }
    return row.back();
}

}  // namespace

bool is_utf8(std::string_view text) {
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t length = character_at(text, i).length;
        if (length == 0) return false;
        i += length;
    }
    return true;
}

std::string with_controls_as(std::string_view text, const std::function<std::string(std::string_view)>& instead) {
    std::string safe;
    for (std::size_t i = 0; i < text.size();) {
        const Character character = character_at(text, i);
        const std::string_view piece = text.substr(i, std::max<std::size_t>(1, character.length));
        const bool layout = piece == "\n" || piece == "\t";
        if (!layout && (character.length == 0 || is_control(character.code))) safe += instead(piece);
        else safe += piece;
        i += piece.size();
    }
    return safe;
}

std::string shown(std::string_view text) { return with_controls_as(text, escape); }

std::string printable(const std::string& given, std::size_t longest) {
    std::size_t end = std::min(given.size(), longest);
    while (end < given.size() && end > 0 && (static_cast<unsigned char>(given[end]) & 0xc0) == 0x80) --end;
    std::string line;
    for (const char c : shown(std::string_view(given).substr(0, end)))
        if (c == '\n') line += "\\n";
        else if (c == '\t') line += "\\t";
        else line += c;
    return end < given.size() ? line + "..." : line;
}

std::string shell_word(const std::string& word) {
    const std::string plain_characters = "./=,:+%@";
    const bool plain = std::all_of(word.begin(), word.end(), [&](char c) {
        return is_name_character(c) || plain_characters.find(c) != std::string::npos;
    });
    if (plain && !word.empty()) return word;
    const bool ansi = printable(word, word.size()) != word;
    std::string text;
    for (const char c : word)
        if (ansi && (c < 0x20 || c > 0x7e)) text += "\\x" + hexadecimal(c);
        else if (c == '\'') text += ansi ? "\\'" : "'\\''";
        else text += ansi && c == '\\' ? std::string("\\\\") : std::string(1, c);
    return (ansi ? "$'" : "'") + text + "'";
}

std::vector<std::string> split_list(std::string_view text, char separator) {
    std::vector<std::string> parts;
    if (trimmed(text).empty()) return parts;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(separator, begin), text.size());
        parts.push_back(trimmed(text.substr(begin, end - begin)));
        begin = end + 1;
    }
    return parts;
}

std::string joined(const std::vector<std::string>& parts, std::string_view separator) {
    std::string text;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (i > 0) text += separator;
        text += parts[i];
    }
    return text;
}

std::string closest(const std::string& word, const std::vector<std::string>& candidates) {
    constexpr std::size_t longest_word = 64;
    if (word.size() > longest_word) return {};
    std::string best;
    std::size_t least = word.size() / 3 + 2;
    for (const std::string& candidate : candidates) {
        const std::size_t distance = edit_distance(word, candidate);
        if (distance < least) least = distance, best = candidate;
    }
    return best;
}

}  // namespace credence
