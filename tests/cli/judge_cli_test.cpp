// Several records at once: judged as a table, and compared trial by trial.

#include "judgement_support.hpp"
#include "program.hpp"

#include <random>

using namespace credence;
using namespace credence::test;
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

}  // namespace

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
    CHECK_THAT(arms[2]["hints"][0].get<std::string>(), Contains("off by a factor of about 4"));
    CHECK(here.credence("judge a.h5 a.h5 --quiet").out.find("a_2/record") != std::string::npos);
    CHECK(here.credence("judge c.h5 b.h5 --quiet --require consistent").exit_code == 1);
    CHECK(here.credence("judge a.h5 missing.h5 --quiet").exit_code == 2);
}

TEST_CASE("judge: the trials with the largest NEES are named with their steps") {
    const Workplace here;
    write_correlated(here.path("a.h5"), 0, 1);
    const Handle root(H5Fopen(here.path("a.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose, "", "");
    set_value(root, "error", (17 * 10 + 3) * 2, 40);
    const Json worst = Json::parse(here.credence("judge a.h5 --quiet --format json").out)[0]["worst_trials"];
    CHECK(worst["trials"].size() == 10);
    CHECK(worst["trials"][0]["trial"] == 17);
    CHECK(worst["trials"][0]["step"] == 4);
    CHECK(worst["trials"][0]["nees_ratio"].get<double>() > 80);
    CHECK_THAT(here.credence("judge a.h5 --quiet").out, Contains("note, ten trials carry") && Contains("17 (step 4)"));
}

TEST_CASE("judge: the margins of directions and of the bias are options") {
    const Workplace here;
    write_correlated(here.path("b.h5"), 0.6, 1);
    const auto verdict = [&](const std::string& options) {
        return Json::parse(here.credence("judge b.h5 --quiet --format json " + options).out)[0]["verdict"].get<std::string>();
    };
    CHECK(verdict("") == "mixed");
    CHECK(verdict("--margin 80%") == "consistent");
    for (const char* wrong : {"--margin-direction 1%", "--margin-direction 2", "--bias 0", "--bias x", "--bias 11"}) {
        const Outcome refused = here.credence(std::string("judge b.h5 --quiet ") + wrong);
        CAPTURE(wrong);
        CHECK(refused.exit_code == 2);
        CHECK(refused.out.empty());
    }
}

TEST_CASE("compare: two records of the same runs are compared trial by trial") {
    const Workplace here;
    write_correlated(here.path("a.h5"), 0.3, 1);
    write_correlated(here.path("b.h5"), 0.3, 2);
    write_correlated(here.path("short.h5"), 0, 1, 200);
    const Outcome compared = here.credence("compare a.h5 b.h5");
    CHECK(compared.exit_code == 0);
    CHECK_THAT(compared.out, Contains("Both of a pair are of the same run") && Contains("300 pairs") && !Contains("unseen"));
    CHECK(here.credence("compare a.h5 short.h5").exit_code == 2);
    CHECK_THAT(here.credence("compare a.h5 short.h5").err, Contains("it has 200 trials, not 300"));
    CHECK_THAT(here.credence("compare a.h5").err, Contains("several records of the same runs"));
}
