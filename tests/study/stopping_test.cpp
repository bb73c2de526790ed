// Stopping at a precision: interim analyses, and the study that grows from one to the next.

#include "catch.hpp"
#include "study_support.hpp"

#include <credence/error.hpp>
#include <credence/statistics.hpp>
#include "study/stopping.hpp"

#include <cmath>
#include <limits>

namespace credence::test::stopping_test {

using Catch::Matchers::WithinRel;

namespace {

const std::vector<double> sample{3.25, -1.5, 7.125, 0.0, 2.0, 2.0, 11.75, -4.0};
const double missing = std::numeric_limits<double>::quiet_NaN();

Moments moments(const std::vector<double>& values) { return moments_of(exact_moments(values)); }

std::vector<StoppingGoal> goals(const std::vector<std::string>& texts) {
    std::vector<StoppingGoal> goals;
    for (const std::string& text : texts) goals.push_back(parse_goal(text));
    return goals;
}

std::vector<std::string> names(const InterimAnalysis& analysis) {
    std::vector<std::string> names;
    for (const GoalState& state : analysis.states) names.push_back(state.name);
    return names;
}

/// An analysis of one sample of this sd, for which `allowed` was requested and not met.
InterimAnalysis one_snapshot(double sd, double allowed, std::int64_t count = 4096) {
    return {4096, 1, analysis_alpha(1), {{"x", count, 0, sd, allowed * 2, allowed}}, false};
}

}  // namespace

TEST_CASE("stopping: analyses are at 4096 trials, then doubled, and at the ceiling") {
    CHECK(analysis_trials(10000) == std::vector<std::int64_t>{4096, 8192, 10000});
    CHECK(analysis_trials(8192) == std::vector<std::int64_t>{4096, 8192});
    CHECK(analysis_trials(100) == std::vector<std::int64_t>{100});
    CHECK(analysis_trials(9, 2) == std::vector<std::int64_t>{2, 4, 8, 9});
    CHECK(analysis_trials(10'000'000).size() == 13);
    CHECK(analysis_trials(std::numeric_limits<std::int64_t>::max()).back() == std::numeric_limits<std::int64_t>::max());
    double spent = 0;
    for (int j = 1; j <= 52; ++j) spent += analysis_alpha(j);
    CHECK(analysis_alpha(1) == 0.025);
    CHECK(spent < 0.05);
}

TEST_CASE("stopping: the half-width is Student's at confidence 1 - 0.05 / 2^j") {
    // t sd / sqrt(8), with 7 degrees of freedom from the closed form of P(|T| <= t) [Abramowitz and Stegun 1964,
    // 26.7.3], solved by bisection. SciPy 1.10 agrees to 3e-9: its t.isf is no more exact there.
    const int analyses[] = {1, 2, 5};
    const double expected[] = {4.986172565902114, 5.853194823490297, 8.777396347882043};
    for (int i = 0; i < 3; ++i) {
        const GoalState state = decide(moments(sample), parse_goal("x=5.9"), analyses[i]);
        CHECK(state.count == 8);
        CHECK_THAT(state.half_width, WithinRel(expected[i], 1e-9));
        CHECK(state.met() == (i < 2));
    }
    CHECK(decide(moments(sample), parse_goal("x=200%"), 1).allowed == 2 * 2.578125);
    std::vector<double> negative;
    for (const double x : sample) negative.push_back(-x);
    CHECK(decide(moments(negative), parse_goal("x=200%"), 1).allowed == 2 * 2.578125);
}

TEST_CASE("stopping: failed trials are left out, and too few values never suffice") {
    std::vector<double> values = sample;
    values.insert(values.begin() + 3, missing);
    CHECK(decide(moments(values), parse_goal("x=1"), 1).half_width ==
          decide(moments(sample), parse_goal("x=1"), 1).half_width);
    CHECK_FALSE(decide(moments({}), parse_goal("x=1e9"), 1).met());
    CHECK_FALSE(decide(moments({1.0}), parse_goal("x=1e9"), 1).met());
    CHECK_FALSE(decide(moments({1.0, missing}), parse_goal("x=1e9%"), 1).met());
    CHECK(decide(moments({0.0, 0.0}), parse_goal("x=1%"), 1).met());  // nothing varies: known exactly
}

TEST_CASE("stopping: an analysis has every arm and scenario, or every pair, of the first trials only") {
    const Study study = small_study(1, 700, 2);
    const InterimAnalysis analysis = analysis_of(study, goals({"trace_P=1%", "unseen[greedy-fixed]=1"}), 512, 3);
    CHECK(analysis.alpha == 0.00625);
    CHECK(names(analysis) == std::vector<std::string>{
        "trace_P of heading-straight/fixed.ekf", "trace_P of heading-straight/greedy.ekf",
        "trace_P of translation-circle/fixed.kf", "trace_P of translation-circle/greedy.kf",
        "unseen of heading-straight/greedy.ekf - fixed.ekf", "unseen of translation-circle/greedy.kf - fixed.kf"});
    const auto& arms = study.scenarios[1].arms;
    std::vector<double> trace(512), difference(512);
    for (std::size_t i = 0; i < 512; ++i) {
        trace[i] = arms[1].columns.in_memory()[column_trace_P][i];
        difference[i] = arms[1].columns.in_memory()[column_unseen][i] - arms[0].columns.in_memory()[column_unseen][i];
    }
    CHECK_THAT(analysis.states[3].mean, WithinRel(summarise(trace).mean, 1e-14));  // rounding of 512 terms
    CHECK_THAT(analysis.states[3].half_width,
               WithinRel(t_quantile(0.00625, 511) * summarise(trace).standard_error, 1e-14));
    CHECK(analysis.states[5].mean == summarise(difference).mean);  // of whole numbers
    CHECK(names(analysis_of(study, goals({"unseen[greedy.kf-fixed]=1"}), 512, 1)).size() == 1);
    CHECK_THROWS_AS(analysis_of(study, goals({"unseen=1"}), 701, 1), std::logic_error);
}

TEST_CASE("stopping: a trial that failed in one arm is in no mean of that arm and in no pair") {
    Study study = small_study(1, 300, 2);
    auto& columns = study.scenarios[0].arms[0].columns.in_memory();
    columns[column_status][7] = static_cast<double>(Status::non_finite);
    columns[column_unseen][7] = -1;  // its fill value, a number
    recount(study.scenarios[0]);
    const InterimAnalysis analysis = analysis_of(study, goals({"unseen=1", "unseen[greedy-fixed]=1"}), 300, 1);
    CHECK(analysis.states[0].count == 299);
    CHECK(analysis.states[1].count == 300);
    CHECK(analysis.states[4].count == 299);
    CHECK(analysis.states[5].count == 300);
    double sum = 0;
    for (std::size_t i = 0; i < 300; ++i) sum += i == 7 ? 0 : columns[column_unseen][i];
    CHECK(analysis.states[0].mean == sum / 299);
}

TEST_CASE("stopping: the number of trials that it takes is predicted from the spread so far") {
    // t sd / sqrt(N) with sd = 1 at analyses 2, 3, 4 ...: 0.02760, 0.02137, 0.01633, 0.01236, 0.00928 (SciPy).
    const StoppingRule rule{{}, 1 << 20};
    CHECK(predicted_trials(one_snapshot(1, 0.0277), rule) == 8192);
    CHECK(predicted_trials(one_snapshot(1, 0.0276), rule) == 16384);
    CHECK(predicted_trials(one_snapshot(1, 0.00927), rule) == 262144);
    CHECK(predicted_trials(one_snapshot(1, 0.0277, 2048), rule) == 32768);   // half of the trials have no value
    CHECK(predicted_trials(one_snapshot(1, 0.0214), {{}, 16000}) == 16384);  // beyond the ceiling
    CHECK(predicted_trials(one_snapshot(1, 0.0217), {{}, 16000}) == 16000);  // or at it: 2.7347 / sqrt(16000) = 0.02162
    CHECK_FALSE(predicted_trials(one_snapshot(1, 1e-10), rule));
    CHECK_FALSE(predicted_trials(one_snapshot(missing, 1, 1), rule));
    InterimAnalysis at_the_ceiling = one_snapshot(1, 0.028, 9000);  // 0.0288 there, and 0.0276 at the analysis before
    at_the_ceiling.trials = 9000;
    at_the_ceiling.number = 3;
    CHECK(predicted_trials(at_the_ceiling, {{}, 9000}) == 16384);
    InterimAnalysis two = one_snapshot(1, 0.0277);
    two.states.push_back({"y", 4096, 0, 1, 0.035, 0.0135});
    two.states.push_back({"z", 4096, 0, 1, 0.035, 0.036});
    CHECK(predicted_trials(two, rule) == 65536);
    CHECK(widest(two).name == "y");
    two.states.push_back({"w", 1, 0, missing, missing, 1});
    CHECK(widest(two).name == "w");
    CHECK_FALSE(predicted_trials(two, rule));
    InterimAnalysis met = one_snapshot(1, 0.036);
    met.met = true;
    met.states[0].half_width = 0.035;
    CHECK(predicted_trials(met, rule) == 4096);
}

TEST_CASE("stopping: a study stops at the first analysis that is precise enough, as computed by hand") {
    const Study all = small_study(1, 2048, 2);
    const auto half_width = [&](std::int64_t trials, int number) {
        const std::vector<double>& column = all.scenarios[0].arms[0].columns.in_memory()[column_trace_P];
        const std::vector<double> first(column.begin(), column.begin() + trials);
        return t_quantile(std::ldexp(0.05, -number), static_cast<double>(trials - 1)) * summarise(first).standard_error;
    };
    // Looks at 256, 512, 1024 and 2000.
    REQUIRE(half_width(256, 1) > 1.05 * half_width(512, 2));
    REQUIRE(half_width(512, 2) > 1.05 * half_width(1024, 3));
    const auto stopped = [&](double width, std::vector<std::int64_t>& analyses) {
        DeformableSettings scenario = small_scenarios()[0];
        scenario.arms.controllers = {Controller::fixed};
        Study study = new_study({scenario}, 1);
        const InterimAnalysis last =
            run_until(study, {goals({"trace_P=" + std::to_string(width)}), 2000, 256}, {0, 2, {}},
                      [&](const InterimAnalysis& analysis) { analyses.push_back(analysis.trials); });
        CHECK(study.scenarios[0].trials == last.trials);  // no trials beyond the analysis
        CHECK(study.complete);
        return last;
    };
    std::vector<std::int64_t> analyses;
    CHECK(stopped(1.01 * half_width(256, 1), analyses).met);
    CHECK(analyses == std::vector<std::int64_t>{256});
    analyses.clear();
    const InterimAnalysis third = stopped(1.01 * half_width(1024, 3), analyses);
    CHECK(third.met);
    CHECK(third.number == 3);
    CHECK_THAT(third.states[0].half_width, WithinRel(half_width(1024, 3), 1e-14));
    CHECK(analyses == std::vector<std::int64_t>{256, 512, 1024});
    analyses.clear();
    const InterimAnalysis ceiling = stopped(0.5 * half_width(2000, 4), analyses);
    CHECK_FALSE(ceiling.met);
    CHECK(ceiling.number == 4);
    CHECK(analyses == std::vector<std::int64_t>{256, 512, 1024, 2000});
    analyses.clear();
    CHECK(stopped(1.01 * half_width(2000, 4), analyses).met);  // the analysis at the ceiling counts too
    CHECK(analyses.back() == 2000);
}

TEST_CASE("stopping: all goals must be met") {
    Study study = new_study(small_scenarios(), 1);
    const StoppingRule rule{goals({"unseen=1", "trace_P=1e-9"}), 300, 64};
    const InterimAnalysis analysis = run_until(study, rule, {0, 2, {}});
    CHECK_FALSE(analysis.met);
    CHECK(analysis.trials == 300);
    CHECK(analysis.states[0].met());
    CHECK(widest(analysis).name.starts_with("trace_P of"));
    CHECK_FALSE(analysis_of(study, goals({"trace_P=1e-9", "unseen=1"}), 300, 1).met);
}

TEST_CASE("stopping: any number of threads and any history stop at the same analysis, with the same study") {
    const StoppingRule rule{goals({"unseen[greedy-fixed]=0.25"}), 3000, 64};
    const auto grown = [&](std::int64_t had, int threads) {
        Study study = new_study(small_scenarios(), 1);
        if (had > 0) run_study(study, {had, 2, {}});
        const InterimAnalysis analysis = run_until(study, rule, {0, threads, {}});
        return std::pair(analysis, study);
    };
    const auto [analysis, study] = grown(0, 1);
    REQUIRE(analysis.met);
    REQUIRE(analysis.number > 1);
    REQUIRE(analysis.trials < 2000);
    for (const int threads : {2, 5}) CHECK(same_results(grown(0, threads).second, study));
    for (const std::int64_t had : {1, 64, 65, 300}) CHECK(same_results(grown(had, 2).second, study));
    const auto [late, longer] = grown(2500, 2);  // more than the analysis needs: the same result, and not reduced
    CHECK(late.trials == analysis.trials);
    CHECK(late.states[0].half_width == analysis.states[0].half_width);
    CHECK(same_results(longer, small_study(1, 2500, 2)));
}

TEST_CASE("stopping: scenarios of different length are first brought to the longest") {
    Study study = new_study(small_scenarios(), 1);
    study.scenarios[1] = small_study(1, 300, 2).scenarios[1];
    const InterimAnalysis analysis = run_until(study, {goals({"unseen=1e9"}), 3000, 64}, {0, 2, {}});
    CHECK(analysis.trials == 64);
    CHECK(same_results(study, small_study(1, 300, 2)));
}

TEST_CASE("stopping: a goal that cannot be evaluated is refused before any trial") {
    Study study = new_study(small_scenarios(), 1);
    CHECK_THROWS_AS(run_until(study, {goals({"trase_P=1"}), 3000, 64}, {0, 2, {}}), InputError);
    CHECK(study.scenarios[0].trials == 0);
}

}  // namespace credence::test::stopping_test
