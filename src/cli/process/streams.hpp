#pragma once
// The standard streams, which the program may be started without.

namespace credence::cli {

/// Opens something on each of descriptors 0, 1 and 2 that is closed, so that no file which the program opens gets one of
/// them: what a library prints there would be written into that file. Ends the process where that is impossible.
void hold_standard_streams();

}  // namespace credence::cli
