#pragma once
// One run on several processes, the ranks 0, 1 ... of a job. Rank 0 leads: it has the study, the journal and the
// files, hands blocks out and takes back what the others computed; they need neither the scenario files nor the results
// file. What goes between them are the journal's own records [journal_record.hpp]. Rank 0 computes blocks as well.

#include "study/workers.hpp"

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace credence {

/// What a message between ranks says.
enum class Word {
    // from rank 0
    study,         ///< the study, and how to compute it
    tasks,         ///< blocks to compute
    drop,          ///< forget those that have not begun, and send what is done
    end,           ///< the work is over
    // to rank 0
    want,          ///< asks for so many blocks
    record,        ///< blocks that are done
    stop,          ///< a signal came; its name
    dropped,       ///< nothing is left here that was handed out
    alive,         ///< nothing else was said for a while
    leaves,        ///< the last word of a rank
};

struct Message {
    int rank = 0;      ///< that sent it
    Word word{};
    std::string bytes;
};

/// How the ranks reach each other. Messages of one rank to another arrive in the order in which they were sent. Of a
/// process only one thread calls it, the one that made it.
class Transport {
public:
    virtual ~Transport() = default;
    virtual int rank() const = 0;
    virtual int size() const = 0;
    /// Returns before the message has arrived.
    virtual void send(int rank, Word word, std::string bytes) = 0;
    /// A message that has come; does not wait for one.
    virtual std::optional<Message> receive() = 0;
    /// Whether messages that this process sent are still on their way.
    virtual bool sending() = 0;
    /// A rank is lost: nobody is to wait for it when the post is given up.
    virtual void abandon() = 0;
};

/// Rank 0: the other ranks as workers.
class RankLeader : public Workers {
public:
    /// `patience`: a rank of which nothing was heard for so long is lost.
    explicit RankLeader(Transport& transport, std::chrono::duration<double> patience = std::chrono::seconds(60));
    /// Sends the other ranks home, and waits until they go.
    ~RankLeader() override;

    /// Tells the ranks of the study, each to compute it on `threads` threads (0: as many as it may have), and to send what
    /// is done every half second (or later, where there are many ranks), or as soon as it is done.
    enum class Sending { now_and_then, at_once };
    void begin(const StudyDefinition& definition, int threads, Sending sending);

    void serve(BlockQueue& queue) override;

    /// The signal that another rank got, such as `SIGTERM of rank 2`; empty where none did.
    const std::string& stopped_by() const { return stopped_by_; }
    /// Whether there is one. From any thread.
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

/// Any other rank: computes what rank 0 hands out until it is sent home. `signal` names the signal that came to this rank,
/// empty for none; it is asked now and then. Throws std::bad_alloc and the like; then the whole job has to end.
void follow(Transport& transport, const std::function<std::string()>& signal);

}  // namespace credence
