#include "files/record/extents.hpp"

#include <algorithm>

namespace credence {

using hdf5::Error;
using hdf5::Extents;
using hdf5::extents_text;
using hdf5::Handle;
using hdf5::RealDataset;

namespace {

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

}  // namespace

void require_squares(const PlacedExtents& vectors, const RealDataset& matrices, const std::string& vector_name,
                     const std::string& matrix_name) {
    const Extents &v = vectors.extents, &M = matrices.extents();
    if (are_squares(M, v)) return;
    const std::string both = extents_text(M) + " and " + vectors.place + " " + extents_text(v);
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

void require_between(const PlacedExtents& dataset, std::size_t axis, hsize_t most, const std::string& of_what) {
    const hsize_t extent = dataset.extents[axis];
    const std::string has = "is " + extents_text(dataset.extents);
    if (extent == 0) throw Error(dataset.place, has + ": no " + of_what, "Write at least one");
    if (extent > most)
        throw Error(dataset.place, has + ": more than " + std::to_string(most) + " " + of_what,
                    "Write fewer of them, such as a part of the state, or every tenth step");
}

void require_same_steps(const PlacedExtents& vectors, const RealDataset& dataset, std::size_t rank,
                        const std::string& written) {
    const Extents &e = vectors.extents, &v = dataset.extents();
    if (v.size() == rank && v.size() + 1 >= e.size() && std::equal(e.begin(), e.end() - 1, v.begin())) return;
    throw Error(dataset.place(),
                "does not fit: it is " + extents_text(v) + " and " + vectors.place + " " + extents_text(e), written);
}

std::optional<RealDataset> optional_dataset(const Handle& root, const std::string& name, const std::string& other) {
    const bool there = hdf5::has_link(root, name);
    if (!there && hdf5::has_link(root, other))
        throw Error(hdf5::place_of(root, name), "is missing, but " + hdf5::place_of(root, other) + " is there",
                    "Write both, or neither");
    if (!there) return std::nullopt;
    return std::optional<RealDataset>(std::in_place, root, name);
}

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

}  // namespace credence
