#pragma once
// Facts of the build, for --version and for /run of every file.

#include <credence/detail/store.hpp>

#include <string>

namespace credence {

std::string version_text();

/// `credence VERSION, git revision REVISION`
std::string made_by();

/// Version, git revision, compiler, flags, processor, instruction set, lane width.
RunFacts build_facts();

}  // namespace credence
