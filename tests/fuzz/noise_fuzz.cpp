// Files as noise records: each is refused by an InputError of one line, or all that it says is there.

#include "hdf5_target.hpp"

#include <credence/detail/store.hpp>

#include <cmath>

using namespace credence;
using namespace credence::fuzz;

namespace {

void require_values(const std::vector<double>& values, int poses, int width, int components) {
    const auto size = [](int count) { return static_cast<std::size_t>(count); };
    require(values.size() == size(poses) * size(width) * size(components), "an array has its size");
    for (const double value : values) require(std::isfinite(value), "noise is finite");
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t room, unsigned seed) {
    return mutate_hdf5(data, size, room, seed);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return try_file(data, size, [](const std::string& path) {
        const NoiseRecord record = read_noise_record(path);
        require_values(record.odometry, record.poses, 1, 3);
        for (const auto* values : {&record.walk, &record.deformation, &record.measurement})
            require_values(*values, record.poses, record.features, 2);
        require_values(record.edge, record.poses, record.edges, 2);
    });
}
