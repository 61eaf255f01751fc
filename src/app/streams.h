#pragma once
// Standard output and standard error of the program.

namespace etendue {

/// To be called before anything else. Afterwards
///  - descriptors 0 to 2 are open, if only to a file that cannot be read or written. Otherwise a file that is opened later
///    could get the descriptor of a closed stream, and messages would be written into it;
///  - printing neither throws nor ends the program, whatever happens to the reader: a render outlives its reader;
///  - printing waits for a reader that stalls, but not after a signal to stop.
void open_standard_streams();

/// Prints what is still buffered. If writing to standard output failed, prints this error and turns the status of success into
/// that of failure. A reader that closed the pipe (`| head -1`, EPIPE) is no failure.
int close_standard_streams(int status);

}  // namespace etendue
