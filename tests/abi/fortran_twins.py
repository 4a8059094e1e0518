#!/usr/bin/env python3
"""Every C test of the ABI has its twin in Fortran: tests/capi/tNN_name.c and tests/fortran/tNN_name.f90. But one, whose
head says why."""

import sys
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]
WITHOUT_TWIN = {"t42_bad_input_content", "t98_points"}


def names(folder, extension):
    return {path.stem for path in (TESTS / folder).glob(f"t[0-9][0-9]_*.{extension}")}


def main():
    c, fortran = names("capi", "c"), names("fortran", "f90")
    if not c:
        sys.exit("no C tests found")
    if c - WITHOUT_TWIN != fortran or not WITHOUT_TWIN <= c:
        sys.exit(f"only in C: {sorted(c - fortran)}; only in Fortran: {sorted(fortran - c)}")
    print(f"ok: {len(c)} C tests, {len(fortran)} with a twin in Fortran")


if __name__ == "__main__":
    main()
