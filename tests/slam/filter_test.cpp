// The filter's pieces by themselves: its Jacobians against finite differences of its own functions, its update
// against the joint one, its covariance, its squared errors. Whole trials: filter_oracle_test.cpp,
// filter_long_test.cpp.

#include "catch.hpp"
#include "filter_samples.hpp"

namespace credence::test::filter_test {

namespace {

/// A noise-free observation of state x: sightings in the frame of the heading that the rows are made for, then edges.
template <class Layout>
VectorXd measured(const Problem& problem, const VectorXd& x, double made_for) {
    const ProblemView& view = problem.view();
    Truth<double, 3> truth;
    if constexpr (Layout::has_heading) truth.heading = x[0];
    truth.rotation = rotation(truth.heading);
    truth.position = {x[Layout::position], x[Layout::position + 1]};
    for (int j = 0; j < 3; ++j) truth.feature[j] = {x[Layout::feature(j)], x[Layout::feature(j) + 1]};
    VectorXd z(6 + 2 * view.filter.edge_count);
    for (int j = 0; j < 3; ++j) {
        Vector2<double> seen = look_at<Layout>(truth, view.sensor, 1, j, silent_noise()).z;
        if constexpr (Layout::has_heading) seen = rotate(rotation(made_for), seen);
        z.segment<2>(2 * j) << seen.x, seen.y;
    }
    for (int e = 0; e < view.filter.edge_count; ++e) {
        const Vector2<double> edge = measure_edge(truth, view.sensor, view.filter.edges[e], 1, e, silent_noise());
        z.segment<2>(6 + 2 * e) << edge.x, edge.y;
    }
    return z;
}

template <class Layout>
VectorXd predicted(const Problem& problem, const VectorXd& x, const Command<double>& command) {
    auto belief = belief_of<Layout>(x, MatrixXd::Zero(x.size(), x.size()));
    predict_robot(belief, problem.view().filter, Layout(3), command);
    predict_features(belief, problem.view().filter, Layout(3), 2);
    return mean_of(belief, x.size());
}

/// Central differences. With steps of 1e-5 both the cut-off and the rounding leave 1e-10 of functions of size 1 to 10.
template <class Function>
MatrixXd jacobian(const Function& function, const VectorXd& x) {
    MatrixXd result(function(x).size(), x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) {
        const VectorXd h = 1e-5 * VectorXd::Unit(x.size(), i);
        result.col(i) = (function(x + h) - function(x - h)) / 2e-5;
    }
    return result;
}
constexpr double difference_quotient = 1e-8;

/// Some of three features seen, and every edge, with measurements out of the air. The signs of the sample's state
/// decide what is seen, so that every combination occurs.
struct InterimAnalysis {
    Sighting<double> sightings[3];
    VectorXd sigma{3}, z;  ///< z: features that are seen, body frame, then edges
    std::vector<bool> seen;
    Eigen::Index sighting_rows = 0;

    InterimAnalysis(int edges, const Sample& sample) {
        std::mt19937 random(7);
        std::normal_distribution<double> normal;
        z.resize(6 + 2 * edges);
        for (int j = 0; j < 3; ++j) {
            seen.push_back(sample.x[2 + j] > 0);
            sigma[j] = 0.3 + 0.1 * j;
            sightings[j] = {seen.back(), {normal(random), normal(random)}, sigma[j]};
            if (!seen.back()) continue;
            z.segment<2>(sighting_rows) << sightings[j].z.x, sightings[j].z.y;
            sighting_rows += 2;
        }
        z.conservativeResize(sighting_rows + 2 * edges);
        for (Eigen::Index i = sighting_rows; i < z.size(); ++i) z[i] = normal(random);
    }
    Vector2<double> edge(int e) const { return {z[sighting_rows + 2 * e], z[sighting_rows + 2 * e + 1]}; }
};

}  // namespace

TEST_CASE("filter: P is carried by the Jacobian of the predicted mean, plus Q") {
    with_both({{"noise.heading", "0.3"}}, [](const Problem& problem, const Sample& sample, auto layout) {
        using Layout = decltype(layout);
        const Command<double> command{0.3, {1.2, -0.7}};
        const MatrixXd F =
            jacobian([&](const VectorXd& x) { return predicted<Layout>(problem, x, command); }, sample.x);
        auto belief = belief_of<Layout>(sample.x, sample.P);
        predict_robot(belief, problem.view().filter, layout, command);
        predict_features(belief, problem.view().filter, layout, 2);
        const MatrixXd expected = F * sample.P * F.transpose() + oracle::process_noise(problem.scenario());
        CHECK((dense(belief, sample.x.size()) - expected).norm() < 10 * difference_quotient * sample.P.norm());
    });
}

TEST_CASE("filter: a belief that is certain is predicted with exactly Q") {
    with_both(
        {{"noise.heading", "0.25"}, {"filter.heading", "3"}, {"filter.odometry", "2"}, {"filter.features", "0.5"}},
        [](const Problem& problem, const Sample& sample, auto layout) {
            auto belief = belief_of<decltype(layout)>(sample.x, MatrixXd::Zero(sample.x.size(), sample.x.size()));
            predict_robot(belief, problem.view().filter, layout, {0.3, {1.2, -0.7}});
            predict_features(belief, problem.view().filter, layout, 2);
            const MatrixXd Q = oracle::process_noise(problem.scenario());
            CHECK((dense(belief, Q.rows()) - Q).norm() <= 1e-16);  // the same squares of the same products
        });
}

TEST_CASE("filter: rows of H are the Jacobian of what the sensor measures") {
    with_both({}, [](const Problem& problem, const Sample& sample, auto layout) {
        using Layout = decltype(layout);
        const double heading = Layout::has_heading ? sample.x[0] : 0;
        const MatrixXd H = jacobian([&](const VectorXd& x) { return measured<Layout>(problem, x, heading); }, sample.x);
        for (int i = 0; i < 6; i += 2) {
            const auto rows = sighting_rows<Layout>(sample.x.data(), i / 2);
            for (Eigen::Index column = 0; column < sample.x.size(); ++column) {
                const VectorXd unit = VectorXd::Unit(sample.x.size(), column);
                const Vector2<double> entry = rows([&](int s) { return unit[s]; });
                CHECK(std::abs(entry.x - H(i, column)) < difference_quotient);
                CHECK(std::abs(entry.y - H(i + 1, column)) < difference_quotient);
            }
        }
    });
}

TEST_CASE("filter: contrasts carry the information of all edges together") {
    for (const char* graph : {"all", "chain", "none", "0-2", "0-1, 0-3, 1-3, 2-4", "3-4, 0-1", "0-2, 0-4, 2-4, 1-3"})
        for (const char* process : {"heading", "translation"}) {
            CAPTURE(graph, process);
            const Problem problem(scenario_with({{"model.process", process}, {"edges.graph", graph},
                                                 {"features.positions", "0 0, 1 0, 0 1, 1 1, 2 2"}}));
            const FilterParameters& filter = problem.view().filter;
            const int n = problem.view().state_size;
            MatrixXd theirs = MatrixXd::Zero(n, n), ours = theirs;
            for (int e = 0; e < filter.edge_count; ++e) {
                const MatrixXd H = oracle::edge_rows(problem.scenario(), filter.edges[e]);
                theirs += H.transpose() * H;
            }
            for (int c = 0; c < 4; ++c) {
                const Contrast& contrast = filter.contrasts[c];
                if (contrast.scale == 0) continue;
                MatrixXd H = MatrixXd::Zero(2, n);
                for (int j = 0; j < 5; ++j)
                    H.block<2, 2>(0, n - 10 + 2 * j) = contrast.coefficient[j] * Eigen::Matrix2d::Identity();
                CHECK(contrast.coefficient[c] == 1);
                ours += H.transpose() * H / contrast.scale;
            }
            CHECK((ours - theirs).norm() < 1e-14);  // small integers and their quotients
            CHECK(filter.laplacian_bound >=
                  Eigen::SelfAdjointEigenSolver<MatrixXd>(theirs).eigenvalues().maxCoeff() - 1e-12);
        }
}

TEST_CASE("filter: updating with two rows after two is the joint update") {
    for (const char* graph : {"all", "chain", "none", "0-2"})
        with_both({{"edges.graph", graph}, {"filter.measurement", "0.9"}}, [](const Problem& problem,
                                                                              const Sample& sample, auto layout) {
            const FilterParameters& filter = problem.view().filter;
            const InterimAnalysis look(filter.edge_count, sample);
            auto belief = belief_of<decltype(layout)>(sample.x, sample.P);
            Update<double, decltype(layout)::capacity> result;
            update_belief(belief, filter, layout, look.sightings, [&](int e) { return look.edge(e); },
                          AtMean<decltype(layout), double>(belief.mean), result);
            CHECK(result.rows == static_cast<double>(look.z.size()));
            CHECK(result.unseen == 3 - static_cast<double>(look.sighting_rows) / 2);
            CHECK(result.positive_definite);
            if (look.z.size() == 0) {
                CHECK((mean_of(belief, sample.x.size()) == sample.x && dense(belief, sample.x.size()) == sample.P));
                CHECK(result.nis == 0);
                return;
            }
            const oracle::Prediction prediction =
                oracle::predicted_measurements(problem.scenario(), sample.x, look.seen, 0.9 * look.sigma);
            const oracle::Correction joint = oracle::correct(sample.P, prediction);
            const VectorXd nu = look.z - prediction.z_hat, move = joint.K * nu;
            // cond(S) is below 1e3 and there are at most 12 rows: 12 * 1e3 * 2^-53 = 1.3e-12.
            CHECK((mean_of(belief, sample.x.size()) - sample.x - move).norm() < 1.3e-12 * move.norm());
            CHECK((dense(belief, sample.x.size()) - joint.P).norm() < 1.3e-12 * sample.P.norm());
            CHECK(relative(result.nis, nu.dot(joint.S.ldlt().solve(nu))) < 1.3e-12);
        });
}

}  // namespace credence::test::filter_test
