#pragma once
// Standard output and standard error of the program.

namespace etendue {

/// To be called before anything else. From then on
///  - descriptors 0 to 2 are in use, if only by what cannot be read or written: no file that is opened later takes the place
///    of a stream that was closed, to have messages written into it;
///  - nothing that is printed throws, waits or ends the program, whatever becomes of its reader: a render outlives that.
void open_standard_streams();

/// Prints what is still held back. A program whose standard output was lost has not done what it was asked to do: this is then
/// said, and the status of success becomes that of failure. A reader that went away (`| head -1`) had what it wanted.
int close_standard_streams(int status);

}  // namespace etendue
