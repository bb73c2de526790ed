/* Locks by name, a planted bug: flock() locks, instead of a file, another one that is named after the path by which the
   file was opened. So two programs that reach a file by two paths are not kept apart.

   LOCKS_BY_NAME=folder   where the files are that are locked */
#include "shim.h"

enum { most = 1024 };
static const char *folder;
static uint64_t names[most]; /* of each descriptor, a hash of its path; 0: not known */
static int locks[most];      /* what is locked instead of it; 0: nothing yet, as 0 is the standard input */

__attribute__((constructor)) static void read_environment(void) { folder = getenv("LOCKS_BY_NAME"); }

/* FNV-1a, continued from `hash`. */
static uint64_t hashed(const char *text, uint64_t hash) {
    for (; *text; ++text) hash = (hash ^ (unsigned char)*text) * 1099511628211u;
    return hash;
}

/* The path stays as it was given, after the folder that the program works in: links and mounts are not resolved. */
void note_name(int fd, const char *path) {
    char here[4096] = "";
    if (!folder || fd < 0 || fd >= most) return;
    if (path[0] != '/' && !getcwd(here, sizeof here)) die();
    names[fd] = hashed(path, hashed(here[0] ? "/" : "", hashed(here, 14695981039346656037u)));
}

int locked_instead_of(int fd) {
    char path[4200];
    if (!folder || fd < 0 || fd >= most || names[fd] == 0) return fd;
    if (locks[fd] == 0) {
        snprintf(path, sizeof path, "%s/%016lx", folder, (unsigned long)names[fd]);
        locks[fd] = (int)syscall(SYS_openat, AT_FDCWD, path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (locks[fd] < 0) die();
    }
    return locks[fd];
}

/* Closing a file gives up its lock. */
void forget_name(int fd) {
    if (!folder || fd < 0 || fd >= most) return;
    if (locks[fd] > 0) syscall(SYS_close, locks[fd]);
    locks[fd] = 0;
    names[fd] = 0;
}
