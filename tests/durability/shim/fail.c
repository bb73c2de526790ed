/* A resource fails once.

   FAIL=kind        malloc, open, read, mmap, thread, sync, rename, remove, lock, write, cut (ftruncate), stat (access
                    too), own (of owners and permissions), close, or none: nothing fails; and three that a program has
                    to bear: short (a read or write does half of its bytes), eintr (a read or write is interrupted) and
                    norename2 (a file system without the flags of renameat2)
   FAIL_AT=n        the n-th of these calls fails, counted from 1 (0: none)
   FAIL_ALWAYS=1    not only the n-th, but each
   FAIL_SILENT=1    plants a bug: the call does not happen and says that it did
   FAIL_HELD=1      plants a bug: fcntl says of closed standard streams that they are open
   FAIL_COUNT=file  8 bytes: how many of these calls there were
   FAIL_PLACES=file for each of these calls, 8 bytes: a hash of its FAIL_CALLERS innermost callers (at most 40) */
#include "shim.h"

#include <execinfo.h>

/* What fails: calls of these kinds, and only those of this name, if there is one. */
#define OF(kind) (1u << (kind))
static const struct way {
    const char *name;
    unsigned kinds;
    int error;
    const char *only;
} ways[] = {{"none", 0, 0},
            {"malloc", OF(ALLOCATING), ENOMEM},
            {"open", OF(OPENING), EMFILE},
            {"read", OF(READING), EIO},
            {"mmap", OF(MAPPING), ENOMEM},
            {"thread", OF(THREADING), EAGAIN},
            {"sync", OF(SYNCING), EIO},
            {"rename", OF(RENAMING), EIO},
            {"remove", OF(REMOVING), EIO},
            {"lock", OF(LOCKING), ENOLCK},
            {"write", OF(WRITING), EIO},
            {"cut", OF(CUTTING), EIO},
            {"stat", OF(ASKING_STATUS), EIO},
            {"own", OF(OWNING), EPERM},
            {"close", OF(CLOSING), EIO},
            {"short", OF(READING) | OF(WRITING), 0},
            {"eintr", OF(READING) | OF(WRITING), EINTR},
            {"norename2", OF(RENAMING), EINVAL, "renameat2"}};
static const struct way *way = ways;
static long at;
static int silent, always, held;
static atomic_long own, *count = &own;
static int main_began, refused_in_hdf5;
static uint64_t *places;
static long callers;
static const void *own_base;
enum { most_places = 1 << 22, most_callers = 40, own_frames = 8 };

static int is_in_hdf5(void) {
    void *frames[60];
    Dl_info found;
    for (int i = 0, n = backtrace(frames, 60); i < n; ++i)
        if (dladdr(frames[i], &found) && found.dli_fname && strstr(found.dli_fname, "hdf5")) return 1;
    return 0;
}

/* Says where the program ends by itself: inside a library, before main() or in its own code. Nothing here may allocate:
   the C library may have found the heap damaged, and then this thread holds its lock. */
static void say_where(int in_hdf5) {
    char line[60];
    const int length = snprintf(line, sizeof line, "shim: it ended in %s\n",
                                in_hdf5 ? "libhdf5" : main_began ? "the program" : "what runs before main");
    syscall(SYS_write, 2, line, (size_t)length);
}
/* A signal may come long after libhdf5 got no memory and damaged the heap. */
static void on_signal(int signal_number) {
    say_where(refused_in_hdf5 || is_in_hdf5());
    signal(signal_number, SIG_DFL);
    raise(signal_number);
}
void exit(int code) {
    REAL(exit, "exit");
    if (code != 0 && at > 0) say_where(is_in_hdf5());
    real(code);
    die();
}

/* A file of `size` bytes that this process shares with what reads it. */
static void *shared_file(const char *path, size_t size) {
    const int file = (int)syscall(SYS_openat, AT_FDCWD, path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file < 0 || syscall(SYS_ftruncate, file, size) != 0) _exit(99);
    void *shared = (void *)syscall(SYS_mmap, NULL, size, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    syscall(SYS_close, file);
    if (shared == MAP_FAILED) _exit(99);
    return shared;
}

static const void *base_of(const void *code) {
    Dl_info found;
    return dladdr(code, &found) ? found.dli_fbase : NULL;
}

/* FNV-1a over the callers' offsets in their libraries, which are the same in every run. */
static uint64_t place_of_call(void) {
    void *frames[most_callers + own_frames];
    uint64_t hash = 14695981039346656037u;
    long left = callers;
    for (int i = 0, n = backtrace(frames, most_callers + own_frames); i < n && left > 0; ++i) {
        const void *base = base_of(frames[i]);
        if (base == own_base) continue;
        hash = (hash ^ ((uintptr_t)frames[i] - (uintptr_t)base)) * 1099511628211u;
        --left;
    }
    return hash;
}

__attribute__((constructor)) static void read_environment(void) {
    const char *name = getenv("FAIL"), *counted = getenv("FAIL_COUNT");
    if (!name) return;
    at = number("FAIL_AT");
    silent = is_on("FAIL_SILENT");
    always = is_on("FAIL_ALWAYS");
    held = is_on("FAIL_HELD");
    callers = number("FAIL_CALLERS");
    own_base = base_of(&callers);
    if (callers < 0 || callers > most_callers) _exit(99);
    void *frame;
    backtrace(&frame, 1); /* loads what it needs */
    static char room[1 << 16]; /* libhdf5 may have used up the stack */
    sigaltstack(&(stack_t){.ss_sp = room, .ss_size = sizeof room}, NULL);
    const struct sigaction action = {.sa_handler = on_signal, .sa_flags = SA_ONSTACK};
    sigaction(SIGSEGV, &action, NULL);
    sigaction(SIGBUS, &action, NULL);
    sigaction(SIGABRT, &action, NULL);
    const struct way *const end = ways + sizeof ways / sizeof *ways;
    for (way = ways; way < end && strcmp(name, way->name) != 0; ++way) {}
    if (way == end) _exit(99);
    if (counted) count = shared_file(counted, sizeof own);
    if (getenv("FAIL_PLACES")) places = shared_file(getenv("FAIL_PLACES"), most_places * sizeof *places);
}

/* One byte has no half; a short call is the only one that does not fail. */
static int may_fail(const struct call *call) {
    if (way->only && strcmp(call->name, way->only) != 0) return 0;
    return (way->kinds & OF(call->kind)) && (way->error || call->size > 1);
}

enum fate fail_fate(const struct call *call, int *error) {
    if (!may_fail(call) && call->kind != ASKING) return goes_on;
    *error = way->error;
    if (call->kind == ASKING) main_began = 1; /* the program looks at its standard streams first */
    if (call->kind == ASKING) return held && call->fd <= 2 && call->flags == F_GETFD ? is_left_out : goes_on;
    static __thread int within; /* an unwinder may allocate: that is not a call of the program */
    if (within) return goes_on;
    const long before = atomic_fetch_add(count, 1);
    if (places && before < most_places) {
        within = 1;
        places[before] = place_of_call();
        within = 0;
    }
    if (before + 1 != at && !always) return goes_on;
    within = 1;
    refused_in_hdf5 = call->kind == ALLOCATING && is_in_hdf5();
    within = 0;
    return silent ? is_left_out : way->error ? fails : only_half;
}
