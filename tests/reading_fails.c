/* Preloaded: reading the file that READING_FAILS names gives EIO from its byte READING_FAILS_FROM on, as a bad disk
   does; removing the one that REMOVING_FAILS names gives EPERM, as in a folder where others own the files. */
#define _GNU_SOURCE
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <unistd.h>

static int is_last(const char *name, const char *path) {
    const char *last = strrchr(path, '/');
    return name != NULL && strcmp(last == NULL ? path : last + 1, name) == 0;
}

/* Whether bytes up to `end` of this file fail. */
static int fails(int descriptor, off_t end) {
    const char *name = getenv("READING_FAILS"), *from = getenv("READING_FAILS_FROM");
    if (name == NULL || from == NULL || end <= atoll(from)) return 0;
    char link[64], path[4096];
    snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
    const ssize_t length = readlink(link, path, sizeof path - 1);
    if (length < 0) return 0;
    path[length] = '\0';
    return is_last(name, path);
}

int unlink(const char *path) {
    if (is_last(getenv("REMOVING_FAILS"), path)) return errno = EPERM, -1;
    return (int)syscall(SYS_unlink, path);
}

ssize_t pread(int descriptor, void *bytes, size_t size, off_t offset) {
    if (fails(descriptor, offset + (off_t)size)) return errno = EIO, -1;
    return syscall(SYS_pread64, descriptor, bytes, size, offset);
}

ssize_t pread64(int descriptor, void* bytes, size_t size, off_t offset) {
    return pread(descriptor, bytes, size, offset);
}

ssize_t read(int descriptor, void *bytes, size_t size) {
    if (fails(descriptor, lseek(descriptor, 0, SEEK_CUR) + (off_t)size)) return errno = EIO, -1;
    return syscall(SYS_read, descriptor, bytes, size);
}
