// Directions: what they do not depend on, what they find, and what they refuse.

#include "statistics/moments/directions.hpp"

#include "statistics/verdict_cases.hpp"

namespace credence::test::directions_test {

namespace {

const double missing = std::numeric_limits<double>::quiet_NaN();

/// Four components, 297 trials.
TrialMoments four_components(double truth, double claimed, double scale = 1) {
    static const nlohmann::json common = {{"n", 4},    {"steps", 8},       {"trials", 297}, {"groups", {{0, 1, 2, 3}}},
                                          {"rho", 0},  {"bias", 0},        {"kind", ""},    {"gaps", false},
                                          {"seed", 5}, {"tails", "normal"}};
    nlohmann::json settings = common;
    settings["true"] = truth;
    settings["claimed"] = claimed;
    settings["scale"] = scale;
    return VerdictCase(settings).moments();
}

/// The group's errors and covariances in other coordinates, e -> A e.
GroupMoments changed(GroupMoments group, const Eigen::MatrixXd& A) {
    for (Eigen::MatrixXd* triangles : {&group.S, &group.C})
        for (Eigen::Index i = 0; i < triangles->rows(); ++i) {
            const Eigen::MatrixXd matrix = A * symmetric(triangles->row(i), group.dimension()) * A.transpose();
            for (int a = 0; a < group.dimension(); ++a)
                for (int b = 0; b <= a; ++b) (*triangles)(i, triangle_place(a, b)) = matrix(a, b);
        }
    return group;
}

GroupDirections directions_of(const GroupMoments& group) { return find_directions(group, fold_sums(group), 0.0075); }

void check_same(const Direction& one, const Direction& other) {
    const auto close = [](double a, double b) { return std::abs(a - b) < 1e-9; };
    CHECK(close(one.ratio.mean, other.ratio.mean));
    CHECK(close(one.bounds.low, other.bounds.low));
    CHECK(close(one.bounds.high, other.bounds.high));
    CHECK(one.finding == other.finding);
    CHECK(one.approximate == other.approximate);
}

void check_same_in(const GroupMoments& group, const Eigen::MatrixXd& A) {
    const GroupMoments other = changed(group, A);
    const GroupDirections here = directions_of(group), there = directions_of(other);
    REQUIRE(there.state == GroupDirections::State::known);
    check_same(here.largest, there.largest);
    check_same(here.smallest, there.smallest);
    const DirectionsAccepted all = accept_directions(group, fold_sums(group)),
                             all_there = accept_directions(other, fold_sums(other));
    CHECK(std::abs(all.shown - all_there.shown) < 1e-9);
    CHECK(std::abs(all.bounds.low - all_there.bounds.low) < 1e-9);
    CHECK(std::abs(all.bounds.high - all_there.bounds.high) < 1e-9);
}

const std::vector<int> all_four{0, 1, 2, 3};

}  // namespace

TEST_CASE("directions: the same findings in other units, another order and rotated coordinates") {
    Eigen::MatrixXd order(4, 4), any(4, 4);
    order << 0, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0, 1, 0, 1, 0, 0;
    any << 1, 2, 0, 1, 0, 1, 3, -1, 2, 0, 1, 1, 1, -1, 0, 1;
    for (const double claimed : {0.5, 0.0}) {
        const GroupMoments group = group_moments(four_components(0.5, claimed), all_four);
        check_same_in(group, Eigen::Vector4d(1e-3, 1, 50, 0.2).asDiagonal());
        check_same_in(group, order);
        check_same_in(group, any.householderQr().householderQ());
        check_same_in(group, any);
    }
}

TEST_CASE("directions: a dropped correlation is found and named, in every order of the components") {
    const TrialMoments trials = four_components(0.5, 0);
    for (const std::vector<int>& components : {std::vector<int>{0, 1}, {1, 0}}) {
        const GroupDirections found = directions_of(group_moments(trials, components));
        CHECK(found.largest.finding);
        CHECK(found.smallest.finding);
        // By step the correlation falls from 0.5 to 0.28.
        CHECK(found.largest.ratio.mean > 1.3);
        CHECK(found.smallest.ratio.mean < 0.7);
        REQUIRE(found.largest.entries.size() == 2);
        CHECK(found.largest.entries[0].component == components[0]);
        for (const DirectionEntry& entry : found.largest.entries)
            CHECK(std::abs(entry.weight - 0.71) < 0.1);  // three standard deviations of an estimated direction
        CHECK(found.smallest.entries[0].weight * found.smallest.entries[1].weight < 0);
    }
}

TEST_CASE("directions: nothing is found for a consistent filter, both sides for one with a wrong size and shape") {
    const GroupDirections right = directions_of(group_moments(four_components(0.5, 0.5), all_four)),
                          large = directions_of(group_moments(four_components(0.5, 0.5, 1.3), all_four)),
                          small = directions_of(group_moments(four_components(0.5, 0.5, 0.7), all_four));
    CHECK_FALSE((right.largest.finding || right.smallest.finding));
    CHECK((large.largest.finding && !large.smallest.finding));
    CHECK((small.smallest.finding && !small.largest.finding));
}

TEST_CASE("directions: below 20 trials, and of trials that lack a component, nothing is said") {
    TrialMoments trials = four_components(0.5, 0);
    const GroupDirections before = directions_of(group_moments(trials, {0, 1}));
    // The third component is absent in every second trial: the others keep all of theirs.
    for (std::size_t i = 0; i < trials.trials(); i += 2)
        trials.values[i * trials.size() + 1 + 4 + static_cast<std::size_t>(triangle_place(2, 0))] = missing;
    check_same(before.largest, directions_of(group_moments(trials, {0, 1})).largest);
    CHECK(group_moments(trials, all_four).trials() == 148);
    for (std::size_t i = 0; i + 19 < trials.trials(); ++i)
        trials.values[i * trials.size() + 1 + 4 + static_cast<std::size_t>(triangle_place(2, 0))] = missing;
    const GroupMoments whole = group_moments(trials, all_four);
    CHECK(whole.trials() > 0);
    CHECK(directions_of(whole).state == GroupDirections::State::few_trials);
    CHECK(accept_directions(whole, fold_sums(whole)).state == GroupDirections::State::few_trials);
}

TEST_CASE("directions: sums over more trials than are kept give the ratio, the kept ones its spread") {
    const GroupMoments group = group_moments(four_components(0.5, 0), all_four);
    FoldSums sums = fold_sums(group);
    const GroupDirections kept = find_directions(group, sums, 0.0075);
    for (int fold = 0; fold < fold_count; ++fold) {  // as if every trial had come four times
        sums.count[fold] *= 4;
        sums.S[fold] *= 4;
        sums.C[fold] *= 4;
    }
    const GroupDirections all = find_directions(group, sums, 0.0075);
    CHECK(all.trials == 4 * 297);
    CHECK(std::abs(all.largest.ratio.mean - kept.largest.ratio.mean) < 1e-12);
    const double half = kept.largest.ratio.mean - kept.largest.bounds.low,
                 less = all.largest.ratio.mean - all.largest.bounds.low;
    CHECK(std::abs(half / less - 2) < 0.03);  // but for Student's quantiles
}

}  // namespace credence::test::directions_test
