#include <credence/recorded_noise.hpp>

#include <credence/error.hpp>

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
        case Source::detection: break;
    }
    return {};
}

void check_covers(const NoiseRecord& record, const Scenario& scenario, const std::string& file) {
    const auto refuse = [&](const std::string& why, const std::string& remedy) {
        throw InputError("noise record " + file + " does not fit scenario " + scenario.name + " (" + why + "). " + remedy + ".");
    };
    const int features = static_cast<int>(scenario.features.positions.size());
    const int edges = static_cast<int>(edge_list(scenario).size());
    if (record.poses < scenario.poses)
        refuse("it has " + std::to_string(record.poses) + " poses, the scenario " + std::to_string(scenario.poses),
               "Lower scenario.poses or record more");
    if (record.features < features)
        refuse("it has " + std::to_string(record.features) + " features, the scenario " + std::to_string(features),
               "Give fewer features.positions or record more");
    if (scenario.truth.edge_noise == EdgeNoise::independent && record.edges != edges)
        refuse("truth.edge_noise=independent needs `edge` [poses, " + std::to_string(edges) + ", 2]", "Record it, in graph order");
    if (scenario.sensor.detection < 1)
        refuse("a record has no detection draws", "Set sensor.detection=1");
}

}  // namespace credence
