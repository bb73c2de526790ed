// Files when the system refuses: existing files are unchanged, and no temporary ones are left.
// Kind: foreign files.

#include "files/system/durable_file.hpp"
#include "files/system/system_file.hpp"
#include "store_study.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>

namespace credence::test::durable_file_test {

namespace {

void write(const std::string& path, const std::string& bytes) { write_text_file(path, bytes); }

std::string failure(const std::string& path, const std::string& bytes) {
    return refusal<Failure>([&] { write(path, bytes); });
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

mode_t permissions_of_new_file() {
    const mode_t mask = umask(0);
    umask(mask);
    return 0666 & ~mask;
}

/// Lets no file of this process grow beyond `bytes`, as a full disk or a quota would.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes) {
        getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit limit{bytes, before_.rlim_max};
        setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() { setrlimit(RLIMIT_FSIZE, &before_); }

private:
    rlimit before_{};
};

}  // namespace

TEST_CASE("durable file: appears whole, replaces, and leaves nothing aside") {
    const TemporaryFolder folder;
    const std::string path = folder / "file";
    write(path, "first");
    CHECK(bytes_of(path) == "first");
    write(path, "");
    CHECK(bytes_of(path).empty());
    write(path, std::string(3 << 20, 'x'));
    CHECK(bytes_of(path).size() == 3 << 20);
    CHECK(folder.entries() == 1);
}

TEST_CASE("durable file: a crash's leftover is taken over") {
    const TemporaryFolder folder;
    put_bytes(folder / "file.credence-partial", std::string(1000, 'x'));
    write(folder / "file", "whole");
    CHECK(bytes_of(folder / "file") == "whole");
    CHECK(folder.entries() == 1);
}

TEST_CASE("durable file: what has a name like it beside it is left alone") {
    const TemporaryFolder folder;
    put_bytes(folder / "file.partial", "mine");
    write(folder / "file", "whole");
    CHECK(bytes_of(folder / "file.partial") == "mine");
    CHECK(folder.entries() == 2);
}

TEST_CASE("durable file: permissions of what it replaces stay") {
    const TemporaryFolder folder;
    const std::string path = folder / "file";
    write(path, "first");
    CHECK(permissions_of(path) == permissions_of_new_file());
    for (const mode_t mode : {mode_t{0600}, mode_t{0664}, mode_t{0400}}) {
        REQUIRE(chmod(path.c_str(), mode) == 0);
        write(path, "next");
        CHECK(permissions_of(path) == mode);
    }
    // Those of what a crash left are another writing's.
    put_bytes(folder / "new.credence-partial", "left");
    REQUIRE(chmod((folder / "new.credence-partial").c_str(), 0600) == 0);
    write(folder / "new", "whole");
    CHECK(permissions_of(folder / "new") == permissions_of_new_file());
}

TEST_CASE("durable file: the owner of what it replaces stays") {
    if (geteuid() != 0) return;  // only root may give a file to another user
    const TemporaryFolder folder;
    const std::string path = folder / "file";
    write(path, "first");
    REQUIRE(chown(path.c_str(), 65534, 65533) == 0);
    write(path, "next");
    struct stat status {};
    REQUIRE(stat(path.c_str(), &status) == 0);
    CHECK(status.st_uid == 65534);
    CHECK(status.st_gid == 65533);
}

TEST_CASE("durable file: what appears or changes under the name in the meantime is not replaced") {
    const TemporaryFolder folder;
    const std::string path = folder / "file";
    const auto said = [](const Output& output) {
        return refusal<Failure>([&] { write_text_file(output, "new"); });
    };
    const Output fresh = check_output(path, false);
    put_bytes(path, "mine");
    CHECK(contains(said(fresh),
                   "cannot write " + path + " (a file of that name appeared in the meantime). Move that away"));
    CHECK(bytes_of(path) == "mine");
    Output seen = check_output(path, true);
    put_bytes(folder / "other", "mine");
    std::filesystem::rename(folder / "other", path);  // as long, but another file
    CHECK(contains(said(seen), "another program changed or replaced it in the meantime"));
    seen = check_output(path, true);
    put_bytes(path, "longer than it was");
    CHECK(contains(said(seen), "another program changed or replaced it in the meantime"));
    CHECK(bytes_of(path) == "longer than it was");
    seen = check_output(path, true);
    std::filesystem::remove(path);
    CHECK(said(seen).empty());
    CHECK(bytes_of(path) == "new");
    CHECK(folder.entries() == 1);
}

TEST_CASE("durable file: no space is a clean failure that keeps what was there") {
    const TemporaryFolder folder;
    const std::string path = folder / "file";
    write(path, "what was there");
    std::string said;
    {
        const FileSizeLimit limit(1 << 16);
        said = failure(path, std::string(1 << 20, 'x'));  // without care the signal SIGXFSZ would end the tests here
    }
    CHECK(said == "cannot write " + path + " (file too large). Raise the limit on the size of files (ulimit -f), or " +
                      "write to another place.");
    CHECK(bytes_of(path) == "what was there");
    CHECK(folder.entries() == 1);
    struct sigaction after {};
    sigaction(SIGXFSZ, nullptr, &after);
    CHECK(after.sa_handler == SIG_DFL);
}

TEST_CASE("durable file: a missing folder, a folder in its place and devices are refused") {
    const TemporaryFolder folder;
    CHECK(contains(failure(folder / "missing/file", "x"), "no such file or directory"));
    std::filesystem::create_directory(folder / "taken");
    CHECK(contains(failure(folder / "taken", "x"), "something that is not a file"));
    // A pipe represents every device: a test that runs as root must not write to a real one.
    REQUIRE(mkfifo((folder / "pipe").c_str(), 0600) == 0);
    CHECK(contains(failure(folder / "pipe", "x"), "something that is not a file"));
    CHECK(std::filesystem::is_fifo(folder / "pipe"));
    std::filesystem::create_directory(folder / "file.credence-partial");
    CHECK(contains(failure(folder / "file", "x"), "is a directory"));
    CHECK(folder.entries() == 3);
    CHECK(contains(failure(folder / std::string(300, 'x'), "x"), "name too long"));
}

TEST_CASE("durable file: a second writer is turned away") {
    const TemporaryFolder folder;
    const std::string aside = folder / "file.credence-partial";
    const int other = ::open(aside.c_str(), O_WRONLY | O_CREAT, 0666);
    REQUIRE(flock(other, LOCK_EX | LOCK_NB) == 0);
    CHECK(contains(refusal<InputError>([&] { write(folder / "file", "x"); }), "another program is writing it"));
    CHECK(std::filesystem::exists(aside));  // it is the other's
    close(other);
    write(folder / "file", "x");
    CHECK(folder.entries() == 1);
}

TEST_CASE("durable file: a link is followed, not replaced; one aside is not") {
    const TemporaryFolder folder;
    put_bytes(folder / "real", "old");
    put_bytes(folder / "precious", "mine");
    std::filesystem::create_symlink("real", folder / "link");
    write(folder / "link", "new");
    CHECK(std::filesystem::is_symlink(folder / "link"));
    CHECK(bytes_of(folder / "real") == "new");
    // One that leads to no file yet makes it, through another one and into another folder.
    std::filesystem::create_directory(folder / "disk");
    std::filesystem::create_symlink("disk/file", folder / "next");
    std::filesystem::create_symlink(folder / "next", folder / "first");
    write_text_file(check_output(folder / "first", false), "through");
    CHECK(bytes_of(folder / "disk/file") == "through");
    CHECK(std::filesystem::is_symlink(folder / "first"));
    std::filesystem::create_symlink("circle", folder / "circle");
    CHECK(contains(refusal<InputError>([&] { check_output(folder / "circle", true); }), "its links lead in a circle"));
    std::filesystem::create_symlink("precious", folder / "file.credence-partial");
    CHECK(!failure(folder / "file", "x").empty());
    CHECK(bytes_of(folder / "precious") == "mine");
}

TEST_CASE("store: results that cannot be written leave what was there") {
    const TemporaryFolder folder;
    const std::string path = folder / "study.h5";
    put_bytes(path, "what was there");
    std::string said;
    {
        const FileSizeLimit limit(1 << 16);
        said = refusal<Failure>([&] { write_results(path, made_up_study(), run_facts); });
    }
    CHECK(contains(said, "file too large"));
    CHECK(bytes_of(path) == "what was there");
    CHECK(folder.entries() == 1);
    said = refusal<Failure>([&] { write_results(folder / "none/x.h5", made_up_study(), {}); });
    CHECK(contains(said, "Make its folder first"));
}

TEST_CASE("store: an output that could not be written is refused before anything runs") {
    const TemporaryFolder folder;
    const auto said = [](const std::string& path, bool overwrite) {
        return refusal<InputError>([&] { check_output(path, overwrite); });
    };
    CHECK(said(folder / "new.h5", false).empty());
    CHECK(said("new-file-in-this-folder.h5", false).empty());
    put_bytes(folder / "old.h5", "x");
    CHECK(said(folder / "old.h5", true).empty());
    CHECK(contains(said(folder / "old.h5", false), "it is there already"));
    CHECK(contains(said(folder / "none/x.h5", false), "there is no folder " + (folder / "none")));
    CHECK(contains(said(folder / "old.h5/x.h5", false), "is not a folder"));
    CHECK(contains(said(folder / "", true), "it names no file"));
    CHECK(contains(said("", true), "it names no file"));
    std::filesystem::create_directory(folder / "folder.h5");
    CHECK(contains(said(folder / "folder.h5", true), "something that is not a file"));
    REQUIRE(mkfifo((folder / "pipe").c_str(), 0600) == 0);
    CHECK(contains(said(folder / "pipe", true), "something that is not a file"));
    CHECK(contains(said(folder / std::string(250, 'x'), true), "name is too long"));
    CHECK(folder.entries() == 3);
    CHECK(bytes_of(folder / "old.h5") == "x");
}

}  // namespace credence::test::durable_file_test
