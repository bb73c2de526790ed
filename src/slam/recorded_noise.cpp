#include <credence/detail/recorded_noise.hpp>

namespace credence {

Vector2<double> RecordedDraws::normal(Source source, int pose, int index) const {
    const NoiseRecord& record = *record_;
    const auto pair = [](const std::vector<double>& values, int row, int width, int column) -> Vector2<double> {
        const std::size_t at = 2 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                                    static_cast<std::size_t>(column));
        return {values[at], values[at + 1]};
    };
    const std::size_t odometry = 3 * static_cast<std::size_t>(pose);
    switch (source) {
        case Source::odometry_heading: return {record.odometry[odometry], 0};
        case Source::odometry_position: return {record.odometry[odometry + 1], record.odometry[odometry + 2]};
        case Source::walk: return pair(record.walk, pose, record.features, index);
        case Source::deformation: return pair(record.deformation, pose, record.features, index);
        case Source::measurement: return pair(record.measurement, pose, record.features, index);
        case Source::edge: return pair(record.edge, pose, record.edges, index);
        case Source::detection:
        case Source::landmark_prior:
        case Source::control:
        case Source::placement:
        case Source::odometry_bias:
        case Source::outlier: break;  // a noise record does not have these
    }
    return {};
}

}  // namespace credence
