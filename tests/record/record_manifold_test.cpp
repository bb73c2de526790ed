// Records with a truth and an estimate on a manifold: the error that is formed is the one from which the
// estimate was made, with the exponential of matrices.

#include "record_support.hpp"

#include <unsupported/Eigen/MatrixFunctions>

namespace credence::test::record_manifold_test {

namespace {

using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

Matrix3d skew(const Vector3d& v) {
    Matrix3d m;
    m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return m;
}

/// Exp of a tangent vector of SE2 (x, y, theta) or SE3 (translation, rotation), as a homogeneous matrix.
MatrixXd exp_of(const VectorXd& tangent) {
    MatrixXd generator;
    if (tangent.size() == 3) {
        generator = Matrix3d::Zero();
        generator(0, 1) = -tangent(2);
        generator(1, 0) = tangent(2);
        generator.topRightCorner(2, 1) = tangent.head(2);
    } else {
        generator = Matrix4d::Zero();
        generator.topLeftCorner(3, 3) = skew(tangent.tail<3>());
        generator.topRightCorner(3, 1) = tangent.head<3>();
    }
    return generator.exp();
}

/// The coordinates of a homogeneous matrix in a record: x y theta, or x y z and a quaternion.
std::vector<double> coordinates_of(const MatrixXd& pose, bool scalar_first) {
    if (pose.rows() == 3) return {pose(0, 2), pose(1, 2), std::atan2(pose(1, 0), pose(0, 0))};
    const Eigen::Quaterniond q(Matrix3d(pose.topLeftCorner(3, 3)));
    std::vector<double> values{pose(0, 3), pose(1, 3), pose(2, 3)};
    if (scalar_first) values.insert(values.end(), {q.w(), q.x(), q.y(), q.z()});
    else values.insert(values.end(), {q.x(), q.y(), q.z(), q.w()});
    return values;
}

struct Poses {
    DrawnRecord drawn;
    std::vector<double> truth, estimate;

    /// `scale` makes the errors small or large; truths are anywhere.
    Poses(int n, double scale, bool local, bool scalar_first) : drawn(10, 3, n) {
        std::mt19937 random(7);
        std::uniform_real_distribution<double> uniform(-3, 3);
        for (VectorXd& error : drawn.error) {
            error *= scale;
            if (n == 6 && error.tail(3).norm() > 3) error.tail(3) *= 3 / error.tail(3).norm();
            if (n == 3) error(2) = std::remainder(error(2), 6);
            VectorXd place(n);
            for (double& value : place) value = uniform(random);
            const MatrixXd T = exp_of(place), E = local ? MatrixXd(T * exp_of(error)) : MatrixXd(exp_of(error) * T);
            for (const auto& [pose, values] : {std::pair{&T, &truth}, std::pair{&E, &estimate}}) {
                const std::vector<double> coordinates = coordinates_of(*pose, scalar_first);
                values->insert(values->end(), coordinates.begin(), coordinates.end());
            }
        }
    }

    void write(const Handle& root, const std::string& manifold, bool local, const std::string& quaternion) const {
        const int q = drawn.n == 3 ? 3 : 7;
        write_values(root, "truth", extents_of(drawn, {q}), truth);
        write_values(root, "estimate", extents_of(drawn, {q}), estimate);
        write_values(root, "covariance", extents_of(drawn, {drawn.n, drawn.n}), flat(drawn.covariance));
        hdf5::write_text(root, "manifold", manifold);
        hdf5::write_text(root, "chart", local ? "local" : "global");
        if (!quaternion.empty()) hdf5::write_text(root, "quaternion", quaternion);
    }
};

/// The errors that were read are those drawn, to the rounding of an exponential of numbers up to 10.
void check_errors(const Record& record, const DrawnRecord& drawn) {
    CHECK(
        std::ranges::all_of(record.troubles, [](const RecordTrouble& one) { return one.status == Status::diverged; }));
    const std::vector<double>& errors = record.results.arms.front().errors;
    const std::vector<double> expected = flat(drawn.error);
    REQUIRE(errors.size() == expected.size());
    for (std::size_t i = 0; i < errors.size(); ++i) CHECK(std::abs(errors[i] - expected[i]) < 1e-9);
}

}  // namespace

TEST_CASE("record: the error of a pose in the plane or in space, in either chart, is the Log of what lies between") {
    for (const double scale : {1e-7, 0.3, 2.0})
        for (const bool local : {true, false}) {
            CAPTURE(scale, local);
            const Poses plane(3, scale, local, true);
            check_errors(read_written([&](const Handle& root) { plane.write(root, "SE2", local, ""); }), plane.drawn);
            for (const bool scalar_first : {true, false}) {
                const Poses space(6, scale, local, scalar_first);
                check_errors(read_written([&](const Handle& root) {
                                 space.write(root, "SE3", local, scalar_first ? "wxyz" : "xyzw");
                             }), space.drawn);
            }
        }
}

TEST_CASE("record: a quaternion and its negative are the same rotation") {
    Poses poses(6, 0.3, true, true);
    for (std::size_t i = 0; i < poses.estimate.size(); ++i)
        if (i % 7 >= 3 && i / 7 % 2 == 0) poses.estimate[i] *= -1;
    check_errors(read_written([&](const Handle& root) { poses.write(root, "SE3", true, "wxyz"); }), poses.drawn);
}

TEST_CASE("record: angles are wrapped, and products put their errors one after the other") {
    const Record record = read_written([&](const Handle& root) {
        // Two steps of SO2 x R2 x SO3, the second with a rotation by pi/2 about z; its last factor is missing at the
        // first.
        const double nan = std::nan(""), h = std::sqrt(0.5);
        write_values(root, "truth", {1, 2, 7}, {3.1, 1, 2, 1, 0, 0, 0, -3.1, 0, 0, 1, 0, 0, 0});
        write_values(root, "estimate", {1, 2, 7}, {-3.1, 1.5, 1, nan, nan, nan, nan, 3.1, 0, 1, h, 0, 0, h});
        std::vector<double> P(2 * 36, 0);
        for (std::size_t i = 0; i < 2; ++i)
            for (std::size_t j = 0; j < 6; ++j) P[i * 36 + j * 7] = 1;
        for (std::size_t j = 0; j < 36; ++j)
            if (j / 6 >= 3 || j % 6 >= 3) P[j] = nan;
        write_values(root, "covariance", {1, 2, 6, 6}, P);
        hdf5::write_text(root, "manifold", "SO2 x R2 x SO3");
        hdf5::write_text(root, "quaternion", "wxyz");
        hdf5::write_text(root, "chart", "local");
    });
    CHECK(
        std::ranges::all_of(record.troubles, [](const RecordTrouble& one) { return one.status == Status::diverged; }));
    const std::vector<double>& errors = record.results.arms.front().errors;
    const double turn = 2 * std::acos(-1), wrapped = turn - 6.2;
    const std::vector<double> expected{wrapped, 0.5, -1, 0, 0, 0, -wrapped, 0, 1, 0, 0, turn / 4};
    for (std::size_t i = 0; i < expected.size(); ++i) {
        if (i >= 3 && i < 6) CHECK(std::isnan(errors[i]));
        else CHECK(std::abs(errors[i] - expected[i]) < 1e-12);
    }
}

TEST_CASE("record: components have the names of their manifold where the record has none for them") {
    using Names = std::vector<std::string>;
    // Names of a record of two steps with truth = estimate = `state` and P = I, and what `more` adds.
    const auto names = [](const std::string& manifold, const std::vector<double>& state, int n,
                          const Names& more = {}) {
        const Record record = read_written([&](const Handle& root) {
            std::vector<double> states = state, P(static_cast<std::size_t>(2 * n * n), 0);
            states.insert(states.end(), state.begin(), state.end());
            for (int i = 0; i < 2 * n; ++i) P[static_cast<std::size_t>(i * n + i % n)] = 1;
            for (const char* name : {"truth", "estimate"}) write_values(root, name, {1, 2, state.size()}, states);
            write_values(root, "covariance", extents_of(DrawnRecord(1, 2, n), {n, n}), P);
            hdf5::write_text(root, "manifold", manifold);
            hdf5::write_text(root, "chart", "local");
            hdf5::write_text(root, "quaternion", "wxyz");
            for (std::size_t i = 0; i < more.size(); i += 2) hdf5::write_text(root, more[i], more[i + 1]);
        });
        Names found{record.results.all_series[series_named(record, "trace_P_step")].unit};
        for (const Series& series : record.results.all_series)
            if (series.role == SeriesRole::standardised_error) found.push_back(series.part);
        return found;
    };
    const std::string unknown = "unit of error squared";
    CHECK(names("SO2", {0}, 1) == Names{"rad^2", "theta"});
    CHECK(names("SE2", {1, 2, 3}, 3) == Names{unknown, "x", "y", "theta"});
    CHECK(names("SO3", {1, 0, 0, 0}, 3) == Names{"rad^2", "rotation_x", "rotation_y", "rotation_z"});
    CHECK(names("SE3 x R2", {1, 2, 3, 1, 0, 0, 0, 4, 5}, 8) ==
          Names{unknown, "translation_x", "translation_y", "translation_z", "rotation_x", "rotation_y", "rotation_z",
                "x6", "x7"});
    CHECK(names("SE2 x SO2", {1, 2, 3, 0}, 4) == Names{unknown, "x", "y", "theta_1", "theta_2"});
    CHECK(names("R2", {1, 2}, 2) == Names{unknown, "x0", "x1"});
    CHECK(names("SE2", {1, 2, 3}, 3, {"component_units", "m, m, rad"}) == Names{"m^2 + rad^2", "x", "y", "theta"});
    CHECK(names("SE2", {1, 2, 3}, 3, {"component_names", "a, b, c"}) == Names{unknown, "a", "b", "c"});
    CHECK(names("SE2", {1, 2, 3}, 3, {"groups", "theta 2"}) == Names{unknown, "x", "y", "theta"});
    // The group keeps its name.
    CHECK(names("SE2", {1, 2, 3}, 3, {"groups", "x 0 1"}) == Names{unknown, "x0", "x1", "x2"});
}

TEST_CASE("record: a manifold, chart or quaternion that cannot be is refused by name") {
    const Poses poses(6, 0.3, true, true);
    const auto with = [&](const std::string& manifold, const std::string& quaternion) {
        return [&, manifold, quaternion](const Handle& root) { poses.write(root, manifold, true, quaternion); };
    };
    check_refused(with("SE4", "wxyz"), "/@manifold: `SE4` is no manifold. Write a product of SO2, SE2");
    check_refused(with("SE3 x", "wxyz"), "/@manifold: `` is no manifold");
    check_refused(with("R1000 x R1", "wxyz"), "/@manifold: has more than 1000 dimensions. Write a part of the state");
    check_refused(with("SE3 x R2", "wxyz"),
                  "/estimate: does not fit: it is [10, 3, 7], and the manifold has 9 coordinates");
    check_refused(with("SE3", ""), "/@quaternion: is missing. Write wxyz or xyzw");
    check_refused(with("SE3", "zyxw"), "/@quaternion: is `zyxw`. Write wxyz or xyzw");
    const auto changed = [&](const Change& change) {
        return [&, change](const Handle& root) {
            poses.write(root, "SE3", true, "wxyz");
            change(root);
        };
    };
    check_refused(changed(without_attribute("/", "chart")), "/@chart: is missing. Write local or global");
    check_refused(changed([](const Handle& root) { set_value(root, "estimate", 7 * 4 + 3, 2); }),
                  "/estimate: trial 1, step 1 (both counted from 0) has no unit quaternion at 3:7");
    check_refused(changed(without("truth")), "/truth: is missing, but /estimate is there");
    check_refused(changed([&](const Handle& root) { write_errors(root, poses.drawn); }),
                  "/estimate: is there, and `error` too");
}

}  // namespace credence::test::record_manifold_test
