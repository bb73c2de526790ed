// Arms and runs compared trial by trial: the numbers, their signs, ties, and failed trials.

#include <algorithm>
#include <nlohmann/json.hpp>

#include "compare_support.hpp"
#include "oracle/oracle.hpp"
#include "store_study.hpp"
#include "study_support.hpp"
#include "worlds/explore/explore.hpp"

namespace credence::test::compare_test {

using Catch::Contains;
using Catch::StartsWith;
using Json = nlohmann::json;

TEST_CASE("compare: every number is computed from the columns") {
    const Study study = small_study(1, 300, 1);
    const CompareReport report = compared({{"small.h5", study}});
    REQUIRE(report.pairs.size() == 2);
    for (std::size_t s = 0; s < 2; ++s) {
        const ComparedPair& pair = report.pairs[s];
        const std::vector<ArmResults>& arms = study.scenarios[s].arms;
        CHECK(pair.comparison.name() == arms[1].name + " - " + arms[0].name);
        CHECK(pair.pairs() == 300);
        REQUIRE(pair.comparison.columns.size() == 8);
        for (std::size_t c = 0; c < 8; ++c) {
            const std::vector<double>&a = arms[1].columns.in_memory()[c], &b = arms[0].columns.in_memory()[c];
            std::vector<double> difference(300);
            double below = 0, above = 0;
            for (std::size_t i = 0; i < 300; ++i) difference[i] = a[i] - b[i], below += a[i]<b[i], above += a[i]> b[i];
            const PairedComparison& paired = pair.comparison.columns[c].paired;
            const double variance = variance_of(difference);
            // Sums of 300 numbers of one size lose some 1e-14 of it; differences are up to 1e-3 of what they are of.
            CHECK(paired.difference.mean == Approx(mean_of(difference)).epsilon(1e-10).margin(1e-15));
            CHECK(paired.difference.standard_deviation == Approx(std::sqrt(variance)).epsilon(1e-10));
            CHECK(paired.effect_size == Approx(mean_of(difference) / std::sqrt(variance)).epsilon(1e-9).margin(1e-12));
            CHECK(paired.variance_reduction == Approx((variance_of(a) + variance_of(b)) / variance).epsilon(1e-9));
            CHECK(paired.wins_a == below / 300);
            CHECK(paired.wins_b == above / 300);
            CHECK(pair.a.mean[c] == Approx(mean_of(a)).epsilon(1e-12));
            CHECK(pair.b.mean[c] == Approx(mean_of(b)).epsilon(1e-12));
        }
    }
    // The same to the last bit as in a report beside the arms.
    const std::vector<Comparison> reported = planned_against_baselines(study.scenarios, study.root_seed);
    for (std::size_t s = 0; s < 2; ++s)
        for (std::size_t c = 0; c < 8; ++c) {
            CHECK(reported[s].columns[c].paired.bootstrap95.low ==
                  report.pairs[s].comparison.columns[c].paired.bootstrap95.low);
            CHECK(reported[s].columns[c].holm_p == report.pairs[s].comparison.columns[c].holm_p);
        }
}

TEST_CASE("compare: arms the other way round turn every sign") {
    const Study study = small_study(1, 300, 1);
    const CompareReport one = compared({{"s.h5", study}}, "greedy,fixed"),
                        other = compared({{"s.h5", study}}, "fixed, greedy");
    REQUIRE(other.pairs.size() == 2);
    for (std::size_t s = 0; s < 2; ++s)
        for (int c = 0; c < 8; ++c) {
            const PairedComparison &p = of(one.pairs[s], c), &q = of(other.pairs[s], c);
            CHECK(q.difference.mean == -p.difference.mean);
            CHECK(q.difference.ci95.low == -p.difference.ci95.high);
            CHECK(q.difference.median == Approx(-p.difference.median).margin(1e-15));
            CHECK(q.wins_a == p.wins_b);
            CHECK(q.ties == p.ties);
            CHECK(q.wilcoxon_z == Approx(-p.wilcoxon_z).epsilon(1e-12).margin(1e-12));
            CHECK(q.effect_size == -p.effect_size);
            CHECK(q.variance_reduction == Approx(p.variance_reduction).epsilon(1e-12));
            CHECK(one.pairs[s].a.mean[static_cast<std::size_t>(c)] ==
                  other.pairs[s].b.mean[static_cast<std::size_t>(c)]);
        }
    const auto turned = [](Conclusion c) {
        return c == Conclusion::lower ? Conclusion::higher : c == Conclusion::higher ? Conclusion::lower : c;
    };
    for (std::size_t s = 0; s < 2; ++s) CHECK(other.pairs[s].conclusion == turned(one.pairs[s].conclusion));
}

TEST_CASE("compare: a study and the same world with filter.measurement=0.8") {
    const CompareReport report =
        compared({{"runs/right.h5", run({matched()}, 1, 2000)},
                  {"runs/wrong.h5", run({changed(matched(), "filter.measurement", "0.8")}, 1, 1500)}});
    REQUIRE(report.pairs.size() == 2);
    const ComparedPair& pair = report.pairs.front();
    CHECK(pair.comparison.name() == "wrong:fixed.kf - right:fixed.kf");
    CHECK(pair.trials == 1500);
    CHECK(pair.a.trials == 1500);
    CHECK(pair.b.trials == 2000);
    REQUIRE(pair.differences.size() == 1);
    CHECK(pair.differences[0].key == "filter.measurement");
    CHECK(pair.differences[0].a == "0.8");
    CHECK(pair.differences[0].b == "1");
    // An independent implementation has NEES/n 1.382 +- 0.006 (1,500 trials) and 1 exactly: 4 standard
    // errors are exceeded with 6e-5.
    // The log score leads, so that each of the others comes one place later.
    const Summary& nees = of(pair, column_nees_ratio + 1).difference;
    CHECK(std::abs(nees.mean - 0.382) < 4 * std::hypot(nees.standard_error, 0.006));
    // P is the same in every trial, and the oracle's.
    const oracle::Noise none{[](Source, int, int) { return Eigen::Vector2d(0, 0); },
                             [](Source, int, int) { return 0.0; }};
    const double expected =
        oracle::run(changed(matched(), "filter.measurement", "0.8"), Controller::fixed, none).trace_P -
        oracle::run(matched(), Controller::fixed, none).trace_P;
    REQUIRE(expected < 0);
    CHECK(of(pair, column_trace_P + 1).difference.mean == Approx(expected).epsilon(1e-9));
    CHECK(of(pair, column_trace_P + 1).wins_a == 1);
    // Of two filters the smaller trace(P) proves nothing: the score of the one that believes too much is worse.
    CHECK(pair.comparison.columns.front().name == "log_score");
    CHECK(pair.conclusion == Conclusion::higher);
    CHECK_THAT(compare_text(report),
               Contains("1500 pairs, of the 1500 trials that both have: A has 1500, B has 2000") &&
                   Contains("they differ in filter.measurement (0.8 in A, 1 in B)") &&
                   Contains("log score (lower is better): wrong:fixed.kf is higher than right:fixed.kf by "));
}

TEST_CASE("compare: a difference that is the same in every trial has no spread, whatever their number") {
    Study study = new_study({matched()}, 1);
    extend(study.scenarios[0], 41);
    const double d = 0.1;  // the sum of 41 of them, rounded, over 41 is another number
    for (std::size_t arm = 0; arm < 2; ++arm)
        for (std::size_t c = 0; c < 8; ++c)
            std::ranges::fill(study.scenarios[0].arms[arm].columns.in_memory()[c], arm == 1 ? d : 0);
    const CompareReport report = compared({{"constant.h5", study}});
    CHECK(of(report.pairs[0], 0).difference.mean == d);
    CHECK(of(report.pairs[0], 0).difference.standard_deviation == 0);
    CHECK(std::isinf(of(report.pairs[0], 0).effect_size));
    CHECK(std::isnan(of(report.pairs[0], 0).variance_reduction));
    CHECK(report.pairs[0].conclusion == Conclusion::higher);
}

TEST_CASE("compare: in the matched translation world both arms see and are the same") {
    const CompareReport report = compared({{"matched.h5", run({matched()}, 1, 200)}});
    REQUIRE(report.pairs.size() == 1);
    CHECK(report.pairs[0].conclusion == Conclusion::equal);
    for (int c = 0; c < 8; ++c) {
        const PairedComparison& paired = of(report.pairs[0], c);
        CHECK(paired.ties == 1);
        CHECK(paired.difference.mean == 0);
        CHECK(paired.wilcoxon_p == 1);
        CHECK(report.pairs[0].comparison.columns[static_cast<std::size_t>(c)].holm_p == 1);
    }
    const std::string text = compare_text(report);
    CHECK_THAT(text, Contains("trace_P: greedy.kf and fixed.kf are equal in every trial") &&
                         Catch::Matches("[^]*100 % +- +1 [^]*"));
    CHECK_THAT(text, !Contains("nan"));
    const Json json = Json::parse(compare_json(report));
    CHECK(json[0]["conclusion"] == "equal");
    CHECK(json[0]["trace_P"]["wilcoxon_z"].is_null());
    CHECK(json[0]["trace_P"]["effect_size"].is_null());
    CHECK_THAT(compare_csv(report), !Contains("nan"));
}

TEST_CASE("compare: trials that failed in one arm are no pairs, and the text says so first") {
    Study study = small_study(1, 300, 1);
    fail_trials(study.scenarios[0], 0, 0, 20);
    fail_trials(study.scenarios[0], 1, 10, 20);
    study.scenarios[0].arms[0].columns.in_memory()[column_status][100] = static_cast<double>(Status::diverged);
    recount(study.scenarios[0]);
    const CompareReport report = compare_studies({{"failed.h5", study}}, std::nullopt);
    const ComparedPair& pair = report.pairs[0];
    CHECK(pair.pairs() == 270);
    CHECK(pair.a.failed == 20);
    CHECK(pair.b.failed == 20);
    CHECK(pair.b.diverged == 1);
    for (std::size_t c = 0; c < 8; ++c)
        CHECK(pair.a.mean[c] - pair.b.mean[c] ==
              Approx(of(pair, static_cast<int>(c)).difference.mean).epsilon(1e-9).margin(1e-12));
    const std::string text = compare_text(report);
    CHECK_THAT(text, Contains("A - B, trial by trial: 270 to 300 pairs in each of 2 comparisons") &&
                         Contains("WARNING: 20 of 300 trials of heading-straight/greedy.ekf failed") &&
                         Contains("note: 1 trial of heading-straight/fixed.ekf diverged"));
    CHECK(text.find("WARNING") < text.find("trace_P:"));
    fail_trials(study.scenarios[0], 0, 0, 300);
    const CompareReport none =
        compare_studies({{"failed.h5", study}}, read_arms("greedy.ekf,fixed.ekf", {"failed.h5"}));
    CHECK_THAT(compare_text(none), Contains("no pairs, nothing to compare") && !Contains("nan"));
    CHECK(Json::parse(compare_json(none))[0]["trace_P"]["mean"].is_null());
    CHECK_THAT(compare_csv(none), Contains("heading-straight,greedy.ekf,fixed.ekf,trace_P,dm^2 + rad^2,0,,,,,"));
}

TEST_CASE("compare: the conclusion names every column that differs, and the JSON lists them by their direction") {
    Study study = new_study({matched()}, 1);
    extend(study.scenarios[0], 400);
    auto& planned = study.scenarios[0].arms[1].columns.in_memory();
    auto& fixed = study.scenarios[0].arms[0].columns.in_memory();
    for (std::size_t i = 0; i < 400; ++i) {
        const auto number = static_cast<double>(i);
        fixed[column_trace_P][i] = planned[column_trace_P][i] = number;
        fixed[column_unseen][i] = 3, planned[column_unseen][i] = i % 2 == 0 ? 0 : 1;
        fixed[column_path_length][i] = number;
        planned[column_path_length][i] = number + 0.01 * static_cast<double>(1 + i % 3);
        fixed[column_pose_error][i] = 1, planned[column_pose_error][i] = i % 2 == 0 ? 0 : 2;  // no difference
    }
    const CompareReport report = compared({{"made-up.h5", study}});
    std::string text = compare_text(report);
    for (std::size_t at; (at = text.find("\n    ")) != std::string::npos;) text.replace(at, 5, " ");
    CHECK_THAT(text, Contains("equal in every trial; pose_error: no difference shown (greedy.kf - fixed.kf is 0.0") &&
                         Catch::Matches("[^]*; verdicts: greedy.kf [a-z]+, fixed.kf [a-z]+; besides, greedy.kf has "
                                        "unseen lower by 2.5[^]*, path_length higher by 0.0[^]*"));
    const Json json = Json::parse(compare_json(report))[0];
    CHECK(json["conclusions"] == Json({{"pose_error", "no difference shown"}}));
    CHECK(json["of_a"]["verdict"] == verdict_name(report.pairs[0].a.verdict.value()));
    CHECK(json["lower"] == Json::array({"unseen"}));
    CHECK(json["higher"] == Json::array({"path_length"}));
}

TEST_CASE("compare: failures are concluded on before means, few pairs by their signs, and carriers are named") {
    Study study = new_study({matched()}, 1);
    extend(study.scenarios[0], 300);
    auto& planned = study.scenarios[0].arms[1].columns.in_memory();
    auto& fixed = study.scenarios[0].arms[0].columns.in_memory();
    std::ranges::fill(fixed[column_trace_P], 1);
    const auto said = [&](std::size_t failed, std::size_t pairs, auto difference) {
        for (std::size_t i = 0; i < 300; ++i) {
            planned[column_trace_P][i] = 1 + difference(i);
            planned[column_status][i] = static_cast<double>(i < failed ? Status::non_finite : Status::completed);
            fixed[column_status][i] =
                static_cast<double>(i < failed + pairs ? Status::completed : Status::non_finite);
        }
        recount(study.scenarios[0]);
        const CompareReport report = compared({{"made-up.h5", study}});
        const Json json = Json::parse(compare_json(report))[0];
        CHECK_THAT(compare_html(report, "test"), Contains(json["conclusion_of_mean"] == "lower" ? "is lower" : "A"));
        std::string text = compare_text(report);
        for (std::size_t at; (at = text.find("\n    ")) != std::string::npos;) text.replace(at, 5, " ");
        return json["conclusion"].get<std::string>() + ", " + json["conclusion_of_mean"].get<std::string>() + "; " +
               text;
    };
    const auto lower = [](std::size_t i) { return i % 5 == 0 ? 0.1 : -1.0 - 0.01 * static_cast<double>(i % 7); };
    CHECK_THAT(said(13, 287, lower),
               StartsWith("fails more often, lower; ") &&
                   Contains("greedy.kf fails or diverges more often than fixed.kf, in 13 of 300 (4 %) trials against 0 "
                            "of 300 (0 %) (Fisher p 2e-04); trace_P: greedy.kf is lower"));
    CHECK_THAT(said(7, 293, lower), StartsWith("lower, lower; ") && !Contains("fails or"));  // p 0.015
    CHECK_THAT(said(0, 20, lower), StartsWith("fails less often, lower; "));                 // signs: p 0.012
    CHECK_THAT(said(0, 10, lower), StartsWith("fails less often, too few to conclude; ") &&  // signs: p 0.11
                                       Contains("too few pairs to conclude (greedy.kf - fixed.kf is -0.8") &&
                                       Contains("; the sign test has p 0.109"));
    CHECK_THAT(said(0, 300, [](std::size_t i) { return i == 7 ? -900 : 1 + 0.001 * static_cast<double>(i); }),
               StartsWith("no difference shown, ") &&
                   Contains("; the median has the other sign: 1 of 300 trials carry the mean (7)"));
    CHECK_THAT(said(0, 300, [](std::size_t i) { return i % 4 == 0 ? -9 - 0.01 * static_cast<double>(i) : 1.0; }),
               StartsWith("lower, lower; ") && Contains(" carry the mean (296, 292, 288, 284, 280, ...)"));
}

TEST_CASE("compare: in explore two paths differ in trace(P), pose error and coverage, at one shared level") {
    ExploreSettings settings;
    settings.poses = 9;
    settings.explorers = {Explorer::frontier, Explorer::greedy};
    Study study = new_study({scenario_of(resolved(settings))}, 4);
    run_study(study, {120, 1, {}});
    const CompareReport report = compared({{"explore.h5", study}}, "greedy,frontier");
    const ComparedPair& pair = report.pairs.at(0);
    REQUIRE(pair.further.size() == 2);
    CHECK(pair.comparison.columns[0].name == "trace_P");
    CHECK(pair.comparison.columns[pair.further[0].first].name == "pose_error");
    CHECK(pair.comparison.columns[pair.further[1].first].name == "coverage");
    // 4 % are shared by three conclusions: half of 1 - 0.04/3 on either side of Student's law with 119 degrees.
    const double quantile = 2.5123;  // scipy.stats.t.ppf(1 - 0.02 / 3, 119)
    const auto expected = [&](std::size_t c) {
        const Summary& difference = pair.comparison.columns[c].paired.difference;
        const double half = quantile * difference.standard_error;
        return difference.mean + half < 0   ? Conclusion::lower
               : difference.mean - half > 0 ? Conclusion::higher
                                            : Conclusion::not_shown;
    };
    CHECK(pair.conclusion == expected(0));
    for (const auto& [column, conclusion] : pair.further) CHECK(conclusion == expected(column));
    CHECK(pair.further[1].second == Conclusion::lower);  // greedy stays where its trace is small
    const Json json = Json::parse(compare_json(report))[0];
    CHECK(json["conclusions"]["coverage"] == "lower");
    // A difference that is certain by itself is not where it shares the level.
    Study made = study;
    auto& arms = made.scenarios[0].arms;
    const std::size_t coverage = pair.further[1].first;
    for (std::size_t i = 0; i < 120; ++i) {
        auto &greedy = arms[1].columns.in_memory()[coverage], &frontier = arms[0].columns.in_memory()[coverage];
        greedy[i] = frontier[i] + (i % 2 == 0 ? 1 : -1) + 0.21;  // 2.3 standard errors
    }
    const ComparedPair again = compared({{"made-up.h5", made}}, "greedy,frontier").pairs.at(0);
    CHECK(again.comparison.columns[coverage].paired.difference.ci95.low > 0);
    CHECK(again.further[1].second == Conclusion::not_shown);
}

TEST_CASE("compare: what is not shown is said so, and ranks against the mean are not hidden") {
    Study study = new_study({matched()}, 1);
    extend(study.scenarios[0], 400);
    auto& planned = study.scenarios[0].arms[1].columns.in_memory()[column_trace_P];
    auto& fixed = study.scenarios[0].arms[0].columns.in_memory()[column_trace_P];
    const auto conclusion = [&](auto difference) {
        for (std::size_t i = 0; i < 400; ++i) fixed[i] = 1, planned[i] = 1 + difference(i);
        const CompareReport report = compared({{"made-up.h5", study}});
        std::string text = compare_text(report);
        const std::size_t begin = text.find("trace_P: ");
        // Wrapped.
        if (const std::size_t at = text.find("\n    ", begin); at < text.find("\n\n", begin)) text.replace(at, 5, " ");
        return conclusion_name(report.pairs[0].conclusion) + "; " + text.substr(begin, text.find('\n', begin) - begin);
    };
    const auto odd = [](std::size_t i) { return i % 2 == 0 ? 1.0 : -1.0; };
    CHECK_THAT(conclusion(odd),
               Contains("no difference shown (greedy.kf - fixed.kf is 0.000 [-0.098, 0.098])") && !Contains("yet"));
    // Three quarters of the trials are a little lower, one is much higher.
    CHECK_THAT(conclusion([](std::size_t i) { return i == 7       ? 30
                                                     : i % 4 == 0 ? 0.01
                                                                  : -0.1; }),
               Contains("no difference shown") && Contains("yet greedy.kf is lower in 75 % of trials (p "));
    // Three quarters are lower by little, the others are higher by much.
    CHECK_THAT(conclusion([](std::size_t i) { return i % 4 == 0 ? 3 + 0.001 * static_cast<double>(i) : -0.1; }),
               Contains("higher; ") && Contains("on average, though only in 25 % of trials"));
    CHECK_THAT(conclusion([](std::size_t i) { return i % 4 == 0 ? -0.5 - 0.001 * static_cast<double>(i) : 0.0; }),
               Contains("lower; ") && Contains(", in 25 % of trials (equal in 75 %)"));
}

}  // namespace credence::test::compare_test
