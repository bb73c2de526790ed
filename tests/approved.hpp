#pragma once
// Approved texts: what a program says, in files beside the tests. `CREDENCE_APPROVE=1 build/tests/credence_tests
// 'approved: *'` renews them.

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "catch.hpp"
#include "store_study.hpp"

namespace credence::test {

/// Fails with the difference unless the text is that of the file `name` in `tests`.
inline void check_approved(const std::string& name, const std::string& text) {
    const std::filesystem::path path = std::filesystem::path(CREDENCE_SOURCE "/tests") / name;
    if (std::getenv("CREDENCE_APPROVE") != nullptr) {
        std::filesystem::create_directories(path.parent_path());
        return put_bytes(path, text);
    }
    const TemporaryFolder folder;
    put_bytes(folder / "now", text);
    FILE* const diff = popen(("diff -u '" + path.string() + "' '" + folder / "now" + "' 2>&1").c_str(), "r");
    REQUIRE(diff != nullptr);
    std::string difference;
    std::array<char, 4096> part;
    while (const std::size_t size = std::fread(part.data(), 1, part.size(), diff)) difference.append(part.data(), size);
    INFO(difference);
    CHECK(pclose(diff) == 0);
}

}  // namespace credence::test
