"""Where the compiled parts of an installed package are.

A package holds several builds of the library, the program and the extension module, for processors of different age
(_prefix/x86-64-v4, …), and chooses the best that this processor can run. The environment variable ETENDUE_ARCHITECTURE chooses
another. A build's own folder (build/python) has the extension module beside this file, and no _prefix.

The command `etendue` of the package runs this file as a program, without importing the package.
"""

from __future__ import annotations

import os
import sys
from typing import Any, Optional

_package = os.path.dirname(os.path.abspath(__file__))


def prefix() -> Optional[str]:
    """The folder of the installed library, in which CMake finds it, too (CMAKE_PREFIX_PATH); None in a build's own folder."""
    folder = os.path.realpath(os.path.join(_package, "_prefix"))
    return folder if os.path.isdir(folder) else None


def available_architectures() -> list[str]:
    """The architectures that the package was built for, the best first."""
    folder = prefix()
    if folder is None:
        return []
    return [name for name in [*(name for name, _ in _known()), "native"] if os.path.isdir(os.path.join(folder, name))]


def architecture() -> str:
    """The architecture of the build that is used. Raises ImportError if this processor can run none of them."""
    available = available_architectures()
    chosen = os.environ.get("ETENDUE_ARCHITECTURE")
    if chosen:
        if chosen not in available:
            raise ImportError(f"ETENDUE_ARCHITECTURE is '{chosen}'; this package was built for {', '.join(available)}")
        return chosen
    best, lacking = _best(available)
    if best is None and "native" in available:
        best = "native"
    if best is None:
        raise ImportError(f"this processor is older than {available[-1]}: it has no {', '.join(lacking)}")
    return best


def folder_of_build() -> str:
    """The folder of the extension module and, in an installed package, of library and program."""
    folder = prefix()
    return _package if folder is None else os.path.join(folder, architecture())


def build_info() -> dict[str, Any]:
    """How the package was built, and which of its builds is used: a dict for reports of bugs.

    Keys: "version"; "architecture", the instruction set of the build that is used; "architectures", of all builds in the package;
    "compiler"; "build_type"; "prefix", the folder in which CMake finds the library (CMAKE_PREFIX_PATH), or None in a build's own
    folder; "program", the path of the program; "bundled", the versions of the libraries of others that the package brings.
    """
    import json

    folder = folder_of_build()
    info: dict[str, Any] = {"architectures": available_architectures(), "prefix": prefix(), "bundled": {}}
    for path in (os.path.join(folder, "build.json"), os.path.join(prefix() or folder, "share", "etendue", "bundled.json")):
        if os.path.exists(path):
            with open(path, encoding="utf-8") as file:
                info.update(json.load(file))
    info["program"] = _program(folder)
    return info


def _known() -> list[tuple[str, list[str]]]:
    """Architectures, the best first, with the flags of /proc/cpuinfo that each needs beyond those of the next."""
    with open(os.path.join(prefix() or "", "share", "etendue", "architectures.txt"), encoding="utf-8") as file:
        lines = [line.partition(":") for line in file if not line.startswith("#")]
    return [(name, flags.split()) for name, _, flags in lines]


def _best(available: list[str]) -> tuple[Optional[str], list[str]]:
    """The best available architecture that this processor can run, and the flags that it lacks for the next better one."""
    there, best = _processor_flags(), None
    for name, flags in reversed(_known()):
        if lacking := [flag for flag in flags if flag not in there]:
            return best, lacking
        if name in available:
            best = name
    return best, []


def _processor_flags() -> set[str]:
    with open("/proc/cpuinfo", encoding="ascii", errors="replace") as file:
        return next((set(line.split()) for line in file if line.startswith("flags")), set())


def _program(folder: str) -> str:
    # In a build's own folder the package is in build/python/etendue, the program in build.
    return os.path.join(folder, "etendue") if prefix() else os.path.normpath(os.path.join(folder, "..", "..", "etendue"))


def program_library() -> str:
    """The shared library that holds the program, beside it."""
    return os.path.join(os.path.dirname(_program(folder_of_build())), "libetendue_app.so")


def run_program(arguments: list[str]) -> None:
    """Replaces this process by the program. Files of USD, and plugins that are written in Python, are then read by this Python, if no
    other was chosen."""
    path = _program(folder_of_build())
    os.environ.setdefault("ETENDUE_PYTHON", sys.executable)
    os.execv(path, ["etendue", *arguments])


if __name__ == "__main__":
    try:
        run_program(sys.argv[1:])
    except (ImportError, OSError) as error:
        sys.exit(f"etendue: {error}")
