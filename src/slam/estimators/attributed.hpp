#pragma once
// What P counts for each source: P_s, propagated for the noise of one source alone with the filter's own gains. Their
// sum is P [docs/budget.md, What P counts].
//
//   P_s <- F P_s F' + Q_s, P_s <- (I - G H) P_s (I - G H)' + N_s G G'  [Bucy, Joseph 1968, of two rows at a time]

#include "slam/estimators/estimators.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace credence {

/// What P counts as one source: the filter with the noise of that source alone, and which of P at pose 0 is its own.
struct CountedSource {
    std::string name;
    FilterParameters filter;
    bool first_pose = false, first_features = false;
};

inline namespace CREDENCE_TARGET {

/// An estimator of double precision that propagates the parts of its P beside it. Prediction and initialisation are
/// linear in P and the variances, so that the estimator's own are applied to each part. The update is not: its gains
/// are heard of by the Update that it fills.
template <class Estimating, class Layout>
class Attributed : public Estimating {
public:
    using State = typename Estimating::State;
    using World = typename Estimating::World;
    using Matrix = Symmetric<double, Layout::capacity>;

    /// Before a trial. The sources must outlive it.
    void attribute(const std::vector<CountedSource>& sources) {
        sources_ = &sources;
        parts_.resize(sources.size());
        predicted_.resize(sources.size());
    }
    /// P_s by source.
    const std::vector<State>& parts() const { return parts_; }

    void start(const Layout& layout, const State& belief, const World& truth) {
        Estimating::start(layout, belief, truth);
        for_each([&](const CountedSource& source, State& part) {
            for (int i = 0; i < layout.size(); ++i) {
                const bool own = i < Layout::pose_size ? source.first_pose : source.first_features;
                for (int j = i; j < layout.size(); ++j)
                    part.covariance.entry[i][j] = own ? belief.covariance.entry[i][j] : 0;
            }
        });
    }

    void predict(State& belief, const FilterParameters& filter, const Layout& layout, const Command<double>& command,
                 const World& truth, int k) {
        apply(belief, layout, [&](Estimating& own, State& part, const FilterParameters& of_source) {
            own.predict(part, of_source, layout, command, truth, k);
        });
        Estimating::predict(belief, filter, layout, command, truth, k);
    }

    template <class EdgeMeasurement, class Linearisation>
    void update(State& belief, const FilterParameters& filter, const Layout& layout,
                const Sighting<double>* sightings, const EdgeMeasurement& edge_measurement,
                const Linearisation& linearised, Update<double, Layout::capacity>& update) {
        for (std::size_t s = 0; s < parts_.size(); ++s) copy(parts_[s].covariance, layout.size(), predicted_[s]);
        heard_.owner = this;
        heard_.size = layout.size();
        Estimating::update(belief, filter, layout, sightings, edge_measurement, linearised, heard_);
        std::copy_n(heard_.correction, layout.size(), update.correction);
        update.nis = heard_.nis, update.nis_features = heard_.nis_features, update.nis_edges = heard_.nis_edges;
        update.rows = heard_.rows, update.unseen = heard_.unseen, update.unsettled = heard_.unsettled;
        update.positive_definite = heard_.positive_definite;
    }

    void initialise(State& belief, const FilterParameters& filter, const Layout& layout, int j,
                    const Sighting<double>& sighting, const World& truth) {
        apply(belief, layout, [&](Estimating& own, State& part, const FilterParameters& of_source) {
            own.initialise(part, of_source, layout, j, sighting, truth);
        });
        Estimating::initialise(belief, filter, layout, j, sighting, truth);
    }

private:
    struct Heard : Update<double, Layout::capacity> {
        Attributed* owner = nullptr;
        int size = 0;
        Vector2<double> gain[Layout::capacity];

        void begun() {
            for (std::size_t s = 0; s < owner->parts_.size(); ++s)
                copy(owner->predicted_[s], size, owner->parts_[s].covariance);
        }
        void gained(const Decorrelation<double>& S, int i, const Vector2<double>& K) {
            gain[i] = {K.x - S.slope * K.y, K.y};  // for the rows as they are: K L^-1
        }
        template <class Rows>
        void taken(const Layout& layout, const Rows& rows, double N) {
            owner->for_each([&](const CountedSource& source, State& part) {
                const bool own = is_sighting(rows) ? source.filter.measurement_factor > 0
                                                   : source.filter.variance_edge > 0;
                condition_part(part.covariance, layout, rows, own ? N : 0, gain);
            });
        }
        void turned(const Layout& layout, const double* shift) {
            for (State& part : owner->parts_) turn_covariance(part.covariance, layout, shift);
        }
    };

    template <class Index>
    static constexpr bool is_sighting(const SightingRows<Layout, double, Index>&) { return true; }
    template <class Rows>
    static constexpr bool is_sighting(const Rows&) { return false; }

    /// P <- (I - G H) P (I - G H)' + N G G'
    template <class Rows>
    static void condition_part(Matrix& P, const Layout& layout, const Rows& rows, double N, const Vector2<double>* G) {
        const int n = layout.size();
        Vector2<double> W[Layout::capacity];  // P H'
        for (int i = 0; i < n; ++i) W[i] = rows([&](int s) { return P.at(i, s); });
        const Vector2<double> x = rows([&](int s) { return W[s].x; }), y = rows([&](int s) { return W[s].y; });
        for (int i = 0; i < n; ++i) {
            // of (H P H' + N) G' - W'
            const Vector2<double> rest{(x.x + N) * G[i].x + y.x * G[i].y - W[i].x,
                                       x.y * G[i].x + (y.y + N) * G[i].y - W[i].y};
            for (int j = i; j < n; ++j)
                P.entry[i][j] += G[j].x * rest.x + G[j].y * rest.y - W[j].x * G[i].x - W[j].y * G[i].y;
        }
    }

    template <class Use>
    void for_each(const Use& use) {
        for (std::size_t s = 0; s < parts_.size(); ++s) use((*sources_)[s], parts_[s]);
    }

    /// Applies a step of the estimator as it is now to each part about the mean.
    template <class Step>
    void apply(const State& belief, const Layout& layout, const Step& step) {
        for_each([&](const CountedSource& source, State& part) {
            Estimating own = *this;
            for (int i = 0; i < layout.size(); ++i) part.mean[i] = belief.mean[i];
            step(own, part, source.filter);
        });
    }

    const std::vector<CountedSource>* sources_ = nullptr;
    std::vector<State> parts_;
    std::vector<Matrix> predicted_;
    Heard heard_;
};

}  // namespace CREDENCE_TARGET
}  // namespace credence
