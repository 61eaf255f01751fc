#pragma once
// The program as a function, in a library of its own: the executable calls it (main.cpp), and so does Python when it runs the
// program within an interpreter (python/etendue/_program.py).

/// Runs a command line and returns the exit status. The standard streams are replaced, so it is called once in a process.
extern "C" int etendue_main(int argument_count, char** arguments);
