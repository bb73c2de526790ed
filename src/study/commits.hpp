#pragma once
// A run's commits to its keeper, and the totals that stay in memory between them.

#include <credence/study.hpp>

#include <mutex>
#include <vector>

namespace credence {

/// Does nothing without a keeper. One thread at a time calls the functions, but for `wait_for_room` and `commit`.
class Commits {
public:
    Commits(const Study& study, const RunOptions& options);

    /// Waits while too many blocks wait to be committed.
    void wait_for_room(std::unique_lock<std::mutex>& lock);

    /// Totals of a scenario were loaded into memory.
    void loaded(const ScenarioResults& results);
    /// The last block of a scenario has been added.
    void finished(const Study& study, std::size_t scenario);

    void take(std::size_t scenario, const Block& block);
    void take_back(std::size_t scenario, std::int64_t block);

    /// Prepares a commit of all blocks taken so far, if it is due; returns whether it was. Totals of finished scenarios
    /// that the keeper then has may leave the memory.
    bool prepare_if_due(Study& study);
    void prepare(Study& study);
    /// Makes the prepared commit durable.
    void commit();

private:
    bool too_much_held() const { return held_ > most_totals_; }

    BlockKeeper* keeper_;
    std::int64_t most_totals_;
    std::mutex committing_;              ///< locked while a commit is made
    std::vector<std::size_t> finished_;  ///< scenarios whose tasks are done, and whose totals are in memory
    std::int64_t held_ = 0, finished_size_ = 0;  ///< bytes of totals in memory, and those of `finished_`
};

}  // namespace credence
