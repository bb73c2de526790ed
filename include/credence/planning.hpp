#pragma once
// Module worlds: parts of planners for a world of one's own, in lanes and for plain doubles alike.
//
//   Candidates<size>                       the controls to choose from: a list, or a grid
//   least(count, allowed, cost)            for each trial of a pack, that of least cost among those allowed
//   least_of_one<Real>(list, cost)         the same for one trial, with its candidates in the lanes
//   in_view, segment_blocked, clearance    range, field of view and walls of the plane [detail/visibility.hpp]
//   Mesh, MeshView, MeshFaces              triangles in space: what they hide, and how near they are
//   EulerRotation                          from roll, pitch and yaw, with its derivatives
//   truncated_normal(trial, limit, ...)    draws that are repeated until they are within a limit
//   update_in_place(P, step, ...)          rows that touch few components, where they were measured
//   Foresight(P, square)                   the trace of P after a control and what would be seen then
//
// Where the trials of a pack diverge, as each sees other things, lanes may hold the candidates of one trial instead.

#include <credence/detail/updates.hpp>
#include <credence/detail/visibility.hpp>
#include <credence/own_trial.hpp>

#include <algorithm>
#include <array>
#include <vector>

namespace credence {
inline namespace CREDENCE_TARGET {

/// The controls to choose from, [size] numbers each, counted from 0.
template <int size>
class Candidates {
public:
    using Control = Eigen::Matrix<double, size, 1>;

    Candidates() = default;
    /// Every combination of the values of each axis; those of the last axis follow each other.
    explicit Candidates(const std::array<std::vector<double>, size>& axes) {
        std::size_t count = 1;
        for (const std::vector<double>& axis : axes) count *= axis.size();
        for (std::size_t i = 0; i < count; ++i) {
            Control control;
            for (std::size_t axis = size, rest = i; axis-- > 0; rest /= axes[axis].size())
                control(static_cast<Eigen::Index>(axis)) = axes[axis][rest % axes[axis].size()];
            add(control);
        }
    }

    void add(const Control& control) { controls_.push_back(control); }
    int count() const { return static_cast<int>(controls_.size()); }
    const Control& operator[](int index) const { return controls_[static_cast<std::size_t>(index)]; }
    /// Each lane's control, by its index.
    template <class Real>
    Eigen::Matrix<Real, size, 1> of_lanes(const Real& index) const {
        Eigen::Matrix<Real, size, 1> all;
        for (int lane = 0; lane < lanes<Real>; ++lane) {
            const Control& control = (*this)[static_cast<int>(lane_of(index, lane))];
            for (int i = 0; i < size; ++i) set_lane(all(i), lane, control(i));
        }
        return all;
    }

private:
    std::vector<Control> controls_;
};

/// The candidate of least cost so far, in each lane: of equal costs the last in the list, never one whose cost is NaN.
template <class Real>
struct Least {
    Real cost = Real(__builtin_inf());
    Real index = Real(-1);  ///< -1 where none was allowed

    void take(const Mask<Real>& allowed, const Real& its_cost, const Real& its_index) {
        const Mask<Real> better = either(its_cost < cost, both(its_cost == cost, its_index > index));
        const Mask<Real> taken = both(allowed, better);
        cost = select(taken, its_cost, cost);
        index = select(taken, its_index, index);
    }
    Mask<Real> found() const { return index >= Real(0); }
};

/// For each trial of the pack the candidate of least cost: allowed(index) gives a mask, and cost(index), which is asked
/// for only where a trial allows it, a Real.
template <class Allowed, class Cost>
auto least(int count, Allowed&& allowed, Cost&& cost) {
    Least<std::remove_cvref_t<decltype(cost(0))>> result;
    for (int index = 0; index < count; ++index)
        if (const auto mask = allowed(index); any(mask)) result.take(mask, cost(index), index);
    return result;
}

/// body(index, used) for the numbers of the list, one in each lane of a Real `index`: the first `used`, which are fewer
/// than there are lanes at the end.
template <class Real, class Body>
void each_pack(const std::vector<int>& list, Body&& body) {
    const int count = static_cast<int>(list.size());
    for (int first = 0; first < count; first += lanes<Real>) {
        Real index;
        for (int lane = 0; lane < lanes<Real>; ++lane)
            set_lane(index, lane, list[static_cast<std::size_t>(std::min(first + lane, count - 1))]);
        body(index, std::min(lanes<Real>, count - first));
    }
}

/// For one trial the candidate of least cost among those of the list, in any order: cost(index) takes and gives a Real,
/// which has a candidate in each lane. Costs that differ by `tolerance` of the least are equal to it, so that rounding
/// does not choose among candidates that are the same. The result does not depend on the number of lanes.
template <class Real, class Cost>
Least<double> least_of_one(const std::vector<int>& list, Cost&& cost, double tolerance = 0) {
    std::vector<double> costs;
    each_pack<Real>(list, [&](const Real& index, int used) {
        const Real pack = cost(index);
        for (int lane = 0; lane < used; ++lane) costs.push_back(lane_of(pack, lane));
    });
    double bound = __builtin_inf();
    for (const double one : costs) bound = min(bound, one + tolerance * absolute(one));
    Least<double> result;
    for (std::size_t i = 0; i < list.size(); ++i) result.take(costs[i] <= bound, bound, list[i]);
    return result;
}

template <class Real>
using Vector3 = Eigen::Matrix<Real, 3, 1>;

/// Triangles between points, by the points' numbers, of either orientation, and their edges, each once.
template <int triangle_count>
struct Mesh {
    int triangles[triangle_count][3], edges[3 * triangle_count][2]{}, edge_count = 0;
    int edge_of[triangle_count][3]{};   ///< of a triangle abc: ab, bc, ca
    bool forward[triangle_count][3]{};  ///< whether it goes along them from the lower number to the higher, as they do

    constexpr explicit Mesh(const int (&list)[triangle_count][3]) : triangles{} {
        for (int t = 0; t < triangle_count; ++t)
            for (int side = 0; side < 3; ++side) {
                const int a = triangles[t][side] = list[t][side], b = list[t][(side + 1) % 3];
                const int low = a < b ? a : b, high = a < b ? b : a;
                int place = 0;
                while (place < edge_count && (edges[place][0] != low || edges[place][1] != high)) ++place;
                if (place == edge_count) ++edge_count;
                edges[place][0] = low;
                edges[place][1] = high;
                edge_of[t][side] = place;
                forward[t][side] = a < b;
            }
    }
};

/// A mesh as it is seen from a point p: what all sights from there have in common is computed once.
template <class Real, int triangle_count>
class MeshView {
public:
    /// points [3, any], of doubles or of Reals
    template <class Points>
    MeshView(const Mesh<triangle_count>& mesh, const Points& points, const Vector3<Real>& p) : mesh_(mesh), p_(p) {
        for (int e = 0; e < mesh.edge_count; ++e) {
            const Vector3<Real> a = points.col(mesh.edges[e][0]) - p, b = points.col(mesh.edges[e][1]) - p;
            normals_[e] = a.cross(b);
        }
        for (int t = 0; t < triangle_count; ++t) {
            const Vector3<Real> c = points.col(mesh.triangles[t][2]) - p;
            volumes_[t] = along(t, 0, normals_[mesh.edge_of[t][0]].dot(c));
        }
    }

    /// Whether a triangle is between p and `target`; those with the corner of this number do not count.
    Mask<Real> blocked(const Vector3<Real>& target, int corner = -1) const {
        const Vector3<Real> way = target - p_;
        Real sides[3 * triangle_count];
        for (int e = 0; e < mesh_.edge_count; ++e) sides[e] = normals_[e].dot(way);
        Mask<Real> result = negated(all_lanes<Real>());
        for (int t = 0; t < triangle_count; ++t) {
            const auto& [a, b, c] = mesh_.triangles[t];
            if (a == corner || b == corner || c == corner) continue;
            // A line through the triangle has its edges on one side; the way reaches it at volume / sum of the sides.
            Mask<Real> left = volumes_[t] > Real(0), right = volumes_[t] < Real(0);
            Real sum = Real(0);
            for (int i = 0; i < 3; ++i) {
                const Real side = along(t, i, sides[mesh_.edge_of[t][i]]);
                left = both(left, side > Real(0));
                right = both(right, side < Real(0));
                sum += side;
            }
            result = either(result, either(both(left, volumes_[t] < sum), both(right, volumes_[t] > sum)));
        }
        return result;
    }

private:
    /// What is of an edge, for a triangle that goes along it or against it.
    Real along(int t, int i, const Real& value) const { return mesh_.forward[t][i] ? value : -value; }

    const Mesh<triangle_count>& mesh_;
    Vector3<Real> p_, normals_[3 * triangle_count];  ///< of the planes through p and an edge
    Real volumes_[triangle_count];                   ///< six times those of the tetrahedra on p
};

/// The faces of a mesh, for distances of many points from it. Its scalar is that of its points, double or Real.
template <class Scalar, int triangle_count>
class MeshFaces {
public:
    template <class Points>
    MeshFaces(const Mesh<triangle_count>& mesh, const Points& points) : edge_count_(mesh.edge_count) {
        for (int e = 0; e < edge_count_; ++e) {
            edges_[e].from = points.col(mesh.edges[e][0]);
            edges_[e].along = points.col(mesh.edges[e][1]) - edges_[e].from;
            edges_[e].place = edges_[e].along * (Scalar(1) / edges_[e].along.squaredNorm());
        }
        for (int t = 0; t < triangle_count; ++t) {
            Face& face = faces_[t];
            face.from = points.col(mesh.triangles[t][0]);
            const Vector3<Scalar> b = points.col(mesh.triangles[t][1]) - face.from;
            const Vector3<Scalar> c = points.col(mesh.triangles[t][2]) - face.from;
            const Vector3<Scalar> normal = b.cross(c);
            const Scalar scale = Scalar(1) / normal.squaredNorm();
            face.by_b = c.cross(normal) * scale;
            face.by_c = normal.cross(b) * scale;
            face.normal = normal * sqrt(scale);
        }
    }

    /// Distance from p to the nearest face, edge or point, inside as outside.
    template <class Real>
    Real clearance(const Vector3<Real>& p) const {
        const Real zero = Real(0), one = Real(1);
        Real least = Real(__builtin_inf());
        for (int e = 0; e < edge_count_; ++e) {
            const Vector3<Real> from = p - edges_[e].from;
            const Real place = max(zero, min(one, Real(from.dot(edges_[e].place))));
            least = min(least, Real((from - place * edges_[e].along).squaredNorm()));
        }
        for (const Face& face : faces_) {
            const Vector3<Real> from = p - face.from;
            const Real b = from.dot(face.by_b), c = from.dot(face.by_c), height = from.dot(face.normal);
            const Mask<Real> above = both(both(b >= zero, c >= zero), b + c <= one);
            least = select(above, min(least, height * height), least);
        }
        return sqrt(least);
    }

private:
    struct Edge {
        Vector3<Scalar> from, along, place;  ///< place: along / length^2
    };
    struct Face {
        Vector3<Scalar> from, by_b, by_c, normal;  ///< for the coordinates of a point by the corners b and c
    };
    int edge_count_;
    Edge edges_[3 * triangle_count];
    Face faces_[triangle_count];
};

/// R = R_z(yaw) R_y(pitch) R_x(roll), from the body's frame to the world's, of angles (roll, pitch, yaw) in radians.
template <class Real>
struct EulerRotation {
    using Matrix = Eigen::Matrix<Real, 3, 3>;
    Matrix x, y, z, R;                 ///< the three factors, and R
    std::array<Matrix, 3> derivative;  ///< of R by each angle

    explicit EulerRotation(const Vector3<Real>& angles) {
        const Rotation<Real> roll = rotation(angles(0)), pitch = rotation(angles(1)), yaw = rotation(angles(2));
        const Real zero = Real(0), one = Real(1);
        x << one, zero, zero, zero, roll.cosine, -roll.sine, zero, roll.sine, roll.cosine;
        y << pitch.cosine, zero, pitch.sine, zero, one, zero, -pitch.sine, zero, pitch.cosine;
        z << yaw.cosine, -yaw.sine, zero, yaw.sine, yaw.cosine, zero, zero, zero, one;
        const Matrix zy = z * y;
        R = zy * x;
        const Vector3<Real> none = Vector3<Real>::Zero();
        derivative[0] << none, R.col(2), -R.col(1);
        derivative[1] << -zy.col(2), none, zy.col(0);
        derivative[1] *= x;
        derivative[2] << -R.row(1), R.row(0), none.transpose();
    }
};

/// Two independent standard normal draws, each drawn again until it is within +-limit: further draws have the indices
/// index + stride, index + 2 stride ...
template <class Real>
Eigen::Matrix<Real, 2, 1> truncated_normal(const OwnTrialOf<Real>& trial, double limit, int source, int pose, int index,
                                           int stride) {
    Eigen::Matrix<Real, 2, 1> draw = trial.normal(source, pose, index);
    while (true) {
        const Mask<Real> first = abs(draw(0)) > Real(limit), second = abs(draw(1)) > Real(limit);
        if (!any(either(first, second))) return draw;
        const Eigen::Matrix<Real, 2, 1> again = trial.normal(source, pose, index += stride);
        draw << select(first, again(0), draw(0)), select(second, again(1), draw(1));
    }
}

/// What a measurement adds after those before it: innovations that are independent of theirs.
template <class Real, int rows>
struct Innovation {
    Eigen::Matrix<Real, rows, 1> nu;
    Eigen::Matrix<Real, rows, rows> S;
};

/// Updates P [n, n] and the step [n] from the predicted mean by rows whose Jacobian is 0 but for its columns H
/// [rows, any] at `places`, with the same variance each. The innovation is that about the predicted mean. Where it was
/// not `seen`, nothing changes. Of P only the lower triangle is read and written.
template <class Real, int n, class DerivedH>
auto update_in_place(Eigen::Matrix<Real, n, n>& P, Eigen::Matrix<Real, n, 1>& step, const int* places,
                     const Eigen::MatrixBase<DerivedH>& H,
                     const Eigen::Matrix<Real, DerivedH::RowsAtCompileTime, 1>& innovation, const Real& variance,
                     const Mask<Real>& seen) {
    constexpr int rows = DerivedH::RowsAtCompileTime;
    Innovation<Real, rows> result{innovation, Eigen::Matrix<Real, rows, rows>::Identity() * variance};
    Eigen::Matrix<Real, rows, n> cross = Eigen::Matrix<Real, rows, n>::Zero();  // H P
    for (int c = 0; c < H.cols(); ++c)
        for (int i = 0; i < n; ++i) {
            const Real entry = i >= places[c] ? P(i, places[c]) : P(places[c], i);
            for (int r = 0; r < rows; ++r) cross(r, i) = multiply_add(H(r, c), entry, cross(r, i));
        }
    for (int c = 0; c < H.cols(); ++c)
        for (int r = 0; r < rows; ++r) {
            result.nu(r) = multiply_add(-H(r, c), step(places[c]), result.nu(r));
            for (int q = 0; q < rows; ++q) result.S(q, r) = multiply_add(H(r, c), cross(q, places[c]), result.S(q, r));
        }
    const Eigen::Matrix<Real, rows, n> K = select(seen, cholesky(result.S).solve(cross), 0);  // transposed
    step += K.transpose() * result.nu;
    for (int j = 0; j < n; ++j)
        for (int i = j; i < n; ++i)
            for (int r = 0; r < rows; ++r) P(i, j) = multiply_add(-K(r, i), cross(r, j), P(i, j));
    return result;
}

/// The trace of P [n, n] after a control that moves the pose alone, and a look: x = (pose [p], `count` features [d]).
/// P is that after all that the control does not change: the features' noise, and measurements of them alone. What no
/// candidate changes is computed once; a candidate then costs a multiple of the features that it sees, squared.
template <class Scalar, int p, int d, int count>
class Foresight {
public:
    static constexpr int n = p + d * count;
    using Matrix = Eigen::Matrix<Scalar, n, n>;
    /// `square` is P P, which may be computed for all trials of a pack at once.
    Foresight(const Matrix& P, const Matrix& square) : P_(P), square_(square) {}

    /// The pose's Jacobian F [p, p] and variances Q [p]; of each feature its Jacobian's columns for the pose [d, p],
    /// those of the feature itself being 1, its variance, and whether it would be seen: `rows`, `variances`, `seen`
    /// [count].
    template <class Real>
    Real trace(const Eigen::Matrix<Real, p, p>& F, const Eigen::Matrix<double, p, 1>& Q,
               const Eigen::Matrix<Real, d, p>* rows, const Real* variances, const Mask<Real>* seen) const {
        using Row = Eigen::Matrix<Real, d, p>;
        Row G[count];  // H F of those in sight
        Eigen::Matrix<Real, d, 2 * p> S_left[count], S_right[count];
        Eigen::Matrix<Real, d, 3 * p> C_left[count], C_right[count];
        int in_sight[count], seen_count = 0;
        for (int j = 0; j < count; ++j) {
            if (!any(seen[j])) continue;
            const int s = seen_count++;
            in_sight[s] = j;
            G[s] = product_sum(rows[j], F.transpose(), Eigen::Matrix<double, d, p>::Zero());
            const Row by_P = product_sum(G[s], pose_block(P_), of_pose(P_, j));
            const Row by_square = product_sum(G[s], pose_block(square_), of_pose(square_, j));
            const Row noisy = rows[j] * Q.asDiagonal(), moved = product_sum(by_P, F, noisy);
            S_left[s] << by_P, noisy;
            S_right[s] << G[s], rows[j];
            C_left[s] << by_square, moved, -by_P;
            C_right[s] << G[s], moved, by_P;
        }
        using Square = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic, 0, d * count, d * count>;
        Square S(d * seen_count, d * seen_count), C(S.rows(), S.rows());  // H P^- H' + R, and H P^- P^- H'
        for (int a = 0; a < seen_count; ++a)
            for (int b = 0; b <= a; ++b) {
                const int i = in_sight[a], j = in_sight[b];
                const auto of = [&](const Matrix& matrix) {
                    return product_sum(G[a], of_pose(matrix, j), matrix.template block<d, d>(p + d * i, p + d * j));
                };
                Eigen::Matrix<Real, d, d> s = product_sum(S_left[a], S_right[b], of(P_));
                Eigen::Matrix<Real, d, d> other = Eigen::Matrix<Real, d, d>::Zero();
                if (a == b) {
                    s.diagonal().array() += variances[i];
                    other.setIdentity();
                }
                const Mask<Real> both_seen = both(seen[i], seen[j]);
                S.template block<d, d>(d * a, d * b) = select(both_seen, s, other);
                s = select(both_seen, product_sum(C_left[a], C_right[b], of(square_)), 0);
                C.template block<d, d>(d * a, d * b) = s;
                C.template block<d, d>(d * b, d * a) = s.transpose();
            }
        const Real features = Real(P_.template bottomRightCorner<n - p, n - p>().trace());
        const Real pose = (F * pose_block(P_)).cwiseProduct(F).sum() + Q.sum();
        return features + pose - inverse(S).cwiseProduct(C).sum();
    }

private:
    static auto pose_block(const Matrix& matrix) { return matrix.template topLeftCorner<p, p>(); }
    static auto of_pose(const Matrix& matrix, int i) { return matrix.template block<d, p>(p + d * i, 0); }

    Matrix P_, square_;  ///< P and P P
};

}  // namespace CREDENCE_TARGET
}  // namespace credence
