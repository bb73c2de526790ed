/* At the n-th change that a program makes to files, the program dies or the system refuses.

   CRASH_AT=n           the change at which something happens, counted from 1 (0 or not set: nothing happens)
   CRASH_HALF=1         half of it first: half of a write's bytes, the whole of any other change
   CRASH_ERROR=ENOSPC   not a kill: this change fails, and every later one
   CRASH_ONCE=1         only this one fails
   CRASH_SIGNAL_AT=n    SIGTERM is raised just before the n-th change, which then goes on
   CRASH_LOG=file       a line `change path size` for every change that succeeded, the size after it, and one that
                        begins with `refused` for every other

   Changes are those to descriptors above 2, and renaming and removing. A full disk does not keep a file from being
   removed or cut, so neither fails with ENOSPC, EDQUOT or EFBIG. */
#include "shim.h"

static long at, signal_at;
static int half, once, failure;
static const char *log_path;
static atomic_long count;

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
        if (strcmp(name, errors[i].name) == 0) failure = errors[i].value;
    if (name && failure == 0) { fprintf(stderr, "crash.c: no error %s\n", name); _exit(99); }
}

enum fate crash_fate(const struct call *call, int *error) {
    if (!changes_files(call)) return goes_on;
    const int frees = call->kind == REMOVING || call->kind == CUTTING;
    const long now = atomic_fetch_add(&count, 1) + 1;
    *error = failure;
    if (now == signal_at) kill(getpid(), SIGTERM);
    if (at == 0 || now < at || (now > at && (failure == 0 || once))) return goes_on;
    if (failure == 0) return half ? half_then_dies : dies;
    if (frees && (failure == ENOSPC || failure == EDQUOT || failure == EFBIG)) return goes_on;
    return half && now == at ? half_then_fails : fails;
}

static const char *path_of(const struct call *call, char *path, size_t room) {
    char own[64];
    if (call->fd < 0) return call->to ? call->to : call->path;
    snprintf(own, sizeof own, "/proc/self/fd/%d", call->fd);
    const ssize_t length = readlink(own, path, room - 1);
    path[length > 0 ? length : 0] = '\0';
    return path;
}

void crash_log(const struct call *call, long result) {
    if (!log_path || !changes_files(call)) return;
    struct stat status; /* asked of the system itself, as all here: these are no calls of the program */
    char room[4096], line[5000];
    const char *path = path_of(call, room, sizeof room);
    const long size = syscall(SYS_newfstatat, AT_FDCWD, path, &status, 0) == 0 ? (long)status.st_size : -1;
    const int length = result >= 0 ? snprintf(line, sizeof line, "%s %s %ld\n", call->name, path, size)
                                   : snprintf(line, sizeof line, "refused - -1\n");
    const long log = syscall(SYS_openat, AT_FDCWD, log_path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (log < 0 || syscall(SYS_write, log, line, (size_t)length) != length) die();
    syscall(SYS_close, log);
}
