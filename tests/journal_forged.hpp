#pragma once
// Forged journals with right checksums.

#include "report/watch/watch.hpp"

#include "journal_support.hpp"

#include <optional>

namespace credence::test {

/// A commit in its parts, each of which can be forged.
struct ForgedCommit {
    std::uint32_t scenario = 0;
    CommitStart start;
    std::string values, totals;
    std::optional<std::int64_t> payload;      ///< as its head says; none: as it is
    std::optional<std::uint32_t> blocks;      ///< as its start says
    Keep keep = Keep::trials;

    std::string bytes() const {
        ByteWriter begin, head;
        put_commit_start(begin, start, keep);
        if (blocks) begin.set(commit_start_size - sizeof *blocks, *blocks);
        const std::string all = begin.bytes() + values + totals;
        put_commit_head(head, {scenario, payload.value_or(static_cast<std::int64_t>(all.size()))});
        return sealed(head.bytes() + all);
    }
};

inline std::string totals_of(const ScenarioResults& results) {
    ByteWriter bytes;
    put_totals(bytes, results);
    return bytes.take();
}

/// A run of one scenario of 3 trials, and the commit in its journal.
struct Made {
    Asked asked;
    TemporaryFolder folder;
    std::string path = folder / "x.h5", header;
    Study study;
    ForgedCommit record;

    explicit Made(Keep keep = Keep::trials) : asked{3, 1, {}, {tiny("a")}, 1, keep}, study(undisturbed(asked)) {
        run_and_die(path, asked);
        const std::string bytes = bytes_of(path + ".journal");
        const std::vector<std::size_t> ends = commit_ends(bytes);
        header = bytes.substr(0, ends[0]);
        record.keep = keep;
        record.start = {3, 3, {{0, 3}}, {}, {{0, 0}}, unknown_release};
        const BlockLayout layout(study.scenarios.front());
        record.values =
            bytes.substr(ends[0] + commit_head_size + commit_start_size + block_list_size(record.start, keep),
                         static_cast<std::size_t>(layout.size({0, 3})));
        record.totals = totals_of(study.scenarios.front());
        REQUIRE(record.bytes() == bytes.substr(ends[0]));
    }
    /// Any byte of the totals that is changed under a right checksum is refused or harmless.
    void flip_totals() const {
        for (std::size_t at = 0; at < record.totals.size(); ++at) {
            ForgedCommit bad = record;
            bad.totals[at] = static_cast<char>(bad.totals[at] ^ 0x81);
            put_bytes(path + ".journal", header + bad.bytes());
            CAPTURE(at);
            REQUIRE_NOTHROW(refusal<InputError>([&] { opened(path, asked); }));
        }
    }
    /// The message with which a run refuses to continue a journal of these commits.
    std::string said(const std::vector<ForgedCommit>& records) const {
        std::string bytes = header;
        for (const ForgedCommit& one : records) bytes += one.bytes();
        put_bytes(path + ".journal", bytes);
        const std::string watched = refusal<InputError>([&] { RunWatch(path).snapshot(); }),
                          text = refused(path, asked);
        // A program that only reads it refuses it too, but for what is in the values, which it does not read.
        if (!text.empty() && !says(text, "unknown status")) CHECK(watched.starts_with(path + ".journal: is damaged: "));
        std::filesystem::remove(path);
        return text;
    }
};

}  // namespace credence::test
