#pragma once
// Quantiles of chi-square that are the same bits with every compiler and library, because stored totals count against
// them. Reports use Boost's instead.

#include <cstdint>
#include <memory>
#include <vector>

namespace credence {

/// The p-quantile of chi-square with `degrees` = 1 ... 1000 of freedom, 0 < p < 1, to about 1e-12 of itself.
double stable_chi_square_quantile(double p, int degrees);

/// The line cut into `distribution_cells` cells that are equally probable under chi-square(degrees).
inline constexpr int distribution_cells = 4096;

/// Whether the distribution of NEES is counted: not over so many steps that the counts alone would take over 128 MB an
/// arm.
inline bool distribution_counted(int steps) { return steps <= 4096; }

class EquiprobableCells {
public:
    explicit EquiprobableCells(int degrees);

    /// The search for a value's cell, separate from the vectors that it reads, so that loops that write keep it in
    /// registers.
    struct Search {
        const double* upper;
        const std::uint16_t* first;
        double limit, scale;

        /// The cell of a value, 0 ... distribution_cells - 1: cell i holds [quantile(i / cells), quantile((i + 1) /
        /// cells)).
        int cell(double value) const {
            if (!(value < limit)) return distribution_cells - 1;
            int cell = value > 0 ? first[static_cast<int>(value * scale)] : 0;
            cell += value >= upper[cell];  // usually all are at or above, and a sum has no branch to predict
            while (value >= upper[cell]) ++cell;
            return cell;
        }
    };
    Search search() const { return {upper_.data(), first_.data(), limit_, scale_}; }
    int cell(double value) const { return search().cell(value); }
    /// Upper bounds of the cells, the last one infinite.
    const std::vector<double>& upper() const { return upper_; }

private:
    std::vector<double> upper_;
    std::vector<std::uint16_t> first_;  ///< by slot of equal width: the first cell that reaches into it
    double limit_ = 0, scale_ = 0;
};

/// The cells for a number of degrees, computed once and kept until the program ends. Thread-safe.
std::shared_ptr<const EquiprobableCells> equiprobable_cells(int degrees);

}  // namespace credence
