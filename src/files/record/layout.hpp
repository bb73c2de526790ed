#pragma once
// Which datasets a record has, and what they say of its shape.

#include "files/hdf5/slab.hpp"
#include "files/record/manifold.hpp"
#include "worlds/own/step.hpp"

#include <optional>
#include <vector>

namespace credence {

/// The datasets of a record, each [trial, step, ...], or [step, ...] where it is a single trial.
struct RecordDatasets {
    std::optional<hdf5::RealDataset> error;                  ///< [n]
    std::optional<hdf5::RealDataset> truth, estimate;        ///< [q] in place of the error
    std::optional<hdf5::RealDataset> covariance;             ///< [n, n], or [n] variances
    std::optional<hdf5::RealDataset> innovation;             ///< [m]
    std::optional<hdf5::RealDataset> innovation_covariance;  ///< [m, m]
    std::vector<std::optional<hdf5::RealDataset>> own;       ///< [groups] covariance [d, d], or NEES []
    std::optional<Manifold> manifold;                        ///< of truth and estimate
};

struct RecordLayout {
    RecordShape shape;      ///< `longest` is not known yet
    bool single = false;    ///< one trial, without a dimension for trials
    RecordDatasets data;
};

/// Opens the datasets of a record of either version and checks that they fit together. Throws hdf5::Error.
RecordLayout open_record(const hdf5::Handle& root);

}  // namespace credence
