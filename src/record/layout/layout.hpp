#pragma once
// Which datasets a record has, and what they say of its shape.

#include "record/manifold.hpp"
#include "record/source.hpp"
#include "record/step.hpp"

#include <optional>
#include <vector>

namespace credence {

/// The datasets of a record, each [trial, step, ...], or [step, ...] where it is a single trial.
struct RecordDatasets {
    DatasetPointer error;                         ///< [n]
    DatasetPointer truth, estimate;               ///< [q] in place of the error
    DatasetPointer covariance;                    ///< [n, n], or [n] variances
    DatasetPointer truth_covariance;              ///< [n, n]
    DatasetPointer innovation;                    ///< [m]
    DatasetPointer innovation_covariance;         ///< [m, m]
    std::vector<DatasetPointer> own;              ///< [groups] covariance [d, d], or NEES []
    std::optional<Manifold> manifold;             ///< of truth and estimate

    /// Those whose numbers say that a step exists: errors, or NEES where there are none.
    std::vector<const RecordDataset*> leading() const;
};

struct RecordLayout {
    RecordShape shape;      ///< `longest` is not known yet
    bool single = false;    ///< one trial, without a dimension for trials
    RecordDatasets data;
};

/// Opens the datasets of a record and checks that they fit together. Throws RecordError.
RecordLayout open_record(const RecordSource& source);

}  // namespace credence
