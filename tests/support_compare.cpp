// Comparing: a production trial with the oracle's, and bits with bits.

#include "support.hpp"

#include <credence/detail/block.hpp>
#include <credence/detail/trajectory.hpp>
#include <credence/error.hpp>

#include <algorithm>
#include <cmath>

namespace credence::test {

double Run::figure(const std::string& name, int k) const { return series(name)[k - 1]; }

Eigen::VectorXd Run::series(const std::string& name) const {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) throw std::logic_error("there is no figure " + name);
    return figures.row(found - names.begin());
}

double relative(double a, double b) {
    if (a == b || (std::isnan(a) && std::isnan(b))) return 0;
    const double ratio = std::abs(a - b) / std::abs(b);
    return std::isnan(ratio) ? infinity : ratio;
}

namespace {

void raise(double& greatest, double value) { greatest = std::isnan(value) ? infinity : std::max(greatest, value); }

template <class Matrix>
double relative_norm(const Matrix& ours, const Matrix& oracle) {
    return (ours - oracle).norm() / oracle.norm();
}

void compare_step(const Run& ours, const oracle::Step& theirs, int k, Difference& greatest) {
    const RunStep& step = ours.steps[static_cast<std::size_t>(k)];
    raise(greatest.mean, relative_norm(step.mean, theirs.mean));
    raise(greatest.covariance, relative_norm(step.covariance, theirs.covariance));
    if (k == 0) return;
    raise(greatest.condition, theirs.condition_of_S);
    raise(greatest.prior_mean, relative_norm(step.prior_mean, theirs.prior_mean));
    raise(greatest.prior_covariance, relative_norm(step.prior_covariance, theirs.prior_covariance));
    raise(greatest.nees, relative(ours.figure("nees", k), theirs.nees));
    raise(greatest.nis, relative(ours.figure("nis", k), theirs.nis));
    raise(greatest.trace_P, relative(ours.figure("trace_P_step", k), theirs.trace_P));
    greatest.same_sight = greatest.same_sight && step.seen == theirs.seen;
    greatest.same_rows = greatest.same_rows && ours.figure("nis_rows", k) == theirs.rows;
    // Controls agree to the rounding of two different sines; another candidate is far from that.
    const Control &a = step.control, &b = theirs.control;
    const double apart = std::abs(a.turn - b.turn) + std::abs(a.move.x - b.move.x) + std::abs(a.move.y - b.move.y);
    greatest.same_control = greatest.same_control && apart < 1e-9 * (1 + std::abs(b.move.x) + std::abs(b.move.y));
    if (static_cast<Eigen::Index>(step.candidate_cost.size()) != theirs.candidate_cost.size()) greatest.cost = infinity;
    for (Eigen::Index i = 0; i < theirs.candidate_cost.size() && greatest.cost < infinity; ++i)
        raise(greatest.cost, relative(step.candidate_cost[static_cast<std::size_t>(i)], theirs.candidate_cost[i]));
}

}  // namespace

Difference difference(const Run& ours, const oracle::Trial& oracle) {
    Difference greatest;
    for (std::size_t k = 0; k < oracle.steps.size(); ++k)
        compare_step(ours, oracle.steps[k], static_cast<int>(k), greatest);
    raise(greatest.trace_P, relative(ours.columns[column_trace_P], oracle.trace_P));
    greatest.pose_error = relative(ours.columns[column_pose_error], oracle.pose_error);
    greatest.nees_ratio = relative(ours.columns[column_nees_ratio], oracle.nees_ratio);
    greatest.nis_ratio = relative(ours.columns[column_nis_ratio], oracle.nis_ratio);
    greatest.log_score = std::abs(ours.columns[column_log_score] - oracle.log_score) /
                         static_cast<double>(ours.steps.front().mean.size());
    greatest.path_length = relative(ours.columns[column_path_length], oracle.path_length);
    greatest.same_unseen = ours.columns[column_unseen] == oracle.unseen;
    return greatest;
}

bool same_bits(double a, double b) { return bits_of(a) == bits_of(b); }

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) { return same_bits(x, y); });
}

bool same_bits(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    return a.rows() == b.rows() && a.cols() == b.cols() &&
           std::equal(a.data(), a.data() + a.size(), b.data(), [](double x, double y) { return same_bits(x, y); });
}

std::vector<std::string> other_bits_in_lanes(const Problem& problem) {
    constexpr int seed = 3, index = 21, trials = 13;
    std::vector<std::string> others;
    const std::vector<Target> targets = runnable_targets();
    std::vector<Block> blocks;
    for (const Target& target : targets) blocks.push_back(run_block(problem, seed, index, trials, target));
    const std::vector<Arm> arms = arms_of(problem.scenario());
    for (std::size_t a = 0; a < arms.size(); ++a)
        for (const std::size_t trial : {0u, 6u, 12u}) {
            const Trajectory one = replay_trial(problem, arms[a], seed, index * block_size + static_cast<int>(trial));
            for (std::size_t t = 0; t < targets.size(); ++t)
                for (std::size_t c = 0; c < column_count; ++c)
                    if (!same_bits(blocks[t].arms[a].columns[c * trials + trial], one.column_values[c]))
                        others.push_back(targets[t].name + ", " + arm_name(problem.scenario(), arms[a]) + ", trial " +
                                         std::to_string(trial) + ": " + one.columns[c].name);
        }
    return others;
}

double smallest_eigenvalue(const Eigen::MatrixXd& symmetric) {
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric, Eigen::EigenvaluesOnly).eigenvalues().minCoeff();
}

std::string refusal(const std::function<void()>& action) {
    try {
        action();
    } catch (const InputError& error) {
        return error.what();
    }
    return {};
}

}  // namespace credence::test
