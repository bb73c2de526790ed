#pragma once
// Words of which one must be given.

#include <credence/text.hpp>

#include <string>
#include <vector>

namespace credence {

/// `Did you mean X? `, to begin a remedy with; empty where no known word is near.
inline std::string did_you_mean(const std::string& word, const std::vector<std::string>& known) {
    const std::string meant = closest(word, known);
    return meant.empty() ? "" : "Did you mean " + meant + "? ";
}

}  // namespace credence
