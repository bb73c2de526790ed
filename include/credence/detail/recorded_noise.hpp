#pragma once
// Module slam: recorded noise with the same interface as the keyed draws. Reading it from HDF5: store.hpp.

#include <credence/detail/draws.hpp>

#include <vector>

namespace credence {

/// Standardised noise of one trial, as read from a noise record: multiply by sigma. Row k belongs to pose k, feature j;
/// `odometry` holds [heading, x, y] used on arrival at pose k (row 0: the initial pose); `walk` row k is used on
/// leaving pose k; `edge` follows the graph order. All arrays are row-major.
struct NoiseRecord {
    int poses = 0, features = 0, edges = 0;
    std::vector<double> odometry;     ///< [poses, 3]
    std::vector<double> walk;         ///< [poses, features, 2]
    std::vector<double> deformation;  ///< [poses, features, 2]
    std::vector<double> measurement;  ///< [poses, features, 2]
    std::vector<double> edge;         ///< [poses, edges, 2], empty where the record has none
};

/// A recorded trial as a noise source. The record must outlive it and must cover the scenario.
class RecordedDraws {
public:
    explicit RecordedDraws(const NoiseRecord& record) : record_(&record) {}

    Vector2<double> normal(Source source, int pose, int index) const;
    /// A noise record holds no detection draws: a study with detection below 1 cannot be replayed from one.
    double uniform(Source, int, int) const { return 0; }

private:
    const NoiseRecord* record_;
};

}  // namespace credence
