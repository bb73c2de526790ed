// Records for `judge`: every number against NumPy and SciPy, and the ways in which other programs write.
// Kind: foreign files.

#include "numeric/chi_square.hpp"

#include "files/hdf5/read.hpp"
#include "files/record.hpp"
#include "record/read.hpp"
#include "judgement_support.hpp"

namespace credence::test::judgement_record_test {

namespace {

void check_agree(const std::vector<double>& values, const Json& expected) {
    REQUIRE(values.size() == expected.size());
    for (std::size_t i = 0; i < values.size(); ++i) check_agrees(values[i], number(expected[i]));
}

std::vector<double> rounded(const std::vector<ExactSum>& sums) {
    std::vector<double> values;
    for (const ExactSum& sum : sums) values.push_back(sum.rounded());
    return values;
}

const SeriesTotals& totals_of(const ScenarioResults& results, const Json& figure) {
    const std::string part = figure["part"], kind = figure["name"];
    std::string name = kind;
    if (kind == "standardised_error" || part != "all") name += "_" + part;
    if (name == "variance") name = "trace_P_step";
    for (std::size_t f = 0; f < results.all_series.size(); ++f)
        if (results.all_series[f].name == name) {
            CHECK(results.all_series[f].part == part);
            return results.arms.front().totals.series[f];
        }
    FAIL("no figure " << name);
    throw std::logic_error(name);
}

void check_figures(const ScenarioResults& results, const Json& expected) {
    CHECK(results.all_series.size() == expected.size());
    for (const Json& figure : expected) {
        CAPTURE(figure["name"], figure["part"]);
        const SeriesTotals& totals = totals_of(results, figure);
        check_agree(rounded(totals.sum), figure["sum"]);
        check_agree(rounded(totals.square_sum), figure.value("square_sum", Json::array()));
        REQUIRE(totals.run_sum.has_value());
        check_agrees(totals.run_sum->rounded(), number(figure["run_sum"]));
        check_agrees(totals.run_square_sum.rounded(), number(figure["run_square_sum"]));
        std::vector<std::int64_t> covered;
        for (const Json& levels : figure.value("covered", Json::array()))
            for (const Json& count : levels) covered.push_back(count);
        CHECK(totals.covered == covered);
    }
}

void check_columns(const ScenarioResults& results, const Json& expected) {
    for (std::size_t c = 0; c < results.columns.size(); ++c) {
        const std::string& name = results.columns[c].name;
        CAPTURE(name);
        const std::vector<double>& column = results.arms.front().columns.in_memory()[c];
        if (name == "unseen")
            CHECK(std::all_of(column.begin(), column.end(), [](double one) { return std::isnan(one); }));
        else check_agree(column, expected[name]);
    }
}

void check_arm(const ScenarioResults& results, const Json& expected) {
    const ArmResults& arm = results.arms.front();
    CHECK(arm.name == "record");
    CHECK(arm.totals.trials.counted() == expected["counted"]);
    CHECK(arm.totals.present == expected["present"].get<std::vector<std::int64_t>>());
    check_agree(arm.totals.distribution_distance, expected["shape_distance"]);
    if (!expected["products"].is_null()) {
        check_agree(rounded(arm.totals.products.sum), expected["products"]["sum"]);
        check_agree(rounded(arm.totals.products.square_sum), expected["products"]["square_sum"]);
        CHECK(arm.totals.products.count == expected["products"]["count"].get<std::vector<std::int64_t>>());
    }
    std::size_t i = 0;
    for (const Json& trial : expected["nees"])
        for (const Json& value : trial) check_agrees(arm.nees.at(i++), number(value));
    CHECK(i == arm.nees.size());
}

void check_troubles(const Record& record, const Json& expected) {
    CHECK(record.trouble_count == static_cast<std::int64_t>(expected.size()));
    CHECK(record.troubles.size() == std::min<std::size_t>(expected.size(), 20));
    for (std::size_t i = 0; i < record.troubles.size(); ++i) {
        const RecordTrouble& trouble = record.troubles[i];
        CHECK(Json{trouble.trial, trouble.step, trouble.what} == expected[i]);
    }
}

std::string reference_path(const std::string& name) {
    return record_folder + record_series().at(name)["file"].get<std::string>();
}

/// The whole of a record that make_records.py wrote, to 1e-9: sums of up to 60 values from matrices of condition below
/// 1e4.
void check_record(const Record& record, const Json& expected) {
    CHECK(record.results.trials == expected["trials"]);
    CHECK(record.results.steps() == expected["steps"]);
    CHECK(record.results.state_size() == expected["n"]);
    CHECK(record.has_innovations == !expected["products"].is_null());
    check_figures(record.results, expected["figures"]);
    check_columns(record.results, expected["columns"]);
    check_arm(record.results, expected);
    check_troubles(record, expected["troubles"]);
}

Record check_reference(const std::string& name) {
    Record record = read_record(reference_path(name));
    check_record(record, record_series().at(name));
    return record;
}

}  // namespace

TEST_CASE("record: Gaussian errors and innovations with groups, as h5py writes them with gzip") {
    const Record record = check_reference("gaussian");
    const Scenario& scenario = record.results.scenario;
    CHECK(scenario.name == "record_gaussian");
    CHECK(scenario.title == "record " + printable(record_folder + "record_gaussian.h5"));
    std::string names;
    for (const Series& figure : record.results.all_series) names += figure.name + " ";
    CHECK(names ==
          "nees nees_pose nees_feature_1 nis nis_rows squared_error squared_error_pose squared_error_feature_1 "
          "trace_P_step variance_pose variance_feature_1 standardised_error_x0 standardised_error_x1 "
          "standardised_error_x2 standardised_error_x3 standardised_error_x4 ");
    CHECK(record.results.columns[column_pose_error].long_name ==
          "squared error of the group pose, summed over the steps");
    CHECK(record.results.arms.front().errors.size() == 60 * 6 * 5);
}

TEST_CASE("record: runs of declared lengths, a step missing within a run, rows not observed, fixed-length text") {
    const Record record = check_reference("ragged");
    const ArmResults& arm = record.results.arms.front();
    for (std::size_t i = 0; i < arm.nees.size(); ++i) CHECK(std::isnan(arm.nees[i]) == std::isnan(arm.errors[3 * i]));
    CHECK(std::isnan(arm.columns.in_memory()[column_nis_ratio][3]));
}

TEST_CASE("record: singular and indefinite covariances fail their trial and are named by trial and step") {
    const Record record = check_reference("troubled");
    const ArmResults& arm = record.results.arms.front();
    for (const Json& trouble : record_series()["troubled"]["troubles"])
        for (std::size_t i = 0; i < 4 * 3; ++i)
            CHECK(std::isnan(arm.errors[trouble[0].get<std::size_t>() * 4 * 3 + i]));
    CHECK(record.results.scenario.name == "record_troubled");
}

TEST_CASE("record: what is not finite, and what is NaN in the error or the covariance alone, fails its trial") {
    const Record record = check_reference("broken");
    CHECK(record.trouble_count == 10);  // an error of 2e12 did not diverge in so short a trial
    CHECK(record.results.arms.front().totals.trials.counted() == 10);
}

TEST_CASE("record: trials that end before the longest one, and do not say so, fail") {
    const Record record = check_reference("cut");
    CHECK(record.trouble_count == 10);
    CHECK(record.results.arms.front().totals.present.back() == 0);  // no trial has the last step, and none need have it
}

TEST_CASE("record: of many troubles the first twenty are named and all are counted") {
    const Record record = check_reference("many troubles");
    CHECK(record.trouble_count == 23);
    CHECK(record.results.scenario.name == "record_many_troubles");
}

TEST_CASE("record: one trial without a dimension of its own, and without groups") {
    const Record record = check_reference("single");
    CHECK(record.results.columns[column_pose_error].long_name ==
          "squared error of the whole state, summed over the steps");
}

TEST_CASE("record: single precision, chunks that fit nothing, and groups as a list of texts") {
    check_reference("singles");
}

TEST_CASE("record: one component and one row, and an attribute without a value") { check_reference("one"); }

TEST_CASE("record: parts of any size, within a trial and over several, are the same record") {
    for (const char* name : {"ragged", "cut", "broken", "troubled", "single", "singles"})
        for (const std::int64_t part_numbers : {1, 100, 300, 2000}) {
            CAPTURE(name, part_numbers);
            const std::string path = reference_path(name);
            check_record(hdf5::read_file(path, "", [&](const Handle& root) {
                             return read_record(RecordReader(FileSource(root), part_numbers), path);
                         }), record_series().at(name));
        }
}

TEST_CASE("record: a run of very many steps has distances, and no cells") {
    const TemporaryFolder folder;
    const std::string path = folder / "long.h5";
    write_plain_record(path, [](const Handle& root) {
        replace<double>(root, "error", {5000, 1}, std::vector<double>(5000, 1));
        replace<double>(root, "covariance", {5000, 1, 1}, std::vector<double>(5000, 1));
        remove(root, "innovation");
        remove(root, "innovation_covariance");
    });
    const Record record = read_record(path);
    const ArmResults& arm = record.results.arms.front();
    CHECK(arm.totals.cells.empty());
    CHECK(arm.totals.distribution_distance.size() == 5000);
    check_agrees(arm.totals.distribution_distance.back(), 0.68268949213708585);  // P(|Z| < 1), SciPy
    CHECK(arm.columns.in_memory()[column_nees_ratio][0] == 1);
    CHECK_FALSE(record.has_innovations);
    CHECK(arm.totals.products.count == std::vector<std::int64_t>(10, 0));
}

TEST_CASE("record: small asymmetry is averaged, progress reaches the end") {
    const TemporaryFolder folder;
    const std::string path = folder / "r\xffx.h5";
    write_plain_record(path, [](const Handle& root) {
        set_value(root, "covariance", 1, 0.5);
        set_value(root, "covariance", 2, 0.5 + 2e-10);
    });
    std::int64_t done = 0;
    const Record record = read_record(path, [&](const Progress& progress) {
        CHECK(progress.total == 3);
        done = progress.done;
    });
    CHECK(done == 3);
    // e' P^-1 e of e = (0.5, 0.5) is 0.5 / (1 + p), p the mean of 0.5 and 0.5 + 2e-10; rounding leaves 1e-15.
    CHECK(std::abs(record.results.arms.front().nees[0] - 0.5 / (1.5 + 1e-10)) < 1e-14);
    CHECK(record.results.scenario.name == "r_x");
    CHECK(record.results.scenario.title == "record " + printable(path));  // a report is UTF-8

    // What rounding leaves of a 0, between components whose variances are far larger.
    write_plain_record(path, [](const Handle& root) { set_value(root, "covariance", 1, 1e-12); });
    CHECK(read_record(path).trouble_count == 0);
}

TEST_CASE("record: parts hold whole chunks where they fit, so that each is decompressed once") {
    hdf5::read_file(reference_path("singles"), "", [](const Handle& root) {
        const RecordReader file(FileSource(root), 20 * 5 * (4 + 16));  // of 50 trials in chunks of 7
        CHECK(file.part_at(0, 0).trials == 14);
        CHECK(file.part_at(42, 0).trials == 8);
        CHECK(RecordReader(FileSource(root), 3 * 5 * (4 + 16)).part_at(0, 0).trials == 3);
        return 0;
    });
}

TEST_CASE("record: a covariance is singular where rounding alone could have made its smallest eigenvalue of 0") {
    const TemporaryFolder folder;
    const auto failed_trials = [&](double correlation, bool singles) {
        const std::string path = folder / "record.h5";
        write_plain_record(path, [&](const Handle& root) {
            set_value(root, "covariance", 1, correlation);
            set_value(root, "covariance", 2, correlation);
            if (!singles) return;
            std::vector<float> values(3 * 4 * 4, 0);
            for (std::size_t i = 0; i < values.size(); ++i) values[i] = i % 4 == 0 || i % 4 == 3;
            values[1] = values[2] = static_cast<float>(correlation);
            replace<float>(root, "covariance", {3, 4, 2, 2}, values);
        });
        return read_record(path).trouble_count;
    };
    // The smallest eigenvalue is 1 - correlation; the bound 2 n eps is 8.9e-16 for doubles, 4.8e-7 for singles.
    CHECK(failed_trials(1 - 0x1p-51, false) == 1);
    CHECK(failed_trials(1 - 0x1p-49, false) == 0);
    CHECK(failed_trials(1 - 0x1p-22, true) == 1);
    CHECK(failed_trials(1 - 0x1p-20, true) == 0);
}

}  // namespace credence::test::judgement_record_test
