#pragma once
// Stopping a run by a signal.

#include "base/signal_handler.hpp"

#include <list>
#include <string>

namespace credence::cli {

/// While an object exists, SIGINT, SIGTERM and SIGHUP ask the run to stop, and a second one of them ends the process at
/// once with 130, unless another program's process does the work. So does the first one with 3, if a block goes on for
/// five seconds and twice as long as any block before. A SIGHUP that was ignored, as nohup arranges it, stays ignored.
class Interrupt {
public:
    Interrupt();

    /// Whether a signal was received. Can be called from any thread.
    static bool came();
    /// The same, asked by each thread of the run before each of its blocks.
    static bool came_after_block();
    /// Between these two, blocks are computed; `message` is printed where one of them goes on for too long.
    static void begin_blocks(const std::string& message);
    static void end_blocks();
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
