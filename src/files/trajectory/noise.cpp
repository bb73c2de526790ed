#include <credence/detail/store.hpp>

#include <credence/text.hpp>

#include <credence/detail/deformable_settings.hpp>

#include "files/hdf5/read.hpp"

#include <cmath>

namespace credence {

namespace {

using hdf5::Dataset;
using hdf5::Error;
using hdf5::Extents;
using hdf5::Handle;

constexpr int largest_edge_count = largest_feature_count * (largest_feature_count - 1) / 2;

/// Position of a value in an array, such as [3, 1, 0].
std::string position_text(std::size_t index, Extents extents) {
    for (std::size_t axis = extents.size(); axis-- > 0;) {
        const hsize_t extent = extents[axis];
        extents[axis] = index % extent;
        index /= extent;
    }
    return extents_text(extents);
}

/// A dataset of finite numbers, [poses, components] or [poses, width, components].
class Array {
public:
    Array(const Handle& root, const std::string& name) : dataset_(root, name) {}

    /// The extent along an axis, which must be 1 to `largest`.
    int count(std::size_t axis, std::size_t rank, int largest) const {
        const Extents& extents = dataset_.extents();
        if (extents.size() != rank)
            throw Error(dataset_.place(),
                        "has extents " + extents_text(extents) + ", not " + std::to_string(rank) + " of them");
        if (extents[axis] < 1 || extents[axis] > static_cast<hsize_t>(largest))
            throw Error(dataset_.place(), "has extents " + extents_text(extents) + ", of which number " +
                                              std::to_string(axis) + " must be 1 to " + std::to_string(largest));
        return static_cast<int>(extents[axis]);
    }

    /// Width 0: the array has no such axis.
    std::vector<double> read(int poses, int width, int components) const {
        Extents extents{static_cast<hsize_t>(poses), static_cast<hsize_t>(components)};
        if (width > 0) extents.insert(extents.begin() + 1, static_cast<hsize_t>(width));
        dataset_.require_extents(extents);
        const std::vector<double> values = dataset_.read_real();
        for (std::size_t i = 0; i < values.size(); ++i)
            if (!std::isfinite(values[i]))
                throw Error(dataset_.place(), "holds " + to_text(values[i]) + " at " + position_text(i, extents));
        return values;
    }

private:
    Dataset dataset_;
};

NoiseRecord read_record(const Handle& root) {
    NoiseRecord record;
    const Array odometry(root, "odometry"), walk(root, "walk");
    record.poses = odometry.count(0, 2, largest_pose_count);
    record.features = walk.count(1, 3, largest_feature_count);
    record.odometry = odometry.read(record.poses, 0, 3);
    record.walk = walk.read(record.poses, record.features, 2);
    record.deformation = Array(root, "deformation").read(record.poses, record.features, 2);
    record.measurement = Array(root, "measurement").read(record.poses, record.features, 2);
    if (hdf5::has_link(root, "edge")) {
        const Array edge(root, "edge");
        record.edges = edge.count(1, 3, largest_edge_count);
        record.edge = edge.read(record.poses, record.edges, 2);
    }
    return record;
}

}  // namespace

NoiseRecord read_noise_record(const std::string& path) {
    return hdf5::read_file(path,
                           "A noise record holds `odometry` [K, 3], `walk`, `deformation` and `measurement` [K, M, 2], "
                           "and may hold `edge` [K, E, 2]",
                           read_record);
}

}  // namespace credence
