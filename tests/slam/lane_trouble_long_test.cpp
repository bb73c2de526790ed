// Numerical trouble in one lane becomes that trial's status, and its neighbours keep every bit.

#include "catch.hpp"
#include "support.hpp"

#include <credence/detail/lane.hpp>
#include "slam/trial/trial.hpp"

#include <bit>
#include <functional>
#include <limits>
#include <memory>

namespace credence::test::lane_trouble_long_test {

namespace {

constexpr int width = 4, troubled_pose = 5;
using Pack4 = Lane<width>;
using ThreeFeatures = Layout<Process::heading, 3>;
constexpr double infinite = std::numeric_limits<double>::infinity();

/// Keyed draws, but for one number of one lane.
struct Draws {
    KeyedDraws<Pack4> keyed;
    std::function<void(Source, int pose, int index, Vector2<Pack4>&)> disturb;

    Vector2<Pack4> normal(Source source, int pose, int index) const {
        Vector2<Pack4> draw = keyed.normal(source, pose, index);
        if (disturb) disturb(source, pose, index, draw);
        return draw;
    }
    Pack4 uniform(Source source, int pose, int index) const { return keyed.uniform(source, pose, index); }
};

using Covariance = decltype(Belief<Pack4, ThreeFeatures::capacity>::covariance);

/// Watches nothing, and may spoil the predicted covariance.
struct Saboteur {
    std::function<void(Covariance&)> spoil;

    void started(const auto&...) {}
    void planned(const auto&...) {}
    void updated(const auto&...) {}
    void predicted(int k, const auto&, const auto&, const auto&, const auto& belief, const auto&...) {
        if (k == troubled_pose && spoil) spoil(const_cast<Covariance&>(belief.covariance));
    }
};

/// The columns of four trials [lane][column].
std::vector<std::vector<double>> columns_of(const Problem& problem, Controller controller, const Draws& draws,
                                            Saboteur saboteur) {
    const auto work = std::make_unique<Workspace<ThreeFeatures, Pack4>>();
    std::vector<Pack4> figures(static_cast<std::size_t>(problem.view().series_count * (problem.view().poses - 1)));
    Pack4 columns[column_count];
    run_trial(problem.view(), controller, draws, saboteur, *work, columns, figures.data());
    std::vector<std::vector<double>> lanes(width);
    for (int lane = 0; lane < width; ++lane)
        for (const Pack4& column : columns) lanes[static_cast<std::size_t>(lane)].push_back(column.v[lane]);
    return lanes;
}

Draws keyed() {
    Bits<Pack4> trials(std::uint64_t{100});
    for (int lane = 0; lane < width; ++lane) trials.v[lane] += static_cast<std::uint64_t>(lane);
    return {KeyedDraws<Pack4>(7, trials, infinite), {}};
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) {
        return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
    });
}

/// Trouble in each lane in turn: `make` puts it into draws or covariance.
void check(Status expected, const std::function<void(int lane, Draws&, Saboteur&)>& make) {
    const DeformableSettings scenario = scenario_with({{"sensor.range_min", "0"}, {"sensor.range_max", "inf"}});
    const Problem problem(scenario);
    for (const Controller controller : {Controller::fixed, Controller::greedy}) {
        const auto undisturbed = columns_of(problem, controller, keyed(), {});
        for (int troubled = 0; troubled < width; ++troubled) {
            Draws draws = keyed();
            Saboteur saboteur;
            make(troubled, draws, saboteur);
            const auto lanes = columns_of(problem, controller, draws, saboteur);
            for (int lane = 0; lane < width; ++lane) {
                CAPTURE(static_cast<int>(controller), troubled, lane);
                const auto at = static_cast<std::size_t>(lane);
                CHECK(undisturbed[at][column_status] == static_cast<double>(Status::completed));
                if (lane != troubled) CHECK(same_bits(lanes[at], undisturbed[at]));
                else CHECK(lanes[at][column_status] == static_cast<double>(expected));
            }
        }
    }
}

void check_draw(double bad, Source source, int index) {
    check(Status::non_finite, [=](int lane, Draws& draws, Saboteur&) {
        draws.disturb = [=](Source s, int pose, int i, Vector2<Pack4>& draw) {
            if (s == source && pose == troubled_pose && i == index) draw.x.v[lane] = bad;
        };
    });
}

void check_covariance(Status expected, const std::function<void(Covariance&, int lane)>& spoil) {
    check(expected, [&](int lane, Draws&, Saboteur& saboteur) {
        saboteur.spoil = [=](Covariance& P) { spoil(P, lane); };
    });
}

}  // namespace

TEST_CASE("lanes: a draw that is not finite fails its own trial only") {
    for (const double bad : {not_a_number, infinite, -infinite}) {
        check_draw(bad, Source::measurement, 1);
        check_draw(bad, Source::odometry_position, 0);
    }
}

TEST_CASE("lanes: a covariance that is not finite or not positive definite fails its own trial only") {
    check_covariance(Status::non_finite, [](Covariance& P, int lane) { P.entry[3][3].v[lane] = not_a_number; });
    check_covariance(Status::non_finite, [](Covariance& P, int lane) { P.entry[1][4].v[lane] = infinite; });
    check_covariance(Status::covariance_not_positive_definite,
                     [](Covariance& P, int lane) { P.entry[3][3].v[lane] = -1; });
}

TEST_CASE("lanes: a singular innovation covariance fails its own trial only") {
    // S = H P H' + N I of the first sighting is 0 where P is -N I for that feature and 0 elsewhere; what its inverse
    // gives is not finite, which is the graver of the two things that are wrong.
    const double sigma = DeformableSettings{}.sensor.sigma;
    check_covariance(Status::non_finite, [=](Covariance& P, int lane) {
        for (int i = 0; i < ThreeFeatures::capacity; ++i)
            for (int j = i; j < ThreeFeatures::capacity; ++j) P.entry[i][j].v[lane] = 0;
        for (const int i : {3, 4}) P.entry[i][i].v[lane] = -sigma * sigma;
    });
}

}  // namespace credence::test::lane_trouble_long_test
