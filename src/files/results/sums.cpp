#include "files/results/format.hpp"
#include "files/results/parts.hpp"

#include <algorithm>
#include <cmath>

namespace credence {

using hdf5::Dataset;
using hdf5::Error;
using hdf5::Extents;
using hdf5::Handle;

std::vector<double> parts_of(const std::vector<ExactSum>& sums, std::size_t width) {
    std::vector<double> rows;
    for (const ExactSum& sum : sums) {
        std::vector<double> parts = sum.parts();
        parts.resize(width);
        std::transform(parts.begin(), parts.end(), std::back_inserter(rows), one_nan);
    }
    return rows;
}

std::int64_t whole_number(const ExactSum& sum, const std::string& name) {
    std::int64_t total = 0;
    for (const double part : sum.parts()) {
        if (!(std::abs(part) < 0x1p62) || part != std::nearbyint(part))
            throw hdf5::Error(name, "its total is not a whole number");
        total += static_cast<std::int64_t>(part);
    }
    return total;
}

std::vector<ExactSum> read_sums(const Handle& group, const std::string& name, const Extents& extents) {
    const std::vector<double> rows = read_as<double>(group, name, extents);
    const auto width = static_cast<std::ptrdiff_t>(extents.back());
    std::vector<ExactSum> sums;
    for (auto row = rows.begin(); row != rows.end(); row += width) {
        sums.push_back(ExactSum::from_parts({row, row + width}));
        std::vector<double> parts = sums.back().parts();
        parts.resize(std::max<std::size_t>(parts.size(), extents.back()));
        const auto same = [](double a, double b) { return a == b || (a != a && b != b); };
        if (!std::equal(parts.begin(), parts.end(), row, row + width, same))
            throw Error(hdf5::place_of(group, name), "its parts do not follow from each other");
    }
    return sums;
}

std::vector<ExactSum> read_whole_sums(const Handle& group, const std::string& name, hsize_t steps) {
    const Dataset dataset(group, name);
    dataset.require_extents({steps});
    std::vector<ExactSum> sums;
    for (const std::int64_t value : dataset.read<std::int64_t>()) {
        constexpr std::int64_t half = std::int64_t{1} << 32;
        const std::int64_t low = value % half;  // both it and the rest are exact as doubles
        sums.push_back(ExactSum::from_parts({static_cast<double>(value - low), static_cast<double>(low)}));
    }
    return sums;
}

}  // namespace credence
