#include "statistics/moments/trial_moments.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace credence {

namespace {

/// The places of a group's triangle in the triangle of the whole state.
std::vector<int> places_of(const std::vector<int>& components) {
    std::vector<int> places;
    for (std::size_t i = 0; i < components.size(); ++i)
        for (std::size_t j = 0; j <= i; ++j)
            places.push_back(
                triangle_place(std::max(components[i], components[j]), std::min(components[i], components[j])));
    return places;
}

bool is_whole(const TrialMoments& moments, std::size_t i, const std::vector<int>& places) {
    return std::ranges::none_of(
        places, [&](int place) { return std::isnan(moments.S(i)[place]) || std::isnan(moments.C(i)[place]); });
}

/// The part that a trial is in, chosen by its own squared errors, to single precision: whatever the order of the trials
/// and of the components, the parts are the same, and nothing that comes back every so many trials falls into one of
/// them. Each number is hashed by SplitMix64 [Steele, Lea, Flood 2014].
int fold_of(const Eigen::RowVectorXd& S, int dimension) {
    std::uint64_t sum = 0;
    for (Eigen::Index i = 0, at = 0; i < dimension; ++i, at += i + 1) {
        std::uint64_t hash = std::bit_cast<std::uint32_t>(static_cast<float>(S[at])) + 0x9e3779b97f4a7c15u;
        hash = (hash ^ (hash >> 30)) * 0xbf58476d1ce4e5b9u;
        hash = (hash ^ (hash >> 27)) * 0x94d049bb133111ebu;
        sum += hash ^ (hash >> 31);
    }
    return static_cast<int>(sum % fold_count);
}

}  // namespace

GroupMoments group_moments(const TrialMoments& moments, const std::vector<int>& components) {
    const std::vector<int> places = places_of(components);
    std::vector<std::size_t> whole;
    for (std::size_t i = 0; i < moments.trials(); ++i)
        if (is_whole(moments, i, places)) whole.push_back(i);
    const auto rows = static_cast<Eigen::Index>(whole.size()), columns = static_cast<Eigen::Index>(places.size());
    GroupMoments group{components, Eigen::MatrixXd(rows, columns), Eigen::MatrixXd(rows, columns), {}};
    for (Eigen::Index r = 0; r < rows; ++r) {
        const std::size_t i = whole[static_cast<std::size_t>(r)];
        for (Eigen::Index c = 0; c < columns; ++c) {
            group.S(r, c) = moments.S(i)[places[static_cast<std::size_t>(c)]];
            group.C(r, c) = moments.C(i)[places[static_cast<std::size_t>(c)]];
        }
        group.fold.push_back(fold_of(group.S.row(r), group.dimension()));
    }
    return group;
}

FoldSums fold_sums(const GroupMoments& group) {
    FoldSums sums;
    for (int fold = 0; fold < fold_count; ++fold) {
        Eigen::VectorXd chosen(group.S.rows());
        for (Eigen::Index i = 0; i < chosen.size(); ++i)
            chosen[i] = group.fold[static_cast<std::size_t>(i)] == fold ? 1 : 0;
        sums.count[fold] = chosen.sum();
        sums.S[fold] = symmetric(group.S.transpose() * chosen, group.dimension());
        sums.C[fold] = symmetric(group.C.transpose() * chosen, group.dimension());
    }
    return sums;
}

Eigen::MatrixXd symmetric(const Eigen::VectorXd& triangle, int dimension) {
    Eigen::MatrixXd matrix(dimension, dimension);
    for (int i = 0; i < dimension; ++i)
        for (int j = 0; j <= i; ++j) matrix(i, j) = matrix(j, i) = triangle[triangle_place(i, j)];
    return matrix;
}

Eigen::VectorXd form_coefficients(const Eigen::VectorXd& v) {
    const int dimension = static_cast<int>(v.size());
    Eigen::VectorXd coefficients(triangle_size(dimension));
    for (int i = 0; i < dimension; ++i)
        for (int j = 0; j <= i; ++j) coefficients[triangle_place(i, j)] = (i == j ? 1 : 2) * v[i] * v[j];
    return coefficients;
}

}  // namespace credence
