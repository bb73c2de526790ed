#pragma once
// The datasets of a record for `judge`: their extents checked against each other, and read part by part.

#include "files/hdf5/slab.hpp"
#include "worlds/own/step.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace credence {

/// A part of the record that is read at once: whole trials, or some steps of one.
struct RecordPart {
    std::int64_t first_trial = 0, trials = 0;
    int first_step = 0, steps = 0;
};

/// Values of a part, row-major; innovations are empty where there are none.
struct RecordValues {
    std::vector<double> error;                  ///< [trials, steps, n]
    std::vector<double> covariance;             ///< [trials, steps, n, n]
    std::vector<double> innovation;             ///< [trials, steps, m]
    std::vector<double> innovation_covariance;  ///< [trials, steps, m, m]
};

/// All functions throw hdf5::Error.
class RecordFile {
public:
    /// `part_numbers`: how many numbers are read at once, 64 MiB of doubles by default.
    explicit RecordFile(const hdf5::Handle& root, std::int64_t part_numbers = (std::int64_t{64} << 20) / 8);

    const RecordShape& shape() const { return shape_; }

    /// The part that starts at a trial and step, as large as allowed, but at least one step.
    RecordPart part_at(std::int64_t trial, int step) const;
    void read(const RecordPart& part, RecordValues& values) const;

private:
    void read(const hdf5::RealDataset& dataset, const RecordPart& part, std::vector<double>& values) const;
    void add_innovations();
    int longest_trial() const;
    int last_step(const RecordPart& part, std::vector<double>& errors) const;

    hdf5::RealDataset error_, covariance_;
    std::optional<hdf5::RealDataset> innovation_, innovation_covariance_;
    std::int64_t part_numbers_;
    bool single_ = false;            ///< one trial, without a dimension for trials
    RecordShape shape_;
};

/// The whole state as `all`, then the component groups that a text names, such as `pose 0:3, feature_1 3:5`, of a state
/// of n components. Throws hdf5::Error at `place`.
std::vector<ComponentGroup> parse_blocks(const std::string& text, int n, const std::string& place);

}  // namespace credence
