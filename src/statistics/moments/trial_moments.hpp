#pragma once
// What the verdict keeps of every trial: a few numbers each, from standardised errors [docs/statistics.md, Verdict].
//
// At every step errors and covariance are standardised first: e~_j = e_j / sigma_j, P~_ij = P_ij / (sigma_i sigma_j),
// sigma_j = sqrt(P_jj). NEES stays the same, units drop out, and every step counts equally.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace credence {

/// Length of the lower triangle of a symmetric matrix, row by row, and the place of an entry in it, row >= column.
constexpr int triangle_size(int dimension) { return dimension * (dimension + 1) / 2; }
constexpr int triangle_place(int row, int column) { return row * (row + 1) / 2 + column; }

/// One row of numbers for each of the first trials of a study that did not fail. NaN: what a trial does not have.
struct TrialMoments {
    int components = 0;               ///< n, of the whole state
    int groups = 0;                   ///< component groups, the whole state first
    std::vector<double> values;       ///< [trials, size()], a row as the functions below read it
    std::vector<std::int64_t> trial;  ///< [trials]: its index in the study, failed trials counted

    std::size_t trials() const { return trial.size(); }
    /// Numbers a trial: X [groups], z [n], S and C [n(n+1)/2 each].
    std::size_t size() const { return static_cast<std::size_t>(groups + components + 2 * triangle_size(components)); }
    /// Appends a row and returns it, to be filled in.
    double* append(std::int64_t index) {
        trial.push_back(index);
        values.resize(values.size() + size());
        return values.data() + values.size() - size();
    }
    const double* row(std::size_t i) const { return values.data() + i * size(); }

    /// Mean over the trial's steps of NEES/dimension of group g.
    double X(std::size_t i, int g) const { return row(i)[g]; }
    /// Mean over the trial's steps of the standardised error of component j.
    double z(std::size_t i, int j) const { return row(i)[groups + j]; }
    /// Lower triangle, row by row, of S: the sum over the trial's steps of e~ e~'.
    const double* S(std::size_t i) const { return row(i) + groups + components; }
    /// Lower triangle, row by row, of C: the sum over the trial's steps of P~.
    const double* C(std::size_t i) const { return S(i) + triangle_size(components); }
};

/// Number of parts of the trials; a direction is found on the others.
inline constexpr int fold_count = 3;

/// S and C of one group of components, which need not be contiguous, by trial. A trial in which a component is absent
/// (NaN) is left out.
struct GroupMoments {
    std::vector<int> components;  ///< of the state; d of them
    Eigen::MatrixXd S, C;         ///< [trials, d(d+1)/2]
    std::vector<int> fold;        ///< [trials]: the part that each is in

    int dimension() const { return static_cast<int>(components.size()); }
    double trials() const { return static_cast<double>(fold.size()); }
};

/// The sums of S and C over the trials of each part: over all trials of the study, which may be more than are kept.
struct FoldSums {
    double count[fold_count]{};                    ///< trials
    Eigen::MatrixXd S[fold_count], C[fold_count];  ///< [d, d]

    double trials() const { return count[0] + count[1] + count[2]; }
    Eigen::MatrixXd all_S() const { return S[0] + S[1] + S[2]; }
    Eigen::MatrixXd all_C() const { return C[0] + C[1] + C[2]; }

    /// Means over the trials of all parts but one.
    Eigen::MatrixXd mean_S_without(int fold) const { return mean_without(S, fold); }
    Eigen::MatrixXd mean_C_without(int fold) const { return mean_without(C, fold); }

private:
    Eigen::MatrixXd mean_without(const Eigen::MatrixXd* sums, int fold) const {
        const int next = (fold + 1) % fold_count, last = (fold + 2) % fold_count;
        return (sums[next] + sums[last]) / (count[next] + count[last]);
    }
};

GroupMoments group_moments(const TrialMoments& moments, const std::vector<int>& components);

/// Over the kept trials: of the whole study where all its trials are kept.
FoldSums fold_sums(const GroupMoments& group);

/// The symmetric matrix [d, d] of a lower triangle [d(d+1)/2].
Eigen::MatrixXd symmetric(const Eigen::VectorXd& triangle, int dimension);

/// The coefficients c of a triangle t for which c't = v'Mv, M the symmetric matrix of t.
Eigen::VectorXd form_coefficients(const Eigen::VectorXd& v);

}  // namespace credence
