/* Everything that a program changes, for power_loss.py to replay.

   RECORD=file          for each change a line `name inode at size path to`, separated by tabs, and the bytes of a write
   RECORD_LEFT_OUT=n    the n-th sync, counted from 1, neither happens nor is recorded: a planted bug */
#include "shim.h"

static long left_out;
static atomic_long syncs;
static int trace = -1;

__attribute__((constructor)) static void read_environment(void) {
    const char *path = getenv("RECORD");
    left_out = number("RECORD_LEFT_OUT");
    if (!path) return;
    const long opened = syscall(SYS_openat, AT_FDCWD, path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    trace = fcntl((int)opened, F_DUPFD_CLOEXEC, 300);
    syscall(SYS_close, opened);
    if (trace < 0) die();
}

enum fate sync_left_out(const struct call *call) {
    return call->kind == SYNCING && atomic_fetch_add(&syncs, 1) + 1 == left_out ? is_left_out : goes_on;
}

static void put(const void *bytes, size_t size) {
    if (syscall(SYS_write, trace, bytes, size) != (long)size) die();
}

void record(const struct call *call, long result) {
    static pthread_mutex_t one = PTHREAD_MUTEX_INITIALIZER;
    const int changes_names = call->kind == OPENING && (call->flags & (O_CREAT | O_TRUNC));
    const int changes_mapped = call->kind == MAPPING && call->fd > 2 && call->flags;
    if (!changes_files(call) && call->kind != LINKING && !changes_names && !changes_mapped) return;
    if (call->kind == SYNCING && left_out && atomic_load(&syncs) == left_out) return;
    const int fd = call->kind == OPENING ? (int)result : call->fd;
    struct stat status = {0};
    if (fd >= 0 && syscall(SYS_newfstatat, fd, "", &status, AT_EMPTY_PATH) != 0) die();
    const size_t written = call->kind == WRITING ? (size_t)result : 0;
    char line[9000];
    const int length = snprintf(line, sizeof line, "%s\t%lu\t%ld\t%zu\t%s\t%s\n", call->name,
                                (unsigned long)status.st_ino, (long)call->at, written, call->path ? call->path : "",
                                call->to ? call->to : "");
    pthread_mutex_lock(&one);
    put(line, (size_t)length);
    if (written > 0 && call->bytes) put(call->bytes, written);
    pthread_mutex_unlock(&one);
}
