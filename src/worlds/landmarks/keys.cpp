#include "worlds/landmarks/keys.hpp"

#include "worlds/values.hpp"

#include <cmath>
#include <numbers>

namespace credence {

namespace {

/// Estimators that work without a heading are none for this world.
std::vector<std::string> estimators_with_heading() {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < estimator_names().size(); ++i)
        if (process_of(static_cast<Estimator>(i)) == Process::heading) names.push_back(estimator_names()[i]);
    return names;
}

std::vector<LandmarkKey> all_keys() {
    std::vector<LandmarkKey> keys;
    add_common_keys(keys);
    const auto real = [&](const char* name, const char* help, const ValueRange& range, auto field) {
        keys.push_back(real_key<LandmarkSettings>(name, help, range, field));
    };
    const auto integer = [&](const char* name, const char* help, int low, int high, auto field) {
        keys.push_back(integer_key<LandmarkSettings>(name, help, low, high, field));
    };
    integer("loop.sides", "sides of the regular polygon that the robot walks", 3, largest_pose_count,
            [](auto& s) -> auto& { return s.loop.sides; });
    real("loop.step", "d, length of a side and of a step (length)", above(0),
         [](auto& s) -> auto& { return s.loop.step; });
    integer("landmarks.count", "M, at equal angles about the loop's centre", 1, largest_feature_count,
            [](auto& s) -> auto& { return s.landmarks.count; });
    real("landmarks.offset", "how much farther from the centre than the loop's corners, then nearer, in turn (length)",
         from(0), [](auto& s) -> auto& { return s.landmarks.offset; });
    real("landmarks.prior", "sigma of what is believed of a landmark before it is seen (length)", above(0),
         [](auto& s) -> auto& { return s.landmarks.prior; });
    real("sensor.range_max", "farthest range seen, included (length); inf for no limit", above_or_infinite(0),
         [](auto& s) -> auto& { return s.sensor.range_max; });
    real("sensor.sigma", "noise of each axis of a relative position (length)", above(0),
         [](auto& s) -> auto& { return s.sensor.sigma; });
    keys.push_back(real_key<LandmarkSettings>("noise.heading",
                                              "sigma_head of the turn that the filter is given, a step", above(0),
                                              [](auto& s) -> auto& { return s.noise.heading; }, "rad"));
    real("noise.odometry", "sigma_odom of the move that the filter is given, a step and axis (length)", above(0),
         [](auto& s) -> auto& { return s.noise.odometry; });
    keys.push_back({"arms.estimators", "any of " + joined(estimators_with_heading()),
                    [](LandmarkSettings& s, const std::string& v) {
                        s.estimators = parse_estimators(v).value_or(LandmarkSettings().estimators);
                    },
                    [](const LandmarkSettings& s) { return names_text(s.estimators, estimator_names()); },
                    estimators_with_heading()});
    add_budget_keys(keys, landmark_sources());
    return keys;
}

void check_variance(const char* key, double sigma) {
    if (!has_variance(sigma))
        throw invalid_value(key, to_text(sigma), "its square is 0 and P or S singular",
                            "Give a standard deviation " + above_least);
}

}  // namespace

std::vector<DrawSource> landmark_sources() { return {slam_sources().begin(), slam_sources().begin() + 4}; }

const std::vector<LandmarkKey>& landmark_keys() {
    static const std::vector<LandmarkKey> keys = all_keys();
    return keys;
}

void validate(const LandmarkSettings& s) {
    const double radius = s.loop.step / 2 / std::sin(std::numbers::pi / s.loop.sides);
    if (!(s.landmarks.offset < radius))
        throw invalid_value("landmarks.offset", to_text(s.landmarks.offset),
                            "must be below the loop's radius, " + to_text(radius), "Give less, or a larger loop");
    check_variance("landmarks.prior", s.landmarks.prior);
    check_variance("sensor.sigma", s.sensor.sigma);
    check_variance("noise.heading", s.noise.heading);
    check_variance("noise.odometry", s.noise.odometry);
    for (const Estimator estimator : s.estimators)
        if (process_of(estimator) != Process::heading)
            throw invalid_value("arms.estimators", names_text(s.estimators, estimator_names()),
                                estimator_names()[static_cast<std::size_t>(estimator)] + " has no heading",
                                "Give some of " + joined(estimators_with_heading()));
}

}  // namespace credence
