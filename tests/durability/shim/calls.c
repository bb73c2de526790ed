/* The calls that are looked at, each as the C library declares it. Those that stdio makes inside the C library pass
   unseen; power_loss.py compares what it replays with what is there. */
#include "shim.h"

static atomic_int started;
static int crashing, failing, recording, meeting;

long number(const char *name) {
    const char *text = getenv(name);
    return text ? atol(text) : 0;
}

int is_on(const char *mode) { return getenv(mode) != NULL; }

__attribute__((constructor)) static void read_environment(void) {
    crashing = is_on("CRASH_AT") || is_on("CRASH_LOG") || is_on("CRASH_SIGNAL_AT");
    failing = is_on("FAIL");
    recording = is_on("RECORD");
    meeting = is_on("MEET");
    started = 1;
}

void die(void) {
    kill(getpid(), SIGKILL);
    for (;;) pause();
}

int changes_files(const struct call *call) { return call->kind <= REMOVING && (call->fd < 0 || call->fd > 2); }

enum fate before(const struct call *call) {
    int error = 0;
    enum fate fate = goes_on;
    if (!started) return goes_on;
    if (meeting) meet(call);
    if (crashing) fate = crash_fate(call, &error);
    if (failing && fate == goes_on) fate = fail_fate(call, &error);
    if (recording && fate == goes_on) fate = sync_left_out(call);
    if (fate == dies) die();
    if (fate == fails || fate == half_then_fails) errno = error;
    return fate;
}

void after(const struct call *call, long result) {
    const int error = errno;
    if (started && call->kind == OPENING) note_name((int)result, call->path);
    if (started && crashing) crash_log(call, result);
    if (started && recording && result >= 0) record(call, result);
    errno = error;
}

ssize_t write(int fd, const void *bytes, size_t size) {
    REAL(write, "write");
    CALL(ssize_t, size > 1, real(fd, bytes, size / 2), real(fd, bytes, size), WRITING, "write", fd, .bytes = bytes,
         .size = size, .at = -1);
}
ssize_t pwrite(int fd, const void *bytes, size_t size, off_t at) {
    REAL(pwrite, "pwrite");
    CALL(ssize_t, size > 1, real(fd, bytes, size / 2, at), real(fd, bytes, size, at), WRITING, "pwrite", fd,
         .bytes = bytes, .size = size, .at = at);
}
ssize_t pwrite64(int fd, const void *bytes, size_t size, off64_t at) { return pwrite(fd, bytes, size, at); }
/* What is written so is not recorded: `bytes` is missing, and power_loss.py fails where it meets such a call. */
ssize_t writev(int fd, const struct iovec *parts, int n) {
    REAL(writev, "writev");
    CALL(ssize_t, n > 1, real(fd, parts, n / 2), real(fd, parts, n), WRITING, "writev", fd);
}
ssize_t pwritev(int fd, const struct iovec *parts, int n, off_t at) {
    REAL(pwritev, "pwritev");
    CALL(ssize_t, n > 1, real(fd, parts, n / 2, at), real(fd, parts, n, at), WRITING, "pwritev", fd);
}
int ftruncate(int fd, off_t size) {
    REAL(ftruncate, "ftruncate");
    WHOLE(int, real(fd, size), CUTTING, "ftruncate", fd, .at = size);
}
int ftruncate64(int fd, off64_t size) { return ftruncate(fd, size); }
int fsync(int fd) {
    REAL(fsync, "fsync");
    WHOLE(int, real(fd), SYNCING, "fsync", fd);
}
int fdatasync(int fd) {
    REAL(fdatasync, "fdatasync");
    WHOLE(int, real(fd), SYNCING, "fdatasync", fd);
}
int rename(const char *from, const char *to) {
    REAL(rename, "rename");
    WHOLE(int, real(from, to), RENAMING, "rename", -1, from, to);
}
int renameat(int from_folder, const char *from, int to_folder, const char *to) {
    REAL(renameat, "renameat");
    WHOLE(int, real(from_folder, from, to_folder, to), RENAMING, "renameat", -1, from, to);
}
int renameat2(int from_folder, const char *from, int to_folder, const char *to, unsigned flags) {
    REAL(renameat2, "renameat2");
    WHOLE(int, real(from_folder, from, to_folder, to, flags), RENAMING, "renameat2", -1, from, to);
}
int unlink(const char *path) {
    REAL(unlink, "unlink");
    WHOLE(int, real(path), REMOVING, "unlink", -1, path);
}
int link(const char *from, const char *to) {
    REAL(link, "link");
    WHOLE(int, real(from, to), LINKING, "link", -1, from, to);
}
int open(const char *path, int flags, ...) {
    REAL(open, "open");
    va_list more;
    va_start(more, flags);
    const mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(more, mode_t) : 0;
    va_end(more);
    WHOLE(int, real(path, flags, mode), OPENING, "open", -1, path, .flags = flags);
}
int open64(const char *path, int flags, ...) {
    va_list more;
    va_start(more, flags);
    const mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(more, mode_t) : 0;
    va_end(more);
    return open(path, flags, mode);
}
int openat(int folder, const char *path, int flags, ...) {
    REAL(openat, "openat");
    va_list more;
    va_start(more, flags);
    const mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(more, mode_t) : 0;
    va_end(more);
    WHOLE(int, real(folder, path, flags, mode), OPENING, "openat", -1, path, .flags = flags);
}
int openat64(int folder, const char *path, int flags, ...) {
    va_list more;
    va_start(more, flags);
    const mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(more, mode_t) : 0;
    va_end(more);
    return openat(folder, path, flags, mode);
}
/* A descriptor is closed even where the system reports an error. */
int close(int fd) {
    REAL(close, "close");
    const struct call call = {CLOSING, "close", fd};
    const enum fate fate = before(&call);
    const int error = errno;
    if (fate == is_left_out) return 0;
    forget_name(fd);
    const int result = real(fd);
    if (fate == fails) errno = error;
    return fate == fails ? -1 : result;
}
/* -1 stands for NULL in the fates. */
static FILE *open_stream(const char *path, const char *mode) {
    REAL(fopen, "fopen");
    const struct call call = {OPENING, "fopen", -1, path};
    if (mode[0] == 'r' && before(&call) == fails) return NULL;
    return real(path, mode);
}
FILE *fopen(const char *path, const char *mode) { return open_stream(path, mode); }
FILE *fopen64(const char *path, const char *mode) { return open_stream(path, mode); }
ssize_t read(int fd, void *bytes, size_t size) {
    REAL(read, "read");
    CALL(ssize_t, size > 1, real(fd, bytes, size / 2), real(fd, bytes, size), READING, "read", fd, .size = size);
}
ssize_t pread(int fd, void *bytes, size_t size, off_t at) {
    REAL(pread, "pread");
    CALL(ssize_t, size > 1, real(fd, bytes, size / 2, at), real(fd, bytes, size, at), READING, "pread", fd,
         .size = size, .at = at);
}
ssize_t pread64(int fd, void *bytes, size_t size, off64_t at) { return pread(fd, bytes, size, at); }
int flock(int fd, int operation) {
    REAL(flock, "flock");
    WHOLE(int, real(locked_instead_of(fd), operation), LOCKING, "flock", fd);
}
/* `argument` is a pointer or a number; both are passed on as they are. */
int fcntl(int fd, int command, ...) {
    REAL(fcntl, "fcntl");
    va_list more;
    va_start(more, command);
    void *argument = va_arg(more, void *);
    va_end(more);
    WHOLE(int, real(fd, command, argument), ASKING, "fcntl", fd, .flags = command);
}
int fcntl64(int fd, int command, ...) {
    va_list more;
    va_start(more, command);
    void *argument = va_arg(more, void *);
    va_end(more);
    return fcntl(fd, command, argument);
}
void *mmap(void *place, size_t size, int protection, int flags, int fd, off_t at) {
    const struct call call = {MAPPING, "mmap", fd, .size = size, .at = at,
                              .flags = (flags & MAP_SHARED) && (protection & PROT_WRITE)};
    if (before(&call) == fails) return MAP_FAILED;
    void *result = (void *)syscall(SYS_mmap, place, size, protection, flags, fd, at);
    after(&call, result == MAP_FAILED ? -1 : 0);
    return result;
}
void *mmap64(void *place, size_t size, int protection, int flags, int fd, off64_t at) {
    return mmap(place, size, protection, flags, fd, at);
}
int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*work)(void *), void *argument) {
    REAL(pthread_create, "pthread_create");
    const struct call call = {THREADING, "pthread_create", -1};
    return before(&call) == fails ? EAGAIN : real(thread, attributes, work, argument);
}

/* dlsym allocates, so the C library's own names are used. */
void *__libc_malloc(size_t);
void *__libc_calloc(size_t, size_t);
void *__libc_realloc(void *, size_t);
void *__libc_memalign(size_t, size_t);
static int refused(const char *name, size_t size) {
    const struct call call = {ALLOCATING, name, -1, .size = size};
    return failing && before(&call) == fails;
}
void *malloc(size_t size) { return refused("malloc", size) ? NULL : __libc_malloc(size); }
void *calloc(size_t n, size_t size) { return refused("calloc", n * size) ? NULL : __libc_calloc(n, size); }
void *realloc(void *old, size_t size) { return refused("realloc", size) ? NULL : __libc_realloc(old, size); }
void *aligned_alloc(size_t alignment, size_t size) {
    return refused("aligned_alloc", size) ? NULL : __libc_memalign(alignment, size);
}
void *memalign(size_t alignment, size_t size) {
    return refused("memalign", size) ? NULL : __libc_memalign(alignment, size);
}
int posix_memalign(void **place, size_t alignment, size_t size) {
    if (refused("posix_memalign", size)) return ENOMEM;
    *place = __libc_memalign(alignment, size);
    return *place == NULL ? ENOMEM : 0;
}
