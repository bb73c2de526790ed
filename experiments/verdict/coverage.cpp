// How often the 95 % interval of NEES/n covers the truth in the worlds of the studies, and how often a verdict on few
// trials claims what that on many denies [docs/theory/statistics.md, Calibration and power].
//
//   verdict_coverage [SHARE]      SHARE of the studies and of the trials, 1 by default
//
// Run in the project's root. The truth of a world is a study of 200,000 trials with a root seed of its own.

#include <credence/consistency.hpp>
#include <credence/evidence.hpp>
#include <credence/ini.hpp>
#include <credence/study.hpp>

#include <boost/math/distributions/binomial.hpp>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

namespace credence::rates {

namespace {

constexpr int sizes[] = {50, 200, 1000}, studies_each = 100, trials_of_truth = 200'000;

/// A scenario file below experiments, and the settings that it gets besides.
struct World {
    std::string file;
    Overrides overrides{};
};

const std::vector<World> worlds{{"seed/kf-straight-constant"},
                                {"seed/kf-straight-ranged"},
                                {"seed/kf-circle-constant"},
                                {"seed/kf-circle-ranged"},
                                {"seed/ekf-straight-constant"},
                                {"seed/ekf-straight-ranged"},
                                {"seed/ekf-circle-constant"},
                                {"seed/ekf-circle-ranged"},
                                {"seed/ekf-circle-ranged", {{"noise.heading", "0.05"}}},
                                {"seed/ekf-circle-ranged", {{"noise.heading", "0.1"}}},
                                {"consistency/matched-linear"},
                                {"consistency/matched-ekf", {{"noise.heading", "0.001"}}},
                                {"consistency/matched-ekf", {{"noise.heading", "0.05"}}},
                                {"consistency/matched-ekf", {{"noise.heading", "0.1"}}}};

/// What one study says of one arm.
struct Said {
    double mean = 0;
    Interval interval;
    Verdict verdict = Verdict::undecided;
};

/// By arm.
std::vector<Said> said_of(const Scenario& scenario, std::uint64_t seed, int trials, int threads) {
    Study study = new_study({scenario}, seed);
    run_study(study, {trials, threads, {}});
    std::vector<Said> all;
    for (const ArmResults& arm : study.scenarios.front().arms) {
        const Evidence evidence = evidence_of(study.scenarios.front(), arm);
        const GroupEvidence& state = evidence.groups.front();
        all.push_back({state.run.mean, over_steps95(state), judge(evidence, Limits()).verdict});
    }
    return all;
}

bool says_above(Verdict word) { return word == Verdict::optimistic || word == Verdict::mixed; }
bool says_below(Verdict word) { return word == Verdict::pessimistic || word == Verdict::mixed; }

/// Whether a verdict claims what the verdict on many trials denies.
bool contradicts(Verdict word, Verdict truth) {
    if (word == Verdict::consistent) return says_above(truth) || says_below(truth);
    return (says_above(word) && !says_above(truth)) || (says_below(word) && !says_below(truth));
}

/// In per cent, with the exact binomial limits of 95 %, one-sided each.
std::string covered_text(int covered, int studies) {
    using Binomial = boost::math::binomial;
    char text[60];
    std::snprintf(text, sizeof text, " %.3g (%.3g to %.3g) |", 100.0 * covered / studies,
                  100 * Binomial::find_lower_bound_on_p(studies, covered, 0.05),
                  100 * Binomial::find_upper_bound_on_p(studies, covered, 0.05));
    return text;
}

void print_rows(const World& world, int studies, int truth_trials) {
    const Scenario scenario = read_scenario("experiments/" + world.file + ".ini", world.overrides);
    std::string name = scenario.name;
    for (const auto& [key, value] : world.overrides) name += ", " + key + " " + value;
    constexpr std::uint64_t seed_of_truth = std::uint64_t{1} << 40;
    const std::vector<Said> truth = said_of(scenario, seed_of_truth, truth_trials, 0);
    std::vector<std::string> covers(truth.size()), contradicted(truth.size());
    for (const int trials : sizes) {
        std::vector<std::vector<Said>> all(static_cast<std::size_t>(studies));
#pragma omp parallel for schedule(dynamic)
        for (std::size_t i = 0; i < all.size(); ++i)
            all[i] = said_of(scenario, static_cast<std::uint64_t>(trials) << 20 | i, trials, 1);
        for (std::size_t arm = 0; arm < truth.size(); ++arm) {
            int covered = 0, wrong = 0;
            for (const std::vector<Said>& one : all) {
                covered += one[arm].interval.low <= truth[arm].mean && truth[arm].mean <= one[arm].interval.high;
                wrong += contradicts(one[arm].verdict, truth[arm].verdict);
            }
            covers[arm] += covered_text(covered, studies);
            contradicted[arm] += (contradicted[arm].empty() ? "" : ", ") + std::to_string(wrong);
        }
    }
    for (std::size_t arm = 0; arm < truth.size(); ++arm)
        std::printf("| %s | %s | %.4f, %s |%s %s |\n", name.c_str(), scenario.arms[arm].c_str(), truth[arm].mean,
                    verdict_name(truth[arm].verdict).c_str(), covers[arm].c_str(), contradicted[arm].c_str());
    std::fflush(stdout);
}

}  // namespace

}  // namespace credence::rates

int main(int argument_count, char** arguments) {
    using namespace credence::rates;
    const double share = argument_count > 1 ? std::atof(arguments[1]) : 1;
    std::printf(
        "| world | arm | NEES/n and verdict of 200,000 trials | covered, N = 50 | N = 200 | N = 1000 | denied |\n"
        "|---|---|---|---|---|---|---|\n");
    for (const World& world : worlds)
        print_rows(world, static_cast<int>(share * studies_each), static_cast<int>(share * trials_of_truth));
}
