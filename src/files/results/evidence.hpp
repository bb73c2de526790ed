#pragma once
// The parts of an arm's group beside columns and totals: the distribution of NEES, whiteness, and the errors of the
// detailed trials [docs/results-format.md, Coverage, Distribution, Whiteness, Errors].

#include <credence/detail/results.hpp>

#include "files/hdf5/read.hpp"
#include "files/hdf5/write.hpp"

#include <string>
#include <vector>

namespace credence {

struct EvidenceDimensions {
    const hdf5::Dimension& step;
    const hdf5::Dimension& part;
    const hdf5::Dimension& level;
};

/// Names of these datasets, coordinates included.
std::vector<std::string> evidence_links(const ScenarioResults& results);

void write_evidence(const hdf5::Handle& group, const EvidenceDimensions& dimensions, const ScenarioResults& results,
                    const ArmResults& arm);

/// Reads what `write_evidence` wrote; results.trials and arm.totals.trials.counted() are known. Throws Error where it
/// is damaged.
void read_evidence(const hdf5::Handle& group, const ScenarioResults& results, hsize_t parts, ArmResults& arm);

}  // namespace credence
