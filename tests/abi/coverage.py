#!/usr/bin/env python3
"""Which public functions the test programs really call, told by the dynamic loader while they run.

    coverage.py --c DIR --fortran DIR

Each DIR holds test programs linked to the shared library with lazy binding: the loader then reports a function when
it is called for the first time. Prints one line a function; fails if one is never called from C or from Fortran.
"""

import argparse
import os
import re
import subprocess
import sys
from pathlib import Path

import header

BINDING = re.compile(r"symbol `(stickslip_\w+)'")


def called(program):
    """The library's functions that a program calls."""
    environment = {**os.environ, "LD_DEBUG": "bindings"}
    environment.pop("LD_BIND_NOW", None)
    done = subprocess.run([program], env=environment, capture_output=True, text=True, errors="replace")
    if done.returncode != 0:
        sys.exit(f"{program.name}: exit code {done.returncode}")
    # The loader also reports the library's own bindings to system libraries; those have other names.
    return set(BINDING.findall(done.stderr))


def callers(folder):
    """Function -> how many programs of a folder call it."""
    tests = [p for p in folder.iterdir() if re.search(r"_t\d\d_", p.name)]
    programs = sorted(p for p in tests if p.is_file() and os.access(p, os.X_OK))
    if not programs:
        sys.exit(f"{folder} holds no test program")
    counts = {}
    for program in programs:
        for name in called(program):
            counts[name] = counts.get(name, 0) + 1
    return counts, len(programs)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--c", required=True, type=Path)
    parser.add_argument("--fortran", required=True, type=Path)
    arguments = parser.parse_args()
    (from_c, n_c), (from_fortran, n_fortran) = callers(arguments.c), callers(arguments.fortran)
    print(f"{'function':45} called by: C ({n_c} programs)   Fortran ({n_fortran})")
    missing = 0
    for f in header.functions():
        c, fortran = from_c.get(f.name, 0), from_fortran.get(f.name, 0)
        missing += c == 0 or fortran == 0
        print(f"{f.name:45} {c:15d} {fortran:19d}{'' if c and fortran else '   NOT CALLED'}")
    sys.exit(f"{missing} functions are not called from both languages" if missing else 0)


if __name__ == "__main__":
    main()
