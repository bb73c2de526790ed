// What rounding may have changed is left out, and the verdict says why.

#include <cmath>
#include <credence/report.hpp>
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "either_way.hpp"
#include "matched.hpp"
#include "of_scenarios.hpp"

namespace credence::test::conditioning_verdict_test {

using Catch::Contains;

namespace {

/// The exact linear filter, its sensor's sigma given.
ArmReport with_sigma(double sigma, std::int64_t trials, double margin = 0.05) {
    DeformableSettings settings = matched_linear();
    settings.sensor.sigma = sigma;
    Study study = new_study({resolved(settings)}, 1);
    run_study(study, {trials, 0, {}});
    return report_either_way(study, margin).arms.front();
}

}  // namespace

TEST_CASE("conditioning: an exact filter whose P doubles cannot hold is undecided, and says why", "[long]") {
    for (const double sigma : {1e-9, 1e-8}) {
        const ArmReport arm = with_sigma(sigma, 1000);
        CAPTURE(sigma);
        CHECK(arm.consistency.verdict == Verdict::undecided);
        CHECK(arm.consistency.findings.empty());
        REQUIRE_FALSE(arm.consistency.reasons.empty());
        CHECK_THAT(arm.consistency.reasons.front(), Contains("conditioning: NEES of all is left out, because "));
        CHECK(arm.consistency.trials_needed.value == 0);  // more trials cannot help
        CHECK(arm.consistency.suspicions.empty());
        CHECK(std::isnan(arm.evidence.groups.front().run.mean));
        CHECK(std::isfinite(arm.evidence.groups[1].run.mean));  // of the pose, whose own P is well conditioned
    }
}

TEST_CASE("conditioning: rounding that is far below the margin withholds nothing", "[long]") {
    for (const double sigma : {1e-6, 0.1}) {
        const ArmReport arm = with_sigma(sigma, 4000);
        CAPTURE(sigma);
        CHECK(arm.consistency.verdict == Verdict::consistent);
        CHECK(arm.evidence.groups.front().rounding < 1e-4);
    }
    // A wider margin needs less accuracy: rounding may change NEES by some per cent here.
    CHECK(with_sigma(3e-8, 1000).consistency.verdict == Verdict::undecided);
    CHECK(with_sigma(3e-8, 1000, 0.5).consistency.verdict == Verdict::consistent);
}

TEST_CASE("conditioning: what is left out is nothing in JSON, and no number in the text") {
    DeformableSettings settings = matched_linear();
    settings.sensor.sigma = 1e-8;
    Study study = new_study({resolved(settings)}, 1);
    run_study(study, {300, 0, {}});
    const Report report = report_either_way(study, 0.05);
    const auto json = nlohmann::json::parse(report_json(report))[0];
    CHECK(json["groups"][0]["nees_ratio"].is_null());
    CHECK(json["groups"][0]["rounding"].get<double>() > 0.005);
    CHECK(json["nees_ratio"]["mean"].is_null());
    CHECK(json["groups"][1]["nees_ratio"].is_number());
    CHECK_THAT(report_text(report), Contains("conditioning: NEES of all") && !Contains("nan"));
    CHECK_THAT(report_html(report, {"r.h5", {}, "test"}), Contains("conditioning: NEES of all") && !Contains(">nan"));
    CHECK_THAT(report_csv(report),
               Contains(",nees_per_dimension:all,1,,,,,") && Contains(",nees_rounding:features,1,0."));
}

}  // namespace credence::test::conditioning_verdict_test
