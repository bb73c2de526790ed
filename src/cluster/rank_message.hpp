#pragma once
// The messages between ranks, as bytes.

#include "cluster/ranks.hpp"

#include "files/journal/commit.hpp"

#include <chrono>
#include <string>
#include <vector>

namespace credence {

/// Pause between two checks for messages: short beside the time for which a rank has blocks, long beside the check
/// itself.
inline constexpr std::chrono::milliseconds rank_pause(1);

/// A rank's task: what to compute, and how.
struct RankOrder {
    StudyDefinition study;
    int threads = 0;                 ///< 0: as many as the rank may have
    double seconds = 0;              ///< between two messages with blocks
};
std::string order_bytes(const RankOrder& order);
RankOrder read_order(const std::string& bytes);

/// Blocks to compute, of a study of `trials` trials.
struct RankTasks {
    std::int64_t trials = 0;
    std::vector<Task> tasks;
};
std::string tasks_bytes(const RankTasks& tasks);
RankTasks read_tasks(const std::string& bytes);

/// Blocks of one scenario that a rank has finished and not sent yet.
class RankMessage {
public:
    explicit RankMessage(const ScenarioResults& empty);

    void take(const Block& block, const std::vector<ArmAggregates>& aggregates = {});
    bool empty() const { return blocks_.empty(); }
    std::size_t size() const { return values_.size() + totals_size_; }  ///< bytes that it takes
    /// The bytes of a journal's commit without its checksum: the totals are those of its blocks alone.
    std::string bytes(std::size_t scenario, std::int64_t trials) const;

private:
    BlockLayout layout_;
    std::vector<ColumnType> types_;
    std::vector<std::int64_t> blocks_;
    ByteWriter values_;
    ScenarioResults results_;
    std::size_t totals_size_ = 0;
};

/// Reads the message back; `empty` are the study's scenarios without columns. Throws BadBytes.
ComputedBlocks read_rank_message(const std::string& bytes, const std::vector<ScenarioResults>& empty);

/// Empty results without columns and totals.
ScenarioResults without_columns(const Scenario& scenario, Keep keep = Keep::trials);

}  // namespace credence
