#pragma once
// One run on several processes, the ranks 0, 1 ... of a job. Rank 0 leads: it has the study, the journal and the files,
// hands blocks out and takes back the results; the other ranks need neither the scenario files nor the results file.
// Results travel in the format of the journal's commits (src/files/journal/commit.hpp). Rank 0 computes blocks as well.

#include "study/workers.hpp"

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace credence {

/// The kind of a message between ranks.
enum class Word {
    // from rank 0
    study,         ///< the study, and how to compute it
    tasks,         ///< blocks to compute
    drop,          ///< forget the blocks that have not begun, and send the finished ones
    end,           ///< the run is over
    // to rank 0
    want,          ///< asks for a number of blocks
    record,        ///< finished blocks
    stop,          ///< a signal was received; its name
    dropped,       ///< this rank has no blocks left
    alive,         ///< sign of life after a while without messages
    leaves,        ///< the last message of a rank
};

struct Message {
    int rank = 0;      ///< the sender
    Word word{};
    std::string bytes;
};

/// The transport between the ranks. Messages from one rank to another arrive in the order in which they were sent. In
/// each process only one thread calls it, the one that created it.
class Transport {
public:
    virtual ~Transport() = default;
    virtual int rank() const = 0;
    virtual int size() const = 0;
    /// Returns before the message has arrived.
    virtual void send(int rank, Word word, std::string bytes) = 0;
    /// A message that has arrived; does not wait for one.
    virtual std::optional<Message> receive() = 0;
    /// Whether messages of this process have not been delivered yet.
    virtual bool sending() = 0;
    /// A rank is lost: the destructor must not wait for it.
    virtual void abandon() = 0;
};

/// Rank 0, with the other ranks as workers.
class RankLeader : public Workers {
public:
    /// `patience`: a rank from which no message came for so long is lost.
    explicit RankLeader(Transport& transport, std::chrono::duration<double> patience = std::chrono::seconds(60));
    /// Ends the work of the other ranks, and waits until they leave.
    ~RankLeader() override;

    /// Sends the study to the ranks, each to compute it on `threads` threads (0: as many as it may have), and to send
    /// finished blocks every half second (or later, where there are many ranks), or as soon as they are done.
    enum class Sending { now_and_then, at_once };
    void begin(const StudyDefinition& definition, int threads, Sending sending);

    void serve(BlockQueue& queue) override;

    /// The signal that another rank received, such as `SIGTERM of rank 2`; empty where there was none.
    const std::string& stopped_by() const { return stopped_by_; }
    /// Whether there was one. Can be called from any thread.
    bool asked_to_stop() const { return asked_to_stop_; }

private:
    struct Rank;
    void hear(const Message& message, BlockQueue* queue);
    void tell_all(Word word, const std::string& bytes = {});
    void hand_out(BlockQueue& queue);
    void check_alive();

    Transport& transport_;
    std::chrono::duration<double> patience_;
    std::vector<Rank> ranks_;                ///< [size], that of rank 0 unused
    std::vector<ScenarioResults> empty_;     ///< by scenario
    std::string stopped_by_;
    std::atomic<bool> asked_to_stop_ = false;
    bool lost_ = false;
};

/// Any other rank: computes what rank 0 hands out until rank 0 ends the work. `signal` returns the name of the signal
/// that this rank received, empty for none; it is called now and then. Throws std::bad_alloc and the like; then the
/// whole job must end.
void follow(Transport& transport, const std::function<std::string()>& signal);

}  // namespace credence
