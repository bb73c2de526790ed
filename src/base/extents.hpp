#pragma once
// Extents in messages.

#include <string>
#include <vector>

namespace credence {

/// `[3, 2]`
template <class Number>
std::string extents_text(const std::vector<Number>& extents) {
    std::string text;
    for (const Number extent : extents) text += (text.empty() ? "[" : ", ") + std::to_string(extent);
    return text + "]";
}

}  // namespace credence
