// Innovations that a gate removed are noticed by where the others end, and exact ones of odd kinds are not suspected.

#include <credence/report.hpp>

#include "catch.hpp"
#include "record_support.hpp"

namespace credence::test::gate_hint_test {

using Catch::Contains;

namespace {

constexpr int trials = 60, steps = 40;

std::string hints_of(const DrawnRecord& record) {
    const Report report = report_written([&](const Handle& root) {
        write_drawn(root, record);
        if (record.m == 3) hdf5::write_text(root, "row_groups", "gps 0:2, baro 2");
    });
    std::string all;
    for (const std::string& hint : report.arms.front().consistency.hints) all += hint + "\n";
    return all;
}

/// Removes some rows where their NIS is beyond a quantile of chi-square.
DrawnRecord gated(int m, const std::vector<int>& rows, double quantile) {
    DrawnRecord record(trials, steps, 2, m, 5);
    const double end = chi_square_quantile(quantile, static_cast<int>(rows.size()));
    for (std::size_t i = 0; i < record.innovation.size(); ++i)
        if (plain_nees(record.innovation[i], record.innovation_covariance[i], rows) > end)
            for (const int row : rows) record.innovation[i](row) = std::nan("");
    return record;
}

}  // namespace

TEST_CASE("gate: what it removed is noticed of all rows, or of a group of them") {
    CHECK_THAT(hints_of(gated(1, {0}, 0.95)),
               Contains("no innovation (all) has a NIS beyond 3.84, where ") && Contains("did a gate remove them?"));
    CHECK_THAT(hints_of(gated(2, {0, 1}, 0.97)), Contains("no innovation (all) has a NIS beyond 7.0"));
    CHECK_THAT(hints_of(gated(3, {0, 1}, 0.95)), Contains("no innovation (gps) has a NIS beyond 5.9"));
}

TEST_CASE("gate: none is suspected of exact records of odd kinds, nor where S has the wrong size", "[long]") {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> uniform;
    std::student_t_distribution<double> heavy(5);
    for (int number = 0; number < 200; ++number) {
        DrawnRecord record(20 + number % 20, steps, 1, 1 + number % 3, static_cast<unsigned>(number));
        const double size = number % 5 == 0 ? std::exp(2 * uniform(random) - 1) : 1;
        for (std::size_t i = 0; i < record.innovation.size(); ++i) {
            const Eigen::MatrixXd root = record.innovation_covariance[i].llt().matrixL();
            if (number % 4 == 1)
                record.innovation[i] = root * Eigen::VectorXd::NullaryExpr(record.m, [&] {
                                           return std::sqrt(12) * (uniform(random) - 0.5);
                                       });
            if (number % 4 == 2)
                record.innovation[i] =
                    root * Eigen::VectorXd::NullaryExpr(record.m, [&] { return std::sqrt(0.6) * heavy(random); });
            record.innovation[i] *= size;
        }
        CAPTURE(number, record.trials, record.m, size);
        CHECK_THAT(hints_of(record), !Contains("gate"));
    }
}

}  // namespace credence::test::gate_hint_test
