#pragma once
// A run and its files: the results file FILE.h5 and, until that is written, FILE.h5.journal beside it.
// docs/durability.md describes their guarantees.

#include "study/releases.hpp"

#include <credence/detail/store.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace credence {

/// How to treat existing output.
enum class Start {
    fresh,      ///< refuse it
    resume,     ///< continue it
    overwrite,  ///< replace it
};

class Journal;
struct JournalHeader;

/// The journal of the results file `path`. It is beside the file that the name leads to, so that a symbolic link and
/// its target have the same journal.
std::string journal_path_of(const std::string& path);

/// The study that is stored under the name of a results file: that of the run whose journal is there, or the file's.
/// Throws InputError where neither can be read.
StudyDefinition stored_definition(const std::string& path);

/// Stores a run on the disk. Only one run at a time can write a file: the journal is locked.
class StoredRun {
public:
    /// Inspects the existing files, and reads them if the run continues; changes nothing but a journal's torn tail.
    /// `study` is the empty study that is asked for, `release` the release that will compute it. Throws InputError
    /// where the output cannot be used: it exists (fresh), holds another study, was computed by a release that may not
    /// be mixed with this one, is damaged, or another program writes it.
    StoredRun(const std::string& path, Study study, Start start, const std::string& release = unknown_release);
    StoredRun(StoredRun&&) noexcept;
    ~StoredRun();

    /// The part of the study that has been computed so far.
    Study& study() { return study_; }
    const Study& study() const { return study_; }

    /// Starts or continues the journal, which makes a commit every `commit_every` blocks (0: about every half second),
    /// and returns it. `shard` is recorded for `credence watch`. Throws InputError and Failure.
    BlockKeeper& begin(std::int64_t trials, std::int64_t commit_every = 0, const Shard& shard = {});

    /// Writes the results file, unless it already holds the whole study, and removes the journal. Returns whether it
    /// wrote. Throws Failure where the system refuses, another program changed the journal, or the name leads to
    /// another file than at the start; the journal is then kept.
    bool finish(const RunFacts& facts);

    /// After a failure: whether computed blocks are on the disk, so that a run can continue. A journal without a commit
    /// is removed.
    bool keeps_something();

private:
    /// The content of a results file, to decide whether it must be written.
    struct Contents {
        std::int64_t trials = 0;
        std::vector<BlockRanges> blocks;  ///< by scenario

        static Contents of(const Study& study);
        bool operator==(const Contents&) const = default;
    };

    void open_journal();
    void resume();
    void resume_journal(const JournalHeader& header, const StudyDefinition& asked);
    void choose(const StudyDefinition& asked);
    void read_file(const StudyDefinition& asked);
    Study stored(const StudyDefinition& asked) const;
    bool is_base_of(const JournalHeader& header) const;
    void check_releases() const;
    void check_unchanged() const;
    void write(const RunFacts& facts);

    Output output_;  ///< may replace the file that existed at the start
    std::string journal_path_;
    Start start_;
    std::string release_;
    std::optional<Contents> in_file_;   ///< of the results file that the run continues
    bool journal_is_over_ = false;      ///< the results file holds all of the journal, which is started over
    std::unique_ptr<Journal> journal_;  ///< must outlive the study, whose columns it may hold
    Study study_;
};

}  // namespace credence
