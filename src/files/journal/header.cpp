// Reading and writing a journal's header.

#include "files/journal/commit.hpp"

#include <credence/error.hpp>
#include <credence/ini.hpp>

#include <algorithm>

namespace credence {

namespace {

const std::string magic = "credence-journal";  // 16 bytes
constexpr std::uint32_t journal_version = 10;
constexpr std::uint32_t largest_header = std::uint32_t{256} << 20;

[[noreturn]] void refuse(const std::string& path, const std::string& why, const std::string& remedy) {
    throw InputError(why, {}, remedy).at(path);
}

}  // namespace

std::string header_bytes(const JournalHeader& header) {
    ByteWriter body;
    body.put(static_cast<std::int32_t>(schema_version));
    body.put(static_cast<std::uint8_t>(header.study.keep));
    body.put(static_cast<std::uint8_t>(header.base));
    body.put(header.base_file.inode);
    body.put(header.base_file.size);
    body.put(header.base_file.written);
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
                         std::to_string(journal_version),
               "Finish the run with the release that began it");
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
    const auto keep = body.get<std::uint8_t>();
    if (keep > static_cast<std::uint8_t>(Keep::aggregates)) throw BadBytes("an unknown kind of study");
    header.study.keep = static_cast<Keep>(keep);
    const auto base = body.get<std::uint8_t>();
    if (base > static_cast<std::uint8_t>(JournalBase::replaced)) throw BadBytes("an unknown kind of base");
    header.base = static_cast<JournalBase>(base);
    header.base_file.inode = body.get<std::uint64_t>();
    header.base_file.size = body.get<std::int64_t>();
    header.base_file.written = body.get<std::int64_t>();
    header.trials = body.get<std::int64_t>();
    if (header.trials < 0 || header.trials > most_trials) throw BadBytes("an impossible number of trials");
    header.shard = get_shard(body);
    header.study.root_seed = body.get<std::uint64_t>();
    for (std::uint64_t left = body.get_count(); left > 0; --left)
        header.study.scenarios.push_back(read_scenario_text(body.get_text(), path + ": scenario", "scenario"));
    return header;
}

}  // namespace credence
