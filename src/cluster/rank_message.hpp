#pragma once
// What ranks tell each other, as bytes.

#include "cluster/ranks.hpp"

#include "files/journal/commit.hpp"

#include <chrono>
#include <string>
#include <vector>

namespace credence {

/// Between two looks at what has come: short beside the time for which a rank has blocks, long beside that of a look.
inline constexpr std::chrono::milliseconds rank_pause(1);

/// What a rank computes, and how.
struct RankOrder {
    StudyDefinition study;
    int threads = 0;                 ///< 0: as many as the rank may have
    double seconds = 0;              ///< between two records
};
std::string order_bytes(const RankOrder& order);
RankOrder read_order(const std::string& bytes);

/// Tasks of a study of `trials` trials.
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
    /// A record of the journal but for its checksum: the totals are those of its blocks alone.
    std::string bytes(std::size_t scenario, std::int64_t trials) const;

private:
    BlockLayout layout_;
    std::vector<ColumnType> types_;
    std::vector<std::int64_t> blocks_;
    ByteWriter values_;
    ScenarioResults results_;
    std::size_t totals_size_ = 0;
};

/// Reads it back; `empty` are those of the study's scenarios without columns. Throws BadBytes.
ComputedBlocks read_rank_message(const std::string& bytes, const std::vector<ScenarioResults>& empty);

/// Empty results that hold no columns, and no totals yet.
ScenarioResults without_columns(const Scenario& scenario, Keep keep = Keep::trials);

}  // namespace credence
