// Rank 0: hands blocks out to the other ranks, and takes back the results.

#include "cluster/rank_message.hpp"

#include <credence/error.hpp>

#include <algorithm>
#include <thread>

namespace credence {

namespace {

using Clock = std::chrono::steady_clock;

/// Rank 0 adds up the totals of a message in milliseconds: it should receive no more than some tens of them a second.
double seconds_between_records(int ranks) { return std::max(0.5, 0.02 * ranks); }

}  // namespace

/// Rank 0's state for another rank.
struct RankLeader::Rank {
    std::int64_t wants = 0;  ///< blocks that it asked for and has not received yet
    std::int64_t out = 0;    ///< blocks that were handed out to it and are not back
    bool dropping = false;   ///< was asked to drop its blocks, and has not answered yet
    bool gone = false;
    Clock::time_point heard = Clock::now();
};

RankLeader::RankLeader(Transport& transport, std::chrono::duration<double> patience)
    : transport_(transport), patience_(patience), ranks_(static_cast<std::size_t>(transport.size())) {
    ranks_.front().gone = true;
}

RankLeader::~RankLeader() {
    try {
        if (!lost_) tell_all(Word::end);
        const auto here = [](const Rank& rank) { return !rank.gone; };
        while (!lost_ && std::any_of(ranks_.begin(), ranks_.end(), here)) {
            while (const std::optional<Message> message = transport_.receive()) hear(*message, nullptr);
            check_alive();
            std::this_thread::sleep_for(rank_pause);
        }
    } catch (const std::exception&) {
        lost_ = true;  // the first error is being reported already
    }
    if (lost_) transport_.abandon();
}

void RankLeader::tell_all(Word word, const std::string& bytes) {
    for (int rank = 1; rank < transport_.size(); ++rank) transport_.send(rank, word, bytes);
}

void RankLeader::begin(const StudyDefinition& definition, int threads, Sending sending) {
    for (const Scenario& scenario : definition.scenarios)
        empty_.push_back(without_columns(scenario, definition.keep));
    const double seconds = sending == Sending::at_once ? 0 : seconds_between_records(transport_.size());
    tell_all(Word::study, order_bytes({definition, threads, seconds}));
}

void RankLeader::serve(BlockQueue& queue) {
    const auto busy = [](const Rank& rank) { return rank.out > 0; };
    const auto dropping = [](const Rank& rank) { return rank.dropping; };
    for (Rank& rank : ranks_) rank.heard = Clock::now();  // until now rank 0 did not receive messages
    bool end_sent = false;
    for (;;) {
        while (const std::optional<Message> message = transport_.receive()) hear(*message, &queue);
        if (!end_sent && queue.stopped()) {
            tell_all(Word::drop);
            for (std::size_t rank = 1; rank < ranks_.size(); ++rank) ranks_[rank].dropping = true;
            end_sent = true;
        }
        if (!end_sent) hand_out(queue);
        const bool over = end_sent ? std::none_of(ranks_.begin(), ranks_.end(), dropping)
                               : queue.left() == 0 && std::none_of(ranks_.begin(), ranks_.end(), busy);
        if (over) return;
        check_alive();
        std::this_thread::sleep_for(rank_pause);
    }
}

/// Hands out what is asked for, but no more than a share of what is left, so that all ranks end at about the same time.
void RankLeader::hand_out(BlockQueue& queue) {
    for (int number = 1; number < transport_.size(); ++number) {
        Rank& rank = ranks_[static_cast<std::size_t>(number)];
        if (rank.wants == 0) continue;
        const std::int64_t share = std::max<std::int64_t>(1, queue.left() / (2 * transport_.size()));
        const std::vector<Task> tasks = queue.hand_out(std::min(rank.wants, share));
        if (tasks.empty()) return;
        rank.wants = 0;
        rank.out += static_cast<std::int64_t>(tasks.size());
        transport_.send(number, Word::tasks, tasks_bytes({queue.trials(), tasks}));
    }
}

/// Without a run in progress, received blocks are ignored.
void RankLeader::hear(const Message& message, BlockQueue* queue) {
    Rank& rank = ranks_[static_cast<std::size_t>(message.rank)];
    rank.heard = Clock::now();
    switch (message.word) {
        case Word::want: {
            ByteReader from(message.bytes.data(), message.bytes.size());
            rank.wants = from.get<std::int64_t>();
            return;
        }
        case Word::record: {
            if (queue == nullptr) return;
            const ComputedBlocks computed = read_rank_message(message.bytes, empty_);
            rank.out -= static_cast<std::int64_t>(computed.blocks.size());
            return queue->take(computed);
        }
        case Word::stop:
            if (stopped_by_.empty()) stopped_by_ = message.bytes + " of rank " + std::to_string(message.rank);
            asked_to_stop_ = true;
            return;
        case Word::dropped:
            rank.dropping = false;
            rank.out = 0;
            return;
        case Word::leaves:
            rank.gone = true;
            return;
        default:
            return;  // alive
    }
}

void RankLeader::check_alive() {
    for (std::size_t number = 1; number < ranks_.size(); ++number) {
        if (ranks_[number].gone || Clock::now() - ranks_[number].heard < patience_) continue;
        lost_ = true;
        throw Failure("rank " + std::to_string(number) + " is lost: nothing was heard of it for " +
                      std::to_string(static_cast<int>(patience_.count())) + " s.");
    }
}

}  // namespace credence
