#pragma once
// Stopping a run by a signal.

#include "base/signal_handler.hpp"

#include <list>
#include <string>

namespace credence::cli {

/// While an object exists, SIGINT, SIGTERM and SIGHUP ask the run to stop, and a second one of them ends the process at
/// once with 130, unless another program's process does the work. A SIGHUP that was ignored, as nohup arranges it,
/// stays ignored.
class Interrupt {
public:
    Interrupt();

    /// Whether a signal was received. Can be called from any thread.
    static bool came();
    /// Asks the run to stop, as SIGTERM does.
    static void ask();
    /// From now on a second signal only asks again: the process is not the program's own.
    static void keep_process();
    /// Its name, such as SIGINT.
    static std::string name();

private:
    std::list<SignalHandler> handlers_;
};

}  // namespace credence::cli
