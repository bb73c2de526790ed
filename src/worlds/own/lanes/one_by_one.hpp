#pragma once
// A pack of trials of a user's own world whose function takes one trial at a time: it runs for each lane in turn, and
// its draws and the evaluation of its steps are those of the pack. That takes a quarter of the time of evaluating each
// trial by itself.

#include <credence/detail/lane_pack.hpp>
#include <credence/detail/own_simulation.hpp>

#include <functional>

namespace credence {

/// What run_one_by_one takes as settings.
struct OneByOne {
    std::function<void(OwnTrial&)> run;
    int lanes = 1;  ///< of the target
};

/// A RunPack.
void run_one_by_one(const void* one_by_one, LanePack& pack);

}  // namespace credence
