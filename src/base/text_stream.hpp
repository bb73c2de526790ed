#pragma once
// Streams that read a text.

#include <sstream>
#include <string>

namespace credence {

/// A stream of a text, which throws where it gets no memory: by default std::getline then ends as at the end of the
/// text.
inline std::istringstream stream_of(const std::string& text) {
    std::istringstream stream(text);
    stream.exceptions(std::ios::badbit);
    return stream;
}

/// A text without the mark that some editors begin every text with.
inline std::string without_mark(const std::string& text) {
    const std::string byte_order_mark = "\xEF\xBB\xBF";
    return text.starts_with(byte_order_mark) ? text.substr(byte_order_mark.size()) : text;
}

}  // namespace credence
