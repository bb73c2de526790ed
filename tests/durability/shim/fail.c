/* A resource fails once.

   FAIL=kind        malloc, open, read, mmap, thread, sync, rename, remove, lock, write or none
   FAIL_AT=n        the n-th of these calls fails, counted from 1 (0: none)
   FAIL_ALWAYS=1    not only the n-th, but each
   FAIL_SILENT=1    plants a bug: the call does not happen and says that it did
   FAIL_HELD=1      plants a bug: fcntl says of closed standard streams that they are open
   FAIL_COUNT=file  8 bytes: how many of these calls there were */
#include "shim.h"

#include <execinfo.h>

static enum kind kind = ALLOCATING + 1;
static long at;
static int failure, silent, always, held;
static atomic_long own, *count = &own;
static int main_began;

/* Says where the program ends by itself: inside a library, before main() or in its own code. Nothing here may allocate:
   the C library may have found the heap damaged, and then this thread holds its lock. */
static void say_where(void) {
    void *frames[60];
    Dl_info found;
    const char *where = main_began ? "the program" : "what runs before main";
    for (int i = 0, n = backtrace(frames, 60); i < n; ++i)
        if (dladdr(frames[i], &found) && found.dli_fname && strstr(found.dli_fname, "hdf5")) where = "libhdf5";
    char line[60];
    const int length = snprintf(line, sizeof line, "shim: it ended in %s\n", where);
    syscall(SYS_write, 2, line, (size_t)length);
}
static void on_signal(int signal_number) {
    say_where();
    signal(signal_number, SIG_DFL);
    raise(signal_number);
}
void exit(int code) {
    REAL(exit, "exit");
    if (code != 0 && at > 0) say_where();
    real(code);
    die();
}

__attribute__((constructor)) static void read_environment(void) {
    static const struct { const char *name; enum kind kind; int error; } kinds[] = {
        {"malloc", ALLOCATING, ENOMEM}, {"open", OPENING, EMFILE}, {"read", READING, EIO},   {"mmap", MAPPING, ENOMEM},
        {"thread", THREADING, EAGAIN},  {"sync", SYNCING, EIO},    {"rename", RENAMING, EIO}, {"remove", REMOVING, EIO},
        {"lock", LOCKING, ENOLCK},      {"write", WRITING, EIO}};
    const char *name = getenv("FAIL"), *counted = getenv("FAIL_COUNT");
    if (!name) return;
    at = number("FAIL_AT");
    silent = is_on("FAIL_SILENT");
    always = is_on("FAIL_ALWAYS");
    held = is_on("FAIL_HELD");
    void *frame;
    backtrace(&frame, 1); /* loads what it needs */
    static char room[1 << 16]; /* libhdf5 may have used up the stack */
    sigaltstack(&(stack_t){.ss_sp = room, .ss_size = sizeof room}, NULL);
    sigaction(SIGSEGV, &(struct sigaction){.sa_handler = on_signal, .sa_flags = SA_ONSTACK}, NULL);
    sigaction(SIGABRT, &(struct sigaction){.sa_handler = on_signal, .sa_flags = SA_ONSTACK}, NULL);
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; ++i)
        if (strcmp(name, kinds[i].name) == 0) kind = kinds[i].kind, failure = kinds[i].error;
    if (failure == 0 && strcmp(name, "none") != 0) _exit(99);
    if (!counted) return;
    const int file = (int)syscall(SYS_openat, AT_FDCWD, counted, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file < 0 || syscall(SYS_ftruncate, file, sizeof own) != 0) _exit(99);
    void *shared = (void *)syscall(SYS_mmap, NULL, sizeof own, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    syscall(SYS_close, file);
    if (shared == MAP_FAILED) _exit(99);
    count = shared;
}

enum fate fail_fate(const struct call *call, int *error) {
    if (call->kind != kind && call->kind != ASKING) return goes_on;
    *error = failure;
    if (call->kind == ASKING) main_began = 1; /* the program looks at its standard streams first */
    if (call->kind == ASKING) return held && call->fd <= 2 && call->flags == F_GETFD ? is_left_out : goes_on;
    return atomic_fetch_add(count, 1) + 1 == at || always ? (silent ? is_left_out : fails) : goes_on;
}
