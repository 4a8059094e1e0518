#!/usr/bin/env python3
"""Keeps the ABI what it is: what the library exports and needs, what the header declares, what is committed.

    check.py --library libstickslip.so            every check; the exit code says whether all hold
    check.py --library libstickslip.so --renew    writes the description anew (`make abi`), and shows what changed

The description is tests/abi/stickslip.abi (libabigail's XML: every function, struct and member as C sees them),
tests/abi/functions.txt (the declarations as they stand: abidiff does not see that two parameters of one type have changed
places) and tests/abi/constants.txt. It is made from the header, compiled with empty bodies, so that it depends on no version of
the Rust compiler; that the library is what the header says is checked here (symbols), by tests/capi/layout.rs and by tests/capi/header.rs.
"""

import argparse
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import header

HERE = Path(__file__).resolve().parent
DUMP = HERE / "stickslip.abi"
FUNCTIONS = HERE / "functions.txt"
CONSTANTS = HERE / "constants.txt"

# A library to link without a second thought: stripped it stays below this many bytes. Two million held until refusals of
# memory, the measures of equilibrium and the checks of a commit came: 2.16 million. Dual multipliers and systems without
# multipliers: 2.3 million. Normals of now, with their share of the tangent in either form: 2.37 million. Plans of the tangent, states of pairs,
# threads, searches with ends: 2.69 million. Quadratic facets in the stages of a pair: 2.8 million. In the
# handle, with a kernel of their own for the tangent: 3.3 million. Lines, pair by pair and in the handle: 3.43 million. With less
# of what plain lanes and quadratic facets unroll, and three kernels once more for the registers of AVX-512: 3.39 million.
# Rigid bodies, and frames of analytic surfaces that move: 60 thousand more.
# Offsets of nodes, whose share of a tangent is compiled apart, so that nothing is paid without them: 0.26 million.
# Laws in the place of Coulomb's: 60 thousand.
# Heat: 0.13 million.
# Points that decide: at most 90 thousand; with friction 75 thousand more. One guard for all entry points, and less that is inlined (cmake/library.cmake): 0.2 million
# less. What each feature that can be left out adds: docs/abi.md.
LARGEST = 4_000_000
# glibc's own libraries, the loader, and the one that unwinds.
ALLOWED = ("libc.so", "libm.so", "libdl.so", "librt.so", "libutil.so", "libpthread.so", "ld-linux", "libgcc_s.so")
# Bits of abidiff's exit code.
ABIDIFF_CHANGE, ABIDIFF_INCOMPATIBLE = 4, 8


def run(*command, accept=(0,), cwd=None):
    # A user's own suppressions must not hide a change.
    environment = {k: v for k, v in os.environ.items() if not k.startswith("LIBABIGAIL_")}
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, env=environment, cwd=cwd)
    if done.returncode not in accept:
        sys.exit(f"{' '.join(map(str, command))}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
    return done


def fail(what, hint=""):
    print(f"FAILED  {what}\n{hint}")
    return False


def check_symbols(library):
    """The library exports the header's functions and nothing else."""
    lines = run("nm", "-D", "--defined-only", library).stdout.splitlines()
    exported = {line.split()[-1].split("@")[0] for line in lines}
    declared = {f.name for f in header.functions()}
    if exported != declared:
        only = f"only exported: {sorted(exported - declared)}; only declared: {sorted(declared - exported)}"
        return fail("symbols", only)
    print(f"ok      symbols: {len(exported)} functions, all stickslip_*, and all of the header's")
    return True


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


# What only the machine that builds has: homes, and another place of cargo's packages than cmake/library.cmake names.
FOREIGN = re.compile(rb"/(?:home|root|Users|builds)/[\w.+~/-]+|(?<!/cargo)/registry/src/[\w.+~/-]+")


def machine_paths(content):
    """Paths of the building machine: those, and this checkout, home and cargo's folder by name."""
    places = (HERE.parents[1], Path.home(), Path(os.environ.get("CARGO_HOME", Path.home() / ".cargo")))
    names = {os.fsencode(place) + b"/" for place in places if place.name}
    return set(FOREIGN.findall(content)) | {name for name in names if name in content}


def check_paths(library):
    """No path of the building machine is in the shared or the static library."""
    planted = (os.fsencode(HERE) + b"/a.rs", b"text/home/me/a.rs", b"/srv/.cargo/registry/src/a-1.0/src/b.rs")
    if not all(map(machine_paths, planted)) or machine_paths(b"/cargo/registry/src/a-1.0/src/b.rs"):
        return fail("paths", "a path that was planted is not found, or a neutral one is")
    libraries = [library, *library.parent.glob("libstickslip.a")]
    found = {path.name: sorted(machine_paths(path.read_bytes()))[:5] for path in libraries}
    if any(found.values()):
        return fail("paths of the building machine", f"{found}; see cmake/library.cmake")
    print(f"ok      paths: none of the building machine in {', '.join(found)}")
    return True


def stub(folder, path):
    """A shared library with a header's functions and empty bodies, with debugging information."""
    code = ["#include <stickslip.h>"]
    code += [f"{f.result} {f.name}({f.parameters}) {{ return 0; }}" for f in header.functions(path)]
    (folder / "stub.c").write_text("\n".join(code) + "\n")
    library = folder / "libstickslip.so"
    # From its folder, so that no path of this machine gets into the description.
    run("cc", "-g", "-shared", "-fPIC", "-I", path.parent, "stub.c", "-o", library, cwd=folder)
    return library


def constants(path=header.HEADER):
    """Every constant but the version, which changes with every release."""
    return {n: str(v) for n, v in header.constants(path).items() if not n.startswith("STICKSLIP_VERSION_")}


def constants_text():
    return "".join(f"{name} {value}\n" for name, value in constants().items())


def functions_text():
    return "".join(f"{function}\n" for function in header.functions())


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
    now = constants(path)
    changed = [n for n, value in committed.items() if now.get(n) != value]
    added = [n for n in now if n not in committed]
    declared = {str(function) for function in header.functions(path)}
    gone = [line for line in FUNCTIONS.read_text().splitlines() if line not in declared]
    report += "".join(f"constant {n}: {committed[n]} -> {now.get(n, 'removed')}\n" for n in changed)
    report += "".join(f"constant added: {n} {now[n]}\n" for n in added)
    report += "".join(f"no longer declared so: {line}\n" for line in gone)
    if done.returncode & ABIDIFF_INCOMPATIBLE or changed or gone or not all(map(GROWTH.match, done.stdout.splitlines())):
        return "broken", report
    if done.returncode or added:
        return "grown", report
    return "same", report


def check_description():
    """Nothing has changed since the description was committed; if it has, whether that breaks callers."""
    verdict, report = compare()
    if verdict == "broken":
        return fail("description: callers would BREAK", f"{report}\nSee docs/abi.md. If it is meant: a new minor "
                    "version (0.x), `make abi`, a line in CHANGELOG.md under ABI.")
    if verdict == "grown" or CONSTANTS.read_text() != constants_text() or FUNCTIONS.read_text() != functions_text():
        return fail("description: the ABI has grown", f"{report}\n`make abi` renews the description; add a line to "
                    "CHANGELOG.md under ABI. After a release: a new minor version (docs/abi.md).")
    counts = f"{len(header.functions())} functions and {len(constants())} constants"
    print(f"ok      description: {counts} as committed")
    return True


VERSION_FUNCTION = "const char *stickslip_version(void);"
# Changes on purpose, what is replaced by what, and the verdict they must get: proof that the gate can close.
CHANGES = [
    ("a member is appended", "} stickslip_options;", "  double extra;\n} stickslip_options;", "grown"),
    ("a function is added", VERSION_FUNCTION, VERSION_FUNCTION + "\nint32_t stickslip_more(void);", "grown"),
    ("a constant is added", "#define STICKSLIP_OK 0", "#define STICKSLIP_OK 0\n#define STICKSLIP_MORE 99", "grown"),
    ("a member is inserted", "  double mu;\n", "  double extra;\n  double mu;\n", "broken"),
    ("a member is removed", "  double search_distance;\n", "", "broken"),
    ("a member is renamed", "  double modulus;\n", "  double young;\n", "broken"),
    ("a member changes its type", "  int32_t form;\n", "  uint32_t form;\n", "broken"),
    ("a function is removed", VERSION_FUNCTION, "", "broken"),
    ("a parameter changes its name (or two their places)", "const double *n_ab,\n", "const double *n_xy,\n", "broken"),
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
    FUNCTIONS.write_text(functions_text())
    print(f"Written: {DUMP.name}, {FUNCTIONS.name}, {CONSTANTS.name}. Add a line to CHANGELOG.md under ABI.")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--library", required=True, type=Path, help="the shared library")
    parser.add_argument("--renew", action="store_true", help="write the description anew")
    arguments = parser.parse_args()
    if arguments.renew:
        renew()
    library = arguments.library.resolve()
    results = [check_symbols(library), check_dependencies(library), check_size(library), check_paths(library),
               check_description(), check_gate()]
    sys.exit(0 if all(results) else 1)


if __name__ == "__main__":
    main()
