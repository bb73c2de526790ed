// A rank other than 0: computes the blocks that rank 0 hands out.

#include "cluster/rank_message.hpp"

#include <omp.h>

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

namespace credence {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds silence(5);               ///< after which a rank sends a sign of life
constexpr double seconds_ahead = 0.1;                    ///< for which a rank should have blocks in advance
constexpr double most_blocks_ahead = 1000;               ///< in advance, of a thread
constexpr std::size_t too_much = std::size_t{64} << 20;  ///< bytes of finished blocks that rank 0 has not received yet

double seconds_since(Clock::time_point then) { return std::chrono::duration<double>(Clock::now() - then).count(); }

/// One thread communicates with rank 0, the others compute.
class Worker {
public:
    Worker(Transport& transport, const std::function<std::string()>& signal) : transport_(transport), signal_(signal) {}

    void run() {
        if (await_order()) {
            const int threads = order_.threads > 0 ? order_.threads : omp_get_max_threads();
            wanted_ = threads_ = threads;
#pragma omp parallel num_threads(threads + 1)
            if (omp_get_thread_num() == 0)
                guarded([&] { omp_get_num_threads() > 1 ? talk() : refuse_one_thread(); });
            else
                guarded([&] { compute(); });
            if (trouble_) std::rethrow_exception(trouble_);
        }
        transport_.send(0, Word::leaves, {});
    }

private:
    [[noreturn]] static void refuse_one_thread() {
        throw std::runtime_error(
            "a rank needs a thread beside those that compute, and may have one only (OMP_THREAD_LIMIT).");
    }

    /// Whether there is any work before the end.
    bool await_order() {
        for (;; std::this_thread::sleep_for(rank_pause)) {
            show_life();
            const std::optional<Message> message = transport_.receive();
            if (!message) continue;
            if (message->word == Word::end) return false;
            if (message->word != Word::study) continue;
            order_ = read_order(message->bytes);
            for (const Scenario& scenario : order_.study.scenarios) {
                runners_.emplace_back(scenario);
                empty_.push_back(without_columns(scenario, order_.study.keep));
                records_.emplace_back(empty_.back());
            }
            return true;
        }
    }

    template <class Work>
    void guarded(Work work) {
        try {
            work();
        } catch (...) {
            const std::lock_guard lock(mutex_);
            trouble_ = std::current_exception();
            finish();
        }
    }

    /// Called with the lock held.
    void finish() {
        over_ = true;
        queue_.clear();
        changed_.notify_all();
    }

    void compute() {
        for (;;) {
            std::unique_lock lock(mutex_);
            changed_.wait(lock, [&] { return over_ || (!queue_.empty() && pending_ < too_much); });
            if (over_) return;
            const Task task = queue_.front();
            queue_.pop_front();
            ++under_way_;
            const int trials = trials_in_block(trials_, task.block);
            lock.unlock();
            const Clock::time_point start = Clock::now();
            const Block block = runners_[task.scenario].run(order_.study.root_seed, task.block, trials);
            const std::vector<ArmAggregates> aggregates = block_aggregates(empty_[task.scenario], block);
            lock.lock();
            take(task, block, aggregates, seconds_since(start));
        }
    }

    void take(const Task& task, const Block& block, const std::vector<ArmAggregates>& aggregates, double seconds) {
        RankMessage& record = records_[task.scenario];
        const std::size_t before = record.size();
        record.take(block, aggregates);
        pending_ += record.size() - before;
        --under_way_;
        block_seconds_ = block_seconds_ > 0 ? 0.8 * block_seconds_ + 0.2 * seconds : seconds;
        wanted_ =
            static_cast<std::int64_t>(threads_ * std::clamp(seconds_ahead / block_seconds_, 1.0, most_blocks_ahead));
    }

    // On the thread that communicates.
    void talk() {
        for (;;) {
            while (const std::optional<Message> message = transport_.receive()) hear(*message);
            if (over()) return;
            pass_signal_on();
            ask_for_tasks();
            send_what_is_done();
            show_life();
            std::this_thread::sleep_for(rank_pause);
        }
    }

    bool over() {
        const std::lock_guard lock(mutex_);
        return over_;
    }

    void hear(const Message& message) {
        if (message.word == Word::tasks) return add_tasks(read_tasks(message.bytes));
        const std::lock_guard lock(mutex_);
        if (message.word == Word::drop) {
            queue_.clear();
            dropping_ = true;
        }
        if (message.word == Word::end) finish();
    }

    void add_tasks(const RankTasks& given) {
        if (given.trials != trials_) send_messages();  // a message is of one number of trials
        const std::lock_guard lock(mutex_);
        trials_ = given.trials;
        waiting_ = false;
        queue_.insert(queue_.end(), given.tasks.begin(), given.tasks.end());
        changed_.notify_all();
    }

    void send(Word word, std::string bytes = {}) {
        transport_.send(0, word, std::move(bytes));
        spoke_ = Clock::now();
    }

    void show_life() {
        if (Clock::now() - spoke_ > silence) send(Word::alive);
    }

    void pass_signal_on() {
        const std::string name = signal_passed_on_ ? "" : signal_();
        if (name.empty()) return;
        send(Word::stop, name);
        signal_passed_on_ = true;
    }

    void ask_for_tasks() {
        if (waiting_ || dropping_ || signal_passed_on_) return;
        std::int64_t some = 0;
        {
            const std::lock_guard lock(mutex_);
            const auto queued = static_cast<std::int64_t>(queue_.size());
            if (queued > wanted_ / 2) return;
            some = std::max<std::int64_t>(1, wanted_ - queued);
        }
        waiting_ = true;
        ByteWriter count;
        count.put(some);
        send(Word::want, count.take());
    }

    void send_what_is_done() {
        bool idle = false;
        {
            const std::lock_guard lock(mutex_);
            idle = queue_.empty() && under_way_ == 0;
            const bool early = seconds_since(sent_) < order_.seconds && pending_ < too_much / 2;
            if (!idle && (early || transport_.sending())) return;
        }
        send_messages();
        if (!idle || !dropping_) return;
        send(Word::dropped);
        dropping_ = false;
    }

    void send_messages() {
        for (std::size_t s = 0; s < records_.size(); ++s) {
            std::optional<RankMessage> record;
            {
                const std::lock_guard lock(mutex_);
                if (records_[s].empty()) continue;
                record = std::exchange(records_[s], RankMessage(empty_[s]));
                pending_ -= record->size();
                changed_.notify_all();
            }
            send(Word::record, record->bytes(s, trials_));
            sent_ = Clock::now();
        }
    }

    Transport& transport_;
    const std::function<std::string()>& signal_;
    RankOrder order_;
    int threads_ = 0;
    std::vector<BlockRunner> runners_;
    std::vector<ScenarioResults> empty_;

    std::mutex mutex_;                 ///< of the members below, up to the empty line
    std::condition_variable changed_;  ///< new tasks, space for results, or the end
    std::deque<Task> queue_;
    std::vector<RankMessage> records_;  ///< by scenario: finished blocks
    std::size_t pending_ = 0;          ///< bytes in these
    std::int64_t trials_ = 0;          ///< of the study, with the current tasks
    std::int64_t wanted_ = 0;          ///< blocks to have in advance
    int under_way_ = 0;
    double block_seconds_ = 0;
    bool over_ = false;
    std::exception_ptr trouble_;

    bool dropping_ = false, waiting_ = false, signal_passed_on_ = false;  // used by the communicating thread only
    Clock::time_point spoke_ = Clock::now(), sent_ = Clock::now();
};

}  // namespace

void follow(Transport& transport, const std::function<std::string()>& signal) { Worker(transport, signal).run(); }

}  // namespace credence
