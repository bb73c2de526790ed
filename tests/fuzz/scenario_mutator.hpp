#pragma once
// A mutator of scenario texts for libFuzzer, which knows the keys.

#include <cstddef>
#include <cstdint>

namespace credence::fuzz {

inline constexpr char override_separator = '\x1e';  ///< between the text and overrides, such as `noise.walk=1`

/// Changes a text of `size` bytes with room for `room`: in any way, or by an override of a key, mostly with a value
/// that it could have. Returns the new size.
std::size_t mutate_scenario(std::uint8_t* text, std::size_t size, std::size_t room, unsigned seed);

}  // namespace credence::fuzz
