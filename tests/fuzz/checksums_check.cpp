// fuzz_checksums FILE...: repairs copies of whole HDF5 files in memory and says which ones changed by it: none should.
// Then it breaks every checksum and repairs again, which must give the file as it was.

#include "hdf5_checksums.hpp"

#include <cstdio>
#include <fstream>
#include <iterator>

using namespace credence::fuzz;

int main(int count, char** paths) {
    int trouble = 0;
    for (int i = 1; i < count; ++i) {
        std::ifstream stream(paths[i], std::ios::binary);
        const std::vector<std::uint8_t> whole{std::istreambuf_iterator<char>(stream), {}};
        std::vector<std::uint8_t> repaired = whole;
        const Structure structure = structure_of(repaired);
        repair_checksums(repaired, structure);
        const bool kept = repaired == whole;
        for (const Summed& part : structure.summed) repaired[part.sum_at] ^= 0x55;
        repair_checksums(repaired);
        const bool restored = repaired == whole;
        if (!kept || !restored) ++trouble;
        std::printf("%s: %zu checksums, %zu regions, %s\n", paths[i], structure.summed.size(), structure.regions.size(),
                    kept && restored ? "all right" : "CHANGED");
    }
    return trouble == 0 ? 0 : 1;
}
