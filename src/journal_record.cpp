#include "journal_record.hpp"

#include <credence/error.hpp>
#include <credence/ini.hpp>
#include <credence/scenario_keys.hpp>

#include <zlib.h>

#include <algorithm>

namespace credence {

namespace {

const std::string magic = "credence-journal";  // 16 bytes
constexpr std::uint32_t journal_version = 2, record_magic = 0x6b636f6c;
constexpr std::uint32_t largest_header = std::uint32_t{256} << 20;

void put_shard(ByteWriter& to, const Shard& shard) {
    to.put(shard.index);
    to.put(shard.count);
}

Shard get_shard(ByteReader& from) {
    const Shard shard{from.get<std::int64_t>(), from.get<std::int64_t>()};
    if (shard.index < 0 || shard.index >= shard.count) throw BadBytes("an impossible shard");
    return shard;
}

[[noreturn]] void refuse(const std::string& path, const std::string& why, const std::string& remedy) {
    throw InputError(path + ": " + why + ". " + remedy + ".");
}

}  // namespace

std::uint32_t checksum(const void* bytes, std::size_t size, std::uint32_t crc) {
    return static_cast<std::uint32_t>(crc32_z(crc, static_cast<const Bytef*>(bytes), size));
}

std::string header_bytes(const JournalHeader& header) {
    ByteWriter body;
    body.put(static_cast<std::int32_t>(schema_version));
    body.put(static_cast<std::uint8_t>(header.base));
    body.put(header.trials);
    put_shard(body, header.shard);
    body.put(header.study.root_seed);
    body.put_count(header.study.scenarios.size());
    for (const Scenario& scenario : header.study.scenarios) body.put_text(scenario_text(scenario));
    ByteWriter all;
    all.put_raw(magic.data(), magic.size());
    all.put(journal_version);
    all.put(static_cast<std::uint32_t>(body.size()));
    all.put_raw(body.bytes().data(), body.size());
    all.put(checksum(all.bytes().data(), all.size()));
    return all.take();
}

std::size_t header_size(const std::string& start, const std::string& path) {
    const std::string another = "Remove it, or give another name for the results";
    if (magic.compare(0, std::min(start.size(), magic.size()), start, 0, std::min(start.size(), magic.size())) != 0)
        refuse(path, "is not a journal of credence", another);
    ByteReader from(start.data(), start.size());
    from.raw(magic.size());
    if (const auto version = from.get<std::uint32_t>(); version != journal_version)
        refuse(path, "is a journal of version " + std::to_string(version) + ", this program's is " +
                         std::to_string(journal_version), "Finish the run with the release that began it");
    const auto body = from.get<std::uint32_t>();
    if (body > largest_header) refuse(path, "is damaged: its header is too long", another);
    return header_prefix + body + sizeof(std::uint32_t);
}

JournalHeader read_header(const std::string& start, const std::string& path, std::size_t& size) {
    size = header_size(start, path);
    ByteReader from(start.data(), start.size());
    const char* all = from.raw(size - sizeof(std::uint32_t));
    if (from.get<std::uint32_t>() != checksum(all, size - sizeof(std::uint32_t))) throw BadBytes("a torn header");
    ByteReader body(all + header_prefix, size - sizeof(std::uint32_t) - header_prefix);
    if (const auto version = body.get<std::int32_t>(); version != schema_version)
        refuse(path, "is of schema version " + std::to_string(version) + ", this program's is " +
                         std::to_string(schema_version), "Finish the run with the release that began it");
    JournalHeader header;
    const auto base = body.get<std::uint8_t>();
    if (base > static_cast<std::uint8_t>(JournalBase::replaced)) throw BadBytes("an unknown kind of base");
    header.base = static_cast<JournalBase>(base);
    header.trials = body.get<std::int64_t>();
    if (header.trials < 0 || header.trials > most_trials) throw BadBytes("an impossible number of trials");
    header.shard = get_shard(body);
    header.study.root_seed = body.get<std::uint64_t>();
    for (std::uint64_t left = body.get_count(); left > 0; --left)
        header.study.scenarios.push_back(read_scenario_text(body.get_text(), path + ": scenario", "scenario"));
    return header;
}

BlockLayout::BlockLayout(const ScenarioResults& results)
    : column_at_{0},
      arms_(static_cast<std::int64_t>(results.arms.size())),
      detailed_blocks_(detailed_trials(results.steps(), results.state_size()) / block_size),
      errors_(std::int64_t{results.steps()} * results.state_size()),
      nees_(results.steps()) {
    for (const Column& column : results.columns) column_at_.push_back(column_at_.back() + value_size(column.type));
}

std::int64_t BlockLayout::column_offset(std::size_t arm, std::size_t column, std::int64_t trials) const {
    return trials * (static_cast<std::int64_t>(arm) * column_at_.back() + column_at_[column]);
}

std::int64_t BlockLayout::details_offset(std::size_t arm, std::int64_t trials) const {
    const auto details = static_cast<std::int64_t>(arm) * (errors_ + nees_) * static_cast<std::int64_t>(sizeof(float));
    return trials * (arms_ * column_at_.back() + details);
}

std::int64_t BlockLayout::size(const JournalBlock& block) const {
    return detailed(block.index) ? details_offset(static_cast<std::size_t>(arms_), block.trials)
                                 : block.trials * arms_ * column_at_.back();
}

std::int64_t value_size(ColumnType type) {
    return type == ColumnType::real ? 8 : type == ColumnType::integer ? 4 : 1;
}

void put_values(ByteWriter& to, ColumnType type, const double* values, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        if (type == ColumnType::real) to.put(values[i]);
        else if (type == ColumnType::integer) to.put(static_cast<std::int32_t>(values[i]));
        else to.put(static_cast<std::int8_t>(values[i]));
    }
}

void get_values(ByteReader& from, ColumnType type, double* values, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        if (type == ColumnType::real) values[i] = from.get<double>();
        else if (type == ColumnType::integer) values[i] = from.get<std::int32_t>();
        else values[i] = from.get<std::int8_t>();
        if (type == ColumnType::status && !(values[i] >= 0 && values[i] < static_cast<double>(status_names().size())))
            throw BadBytes("a status that is none");
    }
}

void put_record_head(ByteWriter& to, const RecordHead& head) {
    to.put(record_magic);
    to.put(head.scenario);
    to.put(head.payload);
}

RecordHead get_record_head(ByteReader& from) {
    if (from.get<std::uint32_t>() != record_magic) throw BadBytes("no record begins there");
    RecordHead head;
    head.scenario = from.get<std::uint32_t>();
    head.payload = from.get<std::int64_t>();
    if (head.payload < static_cast<std::int64_t>(record_start_size)) throw BadBytes("a record is too short");
    return head;
}

void put_record_start(ByteWriter& to, const RecordStart& start) {
    to.put(start.trials);
    to.put(start.counted);
    put_shard(to, start.shard);
    to.put(static_cast<std::uint32_t>(start.blocks.size()));
    for (const JournalBlock& block : start.blocks) {
        to.put(block.index);
        to.put(block.trials);
    }
}

RecordStart get_record_start(ByteReader& from) {
    RecordStart start;
    start.trials = from.get<std::int64_t>();
    start.counted = from.get<std::int64_t>();
    if (start.trials < 0 || start.trials > most_trials || start.counted < 0 || start.counted > start.trials)
        throw BadBytes("an impossible number of trials");
    start.shard = get_shard(from);
    for (auto left = from.get<std::uint32_t>(); left > 0; --left) {
        JournalBlock block{from.get<std::int64_t>(), from.get<std::int32_t>()};
        if (block.index < 0 || block.index >= block_count(start.trials) ||
            block.trials != trials_in_block(start.trials, block.index))
            throw BadBytes("a block that the study does not have");
        start.blocks.push_back(block);
    }
    return start;
}

}  // namespace credence
