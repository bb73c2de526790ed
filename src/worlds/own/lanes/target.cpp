// The part of a target of the engine that runs packs of trials of users' own worlds; what is said in
// src/worlds/deformable/target.cpp holds here. The world's function is in an object of the user's program.

#include "engine/simulate_batch.hpp"
#include "worlds/own/lanes/trials.hpp"
#include "worlds/simulate.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

namespace {

/// A trial of a user's own world.
struct OwnLaneTrial {
    using View = OwnView;
    using Real = Pack<CREDENCE_LANES>;

    static constexpr double truncate(const View&) { return __builtin_inf(); }
    static int column_count(const View& view) { return view.column_count; }
    static int whitened_rows(const View& view) { return view.largest_innovation; }
    static std::size_t room(const View& view) { return PackOfTrials<Real>::room(view) * sizeof(Real); }
    void run(const View& view, const KeyedDraws<Real>& draws, const PackPlace<Real>& place, void* room,
             PackDetails<Real>& details, Real* columns, Real* all_series) const {
        PackOfTrials<Real> pack(view, draws, place, static_cast<Real*>(room), details, all_series);
        view.run(view, pack);
        pack.write_columns(columns);
    }
};

}  // namespace

std::size_t own_workspace_size(const OwnView& view) { return BatchOf<OwnLaneTrial>::workspace_size(view); }

void simulate_own(const OwnView& view, const Batch& batch) { BatchOf<OwnLaneTrial>::simulate(view, {}, batch); }

}  // namespace CREDENCE_TARGET
}  // namespace credence
