// Records: groups as lists of components, names and units of components, groups of innovation rows, times,
// and singles.

#include "record_support.hpp"

namespace credence::test::record_groups_test {

namespace {

/// The same bits.
void check_same(const SeriesTotals& a, const SeriesTotals& b) {
    for (std::size_t k = 0; k < a.sum.size(); ++k) CHECK(a.sum[k].rounded() == b.sum[k].rounded());
    for (std::size_t k = 0; k < a.square_sum.size(); ++k) CHECK(a.square_sum[k].rounded() == b.square_sum[k].rounded());
    CHECK(a.run_sum->rounded() == b.run_sum->rounded());
    CHECK(a.run_square_sum.rounded() == b.run_square_sum.rounded());
    CHECK(a.covered == b.covered);
}

void check_sums(const DrawnRecord& drawn, const SeriesTotals& totals, const std::function<double(std::size_t)>& value) {
    for (int k = 0; k < drawn.steps; ++k) {
        double sum = 0;
        for (int trial = 0; trial < drawn.trials; ++trial) sum += value(drawn.at(trial, k));
        // Sums of 30 values, from matrices of condition below 1e3.
        CHECK(relative(totals.sum[static_cast<std::size_t>(k)].rounded(), sum) < 1e-11);
    }
}

}  // namespace

TEST_CASE("record: groups are lists of components in any order, and ranges") {
    const DrawnRecord drawn(30, 4, 5);
    const Record record =
        read_written(drawn_with(drawn, "groups", "position 0 2, velocity 1 3 ,heading 4, mixed 4 0:2"));
    const std::vector<std::pair<std::string, std::vector<int>>> groups{
        {"position", {0, 2}}, {"velocity", {1, 3}}, {"heading", {4}}, {"mixed", {4, 0, 1}}};
    for (const auto& [name, components] : groups) {
        CAPTURE(name);
        const auto over = [&, &members = components](const std::function<double(std::size_t, int)>& value) {
            return [&, value](std::size_t i) {
                double sum = 0;
                for (const int j : members) sum += value(i, j);
                return sum;
            };
        };
        check_sums(drawn, totals_named(record, "nees_" + name), [&, &members = components](std::size_t i) {
            return plain_nees(drawn.error[i], drawn.covariance[i], members);
        });
        check_sums(drawn, totals_named(record, "squared_error_" + name),
                   over([&](std::size_t i, int j) { return drawn.error[i](j) * drawn.error[i](j); }));
        check_sums(drawn, totals_named(record, "variance_" + name),
                   over([&](std::size_t i, int j) { return drawn.covariance[i](j, j); }));
        CHECK(record.results.all_series[series_named(record, "nees_" + name)].dimension ==
              static_cast<int>(components.size()));
    }
}

TEST_CASE("record: a list of successive components has the bits of a range") {
    const DrawnRecord drawn(20, 3, 5);
    const auto with = [&](const std::string& groups) { return read_written(drawn_with(drawn, "groups", groups)); };
    const Record list = with("pose 1 2 3"), range = with("pose 1:4");
    for (const char* name : {"nees_pose", "squared_error_pose", "variance_pose"})
        check_same(totals_named(list, name), totals_named(range, name));
}

TEST_CASE("record: components have names and units") {
    const DrawnRecord drawn(5, 2, 3);
    const Record record = read_written([&](const Handle& root) {
        write_drawn(root, drawn);
        hdf5::write_text(root, "component_names", "px, py, heading");
        hdf5::write_text(root, "component_units", "m, m, rad");
        hdf5::write_text(root, "groups", "pose 0 2");
    });
    CHECK(record.results.all_series[series_named(record, "standardised_error_heading")].part == "heading");
    CHECK(record.results.all_series[series_named(record, "squared_error_pose")].unit == "m^2 + rad^2");
    CHECK(record.results.all_series[series_named(record, "trace_P_step")].unit == "m^2 + rad^2");
}

TEST_CASE("record: groups of innovation rows are judged by their observed rows") {
    DrawnRecord drawn(30, 4, 2, 4);
    for (int trial = 0; trial < 30; ++trial) {
        drawn.innovation[drawn.at(trial, 1)](2) = std::nan("");
        drawn.innovation[drawn.at(trial, 2)].head(3).setConstant(std::nan(""));
    }
    const auto write = [&](const Handle& root) { write_drawn(root, drawn); };
    const Record record = read_written(drawn_with(drawn, "row_groups", "gps 2 0:2, baro 3"));
    check_same(totals_named(record, "nis"), totals_named(read_written(write), "nis"));
    const auto observed = [&](std::size_t i, const std::vector<int>& rows) {
        std::vector<int> there;
        for (const int row : rows)
            if (!std::isnan(drawn.innovation[i](row))) there.push_back(row);
        return there;
    };
    for (const auto& [name, rows] :
         std::vector<std::pair<std::string, std::vector<int>>>{{"gps", {0, 1, 2}}, {"baro", {3}}}) {
        CAPTURE(name);
        for (int k = 0; k < drawn.steps; ++k) {
            double nis = 0;
            std::size_t count = 0;
            for (int trial = 0; trial < drawn.trials; ++trial) {
                const std::size_t i = drawn.at(trial, k);
                const std::vector<int> there = observed(i, rows);
                count += there.size();
                if (!there.empty()) nis += plain_nees(drawn.innovation[i], drawn.innovation_covariance[i], there);
            }
            CHECK(totals_named(record, "nis_rows_" + name).sum[static_cast<std::size_t>(k)].rounded() ==
                  static_cast<double>(count));
            CHECK(std::abs(totals_named(record, "nis_" + name).sum[static_cast<std::size_t>(k)].rounded() - nis) <=
                  1e-11 * nis);
        }
    }
    const Evidence evidence = evidence_of(record.results, record.results.arms.front());
    REQUIRE(evidence.nis.size() == 3);
    CHECK(evidence.nis[1].part == "gps");
    CHECK(evidence.nis[1].degrees == 30 * (3 + 2 + 0 + 3));
    CHECK(evidence.nis[2].degrees == 30 * 4);
}

TEST_CASE("record: the asymmetry that singles leave is no mistake, and a larger one is") {
    const DrawnRecord drawn(6, 2, 2);
    const auto asymmetric = [&](double relative, bool singles) {
        return [&, relative, singles](const Handle& root) {
            write_errors(root, drawn);
            std::vector<double> values = flat(drawn.covariance);
            values[4 * 3 + 1] += relative * std::sqrt(values[4 * 3] * values[4 * 3 + 3]);
            (singles ? write_values<float> : write_values<double>)(root, "covariance", extents_of(drawn, {2, 2}),
                                                                   values);
        };
    };
    CHECK(read_written(asymmetric(1e-6, true)).trouble_count == 0);  // 8 epsilons of a single
    check_refused(asymmetric(1e-5, true), "/covariance: trial 1, step 1 (both counted from 0) is not symmetric");
    check_refused(asymmetric(1e-6, false), "/covariance: trial 1, step 1 (both counted from 0) is not symmetric");
}

TEST_CASE("record: what its attributes and times cannot mean is refused by name") {
    const DrawnRecord drawn(3, 4, 4, 2);
    const auto with = [&](const std::string& name, const std::string& value) { return drawn_with(drawn, name, value); };
    check_refused(with("groups", "a 0 4"), "/@groups: `a 0 4` goes beyond the 4 components of the state");
    check_refused(with("groups", "a 0:3 2"), "/@groups: `a 0:3 2` names component 2 twice");
    check_refused(with("groups", "a -1"), "/@groups: `a -1` has no component `-1`");
    check_refused(with("row_groups", "gps 0:3"), "/@row_groups: `gps 0:3` goes beyond the 2 rows of the innovation");
    check_refused(with("row_groups", "rows 0"), "/@row_groups: `rows` cannot name a group of rows");
    check_refused(with("component_names", "a, b"), "/@component_names: has 2 entries, and the state has 4 components");
    check_refused(with("component_names", "a, b, c, a"), "/@component_names: names two components `a`");
    check_refused(with("component_units", "m, m, m, "), "/@component_units: `` is no unit");
    const auto time = [&](const hdf5::Extents& extents, std::vector<double> values) {
        return [&, extents, values](const Handle& root) {
            write_drawn(root, drawn);
            write_values(root, "time", extents, values);
        };
    };
    CHECK(read_written(time({4}, {0, 0.1, 0.2, 0.5})).trouble_count == 0);
    check_refused(time({4}, {0, 0.1, 0.1, 0.5}), "/time: step 2 (counted from 0) has 0.1, and the time before is 0.1");
    check_refused(time({3, 4}, {0, 1, 2, 3, 0, 1, 2, 3, 0, 5, 2, 3}), "/time: trial 2, step 2 (counted from 0) has 2");
    check_refused(time({3}, {0, 1, 2}), "/time: does not fit: it is [3], and there are 3 trials and 4 steps");
    check_refused(time({4}, {0, not_a_number, 0.2, 0.5}),
                  "/time: trial 0, step 1 (both counted from 0) is there and has no time: it is NaN");
    check_refused(time({3, 4}, {0, 1, 2, 3, 0, 1, 2, 3, 0, 5, 6, not_a_number}),
                  "/time: trial 2, step 3 (both counted from 0)");
    DrawnRecord shorter = drawn;
    for (int j = 0; j < 4; ++j) shorter.hide(2, 3, j);
    CHECK_NOTHROW(read_written([&](const Handle& root) {  // a step that does not exist needs no time
        write_drawn(root, shorter);
        write_values(root, "time", {3, 4}, {0, 1, 2, 3, 0, 1, 2, 3, 0, 5, 6, not_a_number});
    }));
    std::string many = "a 0";
    for (int i = 1; i < 10; ++i) many += ", a" + std::to_string(i) + " 0";
    const DrawnRecord long_one(1, 91000, 1);
    const Record record = read_written(drawn_with(long_one, "groups", many));
    CHECK(record.every == 11);
    CHECK(record.results.steps() == 8273);
    const TemporaryFolder folder;
    write_file(folder / "record.h5", [&](const Handle& root) { write_drawn(root, drawn); }, 3);
    CHECK(refusal<InputError>([&] { read_record(folder / "record.h5"); }) ==
          folder / "record.h5" +
              ": /@record_version: is 3. Write 2, or use a newer credence if there is such a version.");
}

}  // namespace credence::test::record_groups_test
