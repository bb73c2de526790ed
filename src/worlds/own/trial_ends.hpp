#pragma once
// How the engine leaves the function of a user's own world once no trial of it is left to go on with.

namespace credence {

/// Thrown through the user's function, never beyond the simulation that called it.
struct TrialEnds {};

}  // namespace credence
