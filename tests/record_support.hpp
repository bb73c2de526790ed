#pragma once
// Records, drawn here, and what is in them computed plainly.

#include <credence/report.hpp>

#include "files/hdf5/read.hpp"
#include "judgement_support.hpp"
#include "support.hpp"

#include <Eigen/Dense>

#include <random>

namespace credence::test {

/// A record with Gaussian errors and innovations of other covariances at each step.
struct DrawnRecord {
    int trials, steps, n, m;
    std::vector<Eigen::VectorXd> error, innovation;              ///< [trials, steps]
    std::vector<Eigen::MatrixXd> covariance, innovation_covariance;

    DrawnRecord(int trials_, int steps_, int n_, int m_ = 0, unsigned seed = 1)
        : trials(trials_), steps(steps_), n(n_), m(m_), random_(seed) {
        for (int i = 0; i < trials * steps; ++i) {
            covariance.push_back(matrix(n));
            error.push_back(draw(covariance.back()));
            if (m == 0) continue;
            innovation_covariance.push_back(matrix(m));
            innovation.push_back(draw(innovation_covariance.back()));
        }
    }
    std::size_t at(int trial, int step) const { return static_cast<std::size_t>(trial * steps + step); }
    /// Takes a component out of the state at a step.
    void hide(int trial, int step, int component) {
        error[at(trial, step)](component) = std::nan("");
        covariance[at(trial, step)].row(component).setConstant(std::nan(""));
        covariance[at(trial, step)].col(component).setConstant(std::nan(""));
    }

private:
    double normal() { return normal_(random_); }
    Eigen::MatrixXd matrix(int size) {
        Eigen::MatrixXd factor = Eigen::MatrixXd::NullaryExpr(size, size, [&] { return 0.4 * normal(); });
        factor.diagonal().array() += 1.2;
        const Eigen::MatrixXd product = factor * factor.transpose();
        return (product + product.transpose()) / 2;
    }
    Eigen::VectorXd draw(const Eigen::MatrixXd& P) {
        return P.llt().matrixL() * Eigen::VectorXd::NullaryExpr(P.rows(), [&] { return normal(); });
    }

    std::mt19937 random_;
    std::normal_distribution<double> normal_;
};

/// Row-major.
template <class Matrices>
std::vector<double> flat(const Matrices& all) {
    std::vector<double> values;
    for (const auto& one : all)
        for (Eigen::Index i = 0; i < one.rows(); ++i)
            for (Eigen::Index j = 0; j < one.cols(); ++j) values.push_back(one(i, j));
    return values;
}

/// Writes a dataset [trial, step, ...] of doubles, or of another type.
template <class T = double>
void write_values(const Handle& root, const std::string& name, const hdf5::Extents& extents,
                  const std::vector<double>& values) {
    const std::vector<T> typed(values.begin(), values.end());
    hdf5::write_dataset(root, name, hdf5::type_of<T>(), typed.data(), extents, {"", ""});
}

inline hdf5::Extents extents_of(const DrawnRecord& record, std::initializer_list<int> rest) {
    hdf5::Extents extents{static_cast<hsize_t>(record.trials), static_cast<hsize_t>(record.steps)};
    for (const int size : rest) extents.push_back(static_cast<hsize_t>(size));
    return extents;
}

/// A new file of a version, which `write` fills.
inline void write_file(const std::string& path, const std::function<void(const Handle& root)>& write, int version = 2) {
    const hdf5::QuietErrors quiet;
    const Handle root(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose, path, "no file");
    hdf5::write_number<std::int32_t>(root, "record_version", version);
    write(root);
}

inline void write_errors(const Handle& root, const DrawnRecord& record) {
    write_values(root, "error", extents_of(record, {record.n}), flat(record.error));
}

/// Errors, covariances and innovations.
inline void write_drawn(const Handle& root, const DrawnRecord& record) {
    write_errors(root, record);
    write_values(root, "covariance", extents_of(record, {record.n, record.n}), flat(record.covariance));
    if (record.m == 0) return;
    write_values(root, "innovation", extents_of(record, {record.m}), flat(record.innovation));
    write_values(root, "innovation_covariance", extents_of(record, {record.m, record.m}),
                 flat(record.innovation_covariance));
}

/// Errors and the diagonals of P.
inline void write_variances(const Handle& root, const DrawnRecord& record) {
    write_errors(root, record);
    std::vector<double> values;
    for (const Eigen::MatrixXd& P : record.covariance)
        values.insert(values.end(), P.diagonal().begin(), P.diagonal().end());
    write_values(root, "covariance", extents_of(record, {record.n}), values);
}

/// Writes a drawn record with a text attribute.
inline std::function<void(const Handle& root)> drawn_with(const DrawnRecord& record, const std::string& name,
                                                          const std::string& text) {
    return [=](const Handle& root) {
        write_drawn(root, record);
        hdf5::write_text(root, name, text);
    };
}

/// The record that `write` writes, read.
inline Record read_written(const std::function<void(const Handle& root)>& write) {
    const TemporaryFolder folder;
    write_file(folder / "record.h5", write);
    return read_record(folder / "record.h5");
}

/// The report of what `write` writes, and of a drawn record.
inline Report report_written(const std::function<void(const Handle& root)>& write, const Limits& limits = {}) {
    const TemporaryFolder folder;  // the report may read the record again
    write_file(folder / "record.h5", write);
    return make_record_report(read_record(folder / "record.h5"), "record.h5", limits);
}
inline Report report_of(const DrawnRecord& record) {
    return report_written([&](const Handle& root) { write_drawn(root, record); });
}

/// e' P^-1 e of some components, plainly.
inline double plain_nees(const Eigen::VectorXd& e, const Eigen::MatrixXd& P, const std::vector<int>& components) {
    const auto d = static_cast<Eigen::Index>(components.size());
    Eigen::VectorXd part(d);
    Eigen::MatrixXd covariance(d, d);
    for (Eigen::Index i = 0; i < d; ++i) {
        part(i) = e(components[static_cast<std::size_t>(i)]);
        for (Eigen::Index j = 0; j < d; ++j)
            covariance(i, j) = P(components[static_cast<std::size_t>(i)], components[static_cast<std::size_t>(j)]);
    }
    return part.dot(covariance.inverse() * part);
}

inline std::size_t series_named(const Record& record, const std::string& name) {
    for (std::size_t f = 0; f < record.results.all_series.size(); ++f)
        if (record.results.all_series[f].name == name) return f;
    FAIL("no series " << name);
    throw std::logic_error(name);
}

inline const SeriesTotals& totals_named(const Record& record, const std::string& name) {
    return record.results.arms.front().totals.series[series_named(record, name)];
}

/// What reading the record says, of which every message must name its place.
inline void check_refused(const std::function<void(const Handle& root)>& write, const std::string& said) {
    const TemporaryFolder folder;
    const std::string path = folder / "record.h5";
    write_file(path, write);
    const std::string refused = refusal<InputError>([&] { read_record(path); });
    INFO("expected: " << said);
    INFO("said: " << refused);
    CHECK(refused.starts_with(path + ": " + said));
    CHECK(refused.ends_with("."));
}

}  // namespace credence::test
