// The executable: the program, which starts again within Python when a plugin is written in Python.

#include "program.h"
#include "python_plugins.h"

int main(int argument_count, char** arguments) {
  etendue::restart_for_python_plugins(argument_count, arguments);
  return etendue_main(argument_count, arguments);
}
