// Studies that keep totals of their columns and no trial: the totals are those of the same study's trials, exactly,
// however it was run; and what is said of them agrees.

#include <credence/compare.hpp>
#include <credence/merge.hpp>
#include <credence/report.hpp>
#include <credence/stopping.hpp>
#include <credence/watch.hpp>

#include "../src/superaccumulator.hpp"
#include "journal_support.hpp"

#include <nlohmann/json.hpp>

#include <random>

using namespace credence;
using namespace credence::test;

namespace {

Asked small(std::int64_t trials, Keep keep = Keep::aggregates) { return {trials, 1, {}, small_scenarios(), 1, keep}; }

Study run(std::int64_t trials, Keep keep, int threads = 1) {
    Study study = small(trials, keep).study();
    run_study(study, {trials, threads, {}});
    return study;
}

/// x^2 in parts that need no rounding: x = high + low with half the digits each [Veltkamp; Dekker 1971].
void add_square(ExactSum& sum, double x) {
    const double scaled = 134217729 * x, high = scaled - (scaled - x), low = x - high;
    for (const double part : {high * high, 2 * high * low, low * low}) sum.add(part);
}

/// One value at a time; those that are NaN are left out.
ExactMoments slow_moments(const std::vector<double>& values) {
    ExactMoments moments;
    for (const double value : values) {
        if (std::isnan(value)) continue;
        ++moments.count;
        moments.sum.add(value);
        add_square(moments.square_sum, value);
    }
    return moments;
}

void check_moments(const ExactMoments& moments, const std::vector<double>& values) {
    const ExactMoments expected = slow_moments(values);
    CHECK(moments.count == expected.count);
    CHECK(moments.sum.parts() == expected.sum.parts());
    CHECK(moments.square_sum.parts() == expected.square_sum.parts());
}

void check_totals_of(const ScenarioResults& aggregates, const ScenarioResults& trials) {
    for (std::size_t a = 0; a < trials.arms.size(); ++a) {
        const ArmAggregates& arm = aggregates.arms[a].aggregates;
        CHECK(arm.statuses == status_counts(trials, trials.arms[a]));
        CHECK(arm.trials() == trials.trials);
        CHECK(arm.counted() == trials.arms[a].counted);
        REQUIRE(arm.differences.size() == a);
        for (std::size_t c = 0; c < trials.columns.size(); ++c) {
            if (!is_figure(trials.columns[c])) continue;
            CAPTURE(trials.arms[a].name, trials.columns[c].name);
            const std::vector<double> own = figure_values(trials, trials.arms[a], c);
            check_moments(arm.columns[c], own);
            for (std::size_t b = 0; b < a; ++b) {
                const std::vector<double> other = figure_values(trials, trials.arms[b], c),
                                          differences = paired_differences(own, other);
                const DifferenceTotals& totals = arm.differences[b][c];
                check_moments(totals.difference, differences);
                CHECK(totals.below == std::count_if(differences.begin(), differences.end(), [](double d) { return d < 0; }));
                CHECK(totals.above == std::count_if(differences.begin(), differences.end(), [](double d) { return d > 0; }));
            }
        }
    }
}

/// Two arms of one block with made-up columns: trials that failed, and one that has no value.
Block made_up_block(const std::vector<Column>& columns) {
    constexpr std::size_t trials = 5;
    Block block{0, trials, std::vector<ArmBlock>(2)};
    for (std::size_t a = 0; a < 2; ++a) {
        ArmBlock& arm = block.arms[a];
        for (std::size_t c = 0; c < columns.size(); ++c)
            for (std::size_t i = 0; i < trials; ++i)
                arm.columns.push_back(columns[c].type == ColumnType::real ? std::sqrt(static_cast<double>(3 + a + c + 7 * i))
                                                                          : static_cast<double>(a + i));
    }
    const auto set = [&](std::size_t arm, ColumnIndex column, std::vector<double> values) {
        std::copy(values.begin(), values.end(), block.arms[arm].columns.begin() + column * static_cast<int>(trials));
    };
    set(0, column_status, {0, 2, 0, 1, 0});
    set(1, column_status, {0, 0, 0, 3, 0});
    set(0, column_unseen, {1, -1, 2, 3, 4});
    set(0, column_nis_ratio, {1, NAN, NAN, 2, 3});
    return block;
}

/// Every mean, standard error, interval, spread and count of a report: `path value`.
void numbers_of(const nlohmann::json& json, const std::string& path, std::map<std::string, double>& numbers) {
    if (json.is_number()) numbers[path] = json.get<double>();
    if (json.is_structured())
        for (const auto& [key, value] : json.items()) numbers_of(value, path + "/" + key, numbers);
}

}  // namespace

TEST_CASE("aggregates: the sums of a block are those that are added one value at a time, at any exponent") {
    std::minstd_rand random(3);
    for (int repeat = 0; repeat < 200; ++repeat) {
        Superaccumulator fast;
        ExactSum slow;
        for (int i = 0; i < 512; ++i) {
            const int widest = repeat % 2 == 0 ? 4 : 2040;
            const double mantissa = (static_cast<double>(random()) - 0x1p30) * 0x1p22 + static_cast<double>(random()),
                         value = std::ldexp(mantissa, static_cast<int>(random() % static_cast<unsigned>(widest)) - 1072);
            if (std::abs(value) > 1e290) continue;
            fast.add(value);
            slow.add(value);
        }
        REQUIRE(fast.sum().parts() == slow.parts());
    }
    for (const double value : {0.0, -0.0, 5e-324, -2.2250738585072014e-308, 9.99e299, 1.0}) {
        Superaccumulator alone;
        for (int i = 0; i < 1024; ++i) alone.add(value < 1 ? value : value / 1024);
        CHECK(alone.sum().rounded() == (value < 1 ? 1024 * value : value));
    }
    for (const double value : {1e300, -HUGE_VAL}) {
        Superaccumulator none;
        none.add(value);
        none.add(1);
        CHECK(std::isnan(none.sum().rounded()));
    }
}

TEST_CASE("aggregates: the totals are the exact sums over the columns of the same study, for any number of threads") {
    const Study trials = run(700, Keep::trials), one = run(700, Keep::aggregates), three = run(700, Keep::aggregates, 3);
    for (std::size_t s = 0; s < trials.scenarios.size(); ++s) {
        check_totals_of(one.scenarios[s], trials.scenarios[s]);
        CHECK(one.scenarios[s].arms.front().columns.empty());
        CHECK(one.scenarios[s].arms.front().totals.front().sum.front().parts() ==
              trials.scenarios[s].arms.front().totals.front().sum.front().parts());
    }
    CHECK(same_results(one, three));
}

TEST_CASE("aggregates: failed trials and missing values are in no sum, and break their pairs only") {
    const std::vector<Column> columns = trial_columns(small_scenarios().front());
    const Block block = made_up_block(columns);
    const std::vector<ArmAggregates> arms = aggregates_of(columns, block);
    CHECK(arms[0].statuses == std::vector<std::int64_t>{3, 1, 1, 0});
    CHECK(arms[0].counted() == 4);
    CHECK(arms[0].columns[column_unseen].sum.rounded() == 1 + 2 + 3 + 4);
    CHECK(arms[0].columns[column_nis_ratio].count == 3);
    CHECK(arms[0].columns[column_nis_ratio].square_sum.rounded() == 1 + 4 + 9);
    CHECK(arms[0].columns[column_status].count == 0);
    const DifferenceTotals& unseen = arms[1].differences[0][column_unseen];  // 1 - 1, 3 - 2, 5 - 4
    CHECK(unseen.difference.count == 3);
    CHECK(unseen.difference.sum.rounded() == 2);
    CHECK(unseen.above == 2);
    CHECK(unseen.below == 0);
    CHECK(arms[1].differences[0][column_nis_ratio].difference.count == 2);
    CHECK(unseen.reversed().difference.sum.rounded() == -2);
    CHECK(unseen.reversed().below == 2);

    std::vector<ArmAggregates> sum = arms;
    sum[1].add(arms[1]);
    sum[1].subtract(arms[1]);
    CHECK(sum[1].statuses == arms[1].statuses);
    CHECK(sum[1].differences[0][column_trace_P].difference.square_sum.parts() ==
          arms[1].differences[0][column_trace_P].difference.square_sum.parts());
}

TEST_CASE("aggregates: spreads survive the cancellation that their sums invite") {
    // 1e8 + i 1e-6, i = 0 ... 99: in doubles n Q - S^2 has no digit left. The values themselves are rounded to 1.5e-8.
    std::vector<double> values;
    for (int i = 0; i < 100; ++i) values.push_back(1e8 + 1e-6 * i);
    const Summary expected = summarise(values);
    const Moments found = moments_of(slow_moments(values));
    CHECK(found.mean == expected.mean);
    // summarise's mean, from which it takes the deviations, is rounded to 1.5e-8 too: (1.5e-8 / 2.9e-5)^2 / 2 = 1.3e-7.
    CHECK(found.standard_deviation == Approx(expected.standard_deviation).epsilon(2e-7));
    CHECK(std::isnan(moments_of({}).mean));
    CHECK(moments_of(slow_moments({3})).mean == 3);
    CHECK(std::isnan(moments_of(slow_moments({3})).standard_error));
}

TEST_CASE("aggregates: shards, a crash, a grown study and a partial block taken back end in the bytes of one run") {
    const TemporaryFolder folder;
    const Asked asked = small(1300);
    run_to_end(folder / "one.h5", asked);
    const std::string one = bytes_of(folder / "one.h5");
    CHECK(same_results(read_results(folder / "one.h5").study, undisturbed(asked)));

    std::vector<std::string> shards;
    for (const std::int64_t index : {2, 0, 1}) {
        Asked part = asked;
        part.shard = {index, 3};
        shards.push_back(folder / (std::to_string(index) + ".h5"));
        run_to_end(shards.back(), part);
    }
    Asked half = asked;
    half.shard = {0, 2};
    shards.push_back(folder / "half.h5");  // has blocks that others have too
    run_to_end(shards.back(), half);
    const Study merged = merge_results(shards);
    CHECK(merged.complete);
    write_results(folder / "merged.h5", merged, run_facts);
    CHECK(bytes_of(folder / "merged.h5") == one);

    run_and_die(folder / "crashed.h5", asked, 3);
    CHECK(blocks_in(opened(folder / "crashed.h5", asked).study()) == 3);
    run_to_end(folder / "crashed.h5", asked);
    CHECK(bytes_of(folder / "crashed.h5") == one);

    // 300 trials end within a block: from the journal, then from the file, and once more after a crash in between.
    run_and_die(folder / "journal.h5", small(300));
    run_to_end(folder / "journal.h5", asked);
    CHECK(bytes_of(folder / "journal.h5") == one);
    run_to_end(folder / "grown.h5", small(300));
    run_and_die(folder / "grown.h5", small(900), 1);
    run_to_end(folder / "grown.h5", asked);
    CHECK(bytes_of(folder / "grown.h5") == one);
}

TEST_CASE("aggregates: neither journal nor file grows with the trials") {
    const TemporaryFolder folder;
    const auto sizes = [&](const std::string& name, std::int64_t trials, Keep keep) {
        Asked asked{trials, 1, {}, {tiny("a")}, 1, keep};
        run_and_die(folder / name, asked);
        const auto journal = std::filesystem::file_size(folder / (name + ".journal"));
        run_to_end(folder / name, asked);
        return std::pair(journal, std::filesystem::file_size(folder / name));
    };
    // Both have the same details. Of 4,096 further trials the journal has 16 commits of a block each, with totals.
    const auto few = sizes("few.h5", 4096, Keep::aggregates), many = sizes("many.h5", 8192, Keep::aggregates),
               kept = sizes("kept.h5", 8192, Keep::trials);
    CHECK(many.second == few.second);
    CHECK(kept.second > many.second + 4096 * 49);
    CHECK(many.first < kept.first);
}

TEST_CASE("aggregates: the journal lists blocks as ranges") {
    const TemporaryFolder folder;
    const Asked asked{256 * 40, 1, {}, {tiny("a")}, 1, Keep::aggregates};
    {
        StoredRun run = opened(folder / "x.h5", asked);
        run_study(run.study(), {asked.trials, 1, {}, {}, {}, &run.begin(asked.trials, all_blocks)});
    }
    const std::string bytes = bytes_of(folder / "x.h5.journal");
    const std::vector<std::size_t> ends = record_ends(bytes);
    REQUIRE(ends.size() == 2);  // one commit
    ByteReader from(bytes.data() + ends[0], bytes.size() - ends[0]);
    get_record_head(from);
    const RecordStart start = get_record_start(from, BlockLayout(asked.study().scenarios.front()));
    REQUIRE(start.blocks.size() == 16);  // those of detailed trials, one by one
    REQUIRE(start.ranges.size() == 17);
    CHECK(start.ranges.back() == BlockRange{16, 39});
}

TEST_CASE("aggregates: a study of the other kind is not gone on with, not merged, and said to be so") {
    const TemporaryFolder folder;
    const Asked asked = small(300), other = small(300, Keep::trials);
    run_to_end(folder / "aggregates.h5", asked);
    run_to_end(folder / "trials.h5", other);
    run_and_die(folder / "journal.h5", asked, 1);
    CHECK(study_hash(asked.study()) != study_hash(other.study()));
    CHECK(says(refused(folder / "aggregates.h5", other), "it keeps aggregates, not trials"));
    CHECK(says(refused(folder / "trials.h5", asked), "it keeps trials, not aggregates"));
    CHECK(says(refused(folder / "journal.h5", other), "it keeps aggregates, not trials"));
    const std::string said =
        refusal<InputError>([&] { merge_results({folder / "trials.h5", folder / "aggregates.h5"}); });
    CHECK(says(said, "cannot merge"));
    CHECK(says(said, "it keeps aggregates, not trials"));
}

TEST_CASE("aggregates: the report has the trials' means, errors and verdicts, and says what is missing") {
    const TemporaryFolder folder;
    const Study trials = run(1500, Keep::trials), aggregates = run(1500, Keep::aggregates);
    const Report report = make_report(aggregates, 0.05);
    std::map<std::string, double> expected, found;
    const auto json = nlohmann::json::parse(report_json(report));
    numbers_of(nlohmann::json::parse(report_json(make_report(trials, 0.05))), "", expected);
    numbers_of(json, "", found);
    for (const auto& [path, value] : found) {
        CAPTURE(path);
        REQUIRE(expected.count(path) == 1);
        // Sums of 1500 values in two passes lose some 1e-14 of a spread; sums of squares none.
        CHECK(value == Approx(expected[path]).epsilon(1e-12).margin(1e-300));
    }
    CHECK(found.count("/0/trace_P/se") == 1);
    CHECK(found.count("/1/paired_difference/trace_P/ci95/0") == 1);
    CHECK(found.count("/1/paired_difference/trace_P/variance_reduction") == 1);
    CHECK(json[0]["trace_P"]["median"].is_null());
    CHECK(json[0]["trace_P"]["bootstrap95"][0].is_null());
    CHECK(json[0]["trace_P"]["quantiles"]["0.05"].is_null());
    CHECK(json[1]["paired_difference"]["trace_P"]["wilcoxon_p"].is_null());
    for (std::size_t i = 0; i < report.arms.size(); ++i)
        CHECK(json[i]["verdict"] == verdict_name(make_report(trials, 0.05).arms[i].consistency.verdict));

    const std::string sentence = "medians and distributions need the trials", text = report_text(report);
    CHECK(text.find(sentence) != std::string::npos);
    CHECK(text.find(sentence) == text.rfind(sentence));
    CHECK(report_csv(report).find("nan") == std::string::npos);
    const std::string page = report_html(report, {"x.h5", {}, "credence"});
    CHECK(says(page, "No chart of how trials and pairs are spread"));
    CHECK(says(page, "--keep aggregates -o again.h5"));
    CHECK(!says(page, "What trials end with"));
    CHECK(says(report_html(make_report(trials, 0.05), {"x.h5", {}, "credence"}), "What trials end with"));
}

TEST_CASE("aggregates: arms of one file are compared from totals, arms of several files are not") {
    const Study trials = run(1500, Keep::trials), aggregates = run(1500, Keep::aggregates);
    const ArmsChoice reversed = read_arms("fixed.ekf,greedy.ekf", {"x.h5"});
    for (const std::optional<ArmsChoice>& choice : {std::optional<ArmsChoice>(), std::optional(reversed)}) {
        const CompareReport expected = compare_studies({{"x.h5", trials}}, choice),
                            found = compare_studies({{"x.h5", aggregates}}, choice);
        REQUIRE(found.pairs.size() == expected.pairs.size());
        for (std::size_t p = 0; p < found.pairs.size(); ++p)
            for (std::size_t f = 0; f < found.pairs[p].comparison.figures.size(); ++f) {
                const PairedComparison &one = found.pairs[p].comparison.figures[f].paired,
                                       &other = expected.pairs[p].comparison.figures[f].paired;
                CAPTURE(p, f);
                CHECK(one.pairs == other.pairs);
                CHECK(one.difference.mean == Approx(other.difference.mean).epsilon(1e-12).margin(1e-300));
                CHECK(one.difference.ci95.low == Approx(other.difference.ci95.low).epsilon(1e-12).margin(1e-300));
                CHECK(one.wins_a == other.wins_a);
                CHECK(one.wins_b == other.wins_b);
                CHECK(std::isnan(one.difference.median));
                CHECK(found.pairs[p].a.mean[f] == Approx(expected.pairs[p].a.mean[f]).epsilon(1e-12));
            }
        CHECK(says(compare_text(found), "Medians, bootstrap and signed ranks\nneed the trials"));
        CHECK(!says(compare_text(expected), "need the trials"));
        CHECK(compare_csv(found).find("nan") == std::string::npos);
        CHECK(says(compare_html(found, "credence"), "No chart of how trials and pairs are spread"));
    }
    const std::string said =
        refusal<InputError>([&] { compare_studies({{"x.h5", trials}, {"y.h5", aggregates}}, std::nullopt); });
    CHECK(says(said, "y.h5 keeps aggregates"));
    CHECK(says(said, "--keep trials"));
}

TEST_CASE("aggregates: the variance reduction and an arm's own mean over pairs need that all trials are in pairs") {
    const std::vector<Column> columns = trial_columns(small_scenarios().front());
    const std::vector<ArmAggregates> arms = aggregates_of(columns, made_up_block(columns));
    const auto compared = [&](ColumnIndex c) {
        return compare_totals(arms[1].differences[0][c], arms[1].columns[c], arms[0].columns[c]);
    };
    CHECK(std::isnan(compared(column_trace_P).variance_reduction));
    CHECK(compared(column_trace_P).pairs == 3);
    CHECK(compared(column_unseen).ties == Approx(1.0 / 3));
    CHECK(compare_totals(arms[1].differences[0][column_unseen], arms[1].differences[0][column_unseen].difference,
                         arms[1].differences[0][column_unseen].difference)
              .variance_reduction == Approx(2));
}

TEST_CASE("aggregates: a precision is reached at the look at which the trials reach it; looks that are past are left out") {
    StoppingRule rule{{parse_goal("trace_P=2%"), parse_goal("trace_P[greedy-fixed]=0.02")}, 4096, 256};
    const auto until = [&](Study& study, std::vector<std::int64_t>* looks = nullptr) {
        return run_until(study, rule, {0, 1, {}}, [&](const Look& look) {
            if (looks != nullptr) looks->push_back(look.trials);
        });
    };
    Study trials = small(1, Keep::trials).study(), aggregates = small(1).study();
    std::vector<std::int64_t> looks;
    const Look expected = until(trials), found = until(aggregates, &looks);
    CHECK(found.trials == expected.trials);
    CHECK(found.met == expected.met);
    REQUIRE(looks.size() > 2);
    for (std::size_t i = 0; i < found.states.size(); ++i) {
        CHECK(found.states[i].name == expected.states[i].name);
        CHECK(found.states[i].half_width == Approx(expected.states[i].half_width).epsilon(1e-12));
    }
    // A study that has them already goes to the next look, and spends no more than its share.
    Study begun = run(300, Keep::aggregates);
    looks.clear();
    const Look later = until(begun, &looks);
    CHECK(looks.front() == 512);
    CHECK(later.trials == expected.trials);
    CHECK(later.alpha == expected.alpha);
    rule.ceiling = 256;
    CHECK(until(begun).trials == later.trials);  // more than the ceiling: there are no fewer to look at
}

TEST_CASE("aggregates: a run is followed from its journal's totals, while it grows a file and when it is done") {
    const TemporaryFolder folder;
    const std::string path = folder / "x.h5";
    const auto check = [&](const Study& expected) {
        const WatchLook look = RunWatch(path).look();
        REQUIRE(look.scenarios.size() == expected.scenarios.size());
        for (std::size_t s = 0; s < expected.scenarios.size(); ++s) {
            const ScenarioResults& results = expected.scenarios[s];
            CHECK(look.scenarios[s].trials == results.trials);
            CHECK(look.scenarios[s].blocks == results.blocks.count());
            for (std::size_t a = 0; a < results.arms.size(); ++a) {
                const WatchedArm& arm = look.scenarios[s].arms[a];
                for (std::size_t f = 0; f < arm.figures.size(); ++f) {
                    const Moments moments = moments_of(results.arms[a].aggregates.columns[watched_columns[f]]);
                    CHECK(arm.figures[f].count == moments.count);
                    if (moments.count == 0) continue;
                    CHECK(arm.figures[f].mean == moments.mean);
                    CHECK(arm.figures[f].standard_deviation == Approx(moments.standard_deviation).epsilon(1e-14));
                }
                if (!arm.other.empty()) CHECK(arm.difference.count == static_cast<double>(results.trials));
            }
        }
    };
    run_and_die(path, small(1300), 3);
    check(opened(path, small(1300)).study());
    run_to_end(path, small(1300));
    check(undisturbed(small(1300)));
    run_and_die(path, small(2000), 1);  // takes the partial block back
    check(opened(path, small(2000)).study());
    run_and_die(path, small(2000));
    check(undisturbed(small(2000)));
}
