#pragma once
// Module scenario: sweeps: a grid of values of a scenario's keys, and a scenario's place in one. This file treats keys
// and values as texts; the scenario's world defines which are valid.

#include <cstddef>
#include <string>
#include <vector>

namespace credence {

/// A study has no more scenarios than this where a sweep makes them.
inline constexpr std::size_t most_swept_scenarios = 1000;

/// The value of one swept key at a point of a grid.
struct SweepCoordinate {
    std::string key, value;
    friend bool operator==(const SweepCoordinate&, const SweepCoordinate&) = default;
};

/// A scenario's place in a sweep: the name of the scenario that was swept, and the value of every swept key, the
/// slowest first. Both are empty for a scenario that is not part of a sweep.
struct SweepPoint {
    std::string of;
    std::vector<SweepCoordinate> at;
    friend bool operator==(const SweepPoint&, const SweepPoint&) = default;
};

/// `noise.heading=0.01, planner.turns=0, 0.3`: a value may contain commas, because a part without an equals sign
/// belongs to the value before it.
std::string coordinates_text(const std::vector<SweepCoordinate>& at);
/// Parses that text, every number in a value formatted as by `to_text`. Throws InputError where the text does not begin
/// with `key=`, a value is empty, or a key is repeated or cannot be swept.
std::vector<SweepCoordinate> parse_coordinates(const std::string& text);

/// A swept key and its values, in their order.
struct SweepAxis {
    std::string key;
    std::vector<std::string> values;
};

/// `key=ITEM,ITEM…`, or `key=ITEM|ITEM…` where values contain commas themselves. An item is a value or a range of
/// numbers, `first:last:count` or, with equal ratios, `first:last:count:log`. The ends of a range are as given; the
/// numbers between are rounded to six digits (of the step, or of the number), so that they can be read and typed again.
/// Numbers in values are formatted as by `to_text`. Throws InputError naming --sweep, also where the key cannot be
/// swept: those that name a scenario, or give values for display only.
SweepAxis parse_axis(const std::string& text);

/// The axes of a grid. Throws InputError beyond most_swept_scenarios, where a key is swept twice or a value given
/// twice.
std::vector<SweepAxis> parse_grid(const std::vector<std::string>& texts);

/// The number of points; 1 without axes.
std::size_t point_count(const std::vector<SweepAxis>& axes);

/// All points, the first axis slowest.
std::vector<std::vector<SweepCoordinate>> grid_points(const std::vector<SweepAxis>& axes);

/// A name for a point that names of scenarios allow, such as circle_heading-0p01_sigma-0p05. `p` stands for the dot of
/// a number, and `m` for the sign before it. Values that would be long, or the same, are numbered: `positions-v0`.
std::string point_name(const std::string& of, const std::vector<SweepAxis>& axes,
                       const std::vector<SweepCoordinate>& point);

}  // namespace credence
