// Records without a covariance of the whole state: variances only, covariances of groups, NEES alone.

#include <credence/consistency.hpp>
#include <credence/report.hpp>

#include "record_support.hpp"

namespace credence::test::record_parts_test {

namespace {

/// Uncorrelated errors of variance 1 but for component 1, of which the record says `claimed`.
DrawnRecord uncorrelated(double claimed) {
    DrawnRecord drawn(2000, 3, 3, 0, 2);
    for (std::size_t i = 0; i < drawn.error.size(); ++i) {
        drawn.error[i] = drawn.covariance[i].llt().matrixL().solve(drawn.error[i]);
        drawn.covariance[i].setIdentity();
        drawn.covariance[i](1, 1) = claimed;
    }
    return drawn;
}

std::vector<double> group_covariances(const DrawnRecord& drawn, const std::vector<int>& members) {
    std::vector<double> values;
    for (const Eigen::MatrixXd& P : drawn.covariance)
        for (const int i : members)
            for (const int j : members) values.push_back(P(i, j));
    return values;
}

std::vector<double> group_nees(const DrawnRecord& drawn, const std::vector<int>& members) {
    std::vector<double> values;
    for (std::size_t i = 0; i < drawn.error.size(); ++i)
        values.push_back(plain_nees(drawn.error[i], drawn.covariance[i], members));
    return values;
}

/// As most programs make it, without the order of creation.
Handle plain_group(const Handle& parent, const std::string& name) {
    return {H5Gcreate2(parent.id(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, name, "no group"};
}

/// /group/NAME/covariance or nees.
void write_group(const Handle& root, const DrawnRecord& drawn, const std::string& name, const std::vector<int>& members,
                 bool covariance) {
    if (!hdf5::has_link(root, "group")) plain_group(root, "group");
    const Handle group = plain_group(hdf5::open_group(root, "group"), name);
    const int d = static_cast<int>(members.size());
    if (covariance)
        return write_values(group, "covariance", extents_of(drawn, {d, d}), group_covariances(drawn, members));
    write_values(group, "nees", extents_of(drawn, {}), group_nees(drawn, members));
    hdf5::write_number<std::int32_t>(open(group, "nees"), "dimension", d);
}

/// To the rounding of sums of 30 values from matrices of condition below 1e3.
void check_close(const SeriesTotals& a, const SeriesTotals& b) {
    for (std::size_t k = 0; k < a.sum.size(); ++k) CHECK(relative(a.sum[k].rounded(), b.sum[k].rounded()) < 1e-11);
    CHECK(relative(a.run_square_sum.rounded(), b.run_square_sum.rounded()) < 1e-10);
    CHECK(a.covered == b.covered);
}

Consistency verdict_of(const Record& record) {
    return judge(evidence_of(record.results, record.results.arms.front()), 0.15);
}

}  // namespace

TEST_CASE("record: of variances each component is judged by itself") {
    const DrawnRecord drawn(30, 4, 3);
    const Record joint = read_written(drawn_with(drawn, "groups", "x0 0, x1 1, x2 2, pair 0 2"));
    const Record record = read_written([&](const Handle& root) {
        write_variances(root, drawn);
        hdf5::write_text(root, "groups", "pair 0 2");
    });
    CHECK(record.trouble_count == 0);
    for (const char* name : {"nees_x0", "nees_x1", "nees_x2", "squared_error_pair", "variance_pair", "trace_P_step",
                             "standardised_error_x1", "squared_error"})
        check_close(totals_named(record, name), totals_named(joint, name));
    CHECK(totals_named(record, "nees").runs == 0);
    CHECK(totals_named(record, "nees_pair").runs == 0);
    CHECK(std::isnan(record.results.arms.front().columns.in_memory()[column_nees_ratio][0]));
    CHECK(record.results.not_judged ==
          std::vector<std::string>{
              "The record has variances only: each component is judged by itself, and no correlation "
              "between components is; the log score is the sum of theirs.",
              "Without a covariance there is no NEES of pair."});
}

TEST_CASE("record: variances that are right are undecided, and wrong ones are found") {
    const auto judged = [](double claimed) {
        return verdict_of(read_written([&](const Handle& root) { write_variances(root, uncorrelated(claimed)); }));
    };
    const Consistency right = judged(1);
    std::string found;
    for (const Finding& finding : right.findings) found += sentence(finding) + "; ";
    CHECK(right.verdict == Verdict::undecided);
    CHECK(found == "");
    CHECK(right.trials_needed.value == 0);
    const Consistency small = judged(0.5);
    CHECK(small.verdict == Verdict::optimistic);
    REQUIRE_FALSE(small.findings.empty());
    CHECK(small.findings.front().where == "x1");
    CHECK(judged(2).verdict == Verdict::pessimistic);
}

TEST_CASE("record: a report of variances says what it cannot judge, and no `nan`") {
    const Report report = report_written([](const Handle& root) { write_variances(root, uncorrelated(1)); }, 0.15);
    const std::string text = report_text(report);
    INFO(text);
    CHECK(text.find("undecided") != std::string::npos);
    CHECK(text.find("note: The record has variances only") != std::string::npos);
    CHECK(text.find("nan") == std::string::npos);
    CHECK(Json::parse(report_json(report))[0]["not_judged"].size() == 1);
    CHECK_FALSE(report_html(report, {}).empty());
}

TEST_CASE("record: covariances of groups without a joint one are those of the groups") {
    const DrawnRecord drawn(30, 4, 4);
    const Record joint = read_written(drawn_with(drawn, "groups", "pose 0 2, rest 3"));
    const Record record = read_written([&](const Handle& root) {
        write_errors(root, drawn);
        hdf5::write_text(root, "groups", "pose 0 2, rest 3");
        write_group(root, drawn, "pose", {0, 2}, true);
        write_group(root, drawn, "rest", {3}, true);
    });
    CHECK(record.trouble_count == 0);
    for (const char* name : {"nees_pose", "nees_rest", "squared_error_pose", "variance_pose", "variance_rest",
                             "standardised_error_x0", "standardised_error_x2", "standardised_error_x3"})
        check_close(totals_named(record, name), totals_named(joint, name));
    CHECK(totals_named(record, "nees").runs == 0);
    CHECK(totals_named(record, "standardised_error_x1").runs == 0);  // component 1 is in no group
    CHECK_FALSE(record.results.has_joint_covariance);
    CHECK(verdict_of(record).verdict != Verdict::consistent);
}

TEST_CASE("record: NEES alone, of groups and of the whole state, with their dimensions") {
    const DrawnRecord drawn(30, 4, 4);
    const Record joint = read_written(drawn_with(drawn, "groups", "pose 0:3, rest 3"));
    const auto write = [&](const Handle& root) {
        write_group(root, drawn, "pose", {0, 1, 2}, false);
        write_group(root, drawn, "rest", {3}, false);
    };
    const Record groups = read_written(write), all = read_written([&](const Handle& root) {
        write(root);
        write_values(root, "nees", extents_of(drawn, {}), group_nees(drawn, {0, 1, 2, 3}));
        hdf5::write_number<double>(open(root, "nees"), "dimension", 4);
    });
    for (const char* name : {"nees_pose", "nees_rest"}) {
        check_close(totals_named(groups, name), totals_named(joint, name));
        check_close(totals_named(all, name), totals_named(joint, name));
    }
    check_close(totals_named(all, "nees"), totals_named(joint, "nees"));
    CHECK(totals_named(groups, "nees").runs == 0);
    CHECK(groups.results.all_series.size() == 3);
    CHECK_FALSE(all.results.has_joint_covariance);
    CHECK(all.results.not_judged.back() ==
          "The record has NEES and no errors: bias, directions and the size of the errors are not judged.");
    CHECK(report_text(report_written(write, 0.15)).find("nan") == std::string::npos);
}

TEST_CASE("record: a NEES that is negative or infinite, and a variance that is not positive, fail their trial") {
    DrawnRecord drawn(5, 3, 2);
    const auto trouble = [](const Record& record) {
        REQUIRE(record.trouble_count == 1);
        return std::to_string(record.troubles.front().trial) + ", " + std::to_string(record.troubles.front().step) +
               ": " + record.troubles.front().what;
    };
    const auto of_nees = [&](double value) {
        return trouble(read_written([&](const Handle& root) {
            std::vector<double> nees = group_nees(drawn, {0, 1});
            nees[4] = value;
            write_values(root, "nees", extents_of(drawn, {}), nees);
            hdf5::write_number<std::int32_t>(open(root, "nees"), "dimension", 2);
        }));
    };
    CHECK(of_nees(-1) == "1, 1: the NEES is negative");
    CHECK(of_nees(HUGE_VAL) == "1, 1: the NEES is not finite");
    const auto of_variance = [&](double value) {
        drawn.covariance[4](1, 1) = value;
        return trouble(read_written([&](const Handle& root) { write_variances(root, drawn); }));
    };
    CHECK(of_variance(0) == "1, 1: a variance is 0");
    CHECK(of_variance(-1) == "1, 1: a variance is negative");
    CHECK(of_variance(std::nan("")) == "1, 1: the variance of `x1` is NaN, and the error is not");
}

TEST_CASE("record: parts that do not fit together are refused by name") {
    const DrawnRecord drawn(3, 2, 3);
    check_refused([&](const Handle& root) { write_errors(root, drawn); }, "/covariance: is missing. Write it as");
    check_refused([&](const Handle&) {}, "/error: is missing. Write `error`");
    check_refused([&](const Handle& root) {
        write_errors(root, drawn);
        hdf5::write_text(root, "groups", "a 0, b 1");
        write_group(root, drawn, "a", {0}, true);
    }, "/@groups: nothing to judge `b` by. Write /covariance, or /group/b/covariance");
    check_refused([&](const Handle& root) {
        write_errors(root, drawn);
        write_group(root, drawn, "a", {0}, true);
    }, "/group/a: is no group of components. Name its components");
    check_refused([&](const Handle& root) {
        write_errors(root, drawn);
        hdf5::write_text(root, "groups", "a 0 1");
        write_group(root, drawn, "a", {0}, true);
    }, "/group/a/covariance: does not fit");
    check_refused([&](const Handle& root) {
        write_group(root, drawn, "a", {0}, false);
        H5Adelete(open(root, "group/a/nees").id(), "dimension");
    }, "/group/a/nees@dimension: is missing");
    check_refused([&](const Handle& root) {
        write_drawn(root, drawn);
        write_values(root, "nees", extents_of(drawn, {}), group_nees(drawn, {0, 1, 2}));
    }, "/nees: is there, and a joint covariance too");
    check_refused([&](const Handle& root) {
        write_variances(root, drawn);
        hdf5::write_text(root, "groups", "x1 0 2");
    }, "/@groups: `x1` is a component's name as well");
}

}  // namespace credence::test::record_parts_test
