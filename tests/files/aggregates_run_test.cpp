// Studies that keep totals of their columns and no trial: the same totals however they are run, and what is
// said of them agrees with what is said of the trials.

#include "report/compare/compare.hpp"
#include "files/merge/merge.hpp"
#include <credence/detail/worlds.hpp>
#include <credence/report.hpp>
#include "study/stopping.hpp"
#include "report/watch/watch.hpp"

#include "journal_support.hpp"

#include <nlohmann/json.hpp>

namespace credence::test::aggregates_run_test {

namespace {

Asked small(std::int64_t trials, Keep keep = Keep::aggregates) { return {trials, 1, {}, small_scenarios(), 1, keep}; }

Study run(std::int64_t trials, Keep keep, int threads = 1) {
    Study study = small(trials, keep).study();
    run_study(study, {trials, threads, {}});
    return study;
}

/// Every mean, standard error, interval, spread and count of a report: `path value`.
void numbers_of(const nlohmann::json& json, const std::string& path, std::map<std::string, double>& numbers) {
    if (json.is_number()) numbers[path] = json.get<double>();
    if (json.is_structured())
        for (const auto& [key, value] : json.items()) numbers_of(value, path + "/" + key, numbers);
}

}  // namespace

TEST_CASE(
    "aggregates: any number of threads gives the totals of the blocks, and what a study of trials has besides") {
    const Study one = run(700, Keep::aggregates), three = run(700, Keep::aggregates, 3),
                trials = run(700, Keep::trials);
    CHECK(same_results(one, three));
    Study by_hand = small(700).study();
    for (ScenarioResults& results : by_hand.scenarios) {
        extend(results, 700);
        const BlockRunner runner(world_of(results.scenario), results.scenario);
        for (const std::int64_t block : {2, 0, 1}) {
            const Block computed = runner.run(1, block, trials_in_block(700, block));
            store_columns(results, computed);
            add_totals(results, computed);
        }
    }
    CHECK(same_results(one, by_hand));
    for (std::size_t s = 0; s < trials.scenarios.size(); ++s)
        for (std::size_t a = 0; a < trials.scenarios[s].arms.size(); ++a) {
            const ArmResults &kept = trials.scenarios[s].arms[a], &arm = one.scenarios[s].arms[a];
            CHECK(arm.columns.empty());
            CHECK(arm.errors == kept.errors);
            CHECK(arm.totals.cells == kept.totals.cells);
            for (std::size_t f = 0; f < arm.totals.series.size(); ++f)
                CHECK(arm.totals.series[f].run_square_sum.parts() == kept.totals.series[f].run_square_sum.parts());
        }
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

TEST_CASE("aggregates: a shard whose blocks have no details is grown, from its file and from its journal") {
    const TemporaryFolder folder;
    Asked asked{2 * 18 * block_size, 1, {17, 18}, {tiny("a")}, 1, Keep::aggregates}, first = asked;
    first.trials = 18 * block_size;  // block 17 alone
    run_to_end(folder / "one.h5", asked);
    run_to_end(folder / "grown.h5", first);
    run_to_end(folder / "grown.h5", asked);
    CHECK(bytes_of(folder / "grown.h5") == bytes_of(folder / "one.h5"));
    run_and_die(folder / "journal.h5", first);
    run_to_end(folder / "journal.h5", asked);
    CHECK(bytes_of(folder / "journal.h5") == bytes_of(folder / "one.h5"));
    CHECK(read_results(folder / "one.h5").study.scenarios.front().blocks == BlockRanges{17, 35});
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
    const std::vector<std::size_t> ends = commit_ends(bytes);
    REQUIRE(ends.size() == 2);  // one commit
    ByteReader from(bytes.data() + ends[0], bytes.size() - ends[0]);
    get_commit_head(from);
    const CommitStart start = get_commit_start(from, BlockLayout(asked.study().scenarios.front()));
    REQUIRE(start.blocks.size() == 16);  // those of detailed trials, one by one
    REQUIRE(start.ranges.size() == 17);
    CHECK(start.ranges.back() == BlockRange{16, 39});
}

TEST_CASE("aggregates: a study of the other kind is not resumed, not merged, and said to be so") {
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
            for (std::size_t f = 0; f < found.pairs[p].comparison.columns.size(); ++f) {
                const PairedComparison &one = found.pairs[p].comparison.columns[f].paired,
                                       &other = expected.pairs[p].comparison.columns[f].paired;
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

TEST_CASE("aggregates: a precision is reached at the analysis at which the trials reach it; past ones are left out") {
    StoppingRule rule{{parse_goal("trace_P=2%"), parse_goal("trace_P[greedy-fixed]=0.02")}, 4096, 256};
    const auto until = [&](Study& study, std::vector<std::int64_t>* analyses = nullptr) {
        return run_until(study, rule, {0, 1, {}}, [&](const InterimAnalysis& analysis) {
            if (analyses != nullptr) analyses->push_back(analysis.trials);
        });
    };
    Study trials = small(1, Keep::trials).study(), aggregates = small(1).study();
    std::vector<std::int64_t> analyses;
    const InterimAnalysis expected = until(trials), found = until(aggregates, &analyses);
    CHECK(found.trials == expected.trials);
    CHECK(found.met == expected.met);
    REQUIRE(analyses.size() > 2);
    for (std::size_t i = 0; i < found.states.size(); ++i) {
        CHECK(found.states[i].name == expected.states[i].name);
        CHECK(found.states[i].half_width == Approx(expected.states[i].half_width).epsilon(1e-12));
    }
    // A study that has them already continues with the next analysis, and spends no more than its share.
    Study begun = run(300, Keep::aggregates);
    analyses.clear();
    const InterimAnalysis later = until(begun, &analyses);
    CHECK(analyses.front() == 512);
    CHECK(later.trials == expected.trials);
    CHECK(later.alpha == expected.alpha);
    rule.ceiling = 256;
    CHECK(until(begun).trials == later.trials);  // more than the ceiling: no analysis can be made with fewer
}

TEST_CASE("aggregates: a run is followed from its journal's totals, while it grows a file and when it is done") {
    const TemporaryFolder folder;
    const std::string path = folder / "x.h5";
    const auto check = [&](const Study& expected) {
        const Snapshot snapshot = RunWatch(path).snapshot();
        REQUIRE(snapshot.scenarios.size() == expected.scenarios.size());
        for (std::size_t s = 0; s < expected.scenarios.size(); ++s) {
            const ScenarioResults& results = expected.scenarios[s];
            CHECK(snapshot.scenarios[s].trials == results.trials);
            CHECK(snapshot.scenarios[s].blocks == results.blocks.count());
            for (std::size_t a = 0; a < results.arms.size(); ++a) {
                const WatchedArm& arm = snapshot.scenarios[s].arms[a];
                for (std::size_t f = 0; f < arm.columns.size(); ++f) {
                    const Moments moments =
                        moments_of(results.arms[a].totals.trials.columns[watched_columns(results.columns)[f]]);
                    CHECK(arm.columns[f].count == moments.count);
                    if (moments.count == 0) continue;
                    CHECK(arm.columns[f].mean == moments.mean);
                    CHECK(arm.columns[f].standard_deviation == Approx(moments.standard_deviation).epsilon(1e-14));
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

}  // namespace credence::test::aggregates_run_test
