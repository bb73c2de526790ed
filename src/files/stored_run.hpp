#pragma once
// A run and what it keeps on the disk: the results file FILE.h5 and, until that is written, FILE.h5.journal
// beside it. docs/durability.md says what is promised.

#include <credence/store.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace credence {

/// What to do with what is there already.
enum class Start {
    fresh,      ///< refuse it
    resume,     ///< go on with it
    overwrite,  ///< replace it
};

class Journal;
struct JournalHeader;

/// The journal of the results file `path`: beside the file that the name leads to, so that a symbolic link and that file
/// have one journal.
std::string journal_path_of(const std::string& path);

/// Keeps a run on the disk. One at a time for a file: the journal is locked.
class StoredRun {
public:
    /// Looks at what is there, and reads it where the run is to go on; changes nothing but a journal's torn tail.
    /// `study` is what is asked for, empty, and `release` what will compute it. Throws InputError where the output cannot
    /// be used: it is there (fresh), holds another study, was computed by a release that this one may not be mixed with,
    /// is damaged, or another program writes it.
    StoredRun(const std::string& path, Study study, Start start, const std::string& release = unknown_release);
    StoredRun(StoredRun&&) noexcept;
    ~StoredRun();

    /// What has been computed so far.
    Study& study() { return study_; }
    const Study& study() const { return study_; }

    /// Begins or goes on with the journal, in which `commit_every` blocks make a commit (0: about half a second), and
    /// returns it. What the run works on, a shard or all, is for whoever follows it. Throws InputError and Failure.
    BlockKeeper& begin(std::int64_t trials, std::int64_t commit_every = 0, const Shard& shard = {});

    /// Writes the results file, unless it has all that the study has, and removes the journal. Returns whether it wrote.
    /// Throws Failure where the system refuses, another program changed the journal, or the name leads to another file than
    /// at the start; then the journal is there still.
    bool finish(const RunFacts& facts);

    /// After a failure: whether something that was computed is on the disk, for a run to go on with. A journal without a
    /// commit is removed.
    bool keeps_something();

private:
    /// What a results file has, to tell whether it has to be written.
    struct Contents {
        std::int64_t trials = 0;
        std::vector<BlockRanges> blocks;  ///< by scenario

        static Contents of(const Study& study);
        bool operator==(const Contents&) const = default;
    };

    void open_journal();
    void go_on();
    void go_on_with(const JournalHeader& header, const StudyDefinition& asked);
    void choose(const StudyDefinition& asked);
    void read_file(const StudyDefinition& asked);
    Study stored(const StudyDefinition& asked) const;
    bool is_base_of(const JournalHeader& header) const;
    void check_releases() const;
    void check_unchanged() const;
    void write(const RunFacts& facts);

    Output output_;  ///< may replace the file that was there at the start
    std::string journal_path_;
    Start start_;
    std::string release_;
    std::optional<Contents> in_file_;   ///< of the results file that the study goes on with
    bool journal_is_over_ = false;      ///< the results file has all that it has: it is begun anew
    std::unique_ptr<Journal> journal_;  ///< outlives the study, whose columns it may hold
    Study study_;
};

}  // namespace credence
