// What a record may not hold: refused by dataset, trial and step.

#include <credence/text.hpp>

#include "hdf5_handle.hpp"
#include "judgement_step.hpp"

#include <algorithm>
#include <cmath>

namespace credence {

namespace {

using hdf5::Error;

constexpr double largest_asymmetry = 1e-9;

Error refused(const char* dataset, const RecordStep& step, const std::string& problem, const std::string& remedy) {
    return {dataset, "trial " + std::to_string(step.trial) + ", step " + std::to_string(step.step) +
                         " (both counted from 0) " + problem, remedy};
}

/// Whether some of the values are numbers; throws where some are infinite.
bool any_number(const char* dataset, const RecordStep& step, const double* values, int count) {
    if (std::any_of(values, values + count, [](double value) { return std::isinf(value); }))
        throw refused(dataset, step, "holds an infinite value",
                      "Write NaN for a step that does not exist or a row that was not observed; if the filter "
                      "diverged, end that trial there");
    return !std::all_of(values, values + count, [](double value) { return std::isnan(value); });
}

void refuse_asymmetry(const char* dataset, const RecordStep& step, int i, int j, double above, double below) {
    throw refused(dataset, step,
                  "is not symmetric: [" + std::to_string(i) + ", " + std::to_string(j) + "] is " + to_text(above) +
                      ", [" + std::to_string(j) + ", " + std::to_string(i) + "] is " + to_text(below),
                  "Write (P + P') / 2 if it is rounding that grew, and look for a bug in the filter if it is not");
}

/// The part of a matrix [size, size] in these rows and columns, made symmetric.
void read_symmetric(const char* dataset, const RecordStep& step, const double* values, std::ptrdiff_t size,
                    const std::vector<int>& rows, Eigen::MatrixXd& symmetric) {
    const auto at = [&](int i, int j) { return values[i * size + j]; };
    const auto count = static_cast<Eigen::Index>(rows.size());
    symmetric.resize(count, count);
    for (Eigen::Index a = 0; a < count; ++a) {
        for (Eigen::Index b = 0; b <= a; ++b) {
            const int i = rows[static_cast<std::size_t>(b)], j = rows[static_cast<std::size_t>(a)];
            const double above = at(i, j), below = at(j, i);
            if (!std::isfinite(above) || !std::isfinite(below))
                throw refused(dataset, step,
                              "holds " + to_text(std::isfinite(above) ? below : above) + " at [" + std::to_string(i) +
                                  ", " + std::to_string(j) + "], where the errors or innovations are numbers",
                              "Write the covariance that belongs to them, or NaN for both");
            const double difference = std::abs(above - below);
            // First the cheap bound; the other one forgives the rounding of entries that should be 0.
            if (difference > largest_asymmetry * std::max(std::abs(above), std::abs(below)) &&
                !(difference <= largest_asymmetry * std::sqrt(std::abs(at(i, i))) * std::sqrt(std::abs(at(j, j)))))
                refuse_asymmetry(dataset, step, i, j, above, below);
            symmetric(a, b) = symmetric(b, a) = above / 2 + below / 2;
        }
    }
}

std::vector<int> counted_up(int count) {
    std::vector<int> all(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) all[static_cast<std::size_t>(i)] = i;
    return all;
}

}  // namespace

bool check_step(const RecordStep& step, const RecordShape& shape, CheckedStep& checked) {
    const double* e = step.error;
    if (!any_number("/error", step, e, shape.n)) return false;
    if (std::any_of(e, e + shape.n, [](double value) { return std::isnan(value); }))
        throw refused("/error", step, "holds NaN in some components and numbers in others",
                      "A step exists with all its components: write NaN for all of them, or judge a smaller state");
    checked.e = Eigen::Map<const Eigen::VectorXd>(e, shape.n);
    read_symmetric("/covariance", step, step.covariance, shape.n, counted_up(shape.n),
                   checked.P);
    checked.rows.clear();
    if (!shape.has_innovations()) return true;
    any_number("/innovation", step, step.innovation, shape.m);
    for (int row = 0; row < shape.m; ++row)
        if (!std::isnan(step.innovation[row])) checked.rows.push_back(row);
    checked.nu.resize(static_cast<Eigen::Index>(checked.rows.size()));
    for (std::size_t i = 0; i < checked.rows.size(); ++i)
        checked.nu(static_cast<Eigen::Index>(i)) = step.innovation[checked.rows[i]];
    read_symmetric("/innovation_covariance", step, step.innovation_covariance, shape.m,
                   checked.rows, checked.S);
    return true;
}

}  // namespace credence
