// Several records at once: judged as a table, and compared trial by trial.

#include "judgement_support.hpp"
#include "program.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace credence::test::judge_cli_test {

using Catch::Contains;

namespace {

/// 300 trials of 10 steps of 2 components whose errors have unit variance and this correlation; P is `scale` I.
void write_correlated(const std::string& path, double correlation, double scale, int trials = 300) {
    constexpr int steps = 10;
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal;
    std::vector<double> error, covariance;
    for (int i = 0; i < trials * steps; ++i) {
        const double a = normal(random), b = normal(random);
        error.insert(error.end(), {a, correlation * a + std::sqrt(1 - correlation * correlation) * b});
        covariance.insert(covariance.end(), {scale, 0, 0, scale});
    }
    const auto count = static_cast<hsize_t>(trials);
    const Handle root(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose, path, "no file");
    hdf5::write_dataset(root, "error", hdf5::type_of<double>(), error.data(), {count, steps, 2}, {"", ""});
    hdf5::write_dataset(root, "covariance", hdf5::type_of<double>(), covariance.data(), {count, steps, 2, 2}, {"", ""});
}

/// Errors of 3 independent components of unit variance over 6 steps, and P = I, to be spoilt and written.
struct PlainRecord {
    static constexpr std::size_t trials = 2000, steps = 7, n = 3;
    std::vector<double> error, covariance;

    explicit PlainRecord(unsigned seed) {
        std::mt19937_64 random(seed);
        std::normal_distribution<double> normal;
        for (std::size_t i = 0; i < trials * steps * n; ++i) error.push_back(normal(random));
        for (std::size_t i = 0; i < trials * steps; ++i)
            covariance.insert(covariance.end(), {1, 0, 0, 0, 1, 0, 0, 0, 1});
    }
    double* e(std::size_t trial, std::size_t step) { return error.data() + (trial * steps + step) * n; }
    double* P(std::size_t trial, std::size_t step) { return covariance.data() + (trial * steps + step) * n * n; }
    /// Trials by their NEES, the best-behaved first.
    std::vector<std::size_t> by_nees() {
        std::vector<std::size_t> order(trials);
        std::iota(order.begin(), order.end(), std::size_t{0});
        const auto nees = [&](std::size_t trial) {
            return std::inner_product(e(trial, 0), e(trial, 0) + steps * n, e(trial, 0), 0.0);
        };
        std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return nees(a) < nees(b); });
        return order;
    }
    /// The state in other coordinates: e becomes A e, P becomes A P A'.
    void transform(const Eigen::Matrix3d& A) {
        for (std::size_t i = 0; i < trials * steps; ++i) {
            Eigen::Map<Eigen::Vector3d> x(error.data() + i * n);
            Eigen::Map<Eigen::Matrix3d> Q(covariance.data() + i * n * n);
            x = (A * x).eval();
            Q = (A * Q * A.transpose()).eval();
        }
    }
    void write(const std::string& path) const {
        const Handle root(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose, path, "no file");
        hdf5::write_dataset(root, "error", hdf5::type_of<double>(), error.data(), {trials, steps, n}, {"", ""});
        hdf5::write_dataset(root, "covariance", hdf5::type_of<double>(), covariance.data(), {trials, steps, n, n},
                            {"", ""});
    }
};

/// Ways in which a trial fails, at step 3.
using Spoil = void (*)(PlainRecord&, std::size_t trial);
const std::vector<std::pair<const char*, Spoil>> spoils{
    {"error is NaN", [](PlainRecord& r, std::size_t trial) { r.e(trial, 3)[0] = std::nan(""); }},
    {"P is NaN", [](PlainRecord& r, std::size_t trial) { r.P(trial, 3)[4] = std::nan(""); }},
    {"P is negative", [](PlainRecord& r, std::size_t trial) { r.P(trial, 3)[4] = -1; }},
    {"P is singular", [](PlainRecord& r, std::size_t trial) { std::fill_n(r.P(trial, 3), 9, 1.0); }},
    {"diverged", [](PlainRecord& r, std::size_t trial) { r.e(trial, 3)[1] = 1e13; }},
    {"cut short", [](PlainRecord& r, std::size_t trial) {
         std::fill(r.e(trial, 3), r.e(trial, 6) + 3, std::nan(""));
         std::fill(r.P(trial, 3), r.P(trial, 6) + 9, std::nan(""));
     }}};

}  // namespace

TEST_CASE("judge: the gate is closed for a record in which more than the share of trials failed, whichever they are") {
    const Workplace here;
    for (const auto& [name, spoil] : spoils)
        for (const double share : {0.001, 0.02, 0.5, 0.99})
            for (const bool best : {true, false}) {
                CAPTURE(name, share, best);
                PlainRecord record(7);
                std::vector<std::size_t> order = record.by_nees();
                if (!best) std::reverse(order.begin(), order.end());
                const auto spoilt = static_cast<std::size_t>(share * PlainRecord::trials);
                for (std::size_t i = 0; i < spoilt; ++i) spoil(record, order[i]);
                record.write(here.path("spoilt.h5"));
                const int code = here.credence("judge spoilt.h5 --quiet --require consistent").exit_code;
                CHECK(code == (share > 0.01 ? 1 : 0));
            }
}

TEST_CASE("judge: units, order and rotation of the components change no verdict") {
    const Workplace here;
    const Eigen::Matrix3d units = Eigen::Vector3d(1e6, 1, 1e-6).asDiagonal();
    Eigen::Matrix3d order, rotation = Eigen::Quaterniond(0.5, 0.1, -0.7, 0.5).normalized().toRotationMatrix();
    order << 0, 0, 1, 1, 0, 0, 0, 1, 0;
    for (const double correlation : {0.0, 0.4}) {
        PlainRecord plain(9);
        Eigen::Matrix3d mix = Eigen::Matrix3d::Identity();
        mix(1, 0) = correlation, mix(1, 1) = std::sqrt(1 - correlation * correlation);
        for (std::size_t i = 0; i < PlainRecord::trials * PlainRecord::steps; ++i) {
            Eigen::Map<Eigen::Vector3d> x(plain.error.data() + i * 3);
            x = (mix * x).eval();
        }
        for (const Eigen::Matrix3d& A : {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), units, order, rotation}) {
            PlainRecord changed = plain;
            changed.transform(A);
            changed.write(here.path("changed.h5"));
            const Json arm = Json::parse(here.credence("judge changed.h5 --quiet --format json").out)[0];
            CHECK(arm["verdict"] == (correlation == 0 ? "consistent" : "mixed"));
            if (correlation > 0) CHECK(arm["directions"]["spectrum"][2].get<double>() == Approx(1.4).margin(0.05));
        }
    }
}

TEST_CASE("judge: several records are one report, each with its verdict and its name") {
    const Workplace here;
    write_correlated(here.path("a.h5"), 0, 1);
    write_correlated(here.path("b.h5"), 0.6, 1);
    write_correlated(here.path("c.h5"), 0, 0.25);
    const Json arms = Json::parse(here.credence("judge a.h5 b.h5 c.h5 --quiet --format json").out);
    REQUIRE(arms.size() == 3);
    CHECK(arms[0]["scenario"] == "a");
    CHECK(arms[1]["verdict"] == "mixed");
    CHECK_THAT(arms[1]["findings"][0]["when"].get<std::string>(), Contains("direction 0.7"));
    CHECK(arms[2]["verdict"] == "optimistic");
    CHECK_THAT(arms[2]["hints"][0].get<std::string>(), Contains("P is too small by a factor of about 4 in every direction"));
    CHECK(here.credence("judge a.h5 a.h5 --quiet").out.find("a_2/record") != std::string::npos);
    CHECK(here.credence("judge c.h5 b.h5 --quiet --require consistent").exit_code == 1);
    CHECK(here.credence("judge a.h5 missing.h5 --quiet").exit_code == 2);
}

TEST_CASE("judge: the trials with the largest NEES are named with their steps") {
    const Workplace here;
    write_correlated(here.path("a.h5"), 0, 1);
    const Handle root(H5Fopen(here.path("a.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose, "", "");
    const auto with = [&](double error, std::size_t others) {
        for (std::size_t trial = 17; trial <= 17 + others; ++trial)
            set_value(root, "error", (trial * 10 + 3) * 2, trial == 17 ? error : error - 1);
        return Json::parse(here.credence("judge a.h5 --quiet --format json").out)[0];
    };
    const Json diverged = with(40, 0);
    CHECK(diverged["diverged"] == 1);
    CHECK(diverged["may_be_unseen"].get<double>() == Approx(0.0157).margin(1e-4));  // Clopper and Pearson, 1 of 300
    CHECK_THAT(here.credence("judge a.h5 --quiet").out,
               Contains("note: 1 trial of a/record diverged (NEES/dim over the run beyond 25)") &&
                   Contains("trial 17 (most at step 4)") && Contains(" 1 (at most 1.6 %)"));
    const Json worst = with(21, 5)["worst_trials"];
    CHECK(worst["trials"].size() == 10);
    CHECK(worst["trials"][0]["trial"] == 17);
    CHECK(worst["trials"][0]["step"] == 4);
    CHECK(worst["trials"][0]["nees_ratio"].get<double>() > 20);
    CHECK_THAT(here.credence("judge a.h5 --quiet").out, Contains("note, ten trials carry") && Contains("17 (step 4)"));
}

TEST_CASE("judge: the margins of directions and of the bias are options") {
    const Workplace here;
    write_correlated(here.path("b.h5"), 0.6, 1);
    const auto verdict = [&](const std::string& options) {
        return Json::parse(here.credence("judge b.h5 --quiet --format json " + options).out)[0]["verdict"]
            .get<std::string>();
    };
    CHECK(verdict("") == "mixed");
    CHECK(verdict("--margin 80%") == "consistent");
    for (const char* wrong : {"--margin-direction 1%", "--margin-direction 2", "--bias 0", "--bias x", "--bias 11"})
        check_refused(here.credence(std::string("judge b.h5 --quiet ") + wrong), "credence judge: invalid --");
}

TEST_CASE("compare: two records of the same runs are compared trial by trial") {
    const Workplace here;
    write_correlated(here.path("a.h5"), 0.3, 1);
    write_correlated(here.path("b.h5"), 0.3, 2);
    write_correlated(here.path("short.h5"), 0, 1, 200);
    const Outcome compared = here.credence("compare a.h5 b.h5");
    CHECK(compared.exit_code == 0);
    CHECK_THAT(compared.out,
               Contains("Both of a pair are of the same run") && Contains("300 pairs") && !Contains("unseen"));
    check_refused(here.credence("compare a.h5 short.h5"),
                  "short.h5: /error: is [200, 10, 2], not [300, 10, 2] as in the first record");
    check_refused(here.credence("compare a.h5"), "several records of the same runs");
}

TEST_CASE("compare: the truth's own covariance must not change the sign of what is concluded") {
    const Workplace here;
    write_correlated(here.path("small.h5"), 0, 0.5);  // right where half of the errors' variance is the truth's
    write_correlated(here.path("right.h5"), 0, 1);    // right where the truth is exact
    const auto compared = [&](const char* sigma) {
        for (const char* name : {"small.h5", "right.h5"}) {
            const Handle root(H5Fopen(here.path(name).c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose, "", "");
            if (H5Aexists(root.id(), "truth_sigma") > 0) H5Adelete(root.id(), "truth_sigma");
            if (*sigma != '\0') hdf5::write_text(root, "truth_sigma", sigma);
        }
        return Json::parse(here.credence("compare right.h5 small.h5 --format json").out)[0];
    };
    CHECK(compared("")["conclusion"] == "higher");
    CHECK(!compared("").contains("with_truth"));
    CHECK(compared("0.1")["conclusion"] == "higher");
    CHECK(compared("0.1")["with_truth"]["ci95"][0] > 0);
    const Json turned = compared("0.7071");
    CHECK(turned["conclusion"] == "no difference shown");
    CHECK(turned["log_score"]["ci95"][0] > 0);
    CHECK(turned["with_truth"]["ci95"][1] < 0);
    CHECK_THAT(here.credence("compare right.h5 small.h5").out, Contains("own covariance -0.068 [-0.080, -0.056]"));
}

TEST_CASE("judge: --segments takes a number of steps, auto or off") {
    const Workplace here;
    PlainRecord(7).write(here.path("trials.h5"));
    for (const char* wrong : {"0", "1", "1.5", "-3", "many", ""})
        check_refused(here.credence(std::string("judge trials.h5 --quiet --segments='") + wrong + "'"), "--segments");
    for (const char* counted : {"auto", "off", "5"}) {
        const auto report =
            here.credence(std::string("judge trials.h5 --quiet --format json --segments ") + counted);
        CHECK(Json::parse(report.out)[0]["evidence"] == (counted == std::string("5") ? "segments" : "trials"));
    }
}

TEST_CASE("judge: --require no-finding passes on what is not refuted, and fails on what is, or cannot be judged") {
    const Workplace here;
    PlainRecord record(7);
    record.write(here.path("right.h5"));
    for (double& P : record.covariance) P /= 2;
    record.write(here.path("wrong.h5"));
    write_correlated(here.path("few.h5"), 0, 1, 30);
    const auto code = [&](const std::string& name, const std::string& required) {
        return here.credence("judge " + name + ".h5 --quiet --require " + required).exit_code;
    };
    CHECK(code("right", "consistent") == 0);
    CHECK(code("right", "no-finding") == 0);
    CHECK(code("few", "consistent") == 1);
    CHECK(code("few", "no-finding") == 0);
    CHECK(code("wrong", "no-finding") == 1);
    CHECK(code("right", "no-finding --strict") == 0);
    CHECK(here.credence("judge right.h5 --quiet --strict").exit_code == 2);
    CHECK_THAT(here.credence("judge wrong.h5 --quiet --require no-finding").err,
               Contains("required no finding, but wrong/record is optimistic."));
    std::fill(record.covariance.begin(), record.covariance.end(), 0);
    record.write(here.path("failed.h5"));
    CHECK(code("failed", "no-finding") == 1);
}

}  // namespace credence::test::judge_cli_test
