// A run that several ranks share, here threads that pass messages in memory. tests/cluster has mpirun.

#include <credence/error.hpp>
#include "cluster/ranks.hpp"

#include "cluster/rank_message.hpp"
#include "journal_support.hpp"

#include <atomic>
#include <deque>
#include <mutex>
#include <thread>
#include <tuple>

using namespace credence;
using namespace credence::test;

namespace {

/// The messages of a job, by the rank that they are for.
struct Office {
    explicit Office(int size) : letters(static_cast<std::size_t>(size)) {}
    std::mutex mutex;
    std::vector<std::deque<Message>> letters;
    bool abandoned = false;
};

class ThreadTransport : public Transport {
public:
    ThreadTransport(Office& office, int rank) : office_(office), rank_(rank) {}
    int rank() const override { return rank_; }
    int size() const override { return static_cast<int>(office_.letters.size()); }
    void send(int rank, Word word, std::string bytes) override {
        const std::lock_guard lock(office_.mutex);
        office_.letters[static_cast<std::size_t>(rank)].push_back({rank_, word, std::move(bytes)});
    }
    std::optional<Message> receive() override {
        const std::lock_guard lock(office_.mutex);
        auto& own = office_.letters[static_cast<std::size_t>(rank_)];
        if (own.empty()) return std::nullopt;
        Message first = std::move(own.front());
        own.pop_front();
        return first;
    }
    bool sending() override { return false; }
    void abandon() override { office_.abandoned = true; }

private:
    Office& office_;
    int rank_;
};

using Signal = std::function<std::string()>;
const Signal no_signal = [] { return std::string(); };

/// Ranks 1 ... size - 1, until rank 0 ends their work.
class Followers {
public:
    explicit Followers(Office& office, const Signal& signal = no_signal) {
        for (int rank = 1; rank < static_cast<int>(office.letters.size()); ++rank)
            threads_.emplace_back([&office, rank, signal] {
                ThreadTransport transport(office, rank);
                follow(transport, signal);
            });
    }
    ~Followers() {
        for (std::thread& thread : threads_) thread.join();
    }

private:
    std::vector<std::thread> threads_;
};

/// The settings of one run of several ranks.
struct Job {
    int size = 3;
    std::function<bool()> stop{};
    Signal signal = no_signal;
    RankLeader::Sending sending = RankLeader::Sending::now_and_then;
    std::function<void(const Progress&)> progress{};
};

/// Runs the missing blocks of `asked` on the ranks of the job; all of its threads compute, rank 0's too.
void compute_together(StoredRun& run, const Asked& asked, const Job& job) {
    Office office(job.size);
    const Followers followers(office, job.signal);
    ThreadTransport transport(office, 0);
    RankLeader leader(transport);
    leader.begin(definition_of(run.study()), asked.threads, job.sending);
    RunOptions options{asked.trials, asked.threads, {}, asked.shard, {}, &run.begin(asked.trials, 1), &leader};
    options.stop = [&] { return leader.asked_to_stop() || (job.stop && job.stop()); };
    options.progress = job.progress;
    run_study(run.study(), options);
}

void run_together(const std::string& path, const Asked& asked, const Job& job) {
    StoredRun run = opened(path, asked);
    compute_together(run, asked, job);
    run.finish(run_facts);
}

/// More blocks of a scenario than detailed ones, the last of them partial.
Asked some() { return {5000, 1, {}, {tiny("a"), scenario("b"), tiny("c")}, 1}; }

}  // namespace

TEST_CASE("ranks: any number of them gives the bytes of one process") {
    const TemporaryFolder folder;
    Asked asked = some();
    run_to_end(folder / "one.h5", asked);
    const std::string expected = bytes_of(folder / "one.h5");
    const auto now_and_then = RankLeader::Sending::now_and_then, at_once = RankLeader::Sending::at_once;
    for (const auto& [size, threads, sending] : std::vector<std::tuple<int, int, RankLeader::Sending>>{
             {1, 2, now_and_then}, {2, 1, now_and_then}, {3, 2, at_once}, {4, 1, at_once}}) {
        CAPTURE(size, threads);
        asked.threads = threads;
        run_together(folder / "x.h5", asked, {size, {}, no_signal, sending});
        CHECK(bytes_of(folder / "x.h5") == expected);
        std::filesystem::remove(folder / "x.h5");
    }
}

TEST_CASE("ranks: of a study that keeps aggregates they send totals, and give the bytes of one process") {
    const TemporaryFolder folder;
    Asked asked = some();
    asked.keep = Keep::aggregates;
    run_to_end(folder / "one.h5", asked);
    run_together(folder / "x.h5", asked, {3, {}, no_signal, RankLeader::Sending::at_once});
    CHECK(bytes_of(folder / "x.h5") == bytes_of(folder / "one.h5"));
    Asked less = asked;
    less.trials = 1400;
    {
        StoredRun run = opened(folder / "grown.h5", less);
        compute_together(run, less, {});  // and dies before it writes its file
    }
    run_together(folder / "grown.h5", asked, {2});
    CHECK(bytes_of(folder / "grown.h5") == bytes_of(folder / "one.h5"));
}

TEST_CASE("ranks: what they sent is in the journal, and the run goes on with it on one process, grown and as a shard") {
    const TemporaryFolder folder;
    Asked asked = some();
    asked.shard = {1, 2};
    run_to_end(folder / "one.h5", asked);
    Asked less = asked;
    less.trials = 1400;
    {
        StoredRun run = opened(folder / "x.h5", less);
        compute_together(run, less, {});  // and dies before it writes its file
    }
    {
        const StoredRun left = opened(folder / "x.h5", less);
        CHECK(left.study().scenarios.front().blocks == std::vector<std::int64_t>{1, 3, 5});
        CHECK(same_results(left.study(), undisturbed(less)));
    }
    run_together(folder / "x.h5", asked, {});
    CHECK(bytes_of(folder / "x.h5") == bytes_of(folder / "one.h5"));
}

TEST_CASE("ranks: a stop keeps finished blocks, whichever rank got the signal, and can be resumed") {
    const TemporaryFolder folder;
    Asked asked = some();
    asked.trials = 2000000;
    asked.scenarios = {tiny("a"), scenario("b")};
    // They stop after some of some thousand blocks.
    std::atomic<bool> begun = false;
    const auto enough = [&] { return begun.load(); };
    const auto progress = [&](const Progress& now) { begun = now.done >= 10 * block_size; };
    const auto at_once = RankLeader::Sending::at_once;
    run_together(folder / "own.h5", asked, {3, enough, no_signal, at_once, progress});
    begun = false;
    const Signal signal = [&] { return std::string(begun ? "SIGTERM" : ""); };
    run_together(folder / "other.h5", asked, {3, {}, signal, RankLeader::Sending::now_and_then, progress});
    for (const char* name : {"own.h5", "other.h5"}) {
        const Study study = read_results(folder / name).study;
        CAPTURE(name, blocks_in(study));
        CHECK_FALSE(study.complete);
        REQUIRE(blocks_in(study) >= 10);
        Study again = asked.study();
        for (std::size_t s = 0; s < study.scenarios.size(); ++s)
            for (std::size_t a = 0; a < study.scenarios[s].arms.size(); ++a)
                CHECK(study.scenarios[s].arms[a].counted == study.scenarios[s].trials);
        // The totals are those of the blocks that are there, which another run computes by itself.
        const BlockRanges& blocks = study.scenarios.front().blocks;
        ScenarioResults& results = again.scenarios.front();
        const Problem problem(settings_of(results.scenario));
        for (const std::int64_t block : blocks)
            add_totals(results, run_block(problem, asked.root_seed, block, trials_in_block(asked.trials, block)));
        CHECK(results.arms.front().totals.front().sum.front().parts() ==
              study.scenarios.front().arms.front().totals.front().sum.front().parts());
    }
}

TEST_CASE("ranks: the signal of another rank is reported by name and rank") {
    Office office(2);
    const Followers followers(office, [] { return std::string("SIGHUP"); });
    ThreadTransport own(office, 0);
    const TemporaryFolder folder;
    Asked asked = some();
    asked.trials = 10000000;
    StoredRun run = opened(folder / "x.h5", asked);
    RankLeader leader(own);
    leader.begin(definition_of(run.study()), 1, RankLeader::Sending::at_once);
    RunOptions options{asked.trials, 1, {}, {}, [&] { return leader.asked_to_stop(); }, &run.begin(asked.trials),
                       &leader};
    run_study(run.study(), options);
    CHECK(leader.stopped_by() == "SIGHUP of rank 1");
    CHECK_FALSE(run.study().complete);
}

TEST_CASE("ranks: a rank that falls silent ends the run, and the results of the others are committed") {
    const TemporaryFolder folder;
    const Asked asked = some();
    Office office(2);
    {
        ThreadTransport lost(office, 1), own(office, 0);
        StoredRun run = opened(folder / "x.h5", asked);
        RankLeader leader(own, std::chrono::milliseconds(50));
        ByteWriter one;
        one.put(std::int64_t{1});
        lost.send(0, Word::want, one.take());  // it takes a block, and then sends nothing
        leader.begin(definition_of(run.study()), 1, RankLeader::Sending::at_once);
        RunOptions options{asked.trials, 1, {}, {}, {}, &run.begin(asked.trials, 1), &leader};
        const std::string said = refusal<Failure>([&] { run_study(run.study(), options); });
        CHECK(says(said, "rank 1 is lost"));
    }
    CHECK(office.abandoned);
    run_to_end(folder / "x.h5", asked);
    run_to_end(folder / "one.h5", asked);
    CHECK(bytes_of(folder / "x.h5") == bytes_of(folder / "one.h5"));
}

TEST_CASE("ranks: where rank 0 fails the others end") {
    const TemporaryFolder folder;
    struct NoSpace : BlockKeeper {
        void take_back(std::size_t, std::int64_t) override {}
        void take(std::size_t, const Block&) override {}
        void take(std::size_t, const std::vector<std::int64_t>&, const std::string&) override {}
        bool due(std::int64_t) const override { return true; }
        bool full() const override { return false; }
        void prepare(const Study&) override {}
        void commit() override { throw Failure("no space"); }
        void finished(const Study&) override {}
    } keeper;
    Office office(3);
    const Followers followers(office);
    ThreadTransport transport(office, 0);
    RankLeader leader(transport);
    Study study = some().study();
    leader.begin(definition_of(study), 1, RankLeader::Sending::at_once);
    CHECK(refusal<Failure>([&] { run_study(study, {5000, 1, {}, {}, {}, &keeper, &leader}); }) == "no space");
}

TEST_CASE("ranks: those that are dismissed before they had work end") {
    Office office(3);
    const Followers followers(office);
    ThreadTransport transport(office, 0);
    const RankLeader leader(transport);
    SUCCEED();
}

TEST_CASE("ranks: a message holds the blocks' columns, details and totals, and a torn one is refused") {
    const Asked asked = some();
    const Study whole = undisturbed(asked);
    const std::vector<ScenarioResults> empty{without_columns(scenario_of(asked.scenarios[0])),
                                             without_columns(scenario_of(asked.scenarios[1]))};
    RankMessage record(empty[1]);
    const Problem problem(settings_of(whole.scenarios[1].scenario));
    for (const std::int64_t block : {19, 2, 5})
        record.take(run_block(problem, 1, block, trials_in_block(asked.trials, block)));
    const std::string bytes = record.bytes(1, asked.trials);
    const ComputedBlocks computed = read_rank_message(bytes, empty);
    CHECK(computed.scenario == 1);
    CHECK(computed.blocks == std::vector<std::int64_t>{19, 2, 5});
    CHECK(computed.results.blocks == std::vector<std::int64_t>{2, 5, 19});
    CHECK(computed.results.arms.front().counted == 2 * 256 + 5000 - 19 * 256);
    const std::size_t width = static_cast<std::size_t>(whole.scenarios[1].steps());
    CHECK(computed.results.arms.front().nees[256 * width] == whole.scenarios[1].arms.front().nees[5 * 256 * width]);
    for (std::size_t size = 0; size < bytes.size(); size += 1 + size / 7)
        CHECK_FALSE(refusal<BadBytes>([&] { read_rank_message(bytes.substr(0, size), empty); }).empty());
}
