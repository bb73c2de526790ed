#pragma once
// Lines of fewer points.

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace credence {

/// Which points of a line through values that are numbers to draw: all, or of each of `most` stretches the lowest and
/// the highest.
inline std::vector<std::size_t> thinned_line(const std::vector<double>& values, std::size_t most) {
    std::vector<std::size_t> chosen;
    if (values.size() <= 2 * most) {
        chosen.resize(values.size());
        std::iota(chosen.begin(), chosen.end(), std::size_t{0});
        return chosen;
    }
    const std::size_t stretch = (values.size() + most - 1) / most;
    for (std::size_t first = 0; first < values.size(); first += stretch) {
        const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first),
                   end = values.begin() + static_cast<std::ptrdiff_t>(std::min(first + stretch, values.size()));
        const auto [low, high] = std::minmax_element(begin, end);
        const auto a = static_cast<std::size_t>(low - values.begin()),
                   b = static_cast<std::size_t>(high - values.begin());
        chosen.push_back(std::min(a, b));
        if (a != b) chosen.push_back(std::max(a, b));
    }
    return chosen;
}

}  // namespace credence
