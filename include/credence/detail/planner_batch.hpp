#pragma once
// Module slam: what a planner of one's own is told, and answers [credence/planner.hpp].

#include <credence/detail/deformable_settings.hpp>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace credence {

/// What the filter of one trial believes before its robot moves to pose `step`. Lengths are the scenario's, angles in
/// rad; n components, M features. What is not in the state yet is NaN.
struct PlannerBelief {
    std::int64_t trial = 0;
    int step = 0, components = 0, features = 0;
    const double* mean = nullptr;               ///< [n]
    const double* covariance = nullptr;         ///< [n, n]
    const unsigned char* known = nullptr;       ///< [M] whether the feature is in the state
};

/// What would follow from a candidate, by the filter's own equations: its prediction, and the update with all that
/// would then be in range, view and sight of the predicted mean.
struct Prospect {
    Control control;
    const double* mean = nullptr;               ///< [n] predicted
    const double* covariance = nullptr;         ///< [n, n] after the update
    const unsigned char* seen = nullptr;        ///< [M]
    double trace = 0;                           ///< of W P after the update, W of planner.criterion and heading_weight
    double log_det = 0;                         ///< of P after the update
    int new_cells = 0;                          ///< that would come into view for the first time; `explore` alone
};

struct PlannerBatch;

/// Takes the prospects of a trial of a batch, candidate by candidate; `allowed`: no wall ends the motion.
struct ProspectVisitor {
    virtual ~ProspectVisitor() = default;
    virtual void visit(int place, int candidate, bool allowed, const Prospect& prospect) = 0;
};

/// What a planner is told of up to 64 trials before their robots move to pose `step`, and where its answer goes.
struct PlannerBatch {
    int step = 0, trials = 0, components = 0, features = 0, candidates = 0;  ///< k, B, n, M, C
    int cell_rows = 0, cell_columns = 0;        ///< of the grid of `explore`; 0 in a world without one
    const std::int64_t* trial = nullptr;        ///< [B] numbers of the trials
    const double* mean = nullptr;               ///< [B, n]
    const double* covariance = nullptr;         ///< [B, n, n]
    const unsigned char* known = nullptr;       ///< [B, M]
    const unsigned char* viewed = nullptr;      ///< [B, rows, columns] cells that have been in view
    const Control* candidate = nullptr;         ///< [C]
    double reach = 0;                           ///< length of the longest candidate
    std::uint64_t root_seed = 0;
    std::uint32_t other = 0;                    ///< of draws.other
    Control* control = nullptr;                 ///< [B] the answer; a trial with one that is not finite has failed

    /// Calls the visitor for every trial and candidate.
    void visit_prospects(ProspectVisitor& visitor) const { prospects(world, visitor); }
    /// A number in [0, 1) for the trial at a place of the batch, which depends on seed, trial, step and index alone.
    double uniform(int place, int index) const;

    PlannerBelief belief(int place) const {
        const auto at = static_cast<std::size_t>(place), n = static_cast<std::size_t>(components);
        return {trial[at], step, components, features, mean + at * n, covariance + at * n * n,
                known + at * static_cast<std::size_t>(features)};
    }

    void (*prospects)(const void* world, ProspectVisitor&) = nullptr;
    const void* world = nullptr;
};

/// A key `planner.NAME.key` of a planner. `read` throws InputError for a value out of its range, and returns it as the
/// scenario keeps it.
struct PlannerKey {
    std::string name;
    std::function<std::string(const std::string&)> read;
};

class Planner {
public:
    virtual ~Planner() = default;
    /// Fills the answer of the batch. Called from several threads at once; what it throws ends the study, with what is
    /// committed kept. The answer must depend on the batch's trials one by one, and on nothing else.
    virtual void choose(const PlannerBatch& batch) const = 0;
    virtual std::vector<PlannerKey> keys() const { return {}; }
    /// The same with values of its keys; nullptr: there are none.
    virtual std::shared_ptr<const Planner> with(const std::map<std::string, std::string>&) const { return nullptr; }
};

/// Adds a planner to those that there are, in place of one of that name, and takes it away: not while others call the
/// library. `version` tells planners of one name apart: a study goes on with its own alone.
void add_planner(const std::string& name, std::shared_ptr<const Planner> planner, const std::string& version = {});
void remove_planner(const std::string& name);

/// The planners of a scenario's arms, with its values of their keys. Throws InputError where one is not there, or a key
/// is that of another planner.
std::vector<std::shared_ptr<const Planner>> planners_of(const DeformableSettings& settings);

}  // namespace credence
