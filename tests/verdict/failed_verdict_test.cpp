// The verdict `failed`: a filter that fails in more than the stated share of its trials is nothing else.

#include <credence/consistency.hpp>
#include <credence/report.hpp>

#include "either_way.hpp"
#include "judgement_support.hpp"
#include "program.hpp"
#include "study_support.hpp"
#include "synthetic.hpp"

#include <cmath>
#include <limits>

namespace credence::test::failed_verdict_test {

using Catch::Contains;

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
constexpr std::size_t trials = 1000, steps = 10, n = 2;
Limits limits(double failed = 0.01) { return {0.15, failed}; }

/// A record of a filter whose covariances are right: consistent within 15 %.
struct Values {
    std::vector<double> error, covariance, innovation, innovation_covariance;
    std::vector<std::int32_t> declared;

    Values() {
        Normals normals(7);
        for (std::size_t i = 0; i < trials * steps * n; ++i)
            error.push_back(normals()), innovation.push_back(normals());
        for (std::size_t i = 0; i < trials * steps; ++i) covariance.insert(covariance.end(), {1, 0, 0, 1});
        innovation_covariance = covariance;
    }
    void write(const std::string& path) const {
        write_plain_record(path, [&](const Handle& root) {
            for (const char* name : {"error", "innovation"})
                replace<double>(root, name, {trials, steps, n}, *(name[0] == 'e' ? &error : &innovation));
            for (const char* name : {"covariance", "innovation_covariance"})
                replace<double>(root, name, {trials, steps, n, n},
                                *(name[0] == 'c' ? &covariance : &innovation_covariance));
            if (!declared.empty())
                hdf5::write_dataset(root, "steps", hdf5::type_of<std::int32_t>(), declared.data(), {trials}, {"", ""});
        });
    }
};

std::size_t vector_at(std::size_t trial, std::size_t step) { return (trial * steps + step) * n; }
std::size_t matrix_at(std::size_t trial, std::size_t step) { return vector_at(trial, step) * n; }

void fill(std::vector<double>& values, std::size_t first, std::size_t count, double value) {
    std::fill_n(values.begin() + static_cast<std::ptrdiff_t>(first), count, value);
}

void set_matrix(std::vector<double>& values, std::size_t trial, std::vector<double> matrix) {
    std::copy(matrix.begin(), matrix.end(), values.begin() + static_cast<std::ptrdiff_t>(matrix_at(trial, 2)));
}

/// Cuts a trial after two steps.
void cut(Values& v, std::size_t t) {
    fill(v.error, vector_at(t, 2), (steps - 2) * n, nan);
    fill(v.covariance, matrix_at(t, 2), (steps - 2) * n * n, nan);
}

/// A way in which a trial fails.
struct FailingTrial {
    std::string what;
    std::function<void(Values&, std::size_t trial)> apply;
};

const std::vector<FailingTrial> failing{
    {"ends early", cut},
    {"error NaN", [](Values& v, std::size_t t) { fill(v.error, vector_at(t, 2), n, nan); }},
    {"error NaN in one component", [](Values& v, std::size_t t) { v.error[vector_at(t, 3)] = nan; }},
    {"error infinite", [](Values& v, std::size_t t) { v.error[vector_at(t, 0)] = -infinite; }},
    {"covariance NaN", [](Values& v, std::size_t t) { fill(v.covariance, matrix_at(t, 2), n * n, nan); }},
    {"covariance NaN to the end",
     [](Values& v, std::size_t t) { fill(v.covariance, matrix_at(t, 2), (steps - 2) * n * n, nan); }},
    {"covariance infinite", [](Values& v, std::size_t t) { v.covariance[matrix_at(t, 3)] = infinite; }},
    {"covariance singular",
     [](Values& v, std::size_t t) {
         set_matrix(v.covariance, t, {1, 1, 1, 1});
     }},
    {"covariance 0",
     [](Values& v, std::size_t t) {
         set_matrix(v.covariance, t, {0, 0, 0, 0});
     }},
    {"covariance indefinite",
     [](Values& v, std::size_t t) {
         set_matrix(v.covariance, t, {1, 2, 2, 1});
     }},
    {"covariance negative",
     [](Values& v, std::size_t t) {
         set_matrix(v.covariance, t, {-1, 0, 0, -1});
     }},
    {"innovation infinite", [](Values& v, std::size_t t) { v.innovation[vector_at(t, 1)] = infinite; }},
    {"S NaN", [](Values& v, std::size_t t) { v.innovation_covariance[matrix_at(t, 1)] = nan; }},
    {"S singular",
     [](Values& v, std::size_t t) {
         set_matrix(v.innovation_covariance, t, {1, 1, 1, 1});
     }},
    {"S negative",
     [](Values& v, std::size_t t) {
         set_matrix(v.innovation_covariance, t, {-1, 0, 0, -1});
     }},
    {"no step", [](Values& v, std::size_t t) { fill(v.error, vector_at(t, 0), steps * n, nan); }},
};

/// The record with a failure in its first `count` trials.
Evidence evidence_with(const FailingTrial& failure, std::size_t count) {
    const TemporaryFolder folder;
    Values values;
    for (std::size_t trial = 0; trial < count; ++trial) failure.apply(values, trial);
    values.write(folder / "record.h5");
    const Record record = read_record(folder / "record.h5");
    CHECK(record.trouble_count == static_cast<std::int64_t>(count));
    return evidence_of(record.results, record.results.arms.front());
}

/// A study whose first arm has so many trials that ended like that.
Study with_statuses(std::size_t failed, std::size_t diverged) {
    Study study = small_study(1, 100, 1);
    std::vector<double>& status = study.scenarios.front().arms.front().columns.in_memory()[column_status];
    for (std::size_t i = 0; i < failed + diverged; ++i)
        status[i] = static_cast<double>(i < failed ? Status::covariance_not_positive_definite : Status::diverged);
    recount(study.scenarios.front());
    return study;
}

}  // namespace

TEST_CASE("failed: no record with more failed trials than the share is consistent, however they fail") {
    CHECK(judge(evidence_with(failing.front(), 0), limits(0)).verdict == Verdict::consistent);
    for (const FailingTrial& failure : failing) {
        CAPTURE(failure.what);
        const Evidence one = evidence_with(failure, 1), ten = evidence_with(failure, 10),
                       most = evidence_with(failure, 990);
        CHECK(judge(one, limits()).verdict == Verdict::consistent);
        CHECK(judge(one, limits(0)).verdict == Verdict::failed);
        CHECK(judge(ten, limits(0.01)).verdict == Verdict::consistent);  // exactly the share is not above it
        CHECK(judge(ten, limits(0.0099)).verdict == Verdict::failed);
        CHECK(judge(most, limits()).verdict == Verdict::failed);
        CHECK(judge(most, limits(0.98)).verdict == Verdict::failed);
        CHECK(judge(most, limits(1)).verdict != Verdict::failed);
    }
}

TEST_CASE("failed: the verdict takes precedence over the other trials and over every finding") {
    for (const double scale : {0.1, 1.0, 10.0}) {
        const FailingTrial failure{"errors of another size, and a tenth of the trials cut",
                                   [&](Values& v, std::size_t t) {
                                       if (t < 100) return cut(v, t);
                                       for (std::size_t i = 0; i < steps * n; ++i)
                                           v.error[vector_at(t, 0) + i] *= scale;
                                   }};
        const TemporaryFolder folder;
        Values values;
        for (std::size_t trial = 0; trial < trials; ++trial) failure.apply(values, trial);
        values.write(folder / "record.h5");
        const Record record = read_record(folder / "record.h5");
        const Evidence evidence = evidence_of(record.results, record.results.arms.front());
        CHECK(evidence.left_out == 100);
        CHECK((evidence.diverged > 500) == (scale > 1));
        const Consistency with = judge(evidence, limits()), without = judge(evidence, limits(1));
        CHECK(with.verdict == Verdict::failed);
        CHECK(without.verdict == (scale < 1   ? Verdict::pessimistic
                                  : scale > 1 ? Verdict::optimistic
                                              : Verdict::consistent));
        CHECK(with.findings.size() == without.findings.size());
        CHECK(with.trials_needed.value == 0);
    }
}

TEST_CASE("failed: a trial that ends early has not failed where the dataset `steps` declares its end") {
    const TemporaryFolder folder;
    Values values;
    for (std::size_t trial = 0; trial < 900; ++trial) cut(values, trial);
    values.error[vector_at(0, 3)] = infinite;  // behind the end: not looked at
    values.declared.assign(trials, static_cast<std::int32_t>(steps));
    std::fill_n(values.declared.begin(), 900, 2);
    values.write(folder / "record.h5");
    const Record record = read_record(folder / "record.h5");
    CHECK(record.trouble_count == 0);
    std::vector<std::int64_t> present(steps, 100);
    present[0] = present[1] = 1000;
    CHECK(record.results.arms.front().totals.present == present);
    CHECK(judge(evidence_of(record.results, record.results.arms.front()), limits()).verdict == Verdict::consistent);
    values.declared.assign(trials, static_cast<std::int32_t>(steps));
    values.write(folder / "record.h5");
    CHECK(read_record(folder / "record.h5").trouble_count == 900);
}

TEST_CASE("failed: diverged trials count, and every failed trial is in the first line of the arm") {
    const Report report = report_either_way(with_statuses(1, 2), 0.05);
    const ArmReport& arm = report.arms.front();
    CHECK(arm.failed == 1);
    CHECK(arm.diverged == 2);
    CHECK(arm.consistency.verdict == Verdict::failed);  // 3 of 100 are more than 1 %
    CHECK(report_either_way(with_statuses(1, 0), 0.05).arms.front().consistency.verdict != Verdict::failed);
    CHECK(report_either_way(with_statuses(1, 2), {0.05, 0.03}).arms.front().consistency.verdict != Verdict::failed);

    const std::string text = report_text(report), row = text.substr(text.find("  heading-straight/fixed.ekf"));
    CHECK_THAT(
        text,
        Contains(
            "WARNING: 3 of 100 trials of heading-straight/fixed.ekf failed or diverged; 1 of them are left out of "
            "its numbers.\nnote: 2 trials of heading-straight/fixed.ekf diverged (NEES/dim over the run beyond 25): "
            "left out of the verdict,"));
    CHECK_THAT(row.substr(0, row.find('\n')), Contains(" failed ") && Catch::EndsWith(" 3 (at most 7.6 %)"));
    CHECK_THAT(row, Contains("\n      3 of 100 trials failed or diverged, more than 1 %: 2 with status diverged\n"));
    const Json json = Json::parse(report_json(report));
    CHECK(json[0]["verdict"] == "failed");
    CHECK(json[0]["failed"] == 1);
    CHECK(json[0]["failed_trials"] == 3);
    CHECK(json[0]["reason"] == "3 of 100 trials failed or diverged, more than 1 %: 2 with status diverged");
    CHECK_THAT(report_csv(report), Contains("heading-straight,fixed.ekf,100,1,trace_P,") && Contains(",failed,3\n"));
    const std::string page = report_html(report, {"r.h5", {}, "test"});
    CHECK_THAT(page, Contains("<span class=\"badge failed\">") && Contains("3 of 100 trials failed or diverged") &&
                         Contains(">at most 7.6 %</data> of all"));
    CHECK_THROWS_WITH(require(report, Requirement::consistent), Contains("heading-straight/fixed.ekf failed, "));
}

TEST_CASE("failed: means and series are of diverged trials, too, and what the verdict has stands beside them") {
    // The heading is not observable; about a quarter of the trials diverge.
    Study study = new_study({scenario_with({{"scenario.poses", "101"}, {"features.path", "static"},
                                            {"sensor.range_max", "inf"}, {"noise.heading", "0.05"},
                                            {"truth.deformation", "walk"}, {"edges.graph", "none"},
                                            {"control.path", "circle"}, {"arms.controllers", "fixed"}})}, 1);
    run_study(study, {100, 1, {}});
    const TemporaryFolder folder;
    Values values;
    for (std::size_t i = 0; i < 5 * steps * n; ++i) values.error[i] *= 100;
    values.write(folder / "record.h5");
    const Record record = read_record(folder / "record.h5");
    const Report reports[] = {report_either_way(study, 0.05), make_record_report(record, "record.h5", 0.05)};
    for (const Report& report : reports) {
        const ArmReport& arm = report.arms.front();
        const GroupEvidence& state = arm.evidence.groups.front();
        const ScenarioResults& results = &report == reports ? study.scenarios.front() : record.results;
        const std::size_t status = status_column(results.columns);
        const auto nees = static_cast<std::size_t>(
            std::ranges::find(results.columns, "nees_ratio", &Column::name) - results.columns.begin());
        std::vector<double> all = column_values(results, results.arms.front(), nees), others;
        const std::vector<double> ended = column_values(results, results.arms.front(), status);
        for (std::size_t i = 0; i < all.size(); ++i)
            if (ended[i] == 0) others.push_back(all[i]);
        CHECK(arm.diverged == std::ssize(all) - std::ssize(others));
        CHECK(state.run.mean == Approx(moments_of(exact_moments(all)).mean).epsilon(1e-12));
        CHECK(moments_of(exact_moments(state.anees.ratio)).mean == Approx(state.run.mean).epsilon(1e-12));
        CHECK(state.without_diverged.mean == Approx(moments_of(exact_moments(others)).mean).epsilon(1e-12));
        CHECK(state.without_diverged.mean < state.run.mean / 1.5);
        CHECK(Json::parse(report_json(report))[0]["groups"][0]["without_diverged"]["nees_ratio"] ==
              state.without_diverged.mean);
        CHECK_THAT(report_csv(report), Contains(",nees_per_dimension_without_diverged:all,1,"));
        CHECK_THAT(report_html(report, {"r.h5", {}, "test"}),
                   Contains("all without diverged trials") && Contains("left out of the verdict, which has NEES/dim"));
    }
}

TEST_CASE("failed: where most trials diverged they are judged, and counted all the same") {
    const Report of_study = report_either_way(with_statuses(1, 60), 0.05);
    const TemporaryFolder folder;
    Values values;
    for (std::size_t trial = 0; trial < 600; ++trial)
        for (std::size_t i = 0; i < steps * n; ++i) values.error[vector_at(trial, 0) + i] *= 100;
    cut(values, 999);
    values.write(folder / "record.h5");
    const Report of_record = make_record_report(read_record(folder / "record.h5"), "record.h5", 0.05);
    for (const Report* report : {&of_study, &of_record}) {
        const ArmReport& arm = report->arms.front();
        const std::int64_t diverged = report == &of_study ? 60 : 600;
        CHECK(arm.failed == 1);
        CHECK(arm.diverged == diverged);
        CHECK(arm.evidence.trials == arm.trials - 1);
        const std::string count = std::to_string(diverged + 1),
                          of = count + " of " + std::to_string(arm.trials) + " trials", text = report_text(*report),
                          name = arm.scenario + "/" + arm.arm, page = report_html(*report, {"r.h5", {}, "test"});
        CHECK_THAT(text, Contains("WARNING: " + of) && Contains("judged all the") &&
                             Contains("note: " + std::to_string(diverged) + " trials of " + name) &&
                             !Contains("left out of the verdict"));
        const std::string row = text.substr(text.find("  " + name));
        CHECK_THAT(row.substr(0, row.find('\n')), Contains(" " + count + " (at most"));
        const Json json = Json::parse(report_json(*report))[0];
        CHECK(json["diverged"] == diverged);
        CHECK(json["failed_trials"] == diverged + 1);
        CHECK(json["failed_most"]["status"] == "diverged");
        CHECK_THAT(report_csv(*report), Contains("," + count + "\n"));
        CHECK_THAT(page, Contains("WARNING: " + of) && Contains(">" + count + "</data> of "));
    }
    const Consistency& verdict = of_record.arms.front().consistency;
    CHECK(verdict.verdict == Verdict::failed);
    REQUIRE(!verdict.findings.empty());
    CHECK(verdict.findings.front().what == Fault::optimistic);
}

TEST_CASE("failed: the program's gate, its share and its refusals") {
    const Workplace here;
    REQUIRE(here.credence("run " + seed_scenario("ekf-straight-constant") +
                          " --set noise.heading=1e9 --set arms.controllers=fixed --trials 60 --quiet -o r.h5")
                .exit_code == 0);
    const Outcome gate = here.credence("report r.h5 --require consistent --failed 5%");
    CHECK(gate.exit_code == 1);
    CHECK_THAT(gate.err, Contains("required consistent, but ekf-straight-constant/fixed.ekf failed."));
    CHECK_THAT(gate.out, Contains("60 of 60 trials failed") && Contains(", more than 5 %"));
    const Json all = Json::parse(here.credence("report r.h5 --format json --failed 1").out);
    CHECK(all[0]["verdict"] != "failed");
    CHECK(all[0]["failed_limit"] == 1);
    for (const char* command : {"report r.h5", "judge r.h5", "compare r.h5"})
        for (const char* share : {"-1%", "100.1%", "2", "nan", "inf", "x", "%"})
            check_refused(here.credence(std::string(command) + " --failed=" + share),
                          "(must be from 0 to 100 %). Write 1% or 0.01.");
    const Outcome replayed = here.credence("replay r.h5 --scenario ekf-straight-constant --arm fixed.ekf --trial 0");
    CHECK_THAT(replayed.out, Contains("trace(P) - dm^2 + rad^2, unseen -, pose error -, NEES/n -, NIS/m -, log score -\n"));
}

}  // namespace credence::test::failed_verdict_test
