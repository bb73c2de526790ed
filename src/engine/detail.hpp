#pragma once
// The observer of a built-in world's trials that fills PackDetails.
//
//   nu~ = L^-1 nu, S = L L', rows features (body frame) then edges in graph order

#include "engine/pack_details.hpp"
#include "slam/trial/step_evaluation.hpp"

namespace credence {

/// Pairs of rows that are whitened: with more edges, the features' rows alone.
inline constexpr int largest_whitened = 256;

/// Whether the edges' rows are among the whitened ones.
inline bool edges_whitened(int features, int edges) { return features + edges <= largest_whitened; }

inline namespace CREDENCE_TARGET {

inline int whitened_pairs(const CommonView& problem) {
    const int edges = problem.filter.edge_count;
    return problem.features + (edges_whitened(problem.features, edges) ? edges : 0);
}

/// Rows of an edge: f_to - f_from.
template <class Layout, class Real>
struct EdgeRows {
    int from, to;  ///< indices of the features' first components

    /// (Features between the two have entries 0.)
    auto entries() const {
        return from < to ? entries_at<false>(from, to + 2) : entries_at<false>(to, from + 2);
    }

    template <class Column>
    Vector2<Real> operator()(const Column& column) const {
        return {column(to) - column(from), column(to + 1) - column(from + 1)};
    }
};

/// L^-1 nu of two rows, S = L L'.
template <class Real>
Vector2<Real> whitened(Real xx, Real xy, Real yy, const Vector2<Real>& nu) {
    const Real l_xx = sqrt(xx), l_xy = xy / l_xx, l_yy = sqrt(fnma(l_xy, l_xy, yy));
    const Real x = nu.x / l_xx;
    return {x, fnma(l_xy, x, nu.y) / l_yy};
}

/// Watches a trial, and keeps the details of its pack where some are asked for.
template <class Layout, class Real>
class Detail {
public:
    void watch(const CommonView& problem, PackDetails<Real>& details) {
        problem_ = &problem;
        details_ = &details;
    }

    template <class... Anything>
    void started(const Anything&...) {}
    template <class... Anything>
    void planned(const Anything&...) {}
    template <class... Anything>
    void priced(const Anything&...) {}
    template <class... Anything>
    void explored(const Anything&...) {}

    template <class EdgeMeasurement, class Linearisation>
    void predicted(int k, const Layout& layout, const Truth<Real, Layout::feature_capacity>& truth,
                   const Command<Real>&, const Belief<Real, Layout::capacity>& belief,
                   const Sighting<Real>* sightings, const EdgeMeasurement& edge_measurement,
                   const Linearisation& linearised) {
        truth_ = &truth;
        if (!details_->on) return;
        whiten(k - 1, layout, belief, sightings, edge_measurement, linearised);
        details_->products.correlate(k - 1);
    }

    void updated(int k, const Layout& layout, const Belief<Real, Layout::capacity>& belief, const Real*) {
        if (!details_->keeps_errors) return;
        Real error[Layout::capacity];
        estimation_error(belief, *truth_, layout, error);
        const int n = layout.size();
        for (int i = 0; i < n; ++i)
            details_->errors[i * (problem_->poses - 1) + k - 1] =
                select(present(belief.covariance.entry[i][i]), error[i], Real(__builtin_nan("")));
        for (int i = 0; details_->variances != nullptr && i < n; ++i)
            details_->variances[i * (problem_->poses - 1) + k - 1] =
                Real(problem_->filter.covariance_factor) * belief.covariance.entry[i][i];
        if (details_->moments != nullptr) add_step_moments(n, belief.covariance, error);
    }

private:
    /// Where a component of this variance is in the state. (One that is not a number is: its trial has failed.)
    Mask<Real> present(const Real& variance) const {
        return negated(variance <= Real(problem_->growth.absent_variance));
    }

    /// Errors and covariance in units of each step's own sigma. P is reported times a factor.
    void add_step_moments(int n, const Symmetric<Real, Layout::capacity>& P, const Real* error) {
        const Real inverse_root = Real(1 / __builtin_sqrt(problem_->filter.covariance_factor));
        Real inverse_sigma[Layout::capacity], standardised[Layout::capacity];
        for (int i = 0; i < n; ++i) {
            inverse_sigma[i] = select(present(P.entry[i][i]), Real(1) / sqrt(P.entry[i][i]), Real(0));
            standardised[i] = error[i] * inverse_sigma[i] * inverse_root;
        }
        add_moments(n, [&](int i, int j) { return P.entry[i][j]; }, standardised, inverse_sigma, details_->moments);
    }

    /// Takes the rows of step k in, one pair after the other, as the update does, on a copy.
    template <class EdgeMeasurement, class Linearisation>
    [[gnu::noinline]] void whiten(int k, const Layout& layout, const Belief<Real, Layout::capacity>& belief,
                                  const Sighting<Real>* sightings, const EdgeMeasurement& edge_measurement,
                                  const Linearisation& linearised) {
        const int n = layout.size(), features = layout.features();
        const FilterParameters& filter = problem_->filter;
        const auto keep = [&](int pair, const Vector2<Real>& white, Real observed) {
            details_->products.keep(k, 2 * pair, white.x, observed);
            details_->products.keep(k, 2 * pair + 1, white.y, observed);
        };
        for (int i = 0; i < n; ++i) {
            update_.correction[i] = Real(0);
            for (int j = i; j < n; ++j) P_.entry[i][j] = belief.covariance.entry[i][j];
        }
        update_.nis = Real(0);
        update_.positive_definite = all_lanes<Real>();
        for (int j = 0; j < features; ++j) {
            const Sighting<Real>& sighting = sightings[j];
            keep(j, {Real(0), Real(0)}, Real(0));
            if (!any(sighting.seen)) continue;
            const auto [rows, innovation] = linearised(j, sighting);
            keep(j, take(layout, rows, believed_variance(filter, sighting.sigma), sighting.seen, innovation,
                         linearised.frame),
                 select(sighting.seen, Real(1), Real(0)));
        }
        const int edges = whitened_pairs(*problem_) - features;
        for (int e = 0; e < edges; ++e) {
            const int from = Layout::feature(filter.edges[e].from), to = Layout::feature(filter.edges[e].to);
            keep(features + e,
                 take(layout, EdgeRows<Layout, Real>{from, to}, Real(filter.variance_edge), all_lanes<Real>(),
                      edge_measurement(e) - (point_at(belief.mean, to) - point_at(belief.mean, from)),
                      Rotation<Real>{Real(1), Real(0)}),
                 Real(1));
        }
    }

    /// Conditions the copy on two rows, and whitens them in the frame that `frame` leads from.
    template <class Rows>
    Vector2<Real> take(const Layout& layout, const Rows& rows, Real N, Mask<Real> used, const Vector2<Real>& nu,
                       const Rotation<Real>& frame) {
        const auto column_of = [&](int row) {  // H P H' by its columns
            return rows([&](int s) {
                const Vector2<Real> W = rows([&](int i) { return P_.at(i, s); });
                return row == 0 ? W.x : W.y;
            });
        };
        const Vector2<Real> x = rotate_back(frame, column_of(0)), y = rotate_back(frame, column_of(1));
        const Vector2<Real> S_x = rotate_back(frame, Vector2<Real>{x.x, y.x}),
                            S_y = rotate_back(frame, Vector2<Real>{x.y, y.y});
        const Vector2<Real> fresh = rotate_back(frame, nu - rows([&](int s) { return update_.correction[s]; }));
        const Vector2<Real> white = whitened(S_x.x + N, S_x.y, S_y.y + N, fresh);
        take_in(P_, layout, rows, N, used, nu, update_);
        return {select(used, white.x, Real(0)), select(used, white.y, Real(0))};
    }

    const CommonView* problem_ = nullptr;
    PackDetails<Real>* details_ = nullptr;
    const Truth<Real, Layout::feature_capacity>* truth_ = nullptr;
    Symmetric<Real, Layout::capacity> P_;
    Update<Real, Layout::capacity> update_;
};

/// A trial of a built-in world as BatchOf takes it, watched by a Detail; `run` is missing.
template <class WorldView, class Layout, class Number, class Work>
struct WatchedTrial {
    using View = WorldView;
    using Real = Number;
    struct Room {
        Work work;
        Detail<Layout, Real> detail;
    };

    static int column_count(const View&) { return credence::column_count; }
    static int whitened_rows(const View& problem) { return 2 * whitened_pairs(problem); }
    static std::size_t room(const View&) { return sizeof(Room); }
};

}  // namespace CREDENCE_TARGET
}  // namespace credence
