#pragma once
// Records for `judge`, made here or by tests/reference/make_records.py.

#include <credence/record.hpp>

#include "reference.hpp"
#include "store_damage.hpp"

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

namespace credence::test {

inline const std::string record_folder = CREDENCE_SOURCE "/tests/reference/";

/// The expected values that make_records.py computed for its small records, by their name.
inline const Json& record_series() {
    static const Json values = Json::parse(std::ifstream(record_folder + "records.json"));
    return values;
}

/// A record of 3 trials, 4 steps, 2 components and 2 rows, whose values are `error` and `innovation` 0.5 everywhere and
/// unit covariances; `change` may then change it.
inline void write_plain_record(const std::string& path, const std::function<void(const Handle& root)>& change = {}) {
    const hdf5::QuietErrors quiet;
    const Handle root(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose, path, "no file");
    std::vector<double> vectors(3 * 4 * 2, 0.5);
    std::fill(vectors.begin() + 8, vectors.begin() + 18, -0.5);  // runs that are no copies, with the same NEES
    std::vector<double> matrices;
    for (int i = 0; i < 3 * 4; ++i) matrices.insert(matrices.end(), {1, 0, 0, 1});
    for (const char* name : {"error", "innovation"})
        hdf5::write_dataset(root, name, hdf5::type_of<double>(), vectors.data(), {3, 4, 2}, {"", ""});
    for (const char* name : {"covariance", "innovation_covariance"})
        hdf5::write_dataset(root, name, hdf5::type_of<double>(), matrices.data(), {3, 4, 2, 2}, {"", ""});
    if (change) change(root);
}

/// Overwrites one value of a dataset of doubles.
inline void set_value(const Handle& root, const std::string& name, std::size_t at, double value) {
    const Handle dataset(H5Dopen2(root.id(), name.c_str(), H5P_DEFAULT), H5Dclose, name, "missing");
    const Handle space(H5Dget_space(dataset.id()), H5Sclose, name, "space");
    std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.id())));
    H5Dread(dataset.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    values.at(at) = value;
    H5Dwrite(dataset.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
}

}  // namespace credence::test
