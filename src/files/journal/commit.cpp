#include "files/journal/commit.hpp"

#include <algorithm>

namespace credence {

namespace {

constexpr std::uint32_t commit_magic = 0x6b636f6c;

template <class T>
void put_as(ByteWriter& to, const double* values, std::size_t count) {
    to.put_all(std::vector<T>(values, values + count));
}

template <class T>
void get_as(ByteReader& from, double* values, std::size_t count) {
    const std::vector<T> read = from.get_all<T>(count);
    std::copy(read.begin(), read.end(), values);
}

/// The text padded with nulls to `size`, or cut to it.
void put_release(ByteWriter& to, std::string release) {
    release.resize(commit_release_size, '\0');
    to.put_raw(release.data(), release.size());
}

std::string get_release(ByteReader& from) {
    std::string release(from.raw(commit_release_size), commit_release_size);
    release.resize(std::min(release.find('\0'), release.size()));
    if (std::any_of(release.begin(), release.end(), [](char c) { return c < ' ' || c > '~'; }))
        throw BadBytes("an impossible release");
    return release;
}

/// Ranges of a study's blocks, and in `start.blocks` those blocks that have values.
void get_ranges(ByteReader& from, std::uint32_t count, const BlockLayout& layout, CommitStart& start) {
    for (; count > 0; --count) {
        const BlockRange range{from.get<std::int64_t>(), from.get<std::int64_t>()};
        if (range.first < 0 || range.last < range.first || range.last >= block_count(start.trials))
            throw BadBytes("a block that the study does not have");
        start.ranges.push_back(range);
        for (std::int64_t block = range.first; block <= range.last && layout.detailed(block); ++block)
            start.blocks.push_back({block, trials_in_block(start.trials, block)});
        if (std::ssize(start.blocks) > layout.detailed_blocks()) throw BadBytes("a block is there twice");
    }
}

}  // namespace

void put_shard(ByteWriter& to, const Shard& shard) {
    to.put(shard.index);
    to.put(shard.count);
}

Shard get_shard(ByteReader& from) {
    const Shard shard{from.get<std::int64_t>(), from.get<std::int64_t>()};
    if (shard.index < 0 || shard.index >= shard.count) throw BadBytes("an impossible shard");
    return shard;
}

BlockLayout::BlockLayout(const ScenarioResults& results)
    : keep_(results.keep),
      column_at_{0},
      arms_(static_cast<std::int64_t>(results.arms.size())),
      detailed_blocks_(detailed_trials(results.steps(), results.state_size()) / block_size),
      errors_(std::int64_t{results.steps()} * results.state_size()),
      nees_(results.steps()),
      moments_(results.moment_count()) {
    for (const ColumnType type : kept_types(results)) column_at_.push_back(column_at_.back() + value_size(type));
}

std::int64_t BlockLayout::column_offset(std::size_t arm, std::size_t column, std::int64_t trials) const {
    return trials * (static_cast<std::int64_t>(arm) * column_at_.back() + column_at_[column]);
}

std::int64_t BlockLayout::details_offset(std::size_t arm, std::int64_t trials) const {
    return trials * arms_ * column_at_.back() + static_cast<std::int64_t>(arm) * details_size(trials);
}

std::int64_t BlockLayout::details_size(std::int64_t trials) const {
    return trials * ((errors_ + nees_) * static_cast<std::int64_t>(sizeof(float)) +
                     moments_ * static_cast<std::int64_t>(sizeof(double)));
}

std::int64_t BlockLayout::size(const JournalBlock& block) const {
    return detailed(block.index) ? details_offset(static_cast<std::size_t>(arms_), block.trials)
                                 : block.trials * arms_ * column_at_.back();
}

std::int64_t value_size(ColumnType type) { return type == ColumnType::real ? 8 : type == ColumnType::integer ? 4 : 1; }

void put_values(ByteWriter& to, ColumnType type, const double* values, std::size_t count) {
    if (type == ColumnType::real) to.put_raw(values, count * sizeof(double));
    else if (type == ColumnType::integer) put_as<std::int32_t>(to, values, count);
    else put_as<std::int8_t>(to, values, count);
}

void get_values(ByteReader& from, ColumnType type, double* values, std::size_t count) {
    if (type == ColumnType::real) return get_as<double>(from, values, count);
    if (type == ColumnType::integer) return get_as<std::int32_t>(from, values, count);
    get_as<std::int8_t>(from, values, count);
    const auto statuses = static_cast<double>(status_names().size());
    if (!std::all_of(values, values + count, [&](double status) { return status >= 0 && status < statuses; }))
        throw BadBytes("an unknown status");
}

std::vector<ColumnType> kept_types(const ScenarioResults& results) {
    std::vector<ColumnType> types;
    if (results.keep == Keep::aggregates) return types;
    for (const Column& column : results.columns) types.push_back(column.type);
    return types;
}

void put_block(ByteWriter& to, const std::vector<ColumnType>& types, const Block& block) {
    const auto trials = static_cast<std::size_t>(block.trials);
    for (const ArmBlock& arm : block.arms)
        for (std::size_t c = 0; c < types.size(); ++c)
            put_values(to, types[c], arm.columns.data() + c * trials, trials);
    for (const ArmBlock& arm : block.arms) {
        to.put_all(arm.errors);
        to.put_all(arm.nees);
        to.put_all(arm.moments);
    }
}

void get_details(ByteReader& from, const BlockLayout& layout, std::int64_t trials, std::int64_t row, ArmResults& to) {
    const auto get = [&]<class T>(T, std::vector<double>& all, std::int64_t width) {
        const std::vector<T> values = from.get_all<T>(static_cast<std::size_t>(trials * width));
        std::copy(values.begin(), values.end(), all.begin() + row * width);
    };
    get(float(), to.errors, layout.errors());
    get(float(), to.nees, layout.nees());
    get(double(), to.moments, layout.moments());
}

void put_commit_head(ByteWriter& to, const CommitHead& head) {
    to.put(commit_magic);
    to.put(head.scenario);
    to.put(head.payload);
}

CommitHead get_commit_head(ByteReader& from) {
    if (from.get<std::uint32_t>() != commit_magic) throw BadBytes("no record begins there");
    CommitHead head;
    head.scenario = from.get<std::uint32_t>();
    head.payload = from.get<std::int64_t>();
    if (head.payload < static_cast<std::int64_t>(commit_start_size)) throw BadBytes("a record is too short");
    return head;
}

void put_commit_start(ByteWriter& to, const CommitStart& start, Keep keep) {
    to.put(start.trials);
    to.put(start.counted);
    put_shard(to, start.shard);
    put_release(to, start.release);
    if (keep == Keep::aggregates) {
        to.put(static_cast<std::uint32_t>(start.ranges.size()));
        for (const BlockRange& range : start.ranges) {
            to.put(range.first);
            to.put(range.last);
        }
        return;
    }
    to.put(static_cast<std::uint32_t>(start.blocks.size()));
    for (const JournalBlock& block : start.blocks) {
        to.put(block.index);
        to.put(block.trials);
    }
}

std::size_t block_list_size(const CommitStart& start, Keep keep) {
    return keep == Keep::aggregates ? start.ranges.size() * journal_range_size
                                    : start.blocks.size() * journal_block_size;
}

CommitStart commit_of(const std::vector<std::int64_t>& blocks, std::int64_t trials, const BlockLayout& layout) {
    CommitStart start{trials, 0, {}};
    BlockRanges without_values;
    for (const std::int64_t block : blocks) {
        if (layout.keep() == Keep::aggregates && !layout.detailed(block)) {
            without_values.add(block);
            continue;
        }
        start.blocks.push_back({block, trials_in_block(trials, block)});
        if (layout.keep() == Keep::aggregates) start.ranges.push_back({block, block});
    }
    const std::vector<BlockRange> others = without_values.ranges();
    start.ranges.insert(start.ranges.end(), others.begin(), others.end());
    return start;
}

CommitStart get_commit_start(ByteReader& from, const BlockLayout& layout) {
    CommitStart start;
    start.trials = from.get<std::int64_t>();
    start.counted = from.get<std::int64_t>();
    if (start.trials < 0 || start.trials > most_trials || start.counted < 0 || start.counted > start.trials)
        throw BadBytes("an impossible number of trials");
    start.shard = get_shard(from);
    start.release = get_release(from);
    const auto count = from.get<std::uint32_t>();
    if (layout.keep() == Keep::aggregates) {
        get_ranges(from, count, layout, start);
        return start;
    }
    for (auto left = count; left > 0; --left) {
        JournalBlock block{from.get<std::int64_t>(), from.get<std::int32_t>()};
        if (block.index < 0 || block.index >= block_count(start.trials) ||
            block.trials != trials_in_block(start.trials, block.index))
            throw BadBytes("a block that the study does not have");
        start.blocks.push_back(block);
    }
    return start;
}

std::string commit_start_bytes(std::uint32_t scenario, const CommitStart& start, Keep keep, std::size_t size_after) {
    ByteWriter record;
    const std::size_t payload = commit_start_size + block_list_size(start, keep) + size_after;
    put_commit_head(record, {scenario, static_cast<std::int64_t>(payload)});
    put_commit_start(record, start, keep);
    return record.take();
}

}  // namespace credence
