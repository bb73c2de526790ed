/* A library to preload: at the n-th change that a program makes to files, the program dies or the system refuses.

   CRASH_AT=n           the change at which something happens, counted from 1 (0 or not set: nothing happens)
   CRASH_HALF=1         half of it first: half of a write's bytes, the whole of any other change
   CRASH_ERROR=ENOSPC   not a kill: this change fails, and every later one
   CRASH_ONCE=1         only this one fails
   CRASH_SIGNAL_AT=n    SIGTERM is raised just before the n-th change, which then goes on
   CRASH_LOG=file       a line `change path size` for every change that succeeded, the size after it, and one that
                        begins with `refused` for every other

   Changes are those to descriptors above 2, and renaming and removing. A full disk does not keep a file from being
   removed or cut, so neither fails with ENOSPC, EDQUOT or EFBIG. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

#define REAL(function, name) __typeof__(&function) real = (__typeof__(&function))dlsym(RTLD_NEXT, name)

enum fate { goes_on, half_then_fails, fails, half_then_dies, dies };

static long at, signal_at;
static int half, once, error;
static const char *log_path;
static atomic_long count;

static long number(const char *name) {
    const char *text = getenv(name);
    return text ? atol(text) : 0;
}

__attribute__((constructor)) static void read_environment(void) {
    static const struct { const char *name; int value; } errors[] = {
        {"ENOSPC", ENOSPC}, {"EDQUOT", EDQUOT}, {"EFBIG", EFBIG}, {"EIO", EIO}, {"EROFS", EROFS}};
    const char *name = getenv("CRASH_ERROR");
    at = number("CRASH_AT");
    signal_at = number("CRASH_SIGNAL_AT");
    half = number("CRASH_HALF") != 0;
    once = number("CRASH_ONCE") != 0;
    log_path = getenv("CRASH_LOG");
    for (size_t i = 0; name && i < sizeof errors / sizeof *errors; ++i)
        if (strcmp(name, errors[i].name) == 0) error = errors[i].value;
    if (name && error == 0) { fprintf(stderr, "crash_at_write: no error %s\n", name); _exit(99); }
}

static void die(void) {
    kill(getpid(), SIGKILL);
    for (;;) pause();
}

/* What becomes of the next change; `frees` says that it needs no space. */
static enum fate next_fate(int counted, int frees) {
    if (!counted) return goes_on;
    const long now = atomic_fetch_add(&count, 1) + 1;
    if (now == signal_at) kill(getpid(), SIGTERM);
    if (at == 0 || now < at || (now > at && (error == 0 || once))) return goes_on;
    if (error == 0) return half ? half_then_dies : dies;
    if (frees && (error == ENOSPC || error == EDQUOT || error == EFBIG)) return goes_on;
    return half && now == at ? half_then_fails : fails;
}

static void note(const char *change, const char *path) {
    if (!log_path) return;
    REAL(write, "write");
    struct stat status;
    char line[5000];
    const long size = stat(path, &status) == 0 ? (long)status.st_size : -1;
    const int length = snprintf(line, sizeof line, "%s %s %ld\n", change, path, size);
    const int log = open(log_path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (log < 0 || real(log, line, (size_t)length) != length) die();
    close(log);
}

static void note_descriptor(const char *change, int fd) {
    if (!log_path || fd <= 2) return;
    char own[64], path[4096];
    snprintf(own, sizeof own, "/proc/self/fd/%d", fd);
    const ssize_t length = readlink(own, path, sizeof path - 1);
    path[length > 0 ? length : 0] = '\0';
    note(change, path);
}

static int refuse(void) {
    note("refused", "-");
    errno = error;
    return -1;
}

/* A call whose first `part` makes half of it (a statement for the whole otherwise), as its fate says. */
#define CHANGE(type, change, fd, frees, has_half, part, whole)          \
    do {                                                                \
        const enum fate fate = next_fate((fd) > 2, frees);              \
        if (fate == dies) die();                                        \
        if (fate == fails || (fate == half_then_fails && !(has_half)))  \
            return refuse();                                            \
        if (fate == half_then_dies) { (void)!(part); die(); }           \
        const type result = fate == half_then_fails ? (part) : (whole); \
        const int before = errno;                                       \
        if (result >= 0) note_descriptor(change, fd);                   \
        errno = before;                                                 \
        return result;                                                  \
    } while (0)

ssize_t write(int fd, const void *bytes, size_t size) {
    REAL(write, "write");
    CHANGE(ssize_t, "write", fd, 0, size > 1, real(fd, bytes, size / 2), real(fd, bytes, size));
}
ssize_t pwrite(int fd, const void *bytes, size_t size, off_t offset) {
    REAL(pwrite, "pwrite");
    CHANGE(ssize_t, "pwrite", fd, 0, size > 1, real(fd, bytes, size / 2, offset), real(fd, bytes, size, offset));
}
ssize_t pwrite64(int fd, const void *bytes, size_t size, off64_t offset) {
    REAL(pwrite64, "pwrite64");
    CHANGE(ssize_t, "pwrite64", fd, 0, size > 1, real(fd, bytes, size / 2, offset), real(fd, bytes, size, offset));
}
ssize_t writev(int fd, const struct iovec *parts, int n) {
    REAL(writev, "writev");
    CHANGE(ssize_t, "writev", fd, 0, n > 1, real(fd, parts, n / 2), real(fd, parts, n));
}
ssize_t pwritev(int fd, const struct iovec *parts, int n, off_t offset) {
    REAL(pwritev, "pwritev");
    CHANGE(ssize_t, "pwritev", fd, 0, n > 1, real(fd, parts, n / 2, offset), real(fd, parts, n, offset));
}
int ftruncate(int fd, off_t size) {
    REAL(ftruncate, "ftruncate");
    CHANGE(int, "ftruncate", fd, 1, 0, real(fd, size), real(fd, size));
}
int ftruncate64(int fd, off64_t size) {
    REAL(ftruncate64, "ftruncate64");
    CHANGE(int, "ftruncate64", fd, 1, 0, real(fd, size), real(fd, size));
}
int fsync(int fd) {
    REAL(fsync, "fsync");
    CHANGE(int, "fsync", fd, 0, 0, real(fd), real(fd));
}
int fdatasync(int fd) {
    REAL(fdatasync, "fdatasync");
    CHANGE(int, "fdatasync", fd, 0, 0, real(fd), real(fd));
}

/* The same for a change to a path, which has no half. */
#define CHANGE_PATH(change, path, frees, whole)          \
    do {                                                 \
        const enum fate fate = next_fate(1, frees);      \
        if (fate == dies) die();                         \
        if (fate == fails || fate == half_then_fails)    \
            return refuse();                             \
        const int result = (whole);                      \
        if (fate == half_then_dies) die();               \
        const int before = errno;                        \
        if (result == 0) note(change, path);             \
        errno = before;                                  \
        return result;                                   \
    } while (0)

int rename(const char *from, const char *to) {
    REAL(rename, "rename");
    CHANGE_PATH("rename", to, 0, real(from, to));
}
int renameat(int from_folder, const char *from, int to_folder, const char *to) {
    REAL(renameat, "renameat");
    CHANGE_PATH("renameat", to, 0, real(from_folder, from, to_folder, to));
}
int renameat2(int from_folder, const char *from, int to_folder, const char *to, unsigned flags) {
    REAL(renameat2, "renameat2");
    CHANGE_PATH("renameat2", to, 0, real(from_folder, from, to_folder, to, flags));
}
int unlink(const char *path) {
    REAL(unlink, "unlink");
    CHANGE_PATH("unlink", path, 1, real(path));
}
