// The loop among landmarks over a thousand trials, against the tables of an independent implementation (batched numpy,
// its own draws, N = 1000; docs/theory/estimators.md, Landmarks on a loop).

#include <credence/detail/block.hpp>
#include "worlds/explore/explore.hpp"

#include <cmath>

#include "catch.hpp"
#include "landmark_loop.hpp"
#include "support.hpp"

namespace credence::test::landmark_figures_long_test {

namespace {

struct Mean {
    double value = 0, error = 0;
};

/// Sums over the blocks of a study of one scenario.
class Totals {
public:
    Totals(const ExploreSettings& scenario, int blocks)
        : figures_(explore_series(scenario)), steps_(scenario.poses - 1) {
        const ExploreSimulation simulation(scenario);
        const std::size_t arms = scenario.arms.estimators->size();
        sums_.resize(arms);
        squares_.resize(arms);
        run_squares_.resize(arms);
        for (int b = 0; b < blocks; ++b) {
            const Block block = run_block(simulation, explore_columns(scenario), arms, 3, b, block_size);
            trials_ += block_size;
            for (std::size_t a = 0; a < arms; ++a) {
                REQUIRE(block.arms[a].counted == block_size);
                add(block.arms[a].sums, sums_[a]);
                add(block.arms[a].square_sums, squares_[a]);
                add(block.arms[a].run_square_sums, run_squares_[a]);
            }
        }
    }

    Mean at(std::size_t arm, const std::string& figure, int k) const {
        const std::size_t cell = place(figure) * static_cast<std::size_t>(steps_) + static_cast<std::size_t>(k - 1);
        return mean(sums_[arm][cell], squares_[arm][cell]);
    }
    /// Root of the mean over trials and steps.
    Mean root(std::size_t arm, const std::string& figure) const {
        double sum = 0;
        for (int k = 1; k <= steps_; ++k) sum += at(arm, figure, k).value * trials_;
        const Mean squared = mean(sum, run_squares_[arm][place(figure)]);
        const double value = std::sqrt(squared.value / steps_);
        return {value, squared.error / steps_ / (2 * value)};
    }

private:
    static void add(const std::vector<double>& from, std::vector<double>& to) {
        to.resize(from.size());
        for (std::size_t i = 0; i < from.size(); ++i) to[i] += from[i];
    }
    std::size_t place(const std::string& name) const {
        const auto found =
            std::find_if(figures_.begin(), figures_.end(), [&](const Series& f) { return f.name == name; });
        REQUIRE(found != figures_.end());
        return static_cast<std::size_t>(found - figures_.begin());
    }
    Mean mean(double sum, double square_sum) const {
        const double value = sum / trials_;
        return {value, std::sqrt((square_sum / trials_ - value * value) / trials_)};
    }

    std::vector<Series> figures_;
    int steps_;
    double trials_ = 0;
    std::vector<std::vector<double>> sums_, squares_, run_squares_;
};

/// Both have errors of their own, ours and theirs alike (as many trials), and theirs is rounded to `rounding`. At 4
/// standard errors one check in 16,000 would fail by chance; there are 140 or so.
void check(const Mean& ours, double theirs, double rounding) {
    CAPTURE(ours.value, ours.error, theirs);
    CHECK(std::abs(ours.value - theirs) < 4 * std::sqrt(2.0) * ours.error + rounding / 2);
}

const std::vector<int> tenths{60, 120, 180, 240, 300, 360, 420, 480, 540, 600};

}  // namespace

TEST_CASE("landmarks: every table of the classical loop is what an independent implementation found", "[long]") {
    const Totals totals(resolved(landmark_loop(601)), 4);  // arms: ekf, ideal, fej, riekf, iekf
    const double pose[5][10]{{1.48, 1.82, 1.97, 2.08, 2.18, 2.25, 2.32, 2.39, 2.30, 2.41},
                             {1.02, 1.01, 1.04, 0.98, 1.04, 1.01, 1.03, 1.07, 1.02, 1.04},
                             {1.04, 1.04, 1.07, 1.00, 1.08, 1.04, 1.04, 1.10, 1.05, 1.07},
                             {1.02, 1.01, 1.04, 0.98, 1.05, 1.01, 1.03, 1.07, 1.02, 1.04},
                             {1.12, 1.39, 1.49, 1.54, 1.65, 1.67, 1.72, 1.79, 1.70, 1.78}};
    const double heading[5][10]{{2.37, 3.35, 3.73, 4.20, 4.33, 4.54, 4.72, 4.83, 4.64, 5.03},
                                {1.05, 1.04, 1.10, 1.06, 1.06, 1.01, 1.00, 1.06, 0.97, 1.06},
                                {1.09, 1.08, 1.11, 1.08, 1.11, 1.04, 1.02, 1.10, 1.01, 1.10},
                                {1.05, 1.05, 1.10, 1.06, 1.06, 1.01, 1.00, 1.07, 0.98, 1.06},
                                {1.34, 2.11, 2.38, 2.67, 2.81, 2.89, 2.99, 3.12, 2.94, 3.22}};
    const double full[5][3]{
        {1.67, 1.94, 2.38}, {1.31, 1.08, 1.05}, {1.51, 1.59, 1.87}, {1.06, 1.03, 1.03}, {1.42, 1.50, 1.71}};
    const double error[5][3]{{.0909, .1098, .1141}, {.0654, .0645, .0643}, {.0662, .0655, .0654}, {.0655, .0645, .0645},
                             {.0711, .0898, .0923}};
    const double all_heading[]{.1265, .0806, .0831, .0806, .1052}, all_position[]{1.611, .935, .948, .935, 1.306};
    for (std::size_t arm = 0; arm < 5; ++arm) {
        CAPTURE(arm);
        for (std::size_t i = 0; i < tenths.size(); ++i) {
            CAPTURE(tenths[i]);
            const Mean nees = totals.at(arm, "nees_pose", tenths[i]);
            check({nees.value / 3, nees.error / 3}, pose[arm][i], 0.01);
            check(totals.at(arm, "nees_heading", tenths[i]), heading[arm][i], 0.01);
        }
        for (const int part : {0, 1, 2}) {
            const int k = tenths[part == 0 ? 0 : part == 1 ? 4 : 9];
            CAPTURE(k);
            const Mean nees = totals.at(arm, "nees", k), squared = totals.at(arm, "squared_error_heading", k);
            check({nees.value / 43, nees.error / 43}, full[arm][part], 0.01);
            const double root = std::sqrt(squared.value);
            check({root, squared.error / (2 * root)}, error[arm][part], 1e-4);
        }
        check(totals.root(arm, "squared_error_heading"), all_heading[arm], 1e-4);
        check(totals.root(arm, "squared_error_position"), all_position[arm], 1e-3);
    }
    // NEES of the whole state depends on the chart, that of the pose hardly does.
    const Mean invariant = totals.at(0, "nees_invariant", 600);
    check({invariant.value / 43, invariant.error / 43}, 1.59, 0.01);
    for (std::size_t arm = 0; arm < 5; ++arm)
        for (const int k : tenths)
            CHECK(std::abs(totals.at(arm, "nees_invariant_pose", k).value - totals.at(arm, "nees_pose", k).value) / 3 <
                  0.02);
    // The mark of the effect; a variance varies little from trial to trial.
    CHECK(std::abs(std::sqrt(totals.at(0, "variance_heading", 600).value) - 0.052) < 0.001);
    for (const std::size_t arm : {std::size_t{1}, std::size_t{3}})
        CHECK(std::abs(std::sqrt(totals.at(arm, "variance_heading", 600).value) - 0.063) < 0.001);
}

TEST_CASE("landmarks: under less heading noise the extended Kalman filter loses less", "[long]") {
    struct Row {
        double sigma, ekf, riekf;
    };
    for (const auto& [sigma, ekf, riekf] : {Row{0.001, 0.99, 0.96}, Row{0.01, 1.29, 1.02}, Row{0.02, 1.77, 1.01}}) {
        CAPTURE(sigma);
        ExploreSettings scenario = resolved(landmark_loop(601));
        scenario.noise.heading = sigma;
        scenario.arms.estimators = {Estimator::ekf, Estimator::riekf};
        const Totals totals(scenario, 2);
        check(totals.at(0, "nees_heading", 600), ekf, 0.01);
        check(totals.at(1, "nees_heading", 600), riekf, 0.01);
    }
}

}  // namespace credence::test::landmark_figures_long_test
