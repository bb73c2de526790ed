#pragma once
// The hash in a results file covers scenarios and root seed: a mutator that changes them writes it anew.

#include "hdf5_structure.hpp"

namespace credence::fuzz {

/// Writes the study's hash anew, where the texts of scenarios that the image holds can still be read; they are taken in
/// their order in the file. Else leaves it.
void repair_study_hash(Image image);

}  // namespace credence::fuzz
