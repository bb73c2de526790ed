#pragma once
// Module worlds: one trial of a world of somebody's own, and what the engine makes of it. Who writes such a world reads
// own_world.hpp first.
//
//   n  components of the state, m  rows of an innovation; K poses, steps k = 1 ... K - 1

#include <credence/scenario.hpp>
#include <credence/worlds.hpp>

#include <Eigen/Dense>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace credence {

/// One trial under one arm: where its noise comes from, and where its errors go.
class OwnTrial {
public:
    virtual ~OwnTrial() = default;

    /// Place of the arm in the scenario's list.
    virtual std::size_t arm() const = 0;
    /// K
    virtual int poses() const = 0;

    /// Two independent standard normal draws, keyed by source (0 to 15), pose (from 0) and index (0 to 2^27 - 1): never by
    /// the order of calls, and the same under every arm. A draw that is not needed need not be asked for. A key beyond
    /// these ends the run with std::logic_error.
    virtual Eigen::Vector2d normal(int source, int pose, int index = 0) const = 0;
    /// Uniform on [0, 1), keyed likewise. Do not ask for both kinds under one key.
    virtual double uniform(int source, int pose, int index = 0) const = 0;

    /// What the filter says after the next step, the first call being step 1: error [n], estimate - truth in the chart in
    /// which the covariance P [n, n] lives, angles wrapped. Of P the lower triangle is read. To be called K - 1 times; a
    /// P that is not positive definite, or a number that is not finite, ends the trial as failed, which is data.
    virtual void step(const Eigen::VectorXd& error, const Eigen::MatrixXd& P) = 0;
    /// The same with the step's innovation [m] and its predicted covariance S [m, m]; m may differ from step to step, up
    /// to what the world declares, and row i is the same measurement at every step: NaN where it was not observed.
    virtual void step(const Eigen::VectorXd& error, const Eigen::MatrixXd& P, const Eigen::VectorXd& innovation,
                      const Eigen::MatrixXd& S) = 0;

    /// The value of the world's own column of that place, 0 where it is not set.
    virtual void set(std::size_t column, double value) = 0;
};

/// What a user's own world says of a scenario beside its settings.
struct OwnReport {
    std::vector<Column> columns{};      ///< its own; others are there in every world
    int largest_innovation = 0;         ///< m; 0: the trials give no innovations
};

/// Columns of such a world: trace_P, its own, squared_error, nees_ratio, nis_ratio, mean_trace_P, status, status_pose.
std::vector<Column> own_columns(const Scenario& scenario, const OwnReport& report);
std::vector<Series> own_series(const Scenario& scenario, const OwnReport& report);

/// Makes trials of a function that runs one. It is called from several threads at once.
std::unique_ptr<const Simulation> own_simulation(const Scenario& scenario, const OwnReport& report,
                                                 std::function<void(OwnTrial&)> run);

/// Throws std::invalid_argument where a declaration cannot be: no arm or component, a name with other characters than
/// letters, digits, _ and -, a block beyond the state. It is the world's bug, not its user's.
void check_declared(const Scenario& scenario);

}  // namespace credence
