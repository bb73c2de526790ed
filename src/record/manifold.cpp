#include "record/manifold.hpp"

#include <credence/error.hpp>
#include <credence/text.hpp>

#include "base/nan.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace credence {

namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int largest_dimension = 1000;  // of a factor, and of the product
const std::string manifold_example = "Write a product of SO2, SE2, SO3, SE3 and R1, R2 ..., such as `SE3 x R6`";

/// In [-pi, pi].
double wrapped(double angle) { return std::remainder(angle, 2 * std::numbers::pi); }

/// (t/2) cot(t/2), t in [-pi, pi].
double half_cotangent(double t) {
    const double half = t / 2;
    return std::abs(half) < 1e-4 ? 1 - half * half / 3 : half / std::tan(half);
}

Vector3d log_of(const Quaterniond& q) {
    const double sign = q.w() < 0 ? -1 : 1, w = sign * q.w();
    const Vector3d v = sign * q.vec();
    const double sine = v.norm();
    return sine < 1e-10 ? Vector3d(2 / w * v) : Vector3d(2 * std::atan2(sine, w) / sine * v);
}

/// V(phi)^-1 t: the translation of Log, V the left Jacobian of SO3.
Vector3d unturned(const Vector3d& phi, const Vector3d& t) {
    const double angle = phi.norm(), factor = angle < 1e-4 ? 1.0 / 12 : (1 - half_cotangent(angle)) / (angle * angle);
    return t - phi.cross(t) / 2 + factor * phi.cross(phi.cross(t));
}

Vector2d unturned(double angle, const Vector2d& t) {
    const double a = half_cotangent(angle), b = angle / 2;
    return {a * t.x() + b * t.y(), a * t.y() - b * t.x()};
}

Vector2d turned(double angle, const Vector2d& t) { return Eigen::Rotation2Dd(angle) * t; }

bool has_quaternion(int coordinates, int dimension) { return coordinates == dimension + 1; }

std::string required_text(const RecordSource& source, const std::string& name,
                          const std::vector<std::string>& choices) {
    const std::string place = record_attribute_place(name), remedy = "Write " + joined(choices, " or ");
    if (!source.has_attribute(name)) throw RecordError(place, "is missing", remedy);
    const std::string text = source.text(name);
    if (std::ranges::find(choices, text) == choices.end())
        throw RecordError(place, "is `" + printable(text) + "`", remedy);
    return text;
}

}  // namespace

Manifold::Factor Manifold::parse_factor(const std::string& text, const std::string& place) {
    if (text == "SO2") return {Kind::SO2, 1, 1};
    if (text == "SE2") return {Kind::SE2, 3, 3};
    if (text == "SO3") return {Kind::SO3, 4, 3};
    if (text == "SE3") return {Kind::SE3, 7, 6};
    const auto size = text.starts_with("R") ? to_integer(text.substr(1)) : std::nullopt;
    if (!size || *size < 1 || *size > largest_dimension)
        throw RecordError(place, "`" + printable(text) + "` is no manifold", manifold_example);
    return {Kind::R, static_cast<int>(*size), static_cast<int>(*size)};
}

Manifold Manifold::read(const RecordSource& source) {
    const std::string name = "manifold", place = record_attribute_place(name);
    if (!source.has_attribute(name)) throw RecordError(place, "is missing", manifold_example);
    Manifold manifold;
    bool quaternions = false;
    for (const std::string& text : split_list(source.text(name), 'x')) {
        const Factor factor = parse_factor(text, place);
        manifold.factors_.push_back(factor);
        manifold.coordinates_ += factor.coordinates;
        manifold.dimension_ += factor.dimension;
        if (manifold.dimension_ > largest_dimension)
            throw RecordError(place, "has more than " + std::to_string(largest_dimension) + " dimensions",
                              "Write a part of the state");
        quaternions = quaternions || has_quaternion(factor.coordinates, factor.dimension);
    }
    manifold.has_units_ = source.has_attribute("component_units");
    if (manifold.factors_.empty()) throw RecordError(place, "names no manifold", manifold_example);
    if (quaternions) manifold.scalar_first_ = required_text(source, "quaternion", {"wxyz", "xyzw"}) == "wxyz";
    if (required_text(source, "chart", {"local", "global"}) == "global") manifold.chart_ = ErrorChart::global;
    return manifold;
}

std::string Manifold::chart() const { return plain_ ? "plain" : chart_ == ErrorChart::local ? "local" : "global"; }

int Manifold::charts() const {
    int charts = 1;
    for (const Factor& factor : factors_) {
        if (factor.kind == Kind::SO3) charts = std::max(charts, 2);
        if (factor.kind == Kind::SE2 || factor.kind == Kind::SE3) charts = 3;
    }
    return charts;
}

void Manifold::take_chart(int number) {
    if (number == 1) chart_ = chart_ == ErrorChart::local ? ErrorChart::global : ErrorChart::local;
    plain_ = number == 2;
}

/// `first` is the index of its first component in the whole error.
std::vector<Component> Manifold::factor_components(const Factor& factor, std::size_t first) {
    const std::vector<Component> rotation{{"rotation_x", "rad"}, {"rotation_y", "rad"}, {"rotation_z", "rad"}};
    std::vector<Component> components;
    switch (factor.kind) {
        case Kind::SO2: return {{"theta", "rad"}};
        case Kind::SE2: return {{"x", ""}, {"y", ""}, {"theta", "rad"}};
        case Kind::SO3: return rotation;
        case Kind::SE3:
            components = {{"translation_x", ""}, {"translation_y", ""}, {"translation_z", ""}};
            components.insert(components.end(), rotation.begin(), rotation.end());
            return components;
        case Kind::R:
            for (std::size_t i = 0; i < static_cast<std::size_t>(factor.dimension); ++i)
                components.push_back({"x" + std::to_string(first + i), ""});
            return components;
    }
    return components;
}

std::vector<Component> Manifold::components() const {
    if (std::ranges::all_of(factors_, [](const Factor& factor) { return factor.kind == Kind::R; })) return {};
    std::vector<Component> components;
    std::vector<std::size_t> factor_of;  // of each component
    for (std::size_t f = 0; f < factors_.size(); ++f) {
        const std::vector<Component> more = factor_components(factors_[f], components.size());
        components.insert(components.end(), more.begin(), more.end());
        factor_of.resize(components.size(), f);
    }
    const std::vector<Component> plain = components;
    for (std::size_t j = 0; j < components.size(); ++j)
        if (std::ranges::count(plain, plain[j].name, &Component::name) > 1)
            components[j].name += "_" + std::to_string(factor_of[j] + 1);
    return components;
}

void Manifold::error(const double* truth, const double* estimate, double* error) const {
    for (const Factor& factor : factors_) {
        double sum = 0;  // NaN or infinite where a coordinate is
        for (int i = 0; i < factor.coordinates; ++i) sum += 0 * truth[i] + 0 * estimate[i];
        const bool any_nan =
            std::any_of(truth, truth + factor.coordinates, [](double x) { return std::isnan(x); }) ||
            std::any_of(estimate, estimate + factor.coordinates, [](double x) { return std::isnan(x); });
        if (sum == 0)
            factor_error(factor, truth, estimate, error);
        else
            std::fill(error, error + factor.dimension, any_nan ? nan : std::numeric_limits<double>::infinity());
        truth += factor.coordinates;
        estimate += factor.coordinates;
        error += factor.dimension;
    }
}

void Manifold::factor_error(const Factor& factor, const double* truth, const double* estimate, double* error) const {
    const bool local = chart_ == ErrorChart::local;
    const auto quaternion = [&](const double* q) {
        return (scalar_first_ ? Quaterniond(q[0], q[1], q[2], q[3]) : Quaterniond(q[3], q[0], q[1], q[2])).normalized();
    };
    switch (factor.kind) {
        case Kind::R:
            for (int i = 0; i < factor.dimension; ++i) error[i] = estimate[i] - truth[i];
            return;
        case Kind::SO2: error[0] = wrapped(estimate[0] - truth[0]); return;
        case Kind::SE2: {
            const double angle = wrapped(estimate[2] - truth[2]);
            const Vector2d T(truth[0], truth[1]), E(estimate[0], estimate[1]);
            const Vector2d t =
                plain_ ? Vector2d(E - T)
                       : unturned(angle, local ? turned(-truth[2], E - T) : Vector2d(E - turned(angle, T)));
            error[0] = t.x();
            error[1] = t.y();
            error[2] = angle;
            return;
        }
        case Kind::SO3:
        case Kind::SE3: {
            const int at = factor.kind == Kind::SE3 ? 3 : 0;
            const Quaterniond T = quaternion(truth + at), E = quaternion(estimate + at);
            const Quaterniond between = local ? T.conjugate() * E : E * T.conjugate();
            const Vector3d phi = log_of(between);
            std::copy_n(phi.data(), 3, error + at);
            if (at == 0) return;
            const Vector3d of_truth(truth[0], truth[1], truth[2]), of_estimate(estimate[0], estimate[1], estimate[2]);
            const Vector3d t = plain_ ? Vector3d(of_estimate - of_truth)
                                      : unturned(phi, local ? Vector3d(T.conjugate() * (of_estimate - of_truth))
                                                            : Vector3d(of_estimate - between * of_truth));
            std::copy_n(t.data(), 3, error);
            return;
        }
    }
}

std::vector<int> Manifold::doubtful_angles() const {
    std::vector<int> angles;
    int at = 0;
    for (const Factor& factor : factors_) {
        at += factor.coordinates;
        if (!has_units_ && (factor.kind == Kind::SO2 || factor.kind == Kind::SE2)) angles.push_back(at - 1);
    }
    return angles;
}

int Manifold::wrong_quaternion(const double* coordinates) const {
    int at = 0;
    for (const Factor& factor : factors_) {
        const int first = at + factor.coordinates - 4;
        if (has_quaternion(factor.coordinates, factor.dimension)) {
            double square = 0, others = 0;
            for (int i = first; i < first + 4; ++i) square += coordinates[i] * coordinates[i];
            for (int i = at; i < first; ++i) others += 0 * coordinates[i];
            if (std::isfinite(square) && others == 0 && std::abs(std::sqrt(square) - 1) > 1e-3) return first;
        }
        at += factor.coordinates;
    }
    return -1;
}

}  // namespace credence
