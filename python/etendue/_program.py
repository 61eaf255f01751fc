"""The program within this Python, for plugins that are written in Python.

The program starts itself so when it meets such a plugin (src/app/python_plugins.h): `python3 …/etendue/_program.py ARGUMENTS`. The
package is imported from the folder of this file, wherever it is, and the program is called as a function of its library.
"""

from __future__ import annotations

import ctypes
import importlib.util
import os
import signal
import sys


def _import_package() -> None:
    """Imports the package of this file as `etendue`, though it may be in no folder of sys.path."""
    folder = os.path.dirname(os.path.abspath(__file__))
    if sys.path and os.path.realpath(sys.path[0]) == os.path.realpath(folder):
        del sys.path[0]
    spec = importlib.util.spec_from_file_location(
        "etendue", os.path.join(folder, "__init__.py"), submodule_search_locations=[folder]
    )
    if spec is None or spec.loader is None:
        raise ImportError(f"'{folder}' is no package of Python")
    package = importlib.util.module_from_spec(spec)
    sys.modules["etendue"] = package
    spec.loader.exec_module(package)


def main(arguments: list[str]) -> int:
    """Runs the program and returns its exit status. Signals have the meaning that they have for the program."""
    # Threads that numpy starts inherit the mask: signals come to the thread that runs the program.
    signals = {signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGUSR1}
    before = signal.pthread_sigmask(signal.SIG_BLOCK, signals)
    try:
        _import_package()
    finally:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
    from etendue import _core, _installation

    _core.print_warnings()
    run = ctypes.CDLL(_installation.program_library()).etendue_main
    words = [b"etendue", *(os.fsencode(argument) for argument in arguments)]
    # As for a C program, a null ends the list. ctypes gives the interpreter's lock away during the call.
    return int(run(len(words), (ctypes.c_char_p * (len(words) + 1))(*words, None)))


if __name__ == "__main__":
    try:
        status = main(sys.argv[1:])
    except (ImportError, OSError) as error:
        sys.exit(f"etendue: within Python ({sys.executable}): {error}")
    sys.exit(status)
