#!/usr/bin/env python3
"""Keeps the ABI what it is: what the library exports and needs, what the header declares, against the committed description.

    check.py --library libstickslip.so            every check; the exit code says whether all hold
    check.py --library libstickslip.so --renew    writes the description anew (`make abi`), after showing what has changed

The description is tests/abi/stickslip.abi (libabigail's XML: every function, struct and member as C sees them) and
tests/abi/constants.txt. It is made from the header, compiled with empty bodies, so that it depends on no version of the Rust
compiler; that the library is what the header says is checked here (symbols), by tests/layout.rs and by tests/header.rs.
"""

import argparse
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import header

HERE = Path(__file__).resolve().parent
DUMP = HERE / "stickslip.abi"
CONSTANTS = HERE / "constants.txt"

# A library to link without a second thought: stripped it stays below this many bytes.
LARGEST = 2_000_000
# glibc's own libraries, the loader, and the one that unwinds.
ALLOWED = ("libc.so", "libm.so", "libdl.so", "librt.so", "libutil.so", "libpthread.so", "ld-linux", "libgcc_s.so")
# Bits of abidiff's exit code.
ABIDIFF_CHANGE, ABIDIFF_INCOMPATIBLE = 4, 8


def run(*command, accept=(0,)):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode not in accept:
        sys.exit(f"{' '.join(map(str, command))}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
    return done


def fail(what, hint=""):
    print(f"FAILED  {what}\n{hint}")
    return False


def check_symbols(library):
    """The library exports the header's functions and nothing else."""
    exported = {line.split()[-1].split("@")[0] for line in run("nm", "-D", "--defined-only", library).stdout.splitlines()}
    declared = {f.name for f in header.functions()}
    if exported != declared:
        return fail("symbols", f"only exported: {sorted(exported - declared)}; only declared: {sorted(declared - exported)}")
    print(f"ok      symbols: {len(exported)} functions, all stickslip_*, and all of the header's")
    return all(name.startswith("stickslip_") for name in exported)


def check_dependencies(library):
    """It needs glibc's libraries, libgcc_s and the loader only, and goes by its soname."""
    lines = run("readelf", "-dW", library).stdout.splitlines()
    needed = [line.split("[")[1].rstrip("]") for line in lines if "(NEEDED)" in line]
    soname = [line.split("[")[1].rstrip("]") for line in lines if "(SONAME)" in line]
    foreign = [name for name in needed if not name.startswith(ALLOWED)]
    constants = header.constants()
    major, minor = constants["STICKSLIP_VERSION_MAJOR"], constants["STICKSLIP_VERSION_MINOR"]
    expected = f"libstickslip.so.{f'0.{minor}' if major == 0 else major}"
    if foreign or soname != [expected]:
        return fail("dependencies", f"foreign: {foreign}; soname {soname}, expected {expected}")
    print(f"ok      dependencies: {', '.join(needed)}; soname {expected}")
    return True


def check_size(library):
    """Stripped it is small."""
    with tempfile.TemporaryDirectory() as folder:
        stripped = Path(folder) / "stripped.so"
        run("strip", "-o", stripped, library)
        size = stripped.stat().st_size
    if size >= LARGEST:
        return fail("size", f"{size} bytes stripped, at most {LARGEST} allowed")
    print(f"ok      size: {size} bytes stripped (bound {LARGEST})")
    return True


def stub(folder, path):
    """A shared library with a header's functions and empty bodies, with debugging information."""
    code = ["#include <stickslip.h>"]
    code += [f"{f.result} {f.name}({f.parameters}) {{ return 0; }}" for f in header.functions(path)]
    (folder / "stub.c").write_text("\n".join(code) + "\n")
    library = folder / "libstickslip.so"
    run("cc", "-g", "-shared", "-fPIC", "-I", path.parent, folder / "stub.c", "-o", library)
    return library


def constants_text():
    return "".join(f"{name} {value}\n" for name, value in header.constants().items())


# The lines of abidiff's report that speak of growth: functions added, members appended. Anything else breaks callers.
GROWTH = re.compile(r"""\s*$ | Functions\ changes | Variables\ changes | \s*Leaf
    | \d+\ (Added\ function|function\ with|functions\ with)
    | \s*\[A\]\ 'function | \s*\[C\]\ 'function
    | \s*(parameter\ \d+\ of\ type\ .*\ has\ sub-type\ changes|in\ pointed\ to\ type|in\ unqualified\ underlying\ type)
    | \s*(pointed\ to|unqualified\ underlying)\ type\ .*\ changed,\ as\ reported\ earlier$
    | \s*type\ size\ changed\ from\ \d+\ to\ \d+\ \(in\ bits\)$
    | \s*\d+\ data\ member\ insertions? | \s*'[^']*',\ at\ offset\ \d+""", re.VERBOSE)


def compare(path=header.HEADER):
    """A header against the committed description: "same", "grown" or "broken", and abidiff's report."""
    with tempfile.TemporaryDirectory() as folder:
        command = ("abidiff", "--harmless", "--no-show-locs", DUMP, stub(Path(folder), path))
        done = run(*command, accept=(0, ABIDIFF_CHANGE, ABIDIFF_CHANGE | ABIDIFF_INCOMPATIBLE))
    report = done.stdout
    committed = dict(line.split() for line in CONSTANTS.read_text().splitlines())
    now = {name: str(value) for name, value in header.constants(path).items()}
    changed = [n for n, value in committed.items() if now.get(n) != value and not n.startswith("STICKSLIP_VERSION_")]
    added = [n for n in now if n not in committed]
    report += "".join(f"constant {n}: {committed[n]} -> {now.get(n, 'removed')}\n" for n in changed)
    report += "".join(f"constant added: {n} {now[n]}\n" for n in added)
    if done.returncode & ABIDIFF_INCOMPATIBLE or changed or not all(map(GROWTH.match, done.stdout.splitlines())):
        return "broken", report
    if done.returncode or added:
        return "grown", report
    return "same", report


def check_description():
    """Nothing has changed since the description was committed; if it has, whether that breaks callers."""
    verdict, report = compare()
    if verdict == "broken":
        return fail("description: callers would BREAK", f"{report}\nSee docs/abi.md. If it is meant: a new minor version (0.x), "
                    "`make abi`, a line in CHANGELOG.md under ABI.")
    if verdict == "grown" or CONSTANTS.read_text() != constants_text():
        return fail("description: the ABI has grown", f"{report}\n`make abi` renews the description; add a line to "
                    "CHANGELOG.md under ABI.")
    print(f"ok      description: {len(header.functions())} functions and {len(header.constants())} constants as committed")
    return True


# Changes on purpose, what is replaced by what, and the verdict they must get: proof that the gate can close.
CHANGES = [
    ("a member is appended", "const int32_t *owned;\n} stickslip_surface", "const int32_t *owned;\n  double extra;\n} stickslip_surface", "grown"),
    ("a function is added", "const char *stickslip_version(void);", "const char *stickslip_version(void);\nint32_t stickslip_more(void);", "grown"),
    ("a constant is added", "#define STICKSLIP_OK 0", "#define STICKSLIP_OK 0\n#define STICKSLIP_MORE 99", "grown"),
    ("a member is inserted", "  double mu;\n", "  double extra;\n  double mu;\n", "broken"),
    ("a member is removed", "  const int32_t *owned;\n} stickslip_surface", "} stickslip_surface", "broken"),
    ("a member is renamed", "  double modulus;\n", "  double young;\n", "broken"),
    ("a member changes its type", "  int32_t form;\n", "  uint32_t form;\n", "broken"),
    ("a function is removed", "const char *stickslip_version(void);", "", "broken"),
    ("a parameter changes its type", "uint64_t struct_size);", "uint32_t struct_size);", "broken"),
    ("a constant changes its value", "#define STICKSLIP_STATE_SLIP 2", "#define STICKSLIP_STATE_SLIP 3", "broken"),
    ("a constant is removed", "#define STICKSLIP_STATE_SLIP 2", "", "broken"),
]


def check_gate():
    """The check of the description sees every kind of change."""
    original, right = header.text(), True
    for what, old, new, expected in CHANGES:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "stickslip.h"
            changed = original.replace(old, new, 1)
            path.write_text(changed)
            verdict = "not made" if changed == original else compare(path)[0]
        if verdict != expected:
            right = fail(f"gate: {what}: {verdict}, expected {expected}")
    if right:
        print(f"ok      gate: {len(CHANGES)} changes made on purpose were judged rightly")
    return right


def renew():
    if DUMP.exists():
        print(compare()[1])
    with tempfile.TemporaryDirectory() as folder:
        library = stub(Path(folder), header.HEADER)
        run("abidw", "--no-corpus-path", "--no-comp-dir-path", "--no-show-locs", "--out-file", DUMP, library)
    CONSTANTS.write_text(constants_text())
    print(f"Written: {DUMP.name}, {CONSTANTS.name}. Add a line to CHANGELOG.md under ABI.")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--library", required=True, type=Path, help="the shared library")
    parser.add_argument("--renew", action="store_true", help="write the description anew")
    arguments = parser.parse_args()
    if arguments.renew:
        renew()
    library = arguments.library.resolve()
    results = [check_symbols(library), check_dependencies(library), check_size(library), check_description(),
               check_gate()]
    sys.exit(0 if all(results) else 1)


if __name__ == "__main__":
    main()
