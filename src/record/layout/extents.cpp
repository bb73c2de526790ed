// Checks of the extents of a record's datasets against each other.

#include "record/layout/parts.hpp"

#include <algorithm>

namespace credence {

namespace {

/// Whether `matrices` are square ones of the `vectors`.
bool are_squares(const RecordExtents& matrices, RecordExtents vectors) {
    vectors.push_back(vectors.empty() ? 0 : vectors.back());
    return matrices == vectors;
}

bool are_reversed_squares(RecordExtents matrices, RecordExtents vectors) {
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

}  // namespace

void require_squares(const PlacedExtents& vectors, const RecordDataset& matrices, const std::string& vector_name,
                     const std::string& matrix_name) {
    const RecordExtents &v = vectors.extents, &M = matrices.extents();
    if (are_squares(M, v)) return;
    const std::string both = extents_text(M) + " and " + vectors.place + " " + extents_text(v);
    if (are_reversed_squares(M, v))
        throw RecordError(
            matrices.place(),
            "has the order of its dimensions reversed, as MATLAB, Octave and Julia write them: it is " + both,
            "h5dump must show the trials first. Before you write them, turn them round: " +
                permuted(vector_name, v.size()) + " and " + permuted(matrix_name, M.size()) +
                ", and what else the record holds likewise",
            "Give the trials first: " + vector_name + ".transpose() and " + matrix_name +
                ".transpose(), and the other arrays likewise");
    throw RecordError(matrices.place(), "does not fit: it is " + both,
                      "Write " + vector_name + " as [trial, step, size] and " + matrix_name +
                          " as [trial, step, size, size], with all four even where one of them is 1");
}

void require_between(const PlacedExtents& dataset, std::size_t axis, std::uint64_t most, const std::string& of_what) {
    const std::uint64_t extent = dataset.extents[axis];
    const std::string has = "is " + extents_text(dataset.extents);
    if (extent == 0) throw RecordError(dataset.place, has + ": no " + of_what, "Write at least one");
    if (extent > most)
        throw RecordError(dataset.place, has + ": more than " + std::to_string(most) + " " + of_what,
                          "Write fewer of them, such as a part of the state, or every tenth step");
}

void require_same_steps(const PlacedExtents& vectors, const RecordDataset& dataset, std::size_t rank,
                        const std::string& written) {
    const RecordExtents &e = vectors.extents, &v = dataset.extents();
    if (v.size() == rank && v.size() + 1 >= e.size() && std::equal(e.begin(), e.end() - 1, v.begin())) return;
    throw RecordError(dataset.place(),
                      "does not fit: it is " + extents_text(v) + " and " + vectors.place + " " + extents_text(e),
                      written);
}

std::vector<double> read_by_trial(const RecordDataset& dataset, std::int64_t trials, const std::string& remedy,
                                  const std::string& of_arrays) {
    const RecordExtents all{static_cast<std::uint64_t>(trials)};
    if (dataset.extents() != all)
        throw RecordError(dataset.place(),
                          "does not fit: it is " + extents_text(dataset.extents()) + ", and there are " +
                              std::to_string(trials) + " trials",
                          remedy, of_arrays);
    std::vector<double> values(static_cast<std::size_t>(trials));
    dataset.read({0}, all, values);
    return values;
}

DatasetPointer open_optional(const RecordSource& source, const std::string& name, const std::string& other) {
    if (source.has(name)) return source.open(name);
    if (source.has(other))
        throw RecordError(record_place(name), "is missing, but " + record_place(other) + " is there",
                          "Write both, or neither");
    return nullptr;
}

}  // namespace credence
