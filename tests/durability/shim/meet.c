/* Two programs take turns.

   MEET=fd   a socket: before each call on a file or a name, the call's name goes out on it, and the program waits for a
             byte; where the other end is closed, it goes on */
#include "shim.h"

static int turns = -1;

__attribute__((constructor)) static void read_environment(void) {
    if (is_on("MEET")) turns = (int)number("MEET");
}

/* A file may have another status by the time that the program acts on it, and closing a file gives up its lock. */
static int waits_before(const struct call *call) {
    if (call->fd >= 0 && (call->fd <= 2 || call->fd == turns)) return 0;
    return call->kind < MAPPING || call->kind == ASKING_STATUS || call->kind == OWNING || call->kind == CLOSING;
}

void meet(const struct call *call) {
    static pthread_mutex_t one = PTHREAD_MUTEX_INITIALIZER;
    char line[300], turn;
    if (turns < 0 || !waits_before(call)) return;
    pthread_mutex_lock(&one);
    const int length = snprintf(line, sizeof line, "%s %s\n", call->name, call->path ? call->path : "");
    if (syscall(SYS_sendto, turns, line, (size_t)length, MSG_NOSIGNAL, NULL, 0) == length)
        while (syscall(SYS_read, turns, &turn, 1) < 0 && errno == EINTR) {}
    pthread_mutex_unlock(&one);
}
