// The part of a target of the engine that runs packs of trials of users' own worlds; what is said in
// src/worlds/deformable/target.cpp holds here. The world's function is in an object of the user's program.

#include "engine/simulate_batch.hpp"
#include "worlds/own/lanes/trials.hpp"
#include "worlds/simulate.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

namespace {

using Real = Pack<CREDENCE_LANES>;

std::size_t error_cells(const OwnView& view) {
    return static_cast<std::size_t>(view.state_size) * static_cast<std::size_t>(view.poses - 1);
}

std::size_t moment_cells(const OwnView& view) { return static_cast<std::size_t>(moment_count(view.state_size, 0)); }

/// What of a pack's trials is kept of detailed ones.
void keep_detail(const OwnView& view, const PackOfTrials<Real>& pack, const Real* errors, int trial,
                 const Batch& batch) {
    const int padded = (batch.trials + octet - 1) / octet * octet, cells = static_cast<int>(error_cells(view));
    for (int cell = 0; cell < cells; ++cell) store(errors[cell], batch.errors + cell * padded + trial);
    keep_products(view.poses, pack.products.sum, pack.products.count, pack.counts(), trial, batch);
}

}  // namespace

std::size_t own_workspace_size(const OwnView& view) {
    const Unfolded<Real> unfolded(nullptr, view);
    const auto columns = static_cast<std::size_t>(view.column_count);
    return (PackOfTrials<Real>::room(view) + columns + error_cells(view) + moment_cells(view) +
            static_cast<std::size_t>(unfolded.cells * unfolded.capacity)) * sizeof(Real);
}

void simulate_own(const OwnView& view, const Batch& batch) {
    Real* room = static_cast<Real*>(batch.workspace);
    Real* columns = room + PackOfTrials<Real>::room(view);
    Real* errors = columns + view.column_count;
    Real* moments = batch.moments != nullptr && moment_cells(view) > 0 ? errors + error_cells(view) : nullptr;
    Unfolded<Real> unfolded(errors + error_cells(view) + moment_cells(view), view);
    for (int i = 0; i < batch.trials; i += lanes<Real>) {
        const KeyedDraws<Real> draws(batch.root_seed, trials_from<Real>(batch.first_trial + i), __builtin_inf());
        PackOfTrials<Real> pack(view, draws, first_lanes<Real>(batch.trials - i), room, unfolded.next(),
                                batch.errors != nullptr ? errors : nullptr, moments);
        pack.first_trial = batch.first_trial + i;
        view.run(view, pack);
        pack.note_columns();
        pack.note_lost();
        pack.columns(columns);
        double* to = batch.columns + i / octet * view.column_count * octet + i % octet;
        for (int c = 0; c < view.column_count; ++c) store(columns[c], to + c * octet);
        const int padded = (batch.trials + octet - 1) / octet * octet;
        for (int k = 0; k < view.poses - 1; ++k) store(unfolded.next()[k], batch.nees + k * padded + i);
        if (batch.errors != nullptr) keep_detail(view, pack, errors, i, batch);
        if (moments != nullptr) keep_moments(view, moments, unfolded.next(), i, batch);
        unfolded.keep(pack.counts());
        if (unfolded.full() || i + lanes<Real> >= batch.trials) fold(unfolded, view, batch);
    }
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
