/* Calls on what a file is, not on its bytes: its status, its owner and its permissions. */
#include "shim.h"

int stat(const char *path, struct stat *status) {
    REAL(stat, "stat");
    WHOLE(int, real(path, status), ASKING_STATUS, "stat", -1, path);
}
int lstat(const char *path, struct stat *status) {
    REAL(lstat, "lstat");
    WHOLE(int, real(path, status), ASKING_STATUS, "lstat", -1, path);
}
int fstat(int fd, struct stat *status) {
    REAL(fstat, "fstat");
    WHOLE(int, real(fd, status), ASKING_STATUS, "fstat", fd);
}
int fstatat(int folder, const char *path, struct stat *status, int flags) {
    REAL(fstatat, "fstatat");
    WHOLE(int, real(folder, path, status, flags), ASKING_STATUS, "fstatat", -1, path);
}
/* Where the sizes of files have 64 bits anyway, both structures are the same. */
_Static_assert(sizeof(struct stat) == sizeof(struct stat64), "a status is another with 64 bits");
int stat64(const char *path, struct stat64 *status) { return stat(path, (struct stat *)status); }
int lstat64(const char *path, struct stat64 *status) { return lstat(path, (struct stat *)status); }
int fstat64(int fd, struct stat64 *status) { return fstat(fd, (struct stat *)status); }
int fstatat64(int folder, const char *path, struct stat64 *status, int flags) {
    return fstatat(folder, path, (struct stat *)status, flags);
}
int access(const char *path, int mode) {
    REAL(access, "access");
    WHOLE(int, real(path, mode), ASKING_STATUS, "access", -1, path);
}
int chmod(const char *path, mode_t mode) {
    REAL(chmod, "chmod");
    WHOLE(int, real(path, mode), OWNING, "chmod", -1, path);
}
int fchmod(int fd, mode_t mode) {
    REAL(fchmod, "fchmod");
    WHOLE(int, real(fd, mode), OWNING, "fchmod", fd);
}
int chown(const char *path, uid_t user, gid_t group) {
    REAL(chown, "chown");
    WHOLE(int, real(path, user, group), OWNING, "chown", -1, path);
}
int fchown(int fd, uid_t user, gid_t group) {
    REAL(fchown, "fchown");
    WHOLE(int, real(fd, user, group), OWNING, "fchown", fd);
}
