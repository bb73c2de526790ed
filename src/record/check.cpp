// Checks the values of a step of a record. A covariance that is not symmetric is refused, with its dataset, trial and
// step; a value that is not finite makes the trial fail at this step, as a failure of the filter and not of the record.

#include "record/presence.hpp"

#include <credence/text.hpp>

#include "record/source.hpp"

#include <algorithm>
#include <cmath>

namespace credence {

namespace {

constexpr double largest_asymmetry = 1e-9;

void refuse_asymmetry(const std::string& dataset, const RecordStep& step, int i, int j, double above, double below) {
    throw RecordError(record_place(dataset),
                      "trial " + std::to_string(step.trial) + ", step " + std::to_string(step.step) +
                          " (both counted from 0) is not symmetric: [" + std::to_string(i) + ", " + std::to_string(j) +
                          "] is " + to_text(above) + ", [" + std::to_string(j) + ", " + std::to_string(i) + "] is " +
                          to_text(below),
                      "Write (P + P') / 2 if it is rounding that grew, and look for a bug in the filter if it is not");
}

}  // namespace

std::vector<int> counted_up(int count) {
    std::vector<int> all(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) all[static_cast<std::size_t>(i)] = i;
    return all;
}

std::vector<int> members_of(const ComponentGroup& group) {
    std::vector<int> members;
    for (int i = 0; i < group.count; ++i) members.push_back(group.component(i));
    return members;
}

bool any_number(const double* values, std::ptrdiff_t count) {
    return !std::all_of(values, values + count, [](double value) { return std::isnan(value); });
}

bool read_symmetric(const std::string& dataset, const RecordStep& step, const double* values, std::ptrdiff_t size,
                    const std::vector<int>& rows, double epsilon, Eigen::MatrixXd& symmetric) {
    const double most = std::max(largest_asymmetry, 16 * epsilon);
    const auto at = [&](int i, int j) { return values[i * size + j]; };
    for (const int i : rows)
        for (const int j : rows)
            if (!std::isfinite(at(i, j))) return false;
    const auto count = static_cast<Eigen::Index>(rows.size());
    symmetric.resize(count, count);
    for (Eigen::Index a = 0; a < count; ++a) {
        for (Eigen::Index b = 0; b <= a; ++b) {
            const int i = rows[static_cast<std::size_t>(b)], j = rows[static_cast<std::size_t>(a)];
            const double above = at(i, j), below = at(j, i), difference = std::abs(above - below);
            // The cheap bound comes first; the other one allows for the rounding of entries that should be 0.
            if (difference > most * std::max(std::abs(above), std::abs(below)) &&
                !(difference <= most * std::sqrt(std::abs(at(i, i))) * std::sqrt(std::abs(at(j, j)))))
                refuse_asymmetry(dataset, step, i, j, above, below);
            symmetric(a, b) = symmetric(b, a) = above / 2 + below / 2;
        }
    }
    return true;
}

std::string read_innovation(const RecordStep& step, const RecordShape& shape, CheckedStep& checked) {
    checked.rows.clear();
    for (int row = 0; row < shape.m; ++row)
        if (!std::isnan(step.innovation[row])) checked.rows.push_back(row);
    checked.nu.resize(static_cast<Eigen::Index>(checked.rows.size()));
    for (std::size_t i = 0; i < checked.rows.size(); ++i)
        checked.nu(static_cast<Eigen::Index>(i)) = step.innovation[checked.rows[i]];
    if (!checked.nu.allFinite()) return "the innovation is not finite";
    return read_symmetric("innovation_covariance", step, step.innovation_covariance, shape.m, checked.rows,
                          shape.innovation_epsilon, checked.S)
               ? ""
               : "the innovation covariance is not finite";
}

}  // namespace credence
