// The plugin hostile.cpp, compiled for another instruction set than the program (tests/CMakeLists.txt).
#include "hostile.cpp"
