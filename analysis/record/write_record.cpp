// Writes the errors and covariances of your filter as a record that `credence judge` reads.
//
//   h5c++ write_record.cpp -lhdf5_hl && ./a.out example.h5 && credence judge example.h5
//
// Copy `write_record` into your own program. Arrays are row-major, the trial slowest.

#include <hdf5.h>
#include <hdf5_hl.h>

#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

/// `error` [trials, steps, n] = estimate - truth, wrapped where it is an angle; `covariance` [trials, steps, n, n];
/// both NaN where there is no such step (a run that ends early counts as failed, unless a dataset `steps` [trials]
/// declares how many steps it has). `names` of the components such as "x, vx, y, vy", and `groups` of them, counted
/// from 0, such as "position 0 2, velocity 1 3". False if HDF5 fails.
bool write_record(const char* path, hsize_t trials, hsize_t steps, hsize_t n, const double* error,
                  const double* covariance, const char* names, const char* groups) {
    const int version = 2;
    const hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hsize_t extents[] = {trials, steps, n, n};
    const bool written = file >= 0 && H5LTmake_dataset_double(file, "error", 3, extents, error) >= 0 &&
                         H5LTmake_dataset_double(file, "covariance", 4, extents, covariance) >= 0 &&
                         H5LTset_attribute_int(file, "/", "record_version", &version, 1) >= 0 &&
                         H5LTset_attribute_string(file, "/", "component_names", names) >= 0 &&
                         H5LTset_attribute_string(file, "/", "groups", groups) >= 0;
    return H5Fclose(file) >= 0 && written;
}

/// An example: a random walk in the plane, measured at every step, and the Kalman filter that knows it.
int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("usage: write_record RECORD.h5\n", stderr);
        return 2;
    }
    const hsize_t trials = 10000, steps = 20, n = 2;
    const double q = 0.1, r = 0.5;
    std::mt19937_64 engine(1);
    std::normal_distribution<double> normal;
    std::vector<double> errors, covariances;
    for (hsize_t trial = 0; trial < trials; ++trial) {
        double truth[2] = {0, 0}, estimate[2] = {normal(engine), normal(engine)}, P = 1;
        for (hsize_t step = 0; step < steps; ++step) {
            P += q * q;
            const double gain = P / (P + r * r);
            for (int i = 0; i < 2; ++i) {
                truth[i] += q * normal(engine);
                estimate[i] += gain * (truth[i] + r * normal(engine) - estimate[i]);
                errors.push_back(estimate[i] - truth[i]);
            }
            P *= 1 - gain;
            covariances.insert(covariances.end(), {P, 0, 0, P});
        }
    }
    return write_record(argv[1], trials, steps, n, errors.data(), covariances.data(), "x, y", "along 0, across 1") ? 0
                                                                                                                   : 1;
}
