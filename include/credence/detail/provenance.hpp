#pragma once
// Module study: which release computed which blocks of a study.

#include <credence/detail/block_ranges.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace credence {

struct Study;

/// The blocks that one release computed.
struct ComputedBy {
    std::string release;              ///< such as `credence 0.1.0, git revision 1a2b3c4`
    std::vector<BlockRanges> blocks;  ///< by scenario; those of later scenarios may be left out

    const BlockRanges& of(std::size_t scenario) const;
};
using Provenance = std::vector<ComputedBy>;

/// The name for the release of blocks for which it is not known.
inline const std::string unknown_release = "an unknown release";

/// `credence VERSION, git revision REVISION`
std::string release_name(const std::string& version, const std::string& revision);

/// Notes that `release` computed these blocks of a scenario, replacing earlier notes.
void note_computed(Provenance& provenance, const std::string& release, std::size_t scenario, const BlockRanges& blocks);

/// Copies the notes of these blocks of a scenario from `source`.
void note_computed(Provenance& provenance, const Provenance& source, std::size_t scenario, const BlockRanges& blocks);

/// Whether results of two releases, both of the same schema version, may be in one file: they agree in the first two
/// numbers of their version, or that of one is not known.
bool may_mix(const std::string& release, const std::string& other);

/// The first release in the list that may not be mixed with this one; empty where there is none.
std::string unmixable(const Provenance& provenance, const std::string& release);

/// Why trials that `other` computed may not be mixed with those of `release`, for a message about their file.
std::string why_unmixable(const std::string& other, const std::string& release);

/// Of the blocks that the study has: the release, where one computed them all; else a line for each release with its
/// blocks by scenario, such as `credence 0.1.0, git revision 1a2b3c4: a 0-5 7; b 0-2`. Empty where nothing was noted.
std::string provenance_text(const Study& study);

/// Reads that text of a study that has its blocks. Throws std::invalid_argument where it is invalid.
Provenance read_provenance(const std::string& text, const Study& study);

}  // namespace credence
