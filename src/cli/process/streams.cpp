#include "cli/process/streams.hpp"

#include <fcntl.h>
#include <unistd.h>

namespace credence::cli {

void hold_standard_streams() {
    for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; ++descriptor) {
        if (fcntl(descriptor, F_GETFD) != -1) continue;
        // The descriptor is opened in the mode in which the stream is not used. Reading from or writing to it then
        // fails with EBADF, as on a closed descriptor, and the program reports that its output is lost and exits with
        // 1; output written to /dev/null would be lost silently.
        const int mode = descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY;
        // open() returns the lowest free descriptor, which is this one.
        if (open("/dev/null", mode) != descriptor) _exit(1);
    }
}

}  // namespace credence::cli
