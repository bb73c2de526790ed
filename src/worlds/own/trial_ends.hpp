#pragma once
// How the engine leaves the function of a user's own world, and what that function throws.

#include <credence/detail/lane_pack.hpp>
#include <credence/error.hpp>

#include <new>
#include <stdexcept>
#include <string>

namespace credence {

/// Thrown through the user's function, never beyond the simulation that called it: no trial is left to go on with.
struct TrialEnds {};

/// What a world did wrong, said in full.
struct WorldMistake : std::logic_error {
    using std::logic_error::logic_error;
};

/// Calls the user's function on trials of a pack, from that of lane `first` on. False where it was left by TrialEnds.
/// Throws Failure that names world, arm and trials where the function throws anything else.
template <class Function>
bool call_world(const LanePack& pack, int first, int trials, const Function& function) {
    const auto failure = [&](const std::string& what) {
        const std::int64_t trial = pack.first_trial + first;
        return Failure("cannot run world " + *pack.world,
                       (trials == 1 ? "trial " : "one of trials ") + std::to_string(trial) +
                           (trials == 1 ? "" : " to " + std::to_string(trial + trials - 1)) + " of " + *pack.arm_name +
                           " threw " + what,
                       "Mend its function run");
    };
    try {
        function();
        return true;
    } catch (const TrialEnds&) {
        return false;
    } catch (const WorldMistake&) {
        throw;
    } catch (const Failure&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& thrown) {
        throw failure("`" + printable(thrown.what()) + "`");
    } catch (...) {
        throw failure("what is no std::exception");
    }
}

}  // namespace credence
