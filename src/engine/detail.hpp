#pragma once
// What is kept of a study's first trials only: the errors of the state, and how far whitened innovations are
// correlated in time [docs/statistics.md, Whiteness, NCI]. An observer of the trial; idle unless asked.
//
//   nu~ = L^-1 nu, S = L L', rows features (body frame) then edges in graph order

#include "engine/moments.hpp"
#include "slam/trial/step_evaluation.hpp"

namespace credence {

inline constexpr int largest_lag = 10;
/// Pairs of rows that are whitened: with more edges, the features' rows alone.
inline constexpr int largest_whitened = 256;

/// Whether the edges' rows are among the whitened ones.
inline bool edges_whitened(int features, int edges) { return features + edges <= largest_whitened; }

inline namespace CREDENCE_TARGET {

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

/// One pose's whitened innovation, two rows a pair; 0 where not observed.
template <class Real>
struct WhitenedInnovation {
    Vector2<Real> pair[largest_whitened];
    Real observed[largest_whitened];  ///< 1 or 0
};

/// Watches a trial. `on` false: does nothing.
template <class Layout, class Real>
class Detail {
public:
    bool on = false;
    const CommonView* problem = nullptr;
    Real* errors = nullptr;           ///< [n, K - 1] x^ - x after the updates
    Real* moments = nullptr;          ///< [n + n (n + 1)] of moment_count, those of the groups' NEES left out; or null
    Real product_sum[largest_lag];    ///< [lag - 1] sum over poses and rows of nu~_k nu~_{k + lag}
    Real product_count[largest_lag];  ///< [lag - 1]

    template <class... Anything>
    void started(const Anything&...) {
        for (int i = 0; moments != nullptr && i < own_moment_count(problem->state_size); ++i) moments[i] = Real(0);
        for (int lag = 0; lag < largest_lag; ++lag) product_sum[lag] = product_count[lag] = Real(0);
    }
    template <class... Anything>
    void planned(const Anything&...) {}

    template <class EdgeMeasurement, class Linearisation>
    void predicted(int k, const Layout& layout, const Truth<Real, Layout::feature_capacity>& truth,
                   const Command<Real>&, const Belief<Real, Layout::capacity>& belief,
                   const Sighting<Real>* sightings, const EdgeMeasurement& edge_measurement,
                   const Linearisation& linearised) {
        if (!on) return;
        truth_ = &truth;
        whiten(k, layout, belief, sightings, edge_measurement, linearised);
        correlate(k, pair_count(layout));
    }

    void updated(int k, const Layout& layout, const Belief<Real, Layout::capacity>& belief, const Real*) {
        if (!on) return;
        Real error[Layout::capacity];
        estimation_error(belief, *truth_, layout, error);
        const int n = layout.size();
        for (int i = 0; i < n; ++i) errors[i * (problem->poses - 1) + k - 1] = error[i];
        if (moments != nullptr) add_step_moments(n, belief.covariance, error);
    }

private:
    /// Errors and covariance in units of each step's own sigma. P is reported times a factor.
    void add_step_moments(int n, const Symmetric<Real, Layout::capacity>& P, const Real* error) {
        const Real inverse_root = Real(1 / __builtin_sqrt(problem->filter.covariance_factor));
        Real inverse_sigma[Layout::capacity], standardised[Layout::capacity];
        for (int i = 0; i < n; ++i) {
            inverse_sigma[i] = Real(1) / sqrt(P.entry[i][i]);
            standardised[i] = error[i] * inverse_sigma[i] * inverse_root;
        }
        add_moments(n, [&](int i, int j) { return P.entry[i][j]; }, standardised, inverse_sigma, moments);
    }

    int pair_count(const Layout& layout) const {
        const int features = layout.features(), edges = problem->filter.edge_count;
        return features + (edges_whitened(features, edges) ? edges : 0);
    }

    /// Takes the rows in one pair after the other, as the update does, on a copy.
    template <class EdgeMeasurement, class Linearisation>
    [[gnu::noinline]] void whiten(int k, const Layout& layout, const Belief<Real, Layout::capacity>& belief,
                                  const Sighting<Real>* sightings, const EdgeMeasurement& edge_measurement,
                                  const Linearisation& linearised) {
        const int n = layout.size(), features = layout.features();
        const FilterParameters& filter = problem->filter;
        WhitenedInnovation<Real>& now = history_[k % (largest_lag + 1)];
        for (int i = 0; i < n; ++i) {
            update_.correction[i] = Real(0);
            for (int j = i; j < n; ++j) P_.entry[i][j] = belief.covariance.entry[i][j];
        }
        update_.nis = Real(0);
        update_.positive_definite = all_lanes<Real>();
        for (int j = 0; j < features; ++j) {
            const Sighting<Real>& sighting = sightings[j];
            now.observed[j] = Real(0);
            now.pair[j] = {Real(0), Real(0)};
            if (!any(sighting.seen)) continue;
            const auto [rows, innovation] = linearised(j, sighting);
            now.observed[j] = select(sighting.seen, Real(1), Real(0));
            now.pair[j] = take(layout, rows, believed_variance(filter, sighting.sigma), sighting.seen, innovation,
                               linearised.frame);
        }
        const int edges = pair_count(layout) - features;
        for (int e = 0; e < edges; ++e) {
            const int from = Layout::feature(filter.edges[e].from), to = Layout::feature(filter.edges[e].to);
            now.observed[features + e] = Real(1);
            now.pair[features + e] =
                take(layout, EdgeRows<Layout, Real>{from, to}, Real(filter.variance_edge), all_lanes<Real>(),
                     edge_measurement(e) - (point_at(belief.mean, to) - point_at(belief.mean, from)),
                     Rotation<Real>{Real(1), Real(0)});
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

    [[gnu::noinline]] void correlate(int k, int pairs) {
        const WhitenedInnovation<Real>& now = history_[k % (largest_lag + 1)];
        for (int lag = 1; lag <= largest_lag && lag < k; ++lag) {
            const WhitenedInnovation<Real>& before = history_[(k - lag) % (largest_lag + 1)];
            Real sum = product_sum[lag - 1], count = product_count[lag - 1];
            for (int p = 0; p < pairs; ++p) {
                sum = fma(now.pair[p].y, before.pair[p].y, fma(now.pair[p].x, before.pair[p].x, sum));
                count = fma(Real(2) * now.observed[p], before.observed[p], count);
            }
            product_sum[lag - 1] = sum;
            product_count[lag - 1] = count;
        }
    }

    const Truth<Real, Layout::feature_capacity>* truth_ = nullptr;
    Symmetric<Real, Layout::capacity> P_;
    Update<Real, Layout::capacity> update_;
    WhitenedInnovation<Real> history_[largest_lag + 1];  ///< by pose, modulo its length
};

}  // namespace CREDENCE_TARGET
}  // namespace credence
