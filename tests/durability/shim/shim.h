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
            ASKING, ALLOCATING };

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

enum fate { goes_on, half_then_fails, fails, half_then_dies, dies, is_left_out };

/* Called before and after every call; `before` sets errno where the call fails. */
enum fate before(const struct call *call);
void after(const struct call *call, long result);

/* The modes. */
enum fate crash_fate(const struct call *call, int *error);
void crash_log(const struct call *call, long result);
enum fate fail_fate(const struct call *call, int *error);
enum fate sync_left_out(const struct call *call);
void record(const struct call *call, long result);
void meet(const struct call *call);

int changes_files(const struct call *call);
int is_on(const char *mode);
long number(const char *name);
void die(void);
