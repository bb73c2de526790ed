#include "cluster/rank_message.hpp"

#include "files/journal/totals.hpp"


namespace credence {

std::string order_bytes(const RankOrder& order) {
    ByteWriter to;
    to.put(static_cast<std::int32_t>(order.threads));
    to.put(order.seconds);
    to.put_text(header_bytes({JournalBase::none, {}, 0, {}, order.study}));
    return to.take();
}

RankOrder read_order(const std::string& bytes) {
    ByteReader from(bytes.data(), bytes.size());
    RankOrder order;
    order.threads = from.get<std::int32_t>();
    order.seconds = from.get<double>();
    std::size_t size = 0;
    order.study = read_header(from.get_text(), "message of rank 0", size).study;
    return order;
}

std::string tasks_bytes(const RankTasks& tasks) {
    ByteWriter to;
    to.put(tasks.trials);
    to.put_count(tasks.tasks.size());
    for (const Task& task : tasks.tasks) {
        to.put_count(task.scenario);
        to.put(task.block);
    }
    return to.take();
}

RankTasks read_tasks(const std::string& bytes) {
    ByteReader from(bytes.data(), bytes.size());
    RankTasks tasks{from.get<std::int64_t>(), {}};
    for (std::uint64_t left = from.get_count(); left > 0; --left) {
        const std::size_t scenario = from.get_count();
        tasks.tasks.push_back({scenario, from.get<std::int64_t>()});
    }
    return tasks;
}

ScenarioResults without_columns(const Scenario& scenario, Keep keep) {
    ScenarioResults results = results_without_totals(scenario, keep);
    for (ArmResults& arm : results.arms) arm.columns.clear();
    return results;
}

namespace {

/// All blocks of a message, those that have values in their order.
std::vector<std::int64_t> blocks_of(const CommitStart& start) {
    std::vector<std::int64_t> blocks;
    for (const JournalBlock& block : start.blocks)
        if (start.ranges.empty()) blocks.push_back(block.index);
    for (const BlockRange& range : start.ranges)
        for (std::int64_t block = range.first; block <= range.last; ++block) blocks.push_back(block);
    return blocks;
}

}  // namespace

RankMessage::RankMessage(const ScenarioResults& empty) : layout_(empty), types_(kept_types(empty)), results_(empty) {}

void RankMessage::take(const Block& block, const std::vector<ArmAggregates>& aggregates) {
    blocks_.push_back(block.index);
    put_block(values_, types_, block);
    if (!has_totals(results_)) {
        load_totals(results_);
        totals_size_ = static_cast<std::size_t>(totals_size(results_, 0));
    }
    add_totals(results_, block, aggregates);
}

std::string RankMessage::bytes(std::size_t scenario, std::int64_t trials) const {
    CommitStart start = commit_of(blocks_, trials, layout_);
    for (const std::int64_t block : blocks_) start.counted += trials_in_block(trials, block);
    ByteWriter totals;
    put_totals(totals, results_);
    return commit_bytes(static_cast<std::uint32_t>(scenario), start, layout_.keep(), values_.bytes(), totals.bytes());
}

ComputedBlocks read_rank_message(const std::string& bytes, const std::vector<ScenarioResults>& empty) {
    ByteReader from(bytes.data(), bytes.size());
    const CommitHead head = get_commit_head(from);
    if (head.scenario >= empty.size()) throw BadBytes("a record of a scenario that the study does not have");
    ComputedBlocks computed{head.scenario, {}, {}, empty[head.scenario]};
    ScenarioResults& results = computed.results;
    const BlockLayout layout(results);
    const CommitStart start = get_commit_start(from, layout);
    std::int64_t size = 0;
    for (const JournalBlock& block : start.blocks) size += layout.size(block);
    computed.blocks = blocks_of(start);
    computed.values.assign(from.raw(static_cast<std::uint64_t>(size)), static_cast<std::size_t>(size));
    set_blocks(results, computed.blocks, start.trials);
    load_totals(results);
    get_totals(from, results);
    std::int64_t position = 0;
    for (const JournalBlock& block : start.blocks) {
        for (std::size_t a = 0; a < results.arms.size() && layout.detailed(block.index); ++a) {
            ByteReader details(computed.values.data() + position + layout.details_offset(a, block.trials),
                               static_cast<std::size_t>(layout.details_size(block.trials)));
            get_details(details, layout, block.trials, first_row(results, block.index).value(), results.arms[a]);
        }
        position += layout.size(block);
    }
    return computed;
}

}  // namespace credence
