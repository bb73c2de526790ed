#pragma once
// Module worlds: packs of lanes as scalars of Eigen's matrices, which may be mixed with matrices of doubles. What Eigen
// decides by branching on a scalar is refused with a sentence that says what to write instead; so is namespace std.

#include <credence/detail/functions.hpp>

#include <Eigen/Dense>

#include <algorithm>
#include <concepts>
#include <utility>

namespace Eigen {

template <int W>
struct NumTraits<credence::Lane<W>> : GenericNumTraits<double> {
    using Real = credence::Lane<W>;
    using NonInteger = Real;
    using Nested = Real;
    using Literal = double;
    // The costs are those of a double, and the same in every width, as they decide in which order Eigen adds.
    enum { RequireInitialization = 0, ReadCost = 1, AddCost = 1, MulCost = 1 };
    static Real epsilon() { return NumTraits<double>::epsilon(); }
    static Real dummy_precision() { return NumTraits<double>::dummy_precision(); }
    static Real highest() { return NumTraits<double>::highest(); }
    static Real lowest() { return NumTraits<double>::lowest(); }
    static Real infinity() { return NumTraits<double>::infinity(); }
    static Real quiet_NaN() { return NumTraits<double>::quiet_NaN(); }
};

template <int W, class Operation>
struct ScalarBinaryOpTraits<credence::Lane<W>, double, Operation> {
    using ReturnType = credence::Lane<W>;
};
template <int W, class Operation>
struct ScalarBinaryOpTraits<double, credence::Lane<W>, Operation> {
    using ReturnType = credence::Lane<W>;
};

namespace internal {
/// A pack has its own alignment, which Eigen must not lower.
template <int W, int size>
struct compute_default_alignment<credence::Lane<W>, size> {
    enum { value = 0 };
};
template <int W>
struct compute_default_alignment<credence::Lane<W>, Dynamic> {
    enum { value = 0 };
};

/// Matrices that are too large for the stack, which Eigen refuses, have their numbers elsewhere: of packs all beyond
/// 32 kB, as a filter has many of them, of doubles those that Eigen refuses.
template <class T, int size>
constexpr bool is_large =
    size > (credence::is_pack(static_cast<const T*>(nullptr)) ? 32768 : 131072) / static_cast<int>(sizeof(T));
template <class T, int size>
requires(std::same_as<T, double>&& is_large<T, size>) struct compute_default_alignment<T, size> {
    enum { value = 0 };
};
template <class T, int size, int options>
    requires is_large<T, size>
struct plain_array<T, size, options, 0> {
    T* array = new T[size];

    plain_array() = default;
    explicit plain_array(constructor_without_unaligned_array_assert) {}
    plain_array(const plain_array& other) { *this = other; }
    plain_array(plain_array&& other) noexcept : array(std::exchange(other.array, nullptr)) {}
    plain_array& operator=(const plain_array& other) {
        std::copy_n(other.array, size, array);
        return *this;
    }
    plain_array& operator=(plain_array&& other) noexcept {
        std::swap(array, other.array);
        return *this;
    }
    ~plain_array() { delete[] array; }
};

/// Products of larger matrices go coefficient by coefficient, too: Eigen's kernels for them cannot mix packs with
/// doubles, and the order in which they add depends on the size of a pack.
template <class Lhs, class Rhs>
concept HasPacks = credence::is_pack(static_cast<const typename Lhs::Scalar*>(nullptr)) ||
                   credence::is_pack(static_cast<const typename Rhs::Scalar*>(nullptr));
template <class Lhs, class Rhs>
    requires HasPacks<Lhs, Rhs>
struct generic_product_impl<Lhs, Rhs, DenseShape, DenseShape, GemmProduct>
    : generic_product_impl<Lhs, Rhs, DenseShape, DenseShape, CoeffBasedProductMode> {};
template <class Lhs, class Rhs>
    requires HasPacks<Lhs, Rhs>
struct generic_product_impl<Lhs, Rhs, DenseShape, DenseShape, GemvProduct>
    : generic_product_impl<Lhs, Rhs, DenseShape, DenseShape, CoeffBasedProductMode> {};
}  // namespace internal

// The decompositions that look at a pivot, a norm or an eigenvalue and branch. The last argument is the type
// of a second template parameter, if there is one.
#define CREDENCE_REFUSE(Decomposition, instead, ...)                                                                  \
    template <int W, int rows, int columns, int options, int most_rows,                                               \
              int most_columns __VA_OPT__(, __VA_ARGS__ second)>                                                      \
    class Decomposition<Matrix<credence::Lane<W>, rows, columns, options, most_rows, most_columns> __VA_OPT__(        \
        , second)> {                                                                                                  \
        static_assert(W < 0, "Eigen's " #Decomposition " branches on its numbers, and a Real has several: " instead); \
    }
#define CREDENCE_OF_COVARIANCE \
    "of a covariance S, write credence::cholesky(S), solve(S, b), inverse(S) or determinant(S)"
CREDENCE_REFUSE(LLT, CREDENCE_OF_COVARIANCE, int);
CREDENCE_REFUSE(LDLT, CREDENCE_OF_COVARIANCE, int);
CREDENCE_REFUSE(PartialPivLU, CREDENCE_OF_COVARIANCE);
CREDENCE_REFUSE(FullPivLU, CREDENCE_OF_COVARIANCE);
CREDENCE_REFUSE(HouseholderQR, CREDENCE_OF_COVARIANCE);
CREDENCE_REFUSE(ColPivHouseholderQR, CREDENCE_OF_COVARIANCE);
CREDENCE_REFUSE(FullPivHouseholderQR, CREDENCE_OF_COVARIANCE);
CREDENCE_REFUSE(CompleteOrthogonalDecomposition, CREDENCE_OF_COVARIANCE);
CREDENCE_REFUSE(SelfAdjointEigenSolver, "for a square root of a covariance, write credence::cholesky(P).L");
CREDENCE_REFUSE(EigenSolver, "for a square root of a covariance, write credence::cholesky(P).L");
CREDENCE_REFUSE(JacobiSVD, "for a square root of a covariance, write credence::cholesky(P).L", int);
#undef CREDENCE_OF_COVARIANCE
#undef CREDENCE_REFUSE

}  // namespace Eigen

namespace credence {
inline namespace CREDENCE_TARGET {

/// By lane, the entries of one matrix or of another of its size.
template <int W, class Yes, class No>
auto select(LaneMask<W> mask, const Eigen::MatrixBase<Yes>& yes, const Eigen::MatrixBase<No>& no) {
    const auto by_entry = [mask](const auto& a, const auto& b) { return select(mask, Lane<W>(a), Lane<W>(b)); };
    return yes.binaryExpr(no, by_entry).eval();
}
template <class Yes, class No>
typename Yes::PlainObject select(bool mask, const Eigen::MatrixBase<Yes>& yes, const Eigen::MatrixBase<No>& no) {
    if (mask) return yes;
    return no;
}
/// By lane, the matrix or 0 everywhere: a gain of 0 where nothing was measured leaves a belief as it is.
template <class AnyMask, class Yes>
auto select(AnyMask mask, const Eigen::MatrixBase<Yes>& yes, [[maybe_unused]] int zero) {
    eigen_assert(zero == 0);
    return select(mask, yes, Yes::Zero(yes.rows(), yes.cols()));
}

/// What the functions of namespace std take in place of a pack, so that the compiler can say what to write.
struct OneNumber {
    OneNumber(double) {}
    template <int W>
    OneNumber(Lane<W>) {
        static_assert(W < 0,
                      "functions of namespace std take one number, and a Real has several: write credence::sqrt, sin, "
                      "cos, atan2, exp, log, abs, min or max, and powers and the like by these");
    }
};

}  // namespace CREDENCE_TARGET
}  // namespace credence

namespace std {
#define CREDENCE_REFUSE(function)         \
    double function(credence::OneNumber); \
    double function(credence::OneNumber, credence::OneNumber);
CREDENCE_REFUSE(sqrt) CREDENCE_REFUSE(cbrt) CREDENCE_REFUSE(exp) CREDENCE_REFUSE(log) CREDENCE_REFUSE(pow)
CREDENCE_REFUSE(hypot) CREDENCE_REFUSE(sin) CREDENCE_REFUSE(cos) CREDENCE_REFUSE(tan) CREDENCE_REFUSE(asin)
CREDENCE_REFUSE(acos) CREDENCE_REFUSE(atan) CREDENCE_REFUSE(atan2) CREDENCE_REFUSE(abs) CREDENCE_REFUSE(fabs)
CREDENCE_REFUSE(fmod) CREDENCE_REFUSE(remainder) CREDENCE_REFUSE(isfinite) CREDENCE_REFUSE(isnan)
#undef CREDENCE_REFUSE
}  // namespace std
