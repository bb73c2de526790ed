// Records whose components enter and leave the state.

#include "record_support.hpp"

#include "statistics/goodness.hpp"

namespace credence::test::record_presence_test {

namespace {

constexpr int all_trials = 60, all_steps = 7, n = 5;

/// Components 0 to 2 are always there; 3 and 4 enter at step 1 + trial % 3; 4 leaves at step 5.
bool is_here(int trial, int step, int component) {
    if (component < 3) return true;
    return step >= 1 + trial % 3 && (component == 3 || step < 5);
}

std::vector<int> components_here(int trial, int step) {
    std::vector<int> here;
    for (int j = 0; j < n; ++j)
        if (is_here(trial, step, j)) here.push_back(j);
    return here;
}

DrawnRecord growing() {
    DrawnRecord drawn(all_trials, all_steps, n);
    for (int trial = 0; trial < all_trials; ++trial)
        for (int step = 0; step < all_steps; ++step)
            for (int j = 0; j < n; ++j)
                if (!is_here(trial, step, j)) drawn.hide(trial, step, j);
    return drawn;
}

Record read_growing(const DrawnRecord& drawn) {
    return read_written([&](const Handle& root) {
        write_drawn(root, drawn);
        hdf5::write_text(root, "groups", "pose 0:3, landmark 4 3, edge 0 3");
    });
}

/// What a broken record's first trouble says of trial 2, after `change` to its values.
std::string trouble_of(const std::function<void(DrawnRecord&)>& change) {
    DrawnRecord drawn = growing();
    change(drawn);
    const Record record = read_growing(drawn);
    REQUIRE(record.trouble_count == 1);
    CHECK(record.troubles.front().trial == 2);
    CHECK(record.troubles.front().status == Status::non_finite);
    CHECK(record.results.arms.front().totals.trials.counted() == all_trials - 1);
    return "step " + std::to_string(record.troubles.front().step) + ": " + record.troubles.front().what;
}

}  // namespace

TEST_CASE("record: the whole state has at each step the dimension that it has there") {
    const DrawnRecord drawn = growing();
    const Record record = read_growing(drawn);
    CHECK(record.trouble_count == 0);
    const ArmResults& arm = record.results.arms.front();
    const Evidence evidence = evidence_of(record.results, arm);
    const GroupEvidence& all = evidence.groups.front();
    std::vector<double> run_means;
    for (int trial = 0; trial < all_trials; ++trial) run_means.push_back(0);
    for (int k = 0; k < all_steps; ++k) {
        CAPTURE(k);
        const auto at = static_cast<std::size_t>(k);
        double dimensions = 0, ratios = 0, error = 0;
        std::vector<double> probabilities;
        std::int64_t below_median = 0;
        for (int trial = 0; trial < all_trials; ++trial) {
            const std::vector<int> here = components_here(trial, k);
            const auto d = static_cast<double>(here.size());
            const double nees = plain_nees(drawn.error[drawn.at(trial, k)], drawn.covariance[drawn.at(trial, k)], here);
            dimensions += d;
            ratios += nees / d;
            run_means[static_cast<std::size_t>(trial)] += nees / d / all_steps;
            probabilities.push_back(1 - chi_square_p(nees, d));
            below_median += probabilities.back() < 0.5;
            for (const int j : here) error += std::pow(drawn.error[drawn.at(trial, k)](j), 2);
        }
        CHECK(all.anees.degrees[at] == dimensions);
        CHECK(relative(all.step[at].mean, ratios / all_trials) < 1e-11);
        CHECK(relative(all.anees.ratio[at], ratios / all_trials) < 1e-11);
        CHECK(arm.totals.series[0].covered[at * coverage_level_count] == below_median);
        CHECK(std::abs(arm.totals.distribution_distance[at] - uniform_distance(probabilities)) < 1e-9);
        CHECK(relative(totals_named(record, "squared_error").sum[at].rounded(), error) < 1e-11);
    }
    double sum = 0, square_sum = 0;
    for (const double mean : run_means) {
        sum += mean;
        square_sum += mean * mean;
    }
    const Moments run = moments_from_sums(all_trials, sum, square_sum);
    CHECK(relative(all.run.mean, run.mean) < 1e-11);
    CHECK(relative(all.run.standard_error, run.standard_error) < 1e-9);
    for (std::size_t trial = 0; trial < all_trials; ++trial)
        CHECK(relative(arm.columns.in_memory()[column_nees_ratio][trial], run_means[trial]) < 1e-11);
}

TEST_CASE("record: a group is judged at the steps where it is whole") {
    const DrawnRecord drawn = growing();
    const Record record = read_growing(drawn);
    const std::vector<std::pair<std::string, std::vector<int>>> groups{
        {"pose", {0, 1, 2}}, {"landmark", {4, 3}}, {"edge", {0, 3}}};
    const Evidence evidence = evidence_of(record.results, record.results.arms.front());
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const auto& [name, members] = groups[g];
        CAPTURE(name);
        const SeriesTotals& totals = totals_named(record, "nees_" + name);
        for (int k = 0; k < all_steps; ++k) {
            double sum = 0;
            std::int64_t count = 0;
            for (int trial = 0; trial < all_trials; ++trial) {
                bool whole = true;
                for (const int j : members) whole = whole && is_here(trial, k, j);
                if (!whole) continue;
                ++count;
                sum += plain_nees(drawn.error[drawn.at(trial, k)], drawn.covariance[drawn.at(trial, k)], members);
            }
            const auto at = static_cast<std::size_t>(k);
            CHECK(totals.present[at] == count);
            CHECK(std::abs(totals.sum[at].rounded() - sum) <= 1e-11 * sum);
            CHECK(evidence.groups[g + 1].step[at].count == static_cast<double>(count));
        }
        CHECK(totals.runs == all_trials);
    }
    CHECK(totals_named(record, "standardised_error_x4").present == std::vector<std::int64_t>{0, 20, 40, 60, 60, 0, 0});
    const ArmResults& arm = record.results.arms.front();
    for (int k = 0; k < all_steps; ++k) {  // of trial 0: the details are of the whole state
        CHECK(std::isnan(arm.nees[static_cast<std::size_t>(k)]) == !(is_here(0, k, 3) && is_here(0, k, 4)));
        CHECK(std::isnan(arm.errors[static_cast<std::size_t>(k * n + 4)]) == !is_here(0, k, 4));
    }
}

TEST_CASE(
    "record: a group that no trial has at any step is not judged, and keeps nothing from being said of the rest") {
    DrawnRecord drawn = growing();
    for (int trial = 0; trial < all_trials; ++trial)
        for (int step = 0; step < all_steps; ++step) drawn.hide(trial, step, 4);
    const Record record = read_growing(drawn);
    CHECK(record.trouble_count == 0);
    CHECK(totals_named(record, "nees_landmark").runs == 0);
    const Evidence evidence = evidence_of(record.results, record.results.arms.front());
    CHECK(std::isnan(evidence.groups[2].run.mean));
    CHECK(evidence.groups[0].run.count == all_trials);
}

TEST_CASE("record: a NaN that is not of a component outside the state fails its trial") {
    const double nan = std::nan("");
    CHECK(trouble_of([&](DrawnRecord& r) { r.error[r.at(2, 4)](1) = nan; }) ==
          "step 4: the error of `x1` is NaN, and the covariance is not");
    CHECK(trouble_of([&](DrawnRecord& r) { r.covariance[r.at(2, 4)](1, 1) = nan; }) ==
          "step 4: the covariance of `x1` is NaN, and the error is not");
    CHECK(trouble_of([&](DrawnRecord& r) { r.covariance[r.at(2, 4)](1, 0) = nan; }) ==
          "step 4: the covariance is not finite");
    CHECK(trouble_of([&](DrawnRecord& r) { r.covariance[r.at(2, 0)](4, 0) = 0; }) ==
          "step 0: the error of `x4` is NaN, and the covariance is not");
    CHECK(trouble_of([&](DrawnRecord& r) { r.error[r.at(2, 4)].setConstant(nan); }) ==
          "step 4: the error is NaN, and the covariance is not");
    CHECK(trouble_of([&](DrawnRecord& r) { r.covariance[r.at(2, 4)].setConstant(nan); }) ==
          "step 4: the covariance is NaN, and the error is not");
    CHECK(trouble_of([&](DrawnRecord& r) { r.hide(2, 4, 1); }) ==
          "step 5: the error of `x1` is a number again, after it was NaN");
    CHECK(trouble_of([&](DrawnRecord& r) { r.error[r.at(2, 4)](1) = HUGE_VAL; }) == "step 4: the error is not finite");
}

TEST_CASE("record: a step that does not exist is no leaving, and a trial that ends early must say so") {
    DrawnRecord drawn = growing();
    for (int j = 0; j < n; ++j) drawn.hide(7, 3, j);
    CHECK(read_growing(drawn).trouble_count == 0);
    for (int j = 0; j < n; ++j) drawn.hide(7, all_steps - 1, j);
    const Record cut = read_growing(drawn);
    CHECK(cut.trouble_count == 1);
    CHECK(cut.troubles.front().what ==
          "the trial ends after 6 of 7 steps, and no dataset `steps` declares that it is shorter");
    CHECK(read_written([&](const Handle& root) {
              write_drawn(root, drawn);
              std::vector<double> declared(all_trials, all_steps);
              declared[7] = all_steps - 1;
              write_values(root, "steps", {all_trials}, declared);
          }).trouble_count == 0);
}

}  // namespace credence::test::record_presence_test
