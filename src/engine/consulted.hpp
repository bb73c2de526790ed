#pragma once
// Trials whose controls a planner of one's own chooses. It is asked for many at once, so they go step by step together,
// and it is asked before they are run: the commands that this gives are what the engine then runs them by, one pack
// after the other, as any others.

#include <credence/detail/block_ranges.hpp>
#include <credence/detail/draws.hpp>
#include <credence/detail/planner_batch.hpp>
#include "engine/detail.hpp"
#include "engine/pieces.hpp"
#include "engine/simulate_batch.hpp"
#include "slam/planning/workspace.hpp"

#include <new>

namespace credence {

/// Trials that go together, at most. The engine's batches are multiples of it but for the last one.
inline constexpr int trials_together = 64;

inline namespace CREDENCE_TARGET {

/// The trials of a batch under a planner. `Trial` is a world's as of BatchOf, with `consults`, whether it can be one
/// under a planner, and if so with the type Steps, which has start, step, layout and work, and the functions
///   steps(view, draws, room, details)  begins the trials of a pack in its room
///   cells(view), tell(view, steps, lane, known, viewed)  what only this world knows of a trial
///   ahead(view, steps, k, price)  calls price(i, command, allowed, sees, new cells) for the candidates, all of them in
///                                 lanes; sees(j, squared) as of `expect`
template <class Trial>
class Consulted {
    using View = typename Trial::View;
    using Real = typename Trial::Real;
    using Steps = typename Trial::Steps;
    static constexpr int most_packs = trials_together / lanes<Real>;

public:
    static std::size_t workspace_size(const View& problem, int trials) {
        return Consulted(problem, trials, Pieces()).size_;
    }

    Consulted(const View& problem, int trials, Pieces pieces) : problem_(problem) {
        const auto count = [](int number) { return static_cast<std::size_t>(number); };
        const std::size_t n = count(problem.state_size), B = trials_together,
                          packs = count((trials + lanes<Real> - 1) / lanes<Real>);
        commands_ = pieces.take<Command<Real>>(packs * count(problem.poses - 1));
        rooms_ = pieces.take<std::byte>(most_packs * padded(Trial::room(problem)));
        steps_ = pieces.take<Steps>(most_packs);
        draws_ = pieces.take<KeyedDraws<Real>>(most_packs);
        all_series_ = pieces.take<Real>(count(problem.series_count * (problem.poses - 1)));
        trial_ = pieces.take<std::int64_t>(B);
        at_ = pieces.take<int>(B);
        mean_ = pieces.take<double>(B * n);
        covariance_ = pieces.take<double>(B * n * n);
        known_ = pieces.take<unsigned char>(B * count(problem.features));
        viewed_ = pieces.take<unsigned char>(B * Trial::cells(problem));
        control_ = pieces.take<Control>(B);
        prospect_ = pieces.take<double>(n + n * n);
        seen_ = pieces.take<unsigned char>(count(problem.features));
        sees_ = pieces.take<Mask<Real>>(count(problem.features));
        size_ = pieces.size();
    }

    /// The commands [packs, K - 1] of all trials of the batch.
    const Command<Real>* choose(const Planner& planner, std::uint64_t root_seed, std::int64_t first, int trials) {
        for (int from = 0; from < trials; from += trials_together)
            choose_together(planner, root_seed, first + from, trials - from < trials_together ? trials - from
                                                                                              : trials_together,
                            commands_ + from / lanes<Real> * (problem_.poses - 1));
        return commands_;
    }

private:

    void choose_together(const Planner& planner, std::uint64_t root_seed, std::int64_t first, int trials,
                         Command<Real>* commands) {
        const int packs = (trials + lanes<Real> - 1) / lanes<Real>;
        PackDetails<Real> details(problem_, Trial::whitened_rows(problem_), Batch{}, nullptr);
        details.keeps_errors = false;
        for (int p = 0; p < packs; ++p) {
            draws_[p] = KeyedDraws<Real>(root_seed, trials_from<Real>(first + p * lanes<Real>),
                                         Trial::truncate(problem_), problem_.other);
            new (steps_ + p) Steps(Trial::steps(problem_, draws_[p],
                                                rooms_ + static_cast<std::size_t>(p) * padded(Trial::room(problem_)),
                                                details));
            steps_[p].start();
        }
        for (int k = 1; k < problem_.poses; ++k) {
            const int told = tell(first, trials);
            if (told > 0) ask(planner, root_seed, told, k);
            for (int p = 0; p < packs; ++p) {
                Command<Real>& command = commands[p * (problem_.poses - 1) + k - 1];
                command = nowhere();
                for (int b = 0; b < told; ++b)
                    if (at_[b] / lanes<Real> == p) set(command, at_[b] % lanes<Real>, control_[b]);
                steps_[p].step(k, command, all_series_);
            }
        }
    }

    /// The command of a trial that has failed.
    static Command<Real> nowhere() {
        const Real nan(__builtin_nan(""));
        return {nan, {nan, nan}};
    }
    static void set(Command<Real>& command, int lane, const Control& control) {
        set_lane(command.turn, lane, control.turn);
        set_lane(command.move.x, lane, control.move.x);
        set_lane(command.move.y, lane, control.move.y);
    }

    /// Writes down what the trials that have not failed believe. Returns how many they are.
    int tell(std::int64_t first, int trials) {
        const int n = problem_.state_size;
        int told = 0;
        for (int t = 0; t < trials; ++t) {
            Steps& steps = steps_[t / lanes<Real>];
            const int lane = t % lanes<Real>;
            double *mean = mean_ + told * n, *covariance = covariance_ + told * n * n;
            copy_lane(steps.work().belief, lane, n, mean, covariance);
            double sum = 0;
            for (int i = 0; i < n; ++i) sum += mean[i] + covariance[i * n + i];
            if (sum * 0 != 0) continue;
            trial_[told] = first + t;
            at_[told] = t;
            Trial::tell(problem_, steps, lane, known_ + told * problem_.features,
                        viewed_ + told * static_cast<int>(Trial::cells(problem_)));
            for (int j = 0; j < problem_.features; ++j)
                if (!known_[told * problem_.features + j]) forget(n - 2 * (problem_.features - j), n, mean, covariance);
            ++told;
        }
        return told;
    }

    /// What is not in the state yet is NaN.
    static void forget(int component, int n, double* mean, double* covariance) {
        for (int i = component; i < component + 2; ++i) {
            mean[i] = __builtin_nan("");
            for (int j = 0; j < n; ++j) covariance[i * n + j] = covariance[j * n + i] = __builtin_nan("");
        }
    }

    void ask(const Planner& planner, std::uint64_t root_seed, int told, int k) {
        PlannerBatch batch;
        batch.step = k;
        batch.trials = told;
        batch.components = problem_.state_size;
        batch.features = problem_.features;
        batch.candidates = problem_.control.candidate_count;
        Trial::describe_cells(problem_, batch);
        batch.trial = trial_;
        batch.mean = mean_;
        batch.covariance = covariance_;
        batch.known = known_;
        batch.viewed = viewed_;
        batch.candidate = problem_.control.candidates;
        batch.reach = __builtin_sqrt(problem_.control.squared_reach);
        batch.root_seed = root_seed;
        batch.other = problem_.other;
        batch.control = control_;
        told_ = told;
        step_ = k;
        batch.world = this;
        batch.prospects = [](const void* self, ProspectVisitor& visitor) {
            static_cast<const Consulted*>(self)->visit(visitor);
        };
        planner.choose(batch);
    }

    void visit(ProspectVisitor& visitor) const {
        for (int b = 0; b < told_;) {
            const int pack = at_[b] / lanes<Real>, begin = b;
            while (b < told_ && at_[b] / lanes<Real> == pack) ++b;
            visit(pack, begin, b, visitor);
        }
    }

    /// The prospects of the trials begin ... end - 1, which are those of a pack.
    void visit(int pack, int begin, int end, ProspectVisitor& visitor) const {
        Steps& steps = steps_[pack];
        const auto& layout = steps.layout();
        auto& planner = steps.work().planner;
        auto& next = planner.next;
        prepare_candidates(steps.work().belief, problem_.filter, layout, step_, planner.still);
        const auto price = [&](int i, const Command<Real>& command, Mask<Real> allowed, const auto& sees,
                               const Real& new_cells) {
            for (int j = 0; j < problem_.features; ++j) sees_[j] = negated(all_lanes<Real>());
            expect(planner.still, command, problem_.filter, problem_.sensor, layout,
                   [&](auto j, const Real& squared) { return sees_[j] = sees(j, squared); }, next);
            const Real trace = weighted_trace(next.covariance, layout, problem_.control.weights);
            const Real log_det = log_determinant<false>(next.covariance, layout.size());
            for (int place = begin; place < end; ++place) {
                const int lane = at_[place] % lanes<Real>;
                Prospect prospect{problem_.control.candidates[i], prospect_, prospect_ + problem_.state_size, seen_,
                                  lane_of(trace, lane), lane_of(log_det, lane),
                                  static_cast<int>(lane_of(new_cells, lane))};
                const int n = problem_.state_size;
                copy_lane(next, lane, n, prospect_, prospect_ + n);
                const unsigned char* known = known_ + place * problem_.features;
                for (int j = 0; j < problem_.features; ++j) {
                    seen_[j] = lane_bits(sees_[j]) >> lane & 1;
                    if (known[j]) continue;
                    forget(n - 2 * (problem_.features - j), n, prospect_, prospect_ + n);
                    prospect.log_det -= 2 * log(problem_.growth.absent_variance);
                }
                visitor.visit(place, i, lane_bits(allowed) >> lane & 1, prospect);
            }
        };
        Trial::ahead(problem_, steps, step_, price);
    }

    /// The mean [n] and the covariance [n, n] of one trial of a pack.
    template <class Belief>
    static void copy_lane(const Belief& belief, int lane, int n, double* mean, double* covariance) {
        for (int i = 0; i < n; ++i) {
            mean[i] = lane_of(belief.mean[i], lane);
            for (int j = i; j < n; ++j)
                covariance[i * n + j] = covariance[j * n + i] = lane_of(belief.covariance.entry[i][j], lane);
        }
    }

    const View& problem_;
    Command<Real>* commands_ = nullptr;
    std::byte* rooms_ = nullptr;
    Steps* steps_ = nullptr;
    KeyedDraws<Real>* draws_ = nullptr;
    Real* all_series_ = nullptr;
    std::int64_t* trial_ = nullptr;
    int* at_ = nullptr;
    double *mean_ = nullptr, *covariance_ = nullptr;
    unsigned char *known_ = nullptr, *viewed_ = nullptr;
    Control* control_ = nullptr;
    double* prospect_ = nullptr;
    unsigned char* seen_ = nullptr;
    Mask<Real>* sees_ = nullptr;
    std::size_t size_ = 0;
    int told_ = 0, step_ = 0;
};

/// The commands of the trials of a batch that a planner of one's own has chosen; none of other arms.
template <class Real>
struct Chosen {
    const Command<Real>* commands = nullptr;  ///< [packs, steps]
    std::int64_t first = 0;                   ///< trial
    int steps = 0;

    const Command<Real>* of(const PackPlace<Real>& place) const {
        return commands == nullptr ? nullptr : commands + (place.first - first) / lanes<Real> * steps;
    }
};

/// What a batch of an arm needs, with the arm's planner or -1.
template <class Trial>
std::size_t workspace_size_of(const typename Trial::View& problem, int planner) {
    const std::size_t of_batch = padded(BatchOf<Trial>::workspace_size(problem));
    if constexpr (Trial::consults)
        return of_batch + (planner < 0 ? 0 : Consulted<Trial>::workspace_size(problem, block_size));
    else
        return of_batch;
}

template <class Trial>
Chosen<typename Trial::Real> chosen_by(const typename Trial::View& problem, int planner, const Batch& batch) {
    if constexpr (Trial::consults) {
        if (planner < 0) return {};
        std::byte* behind = static_cast<std::byte*>(batch.workspace) + workspace_size_of<Trial>(problem, -1);
        Consulted<Trial> consulted(problem, batch.trials, Pieces(behind));
        return {consulted.choose(*problem.planners[planner], batch.root_seed, batch.first_trial, batch.trials),
                batch.first_trial, problem.poses - 1};
    } else {
        return {};
    }
}

/// Simulates a batch of an arm, or finds the commands that it asks for.
template <class Trial, class Arm>
void simulate_arm(const typename Trial::View& problem, const Arm& arm, const Batch& batch) {
    const auto chosen = chosen_by<Trial>(problem, arm.planner, batch);
    if (batch.commands == nullptr) {
        BatchOf<Trial>::simulate(problem, Trial(arm.controller, chosen), batch);
        return;
    }
    for (int k = 0; k + 1 < problem.poses; ++k) {
        const auto& command = chosen.commands[k];
        batch.commands[k] = {lane_of(command.turn, 0), {lane_of(command.move.x, 0), lane_of(command.move.y, 0)}};
    }
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
