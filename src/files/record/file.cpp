#include "files/record/file.hpp"

#include <credence/text.hpp>

#include <algorithm>
#include <cmath>

namespace credence {

namespace {

using hdf5::Error;
using hdf5::Extents;
using hdf5::extents_text;
using hdf5::Handle;
using hdf5::RealDataset;

constexpr hsize_t largest_state = 1000, largest_rows = 2000, largest_steps = 99999;

/// Whether `matrices` are square ones of the `vectors`.
bool are_squares(const Extents& matrices, Extents vectors) {
    vectors.push_back(vectors.empty() ? 0 : vectors.back());
    return matrices == vectors;
}

bool are_reversed_squares(Extents matrices, Extents vectors) {
    std::reverse(matrices.begin(), matrices.end());
    std::reverse(vectors.begin(), vectors.end());
    return are_squares(matrices, vectors);
}

/// `permute(error, [3 2 1])`
std::string permuted(const std::string& name, std::size_t rank) {
    std::string order;
    for (std::size_t axis = rank; axis > 0; --axis) order += (order.empty() ? "[" : " ") + std::to_string(axis);
    return "permute(" + name + ", " + order + "])";
}

/// Throws where the matrices are not [..., n, n] to the vectors' [..., n].
void require_squares(const RealDataset& vectors, const RealDataset& matrices, const std::string& vector_name,
                     const std::string& matrix_name) {
    const Extents &v = vectors.extents(), &M = matrices.extents();
    if (are_squares(M, v)) return;
    const std::string both = extents_text(M) + " and " + vectors.place() + " " + extents_text(v);
    if (are_reversed_squares(M, v))
        throw Error(matrices.place(),
                    "has the order of its dimensions reversed, as MATLAB, Octave and Julia write them: it is " + both +
                        ", but h5dump must show the trials first",
                    "Before you write them, turn them round: " + permuted(vector_name, v.size()) + " and " +
                        permuted(matrix_name, M.size()) + ", and what else the record holds likewise");
    throw Error(matrices.place(), "does not fit: it is " + both,
                "Write " + vector_name + " as [trial, step, size] and " + matrix_name +
                    " as [trial, step, size, size], with all four even where one of them is 1");
}

void require_between(const RealDataset& dataset, std::size_t axis, hsize_t most, const std::string& of_what) {
    const hsize_t extent = dataset.extents()[axis];
    const std::string has = "is " + extents_text(dataset.extents());
    if (extent == 0) throw Error(dataset.place(), has + ": no " + of_what, "Write at least one");
    if (extent > most)
        throw Error(dataset.place(), has + ": more than " + std::to_string(most) + " " + of_what,
                    "Write fewer of them, such as a part of the state, or every tenth step");
}

/// Throws unless `innovation` has the trials and steps of `error`.
void require_same_steps(const RealDataset& error, const RealDataset& innovation) {
    const Extents &e = error.extents(), &v = innovation.extents();
    if (v.size() == e.size() && std::equal(e.begin(), e.end() - 1, v.begin())) return;
    throw Error(innovation.place(),
                "does not fit: it is " + extents_text(v) + " and " + error.place() + " " + extents_text(e),
                "Write it as [trial, step, row], with NaN where a step has no such row");
}

std::optional<RealDataset> optional_dataset(const Handle& root, const std::string& name, const std::string& other) {
    const bool there = hdf5::has_link(root, name);
    if (!there && hdf5::has_link(root, other))
        throw Error(hdf5::place_of(root, name), "is missing, but " + hdf5::place_of(root, other) + " is there",
                    "Write both, or neither");
    if (!there) return std::nullopt;
    return std::optional<RealDataset>(std::in_place, root, name);
}

/// Throws where `name` is a group, as Octave's own `save -hdf5` writes variables.
const Handle& with_dataset(const Handle& root, const std::string& name) {
    if (!hdf5::has_link(root, name)) return root;
    const std::string place = hdf5::place_of(root, name);
    const Handle object(H5Oopen(root.id(), hdf5::hard(root, name).c_str(), H5P_DEFAULT), H5Oclose, place,
                        "cannot be opened");
    if (H5Iget_type(object.id()) == H5I_GROUP)
        throw Error(place, "is a group, not a dataset, as Octave's save makes it",
                    "Write a dataset of that name, in Octave with nccreate and ncwrite of the package netcdf");
    return root;
}

std::vector<ComponentGroup> read_blocks(const Handle& root, int n) {
    const std::string name = "blocks", place = hdf5::attribute_place(root, name);
    if (hdf5::has_attribute(root, name)) return parse_blocks(hdf5::read_any_text(root, name), n, place);
    if (hdf5::has_link(root, name) || H5Aexists_by_name(root.id(), "error", name.c_str(), H5P_DEFAULT) > 0)
        throw Error(place, "is missing, but there is a `blocks` elsewhere", "Make it an attribute of the root, `/`");
    return parse_blocks("", n, place);
}

/// The dataset `steps` [trial]: the number of steps of each run.
std::vector<int> read_steps(const RealDataset& dataset, const RecordShape& shape) {
    const Extents& extents = dataset.extents();
    const Extents all{static_cast<hsize_t>(shape.trials)};
    if (extents != all)
        throw Error(dataset.place(), "does not fit: it is " + extents_text(extents) + ", and there are " +
                                         std::to_string(shape.trials) + " trials",
                    "Write it as [trial], the number of steps of each");
    std::vector<double> values(static_cast<std::size_t>(shape.trials));
    dataset.read({0}, all, values);
    std::vector<int> steps;
    for (const double value : values) {
        if (!(value >= 1 && value <= shape.steps && value == std::nearbyint(value)))
            throw Error(dataset.place(),
                        "trial " + std::to_string(steps.size()) + " (counted from 0) has " + to_text(value) + " steps",
                        "Write whole numbers from 1 to " + std::to_string(shape.steps) + ", the steps of the file");
        steps.push_back(static_cast<int>(value));
    }
    return steps;
}

}  // namespace

RecordFile::RecordFile(const Handle& root, std::int64_t part_numbers)
    : error_(with_dataset(root, "error"), "error"),
      covariance_(with_dataset(root, "covariance"), "covariance"),
      innovation_(optional_dataset(root, "innovation", "innovation_covariance")),
      innovation_covariance_(optional_dataset(root, "innovation_covariance", "innovation")),
      part_numbers_(part_numbers) {
    require_squares(error_, covariance_, "error", "covariance");
    const Extents& extents = error_.extents();
    const std::size_t rank = extents.size();
    if (rank != 2 && rank != 3)
        throw Error(error_.place(), "is " + extents_text(extents), "Write it as [trial, step, n]");
    single_ = rank == 2;
    if (!single_) require_between(error_, 0, H5S_UNLIMITED, "trials");
    require_between(error_, rank - 2, largest_steps, "steps");
    require_between(error_, rank - 1, largest_state, "components");
    shape_.trials = single_ ? 1 : static_cast<std::int64_t>(extents[0]);
    shape_.steps = static_cast<int>(extents[rank - 2]);
    shape_.n = static_cast<int>(extents[rank - 1]);
    shape_.groups = read_blocks(root, shape_.n);
    shape_.covariance_epsilon = covariance_.epsilon();
    if (innovation_) add_innovations();
    if (hdf5::has_link(root, "steps"))
        shape_.declared = read_steps(RealDataset(root, "steps", hdf5::Numbers::any), shape_);
    else
        shape_.longest = longest_trial();
}

void RecordFile::add_innovations() {
    require_squares(*innovation_, *innovation_covariance_, "innovation", "innovation_covariance");
    require_same_steps(error_, *innovation_);
    require_between(*innovation_, error_.extents().size() - 1, largest_rows, "rows");
    shape_.m = static_cast<int>(innovation_->extents().back());
    shape_.innovation_epsilon = innovation_covariance_->epsilon();
}

/// Only the errors are read, and usually only the first trial: the search ends at a trial that has all steps.
int RecordFile::longest_trial() const {
    int longest = 0;
    std::vector<double> errors;
    for (std::int64_t trial = 0; trial < shape_.trials && longest < shape_.steps;) {
        std::int64_t trials = 1;
        for (int step = 0; step < shape_.steps;) {
            const RecordPart part = part_at(trial, step);
            longest = std::max(longest, last_step(part, errors));
            step += part.steps;
            trials = part.trials;
        }
        trial += trials;
    }
    return longest;
}

/// The number of steps, counted from the first of all, up to the last one that some trial of the part has.
int RecordFile::last_step(const RecordPart& part, std::vector<double>& errors) const {
    read(error_, part, errors);
    const auto n = static_cast<std::size_t>(shape_.n), steps = static_cast<std::size_t>(part.steps);
    int last = 0;
    for (std::size_t i = 0; i < errors.size(); ++i)
        if (!std::isnan(errors[i])) last = std::max(last, part.first_step + static_cast<int>(i / n % steps) + 1);
    return last;
}

RecordPart RecordFile::part_at(std::int64_t trial, int step) const {
    const std::int64_t n = shape_.n, m = shape_.m, of_step = n + n * n + m + m * m;
    const auto steps = static_cast<int>(std::clamp<std::int64_t>(part_numbers_ / of_step, 1, shape_.steps - step));
    if (step > 0 || steps < shape_.steps) return {trial, 1, step, steps};
    std::int64_t trials = std::max<std::int64_t>(part_numbers_ / (of_step * steps), 1);
    // Whole chunks are read, so that each is decompressed once.
    const auto together = single_ ? 1 : static_cast<std::int64_t>(covariance_.chunk()[0]);
    if (trials > together) trials -= trials % together;
    return {trial, std::min(trials, shape_.trials - trial), 0, steps};
}

void RecordFile::read(const RealDataset& dataset, const RecordPart& part, std::vector<double>& values) const {
    Extents first(dataset.extents().size(), 0), count = dataset.extents();
    const std::size_t axis = single_ ? 0 : 1;
    first[axis] = static_cast<hsize_t>(part.first_step);
    count[axis] = static_cast<hsize_t>(part.steps);
    if (!single_) {
        first[0] = static_cast<hsize_t>(part.first_trial);
        count[0] = static_cast<hsize_t>(part.trials);
    }
    std::size_t size = 1;
    for (const hsize_t extent : count) size *= extent;
    values.resize(size);
    dataset.read(first, count, values);
}

void RecordFile::read(const RecordPart& part, RecordValues& values) const {
    read(error_, part, values.error);
    read(covariance_, part, values.covariance);
    if (!innovation_) return;
    read(*innovation_, part, values.innovation);
    read(*innovation_covariance_, part, values.innovation_covariance);
}

}  // namespace credence
