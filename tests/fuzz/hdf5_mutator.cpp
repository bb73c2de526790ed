#include "hdf5_mutator.hpp"

#include "hdf5_checksums.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <random>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t room);

namespace credence::fuzz {

namespace {

using Random = std::minstd_rand;

std::size_t below(Random& random, std::size_t count) { return random() % count; }

std::uint64_t interesting_number(Random& random) {
    constexpr std::uint64_t numbers[] = {0, 1, 2, 3, 4, 8, 16, 64, 0x7f, 0x80, 0xff, 0x7fff, 0xffff, 0x7fffffff,
                                         0xffffffff, std::uint64_t{1} << 40, std::uint64_t{1} << 62, ~std::uint64_t{0}};
    return numbers[below(random, std::size(numbers))];
}

double interesting_real(Random& random) {
    using Limits = std::numeric_limits<double>;
    constexpr double numbers[] = {0, -0.0, 1, -1, 0.5, 1e-300, 1e300, 1e140, 1e16, -1e16, 1e-9, Limits::quiet_NaN(),
                                  Limits::infinity(), -Limits::infinity(), Limits::max(), Limits::denorm_min()};
    return numbers[below(random, std::size(numbers))];
}

/// Overwrites a number of 1, 2, 4 or 8 bytes somewhere in a part, on its own alignment where it is raw data.
void set_number(Image part, bool aligned, Random& random) {
    const std::size_t width = std::min(std::size_t{1} << below(random, 4), std::bit_floor(part.size()));
    const std::size_t places = aligned ? part.size() / width : part.size() - width + 1;
    const std::size_t at = below(random, places) * (aligned ? width : 1);
    std::uint64_t number = interesting_number(random);
    if (below(random, 2) == 0) number = number_at(part, at, width) + below(random, 5) - 2;
    if (aligned && width == 8 && below(random, 2) == 0) number = std::bit_cast<std::uint64_t>(interesting_real(random));
    if (aligned && width == 4 && below(random, 2) == 0)
        number = std::bit_cast<std::uint32_t>(static_cast<float>(std::clamp(interesting_real(random), -3e38, 3e38)));
    for (std::size_t i = 0; i < width; ++i) part[at + i] = static_cast<std::uint8_t>(number >> (8 * i));
}

/// Any change that keeps the size.
void change_bytes(Image part) { LLVMFuzzerMutate(part.data(), part.size(), part.size()); }

/// Puts the body of another message in the place of one, as far as it fits.
void copy_message(Image image, const Region& to, const std::vector<Region>& regions, Random& random) {
    const Region& from = regions[below(random, regions.size())];
    const Image source = image.subspan(from.first, std::min(from.length, to.length));
    const std::vector<std::uint8_t> bytes(source.begin(), source.end());
    std::copy(bytes.begin(), bytes.end(), image.begin() + static_cast<std::ptrdiff_t>(to.first));
}

/// Our readers use the raw data, but there is less of it than of HDF5's own structures: a third of all changes.
const Region& choose(const std::vector<Region>& regions, Random& random) {
    for (int tries = 0; tries < 8; ++tries) {
        const Region& region = regions[below(random, regions.size())];
        if (tries > 0 ? region.kind == Region::Kind::data : below(random, 3) > 0) return region;
    }
    return regions[below(random, regions.size())];
}

void change_region(Image image, const std::vector<Region>& regions, Random& random) {
    const Region& region = choose(regions, random);
    const Image part = image.subspan(region.first, region.length);
    const bool is_data = region.kind == Region::Kind::data;
    switch (below(random, 8)) {
        case 0: return is_data ? change_bytes(part) : copy_message(image, region, regions, random);
        case 1:
        case 2: return change_bytes(part);
        default: return set_number(part, is_data, random);
    }
}

}  // namespace

std::size_t mutate_hdf5(std::uint8_t* image, std::size_t size, std::size_t room, unsigned seed,
                        const std::function<void(Image)>& repair) {
    Random random(seed);
    const std::vector<Region> regions = structure_of({image, size}).regions;
    if (regions.empty() || below(random, 8) == 0)
        size = LLVMFuzzerMutate(image, size, room);
    else if (below(random, 8) == 0)
        change_bytes({image, size});
    else
        for (std::size_t changes = std::size_t{1} << below(random, 3); changes > 0; --changes)
            change_region({image, size}, regions, random);
    if (repair) repair({image, size});
    repair_checksums({image, size});
    return size;
}

}  // namespace credence::fuzz
