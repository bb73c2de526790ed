// The causes that are named, each of a record in which it was planted, and none of exact records of odd kinds.

#include <numbers>
#include <random>

#include "record_support.hpp"
#include "statistics/moments/trial_moments.hpp"
#include "verdict/judgement.hpp"

namespace credence::test::causes_test {

using Catch::Contains;

namespace {

/// Errors and diagonal covariances, one variance for each step and component.
struct Planted {
    int trials = 400, steps = 12, n = 3;
    Eigen::MatrixXd variance = Eigen::MatrixXd(12, 3);  ///< [step, component] of the errors
    Eigen::MatrixXd said;                               ///< what P says of them

    Planted() {
        for (int k = 0; k < steps; ++k)
            for (int j = 0; j < n; ++j) variance(k, j) = std::exp(0.8 * std::sin(1 + 3 * k + 5 * j) - 2 * j);
        said = variance;
    }

    std::vector<std::string> causes(const std::function<void(DrawnRecord&)>& change = {}) const {
        DrawnRecord record(trials, steps, n);
        std::mt19937_64 random(7);
        std::normal_distribution<double> normal;
        for (int i = 0; i < trials; ++i)
            for (int k = 0; k < steps; ++k) {
                for (int j = 0; j < n; ++j)
                    record.error[record.at(i, k)](j) = std::sqrt(variance(k, j)) * normal(random);
                record.covariance[record.at(i, k)] = said.row(k).asDiagonal();
            }
        if (change) change(record);
        return causes_in(record);
    }

    /// By the record's steps, or by the mean sizes of its errors, as of a study.
    static std::vector<std::string> causes_in(const DrawnRecord& drawn, bool by_steps = true) {
        const TemporaryFolder folder;
        write_file(folder / "record.h5", [&](const Handle& root) { write_drawn(root, drawn); });
        const Record record = read_record(folder / "record.h5");
        const Evidence evidence =
            by_steps ? evidence_of(record) : evidence_of(record.results, record.results.arms.front());
        return judge(evidence, Limits()).hints;
    }
};

std::string first_cause(const Planted& planted, const std::function<void(DrawnRecord&)>& change = {}) {
    const std::vector<std::string> causes = planted.causes(change);
    return causes.empty() ? "" : causes.front();
}

}  // namespace

TEST_CASE("causes: what P holds in place of variances") {
    Planted planted;
    CHECK(planted.causes().empty());
    planted.said = planted.variance.cwiseSqrt();
    CHECK_THAT(first_cause(planted), Contains("does P hold standard deviations"));
    planted.variance *= 20;  // so that no run diverges
    planted.said = planted.variance.cwiseAbs2();
    CHECK_THAT(first_cause(planted), Contains("does P hold squared variances"));
    planted.variance /= 20;
    planted.said = planted.variance.cwiseInverse();
    CHECK_THAT(first_cause(planted), Contains("does P hold the inverse of the covariance"));
    planted.said = 4 * planted.variance;  // a scale is no power
    CHECK_THAT(first_cause(planted), Contains("P is too large by a factor of about 4"));
    planted.variance.setConstant(4);  // without a spread, a power is a scale
    planted.said.setConstant(2);
    CHECK_THAT(first_cause(planted), Contains("P is too small by a factor of about 2 in every direction"));
}

TEST_CASE("causes: of a study they are applied to the mean sizes of the errors") {
    DrawnRecord drawn(400, 12, 3);
    for (std::size_t i = 0; i < drawn.error.size(); ++i) {
        const Eigen::Vector3d sigma(0.2, 1, 3);
        drawn.error[i] = sigma.cwiseProduct(drawn.error[i].cwiseQuotient(drawn.covariance[i].diagonal().cwiseSqrt()));
        drawn.covariance[i] = sigma.cwiseAbs2().asDiagonal();
    }
    for (Eigen::MatrixXd& P : drawn.covariance) P.diagonal().reverseInPlace();
    const std::vector<std::string> exchanged = Planted::causes_in(drawn, false);
    REQUIRE(exchanged.size() == 1);
    CHECK_THAT(exchanged.front(), Contains("errors of x0 are as large as P says of x2"));
}

TEST_CASE("causes: a filter that diverges, and not a factor however large") {
    Planted planted;
    const Eigen::MatrixXd right = planted.variance;
    planted.said = right / 1e4;
    for (const std::string& cause : planted.causes()) CHECK_THAT(cause, !Contains("diverges"));
    planted.said = right;
    planted.said.col(1) /= 1e6;  // a unit
    for (const std::string& cause : planted.causes()) CHECK_THAT(cause, !Contains("diverges"));
    planted.said = right;
    for (int k = 0; k < planted.steps; ++k) planted.variance.row(k) *= std::pow(3, k);
    REQUIRE(planted.causes().size() == 1);
    CHECK_THAT(first_cause(planted), Contains("the filter diverges, NEES/dim is ") && Contains("is a Jacobian wrong") &&
                                         Contains("jacobian_mismatch"));
    planted.variance = right;
    for (int k = 0; k < planted.steps; ++k) planted.variance.row(k) *= 1 + 0.2 * k;  // far from diverged
    for (const std::string& cause : planted.causes()) CHECK_THAT(cause, !Contains("diverges"));
}

TEST_CASE("causes: degrees, components that are exchanged, and variances that stand for unknown") {
    Planted planted;
    const double squared_degrees = std::pow(180 / std::numbers::pi, 2);
    planted.said.col(2) /= squared_degrees;
    CHECK_THAT(first_cause(planted), Contains("errors of x2 are 57 times P's sigma"));
    planted.said.col(2) *= squared_degrees * squared_degrees;
    CHECK_THAT(first_cause(planted), Contains("errors of x2 are 1/57 of P's sigma"));
    planted.said = planted.variance;
    planted.said.col(0).swap(planted.said.col(2));
    CHECK_THAT(first_cause(planted),
               Contains("errors of x0 are as large as P says of x2, and the other way round"));
    planted.said = planted.variance;
    planted.said.col(1).setConstant(1e12);
    CHECK_THAT(first_cause(planted), Contains("P says next to nothing of x1"));
}

TEST_CASE("causes: P of the step before or after, a start alone, and few trials that are wrong") {
    Planted planted;
    planted.said.bottomRows(11) = planted.variance.topRows(11);
    CHECK_THAT(first_cause(planted), Contains("P of the step after says: is P a step late?"));
    planted.said = planted.variance;
    planted.said.topRows(11) = planted.variance.bottomRows(11);
    CHECK_THAT(first_cause(planted), Contains("P of the step before says: is P a step early?"));
    planted.said = planted.variance;
    planted.said.topRows(2) /= 4;
    CHECK_THAT(first_cause(planted), Contains("at the last: is P at the start that of the first"));
    planted.said = planted.variance;
    for (int k = 0; k < planted.steps; ++k) planted.said.row(k) /= 1 + 0.02 * k * k;
    CHECK_THAT(first_cause(planted), Contains("at the last: do errors build up"));
    planted.said = planted.variance;
    const auto spoil = [](DrawnRecord& record) {
        for (int i = 0; i < 20; ++i)
            for (int k = 0; k < record.steps; ++k) record.error[record.at(i, k)] *= 4;  // NEES/dim 16: not diverged
    };
    CHECK_THAT(first_cause(planted, spoil), Contains("few steps carry what is too large: outliers, or a few trials"));
}

TEST_CASE("causes: an offset, and none where the mean error changes with the steps") {
    const Planted planted;
    const auto shifted = [](double by_step) {
        return [by_step](DrawnRecord& record) {
            for (int i = 0; i < record.trials; ++i)
                for (int k = 0; k < record.steps; ++k) record.error[record.at(i, k)](1) += 0.3 - by_step * k;
        };
    };
    CHECK_THAT(first_cause(planted, shifted(0)), Contains("on average at all steps: an offset"));
    CHECK(first_cause(planted, shifted(0.05)).find("offset") == std::string::npos);
}

TEST_CASE("causes: none is named of exact records of odd kinds") {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> uniform;
    const auto between = [&](double low, double high) { return low + (high - low) * uniform(random); };
    for (int number = 0; number < 200; ++number) {
        DrawnRecord record(static_cast<int>(between(25, 120)), static_cast<int>(between(1, 12)),
                           static_cast<int>(between(1, 5)), 0, static_cast<unsigned>(number));
        Eigen::VectorXd unit(record.n);
        for (double& one : unit) one = std::exp(between(-8, 8));
        const bool heavy = number % 3 == 0;
        for (std::size_t i = 0; i < record.error.size(); ++i) {
            const double scale = heavy ? (uniform(random) < 0.05 ? 3 : 1) / std::sqrt(1.4) : 1;
            record.error[i] = (scale * unit.array() * record.error[i].array()).matrix();
            record.covariance[i] = unit.asDiagonal() * record.covariance[i] * unit.asDiagonal();
        }
        CAPTURE(number, record.trials, record.steps, record.n);
        CHECK(Planted::causes_in(record) == std::vector<std::string>());
    }
}

TEST_CASE("causes: two trials that are the same run are named, however many there are") {
    const DrawnRecord drawn(60, 5, 2);
    const Record record = read_written([&](const Handle& root) { write_drawn(root, drawn); });
    Evidence evidence = evidence_of(record.results, record.results.arms.front());
    CHECK(repeated_trials(evidence).empty());
    TrialMoments moments = *evidence.moments;  // as of a study, where a copy is a trial like the others
    std::copy_n(moments.row(3), moments.size(), &moments.values[41 * moments.size()]);
    evidence.moments = std::make_shared<const TrialMoments>(moments);
    CHECK(repeated_trials(evidence) == "trials 3 and 41 are the same run: was a seed used twice?");
}

}  // namespace credence::test::causes_test
