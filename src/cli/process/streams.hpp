#pragma once
// Standard streams that are closed when the program starts.

namespace credence::cli {

/// Opens each of descriptors 0, 1 and 2 that is closed, so that no file that the program opens gets one of them: a
/// library's messages would be written into that file. Ends the process where this is impossible.
void hold_standard_streams();

}  // namespace credence::cli
