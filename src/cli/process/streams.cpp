#include "cli/process/streams.hpp"

#include <fcntl.h>
#include <unistd.h>

namespace credence::cli {

void hold_standard_streams() {
    for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; ++descriptor) {
        if (fcntl(descriptor, F_GETFD) != -1) continue;
        // The mode is the one that the stream is not used in. Reading from or writing to it then fails with EBADF as it
        // does on a closed descriptor, and the program says that its output is lost and exits with 1; written to
        // /dev/null, the output would be lost without a word.
        const int mode = descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY;
        // The lowest free descriptor is this one.
        if (open("/dev/null", mode) != descriptor) _exit(1);
    }
}

}  // namespace credence::cli
