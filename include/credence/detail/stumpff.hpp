#pragma once
// Module worlds: the functions of an angle of which exponentials, logarithms and Jacobians of rotations are made.

#include <credence/detail/functions.hpp>

namespace credence {
inline namespace CREDENCE_TARGET {

/// Stumpff's functions c_k(s) = 1/k! - s/(k + 2)! + s^2/(k + 4)! - ..., s = angle^2: c_0 = cos, c_1 = sin(angle)/angle,
/// c_2 = (1 - cos)/s and so on [Battin 1999, 4.5]. c_k = 1/k! - s c_{k+2}, which loses nothing downwards below s = 1,
/// where the last two come from their series, and next to nothing upwards beyond, where the first two are sine and
/// cosine.
template <RealNumber Real>
struct Stumpff {
    Real c0, c1, c2, c3, c4, c5;

    explicit Stumpff(Real s) {
        const Real angle = sqrt(s), inverse = Real(1) / s;
        const Rotation<Real> of_angle = rotation(angle);
        const Mask<Real> near_zero = s < Real(1);
        c4 = select(near_zero, series(s, 4), (Real(0.5) - (Real(1) - of_angle.cosine) * inverse) * inverse);
        c5 = select(near_zero, series(s, 5), (Real(1.0 / 6) - (Real(1) - of_angle.sine / angle) * inverse) * inverse);
        c2 = Real(0.5) - s * c4;
        c3 = Real(1.0 / 6) - s * c5;
        c1 = Real(1) - s * c3;
        c0 = Real(1) - s * c2;
    }

private:
    /// c_k by its first ten terms: below s = 1 the next one is less than 1e-20 of it.
    static Real series(Real s, int k) {
        constexpr int terms = 10;
        double factorial = 1;
        for (int i = 2; i <= k + 2 * (terms - 1); ++i) factorial *= i;
        Real sum = Real(1 / factorial);
        for (int term = terms - 2; term >= 0; --term) {
            factorial /= (k + 2 * term + 1) * (k + 2 * term + 2);
            sum = fnma(s, sum, Real(1 / factorial));
        }
        return sum;
    }
};

}  // namespace CREDENCE_TARGET
}  // namespace credence
