#pragma once
// States on a manifold: the error in the tangent space, from a truth and an estimate [Sola, Deray, Atchuthan 2018].

#include <credence/columns.hpp>

#include "record/source.hpp"

#include <string>
#include <vector>

namespace credence {

/// local: error = Log(truth^-1 estimate); global: error = Log(estimate truth^-1).
enum class ErrorChart { local, global };

/// A product of SO2, SE2, SO3, SE3 and R1, R2 ...
class Manifold {
public:
    /// `text` such as `SE3 x R6`; `quaternion` wxyz or xyzw, needed for SO3 and SE3; `chart` local or global. Throws
    /// RecordError at the attribute that is wrong.
    static Manifold read(const RecordSource& source);

    int coordinates() const { return coordinates_; }  ///< q, of a truth and of an estimate
    int dimension() const { return dimension_; }      ///< n, of the error

    /// local, global, or plain where positions are subtracted.
    std::string chart() const;
    /// How many charts differ in the error: one of angles and numbers alone, two of rotations, three of poses.
    int charts() const;
    /// The record's own chart at 0; at 1 the other of local and global; at 2 plain: the differences of positions in the
    /// world's frame, and the rotation as in the record's own.
    void take_chart(int number);

    /// Names and units of the error's components, such as x, y, theta (rad) of SE2; x3 for a number (R) that is the
    /// fourth. A name that several factors have ends in the number of its factor. Empty where all are numbers.
    std::vector<Component> components() const;

    /// Writes the error [n]. In a factor of the product where a coordinate is not finite, all of it is so: NaN, or
    /// infinite.
    void error(const double* truth, const double* estimate, double* error) const;

    /// The first coordinate of a quaternion that is not of length 1, by a thousandth or more; -1 where there is none.
    int wrong_quaternion(const double* coordinates) const;

    /// The coordinates that are angles and components of the error; empty where the record says that they are in rad.
    std::vector<int> doubtful_angles() const;

private:
    enum class Kind { SO2, SE2, SO3, SE3, R };
    struct Factor {
        Kind kind;
        int coordinates, dimension;
    };
    static std::vector<Component> factor_components(const Factor& factor, std::size_t first);
    static Factor parse_factor(const std::string& text, const std::string& place);
    void factor_error(const Factor& factor, const double* truth, const double* estimate, double* error) const;

    std::vector<Factor> factors_;
    int coordinates_ = 0, dimension_ = 0;
    bool scalar_first_ = true;  ///< quaternions are w x y z
    ErrorChart chart_ = ErrorChart::local;
    bool plain_ = false;
    bool has_units_ = false;  ///< the record says the units of the components
};

}  // namespace credence
