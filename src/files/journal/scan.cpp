#include "files/journal/scan.hpp"

#include <credence/error.hpp>

#include <algorithm>

namespace credence {

namespace {

constexpr auto head_size = static_cast<std::int64_t>(commit_head_size),
               tail_size = static_cast<std::int64_t>(commit_tail_size);

/// The checksum that follows these bytes of the file; nothing where it does not match them.
std::optional<std::uint32_t> right_checksum(const JournalBytes& file, std::int64_t begin, std::int64_t end) {
    constexpr std::int64_t at_once = std::int64_t{1} << 20;
    std::uint32_t crc = 0, stored = 0;
    for (std::int64_t at = begin; at < end; at += at_once) {
        const std::string some = file.read(at, std::min(at_once, end - at));
        crc = checksum(some.data(), some.size(), crc);
    }
    file.read(end, &stored, sizeof stored);
    return crc == stored ? std::optional(stored) : std::nullopt;
}

/// The head of the commit that begins at `position`; nothing where it is torn.
std::optional<CommitHead> find_head(const JournalBytes& file, std::int64_t position) {
    const std::int64_t left = file.size() - position - head_size - tail_size;
    if (left < static_cast<std::int64_t>(commit_start_size)) return std::nullopt;
    const std::string bytes = file.read(position, head_size);
    try {
        ByteReader from(bytes.data(), bytes.size());
        const CommitHead head = get_commit_head(from);
        return head.payload > left ? std::nullopt : std::optional(head);
    } catch (const BadBytes&) {
        return std::nullopt;
    }
}

/// The commit that begins at `position`; nothing where it is torn. Throws BadBytes for an invalid one.
std::optional<FoundCommit> find_record(const JournalBytes& file, std::int64_t position,
                                       const std::vector<BlockLayout>& layouts) {
    const std::optional<CommitHead> head = find_head(file, position);
    if (!head) return std::nullopt;
    const std::int64_t payload = position + head_size, end = payload + head->payload;
    const std::optional<std::uint32_t> crc = right_checksum(file, position, end);
    if (!crc) return std::nullopt;
    std::uint32_t count = 0;
    file.read(payload + static_cast<std::int64_t>(commit_start_size - sizeof count), &count, sizeof count);
    if (head->scenario >= layouts.size()) throw BadBytes("a record is of a scenario that the study does not have");
    const BlockLayout& layout = layouts[head->scenario];
    const std::size_t listed = layout.keep() == Keep::aggregates ? journal_range_size : journal_block_size;
    const auto start_size = static_cast<std::int64_t>(commit_start_size + count * listed);
    if (start_size > head->payload) throw BadBytes("a record has more blocks than bytes");
    const std::string start = file.read(payload, start_size);
    ByteReader from(start.data(), start.size());
    FoundCommit record{head->scenario, get_commit_start(from, layout), {}, payload + start_size, end, *crc};
    for (const JournalBlock& block : record.start.blocks) {
        const std::int64_t size = layout.size(block);
        if (size > end - record.totals) throw BadBytes("a record has fewer values than its blocks");
        record.places.push_back(record.totals);
        record.totals += size;
    }
    return record;
}

}  // namespace

void refuse_damaged(const std::string& path, const std::string& why) {
    throw InputError("is damaged: " + why, {}, "Remove it and run the study again, or give an undamaged copy").at(path);
}

std::optional<FoundHeader> find_header(const JournalBytes& file) {
    const auto start_of = [&](std::size_t size) {
        return file.read(0, std::min(static_cast<std::int64_t>(size), file.size()));
    };
    std::size_t size = header_prefix;
    try {
        size = header_size(start_of(header_prefix), file.path());
        FoundHeader found;
        found.header = read_header(start_of(size), file.path(), size);
        found.size = static_cast<std::int64_t>(size);
        return found;
    } catch (const BadBytes& bad) {
        // The header is on the disk before the first commit is written: a torn header has nothing after it.
        if (file.size() <= static_cast<std::int64_t>(size)) return std::nullopt;
        refuse_damaged(file.path(), std::string("its header ") + bad.what());
    }
}

std::int64_t scan_commits(const JournalBytes& file, std::int64_t position, const std::vector<BlockLayout>& layouts,
                          const std::function<void(const FoundCommit&)>& found) {
    while (const std::optional<FoundCommit> record = find_record(file, position, layouts)) {
        found(*record);
        position = record->end + tail_size;
    }
    return position;
}

}  // namespace credence
