#pragma once
// A baseline's sources of standard-normal draws: both kinds have the interface that the trial uses.

#include <Eigen/Core>
#include <credence/detail/draws.hpp>
#include <random>

namespace credence::bench {

/// A generator seeded for each trial, used in order.
class StandardNoise {
public:
    StandardNoise(std::uint64_t root_seed, std::int64_t trial)
        : generator_(root_seed * 0x9E3779B97F4A7C15u + static_cast<std::uint64_t>(trial)) {}

    double one(Source, int, int) { return normal_(generator_); }
    Eigen::Vector2d two(Source, int, int) {
        const double x = normal_(generator_);
        return {x, normal_(generator_)};
    }

private:
    std::mt19937_64 generator_;
    std::normal_distribution<double> normal_;
};

/// The draws of credence's own trial.
class KeyedNoise {
public:
    KeyedNoise(std::uint64_t root_seed, std::int64_t trial)
        : draws_(root_seed, static_cast<std::uint64_t>(trial), std::numeric_limits<double>::infinity()) {}

    double one(Source source, int pose, int index) { return draws_.normal(source, pose, index).x; }
    Eigen::Vector2d two(Source source, int pose, int index) {
        const Vector2<double> draw = draws_.normal(source, pose, index);
        return {draw.x, draw.y};
    }

private:
    KeyedDraws<double> draws_;
};

}  // namespace credence::bench
