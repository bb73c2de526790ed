// Bytes of small results files are flipped one by one: the file then reads the same, or is refused by its name. Usually
// every 101st byte is flipped; CREDENCE_FLIP_EVERY=1 in the environment takes each, for some ten minutes.

#include "journal_support.hpp"

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

namespace credence::test::every_byte_long_test {

namespace {

enum Outcome : char { untried, same, refused_by_name, refused_without_name, other_numbers, other_error, process_ended };

std::size_t distance_of_bytes() {
    const char* given = std::getenv("CREDENCE_FLIP_EVERY");
    return given == nullptr ? 101 : static_cast<std::size_t>(std::max(1, std::atoi(given)));
}

/// The outcome for each byte that is flipped of a file. Processes that are forked share it.
class Outcomes {
public:
    explicit Outcomes(std::size_t size)
        : size_(size), outcome_(static_cast<char*>(mmap(nullptr, size, PROT_READ | PROT_WRITE,
                                                        MAP_SHARED | MAP_ANONYMOUS, -1, 0))) {
        REQUIRE(outcome_ != MAP_FAILED);
    }
    ~Outcomes() { munmap(outcome_, size_); }
    Outcomes(const Outcomes&) = delete;
    Outcomes& operator=(const Outcomes&) = delete;

    std::size_t size() const { return size_; }
    void set(std::size_t i, Outcome outcome) { outcome_[i] = outcome; }
    std::size_t first_untried() const {
        return static_cast<std::size_t>(std::find(outcome_, outcome_ + size_, char{untried}) - outcome_);
    }
    /// The numbers of the flips that came to this.
    std::vector<std::size_t> with(Outcome outcome) const {
        std::vector<std::size_t> found;
        for (std::size_t i = 0; i < size_; ++i)
            if (outcome_[i] == outcome) found.push_back(i);
        return found;
    }

private:
    std::size_t size_;
    char* outcome_;
};

/// What reading the file at `path` comes to, of which `expected` was written.
Outcome outcome_of(const std::string& path, const StoredStudy& expected) {
    try {
        const StoredStudy read = read_results(path);
        const bool as_before = study_hash(read.study) == study_hash(expected.study) &&
                               read.study.trials == expected.study.trials &&
                               read.study.complete == expected.study.complete &&
                               same_results(read.study, expected.study) && read.run == expected.run;
        return as_before ? same : other_numbers;
    } catch (const InputError& error) {
        return says(error.what(), path) ? refused_by_name : refused_without_name;
    } catch (...) {
        return other_error;
    }
}

bool put_byte(const std::string& path, std::size_t at, char byte) {
    const int file = ::open(path.c_str(), O_WRONLY);
    const bool done = pwrite(file, &byte, 1, static_cast<off_t>(at)) == 1;
    close(file);
    return done;
}

/// A small file, and which of its bytes are flipped.
struct Flipped {
    std::string path, good;
    StoredStudy expected;
    std::size_t every;

    /// Flips a bit of each of some bytes from the i-th on, or all its bits. Reading must end within a minute.
    [[noreturn]] void some(std::size_t i, Outcomes& outcomes) const noexcept {
        for (const std::size_t end = std::min(i + 2000, outcomes.size()); i < end; ++i) {
            const std::size_t at = i * every;
            const int flip = i % 3 == 0 ? 0xff : 1 << i % 8;
            alarm(60);
            if (!put_byte(path, at, static_cast<char>(good[at] ^ flip))) _exit(1);
            outcomes.set(i, outcome_of(path, expected));
            if (!put_byte(path, at, good[at])) _exit(1);
        }
        _exit(0);
    }
};

/// Flips some bytes from the first untried one on in a process of its own: HDF5 1.10 may end it, and does not free what
/// it could not read.
void flip_some(const Flipped& file, Outcomes& outcomes) {
    const pid_t child = fork();
    REQUIRE(child != -1);
    if (child == 0) file.some(outcomes.first_untried(), outcomes);
    int status = -1;
    REQUIRE(waitpid(child, &status, 0) == child);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
    const std::size_t i = outcomes.first_untried();
    REQUIRE(i < outcomes.size());
    outcomes.set(i, process_ended);
    REQUIRE(put_byte(file.path, i * file.every, file.good[i * file.every]));
}

}  // namespace

TEST_CASE("store: a results file of which any byte is flipped reads the same, or is refused by name") {
    const TemporaryFolder folder;
    const std::string path = folder / "flipped.h5", whole = folder / "whole.h5";
    const std::size_t every = distance_of_bytes();
    for (const Keep keep : {Keep::trials, Keep::aggregates}) {
        CAPTURE(keep_name(keep));
        Study study = new_study({tiny("a")}, 1, keep);
        run_study(study, {3, 1, {}});
        write_results(whole, study, run_facts);
        // What is read keeps columns in its file, which therefore is another one.
        const Flipped file{path, bytes_of(whole), read_results(whole), every};
        put_bytes(path, file.good);
        Outcomes outcomes((file.good.size() + every - 1) / every);
        while (outcomes.first_untried() < outcomes.size()) flip_some(file, outcomes);
        for (const Outcome wrong : {other_numbers, refused_without_name, other_error, process_ended})
            CHECK(outcomes.with(wrong) == std::vector<std::size_t>{});
        CHECK(outcomes.with(refused_by_name).size() > outcomes.size() / 2);
        if (every == 1)
            std::cout << "each byte of results of " << keep_name(keep) << ": " << file.good.size() << " bytes, "
                      << outcomes.with(same).size() << " harmless, " << outcomes.with(refused_by_name).size()
                      << " refused by name\n";
    }
}

}  // namespace credence::test::every_byte_long_test
