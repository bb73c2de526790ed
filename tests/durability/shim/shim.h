/* A library to preload: every call that a program makes to files, memory and threads goes through calls.c, and modes
   decide what becomes of it. Each mode is a source of its own, which lists the variables that switch it on. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

#define REAL(function, name) __typeof__(&function) real = (__typeof__(&function))dlsym(RTLD_NEXT, name)

enum kind { WRITING, CUTTING, SYNCING, RENAMING, REMOVING, LINKING, OPENING, READING, LOCKING, MAPPING, THREADING,
            ASKING, ALLOCATING, ASKING_STATUS, OWNING, CLOSING };

struct call {
    enum kind kind;
    const char *name;
    int fd;                /* of the file, or -1 */
    const char *path, *to; /* of calls on names */
    const void *bytes;     /* of a write at `at` */
    size_t size;
    off_t at;
    int flags;             /* of opening and mapping */
};

enum fate { goes_on, half_then_fails, half_then_dies, only_half, fails, dies, is_left_out };

/* Called before and after every call; `before` sets errno where the call fails. */
enum fate before(const struct call *call);
void after(const struct call *call, long result);

/* A call whose first `part` makes half of it, where it has a half, as its fate says. */
#define CALL(type, has_half, part, whole, ...)                                              \
    do {                                                                                    \
        const struct call call = {__VA_ARGS__};                                             \
        const enum fate fate = before(&call);                                               \
        if (fate == fails || (fate == half_then_fails && !(has_half))) {                    \
            after(&call, -1);                                                               \
            return (type)-1;                                                                \
        }                                                                                   \
        const int halves = (has_half) && fate >= half_then_fails && fate <= only_half;      \
        const type result = fate == is_left_out ? (type)call.size : halves ? (part) : (whole); \
        if (fate == half_then_dies) die();                                                  \
        after(&call, (long)result);                                                         \
        return result;                                                                      \
    } while (0)
#define WHOLE(type, call, ...) CALL(type, 0, call, call, __VA_ARGS__)

/* The modes. */
enum fate crash_fate(const struct call *call, int *error);
void crash_log(const struct call *call, long result);
enum fate fail_fate(const struct call *call, int *error);
enum fate sync_left_out(const struct call *call);
void record(const struct call *call, long result);
void meet(const struct call *call);

/* Called after opening a file, before closing it, and for the descriptor that is locked instead of it. */
void note_name(int fd, const char *path);
void forget_name(int fd);
int locked_instead_of(int fd);

int changes_files(const struct call *call);
int is_on(const char *mode);
long number(const char *name);
void die(void);
