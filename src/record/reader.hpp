#pragma once
// The datasets of a record for `judge`: their extents checked against each other, and read part by part.

#include "record/known.hpp"
#include "record/layout/layout.hpp"
#include "record/step.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace credence {

/// A part of the record that is read at once: whole trials, or some steps of one.
struct RecordPart {
    std::int64_t first_trial = 0, trials = 0;
    int first_step = 0, steps = 0;
};

/// Values of a part, row-major; empty where the record has none.
struct RecordValues {
    std::vector<double> error;                  ///< [trials, steps, n]
    std::vector<double> covariance;             ///< [trials, steps, n, n], or [trials, steps, n] of variances
    std::vector<double> innovation;             ///< [trials, steps, m]
    std::vector<double> innovation_covariance;  ///< [trials, steps, m, m]
    std::vector<std::vector<double>> own;       ///< [groups] [trials, steps, d, d] covariances, or [trials, steps] NEES
    std::vector<double> truth, estimate;        ///< [trials, steps, q]
    std::vector<double> truth_covariance;       ///< [trials, steps, n, n]
};

/// The values of a part's step, one step after the other.
void for_each_step(const RecordPart& part, const RecordValues& values,
                   const std::function<void(const RecordStep&)>& use);

/// Shape and values are those without components that are known exactly. All functions throw RecordError.
class RecordReader {
public:
    /// `part_numbers`: how many numbers are read at once, 64 MiB of doubles by default.
    explicit RecordReader(const RecordSource& source, std::int64_t part_numbers = (std::int64_t{64} << 20) / 8);

    const RecordShape& shape() const { return layout_.shape; }
    /// Lets only these steps count.
    void compare(std::function<bool(std::int64_t trial, int step)> steps) { layout_.shape.compared = std::move(steps); }
    /// Of truth and estimate, where they lie on a manifold.
    std::optional<Manifold>& manifold() { return layout_.data.manifold; }

    /// What is done with the covariance of the truth's errors.
    void use_truth(TruthUse use) { layout_.shape.truth = use; }
    /// What is subtracted from the errors [steps, n], and a factor on what is left [steps, n].
    void centre(std::vector<double> means, std::vector<double> factors);

    /// The part that starts at a trial and step, as large as allowed, but at least one step.
    RecordPart part_at(std::int64_t trial, int step) const;
    /// Calls `visit` for every part, until it returns false.
    void each_part(const std::function<bool(const RecordPart&)>& visit) const;
    void read(const RecordPart& part, RecordValues& values) const;

private:
    void read(const RecordDataset& dataset, const RecordPart& part, std::vector<double>& values) const;
    void read_manifold(const RecordPart& part, RecordValues& values) const;
    void require_quaternions(const RecordDataset& dataset, std::int64_t trial, int step,
                             const double* coordinates) const;
    void add_size(const DatasetPointer& dataset);
    int longest_trial() const;
    std::vector<char> known_components() const;
    void read_errors(const RecordPart& part, RecordValues& values) const;
    void read_covariances(const RecordPart& part, RecordValues& values) const;
    int last_step(const RecordDataset& dataset, const RecordPart& part, std::vector<double>& values) const;

    RecordLayout layout_;
    std::int64_t part_numbers_;
    std::int64_t step_numbers_ = 0;  ///< numbers of one step of a trial
    std::optional<RemainingState> remaining_;  ///< where components are known exactly
    std::vector<double> means_, factors_;      ///< [steps, n] of the errors that are left; empty: as they are
};

}  // namespace credence
