#!/usr/bin/env python3
"""The Fortran module says what the C header says, all of it, in the same order: constants, types, functions.

    fortran_probe.py --include DIR [--cc cc] [--fortran gfortran]

DIR holds stickslip.h and stickslip.f90. Values, sizes and offsets are those of the two compilers: a C and a Fortran
program are generated from the header, and must print the same. Members and arguments are compared by the C declarations
that gfortran makes of the module (-fc-prototypes), names and const included; a `type(c_ptr)` stands for any pointer.
"""

import argparse
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import header

# The module must be plain Fortran 2003.
STRICT = ["-std=f2003", "-Wall", "-Wextra", "-pedantic", "-Werror", "-fimplicit-none"]
# C's integers as gfortran's prototypes have them; Fortran's have a sign.
INTEGERS = {"int": "int32_t", "long": "int64_t", "long long": "int64_t", "uint64_t": "int64_t"}
# Of a compiler's complaints the first ones tell what is wrong.
MOST_TEXT = 1500
# Handles are pointers to what C does not show; the module wraps each pointer in a type.
HANDLES = ("stickslip_interface", "stickslip_rigid", "stickslip_skin")
# The one type of functions of the host's; a `type(c_funptr), value` in the module.
FUNCTION_TYPE = "stickslip_threshold"


def run(*command, cwd):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, cwd=cwd)
    if done.returncode != 0:
        complaint = (done.stderr or done.stdout)[:MOST_TEXT]
        sys.exit(f"{' '.join(map(str, command))}: exit code {done.returncode}\n{complaint}")
    return done.stdout


def structs(code):
    """Name -> members of every struct in C's text, each as (const, type, stars, name, number of entries)."""
    return {name: [member(line) for line in body.splitlines()]
            for name, body in re.findall(r"typedef struct (\w+) \{\n(.*?)\n\} \1;", code, flags=re.S)}


def member(line):
    declaration, count = re.fullmatch(r"\s*([^;\[]+)(?:\[(\d+)\])?;", line).groups()
    return *normal(declaration), int(count or 1)


def names(members):
    return [name for _, _, _, name, _ in members]


def real_among(constants):
    """Tells which are real numbers, of which the programs print the bits."""
    return lambda name: isinstance(constants[name], float)


# The programs print for each type its size three times: in Fortran it comes from the compiler, from the module's
# constant, and from the type's default value.
def c_probe(constants, types):
    is_real = real_among(constants)
    lines = ["#include <stddef.h>", "#include <stdio.h>", "#include <string.h>", "#include <stickslip.h>",
             "int main(void) {"]
    lines += [f'  printf("{name} %d\\n", {name});' for name in constants if not is_real(name)]
    lines += [f'  {{ const double v = {name}; long long bits; memcpy(&bits, &v, sizeof v); printf("{name} %lld\\n", bits); }}'
              for name in constants if is_real(name)]
    for name, members in types.items():
        lines += [f'  printf("{name} %d %d %d\\n", (int)sizeof({name}), (int)sizeof({name}), (int)sizeof({name}));']
        lines += [f'  printf("{name}.{m} %d %d\\n", (int)offsetof({name}, {m}), (int)sizeof((({name} *)0)->{m}));'
                  for m in names(members)]
    lines += [f'  printf("{handle} %d\\n", (int)sizeof({handle} *));' for handle in HANDLES]
    lines += ["  return 0;", "}"]
    return "\n".join(lines) + "\n"


def fortran_probe(constants, types):
    is_real = real_among(constants)
    lines = ["program probe", "  use, intrinsic :: iso_c_binding", "  use stickslip", "  implicit none"]
    lines += [f"  type({name}), target :: v_{name}" for name in types]
    lines += [f"  type({handle}) :: h_{handle}" for handle in HANDLES]
    lines += [f"  write (*, '(a, i0)') '{name} ', {name}" for name in constants if not is_real(name)]
    lines += [f"  write (*, '(a, i0)') '{name} ', transfer({name}, 0_c_int64_t)" for name in constants if is_real(name)]
    for name, members in types.items():
        v = f"v_{name}"
        lines += [f"  write (*, '(a, 3(1x, i0))') '{name}', c_sizeof({v}), {name}_size, {v}%struct_size"]
        lines += [f"  write (*, '(a, 2(1x, i0))') '{name}.{m}', &\n"
                  f"    address(c_loc({v}%{m})) - address(c_loc({v})), c_sizeof({v}%{m})" for m in names(members)]
    lines += [f"  write (*, '(a, i0)') '{handle} ', c_sizeof(h_{handle})" for handle in HANDLES]
    lines += ["contains",
              "  integer(c_intptr_t) function address(p)", "    type(c_ptr), intent(in) :: p",
              "    address = transfer(p, address)", "  end function", "end program"]
    return "\n".join(lines) + "\n"


def code_of(module):
    """The module without comments."""
    return "\n".join(line.split("!")[0].rstrip() for line in module.read_text().splitlines())


def declared_in(module):
    """Constants, types and functions that the module's source declares, in its order."""
    code = code_of(module)
    constants = re.findall(r"\bparameter\s*::\s*(\w+)", code, flags=re.I)
    types = re.findall(r"^\s*type\s*,\s*bind\(C\)\s*::\s*(\w+)", code, flags=re.I | re.M)
    functions = re.findall(r"\bfunction\s+(stickslip_\w+)\s*\(", code, flags=re.I)
    return constants, types, functions


def normal(text):
    """An argument's or result's type and name in one spelling: const, type, stars, name."""
    text = " ".join(text.replace("struct ", "").replace("*", " * ").split())
    match = re.fullmatch(r"(const )?(long long|\w+)((?: \*)*)(?: (\w+))?", text)
    if not match:
        sys.exit(f"cannot read the C declaration '{text}'")
    const, kind, stars, name = match.groups()
    return bool(const), INTEGERS.get(kind, kind), stars.count("*"), name


def split(parameters):
    return [normal(p) for p in parameters.split(",") if p.strip() not in ("", "void")]


def agrees(c, fortran):
    """Whether the header's declaration and the one made of the module's mean the same to a compiler."""
    const, kind, stars, name = c
    f_const, f_kind, f_stars, f_name = fortran
    if name != f_name:
        return False
    if kind in HANDLES:
        return (f_kind, f_stars) == (kind, stars - 1)
    if f_kind == "void":
        return stars == f_stars == 1
    return (const, kind, stars) == (f_const, f_kind, f_stars)


def compare_members(types, f_types):
    """Complaints about the members of types. Pointers are all alike in Fortran, so they may differ in const."""
    for name, members in types.items():
        theirs = f_types.get(name, [])
        yield from compare_names(name, names(members), names(theirs))
        yield from (f"{name}.{c[3]}: {c} in C, {fortran} in Fortran" for c, fortran in zip(members, theirs)
                    if not agrees(c[:4], fortran[:4]) or c[4] != fortran[4])


def compare_functions(path, prototypes):
    """Complaints about results and arguments."""
    prototypes = re.sub(r"int \(\*(\w+)\)\(\)", rf"{FUNCTION_TYPE} \1", prototypes)
    declaration = re.compile(r"^(\w+ \*?)(stickslip_\w+) \(([^)]*)\);", flags=re.M)
    found = {name: (result, parameters) for result, name, parameters in declaration.findall(prototypes)}
    for f in header.functions(path):
        if f.name not in found:
            yield f"{f.name} is not in the module"
            continue
        result, parameters = found[f.name]
        if not agrees(normal(f.result), normal(result)):
            yield f"{f.name}: result {f.result} in C, {result} in Fortran"
        ours, theirs = split(f.parameters), split(parameters)
        if len(ours) != len(theirs) or not all(agrees(c, fortran) for c, fortran in zip(ours, theirs)):
            yield f"{f.name}:\n    C        {f.parameters}\n    Fortran  {parameters}"


def pointers_by_reference(module):
    """Complaints about pointers that are not passed by value: gfortran's prototypes do not tell them apart."""
    arguments = code_of(module).split("\n  interface\n")[1]
    for declaration in re.findall(r"type\(c_ptr\)(?!,\s*value\s*::)(?!\s*function)[^\n]*", arguments, flags=re.I):
        yield f"'{declaration}' needs the VALUE attribute"


def compare_names(what, ours, theirs):
    """Complaints about names that one side lacks, or another order."""
    if ours != theirs:
        missing, surplus = [n for n in ours if n not in theirs], [n for n in theirs if n not in ours]
        yield f"{what}: not in the module: {missing}; not in the header: {surplus}" if missing or surplus else \
            f"{what}: another order than the header's"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--include", required=True, type=Path)
    parser.add_argument("--cc", default="cc")
    parser.add_argument("--fortran", default="gfortran")
    arguments = parser.parse_args()
    c_header, module = arguments.include.resolve() / "stickslip.h", arguments.include.resolve() / "stickslip.f90"

    constants, types = header.constants(c_header), structs(header.text(c_header))
    functions = [f.name for f in header.functions(c_header)]
    if not (constants and types and functions):
        sys.exit("the header could not be read")
    f_constants, f_types, f_functions = declared_in(module)
    sizes = [f"{name}_size" for name in types]
    complaints = [*compare_names("constants", list(constants), [n for n in f_constants if n not in sizes]),
                  *compare_names("constants of sizes", sizes, [n for n in f_constants if n in sizes]),
                  *compare_names("types", [*HANDLES, *types], f_types),
                  *compare_names("functions", functions, f_functions),
                  *pointers_by_reference(module)]

    with tempfile.TemporaryDirectory() as folder:
        prototypes = run(arguments.fortran, "-fc-prototypes", "-fsyntax-only", module, cwd=folder)
        complaints += [*compare_members(types, structs(prototypes)), *compare_functions(c_header, prototypes)]
        if not complaints:
            run(arguments.fortran, *STRICT, "-c", module, "-o", "module.o", cwd=folder)
            Path(folder, "c.c").write_text(c_probe(constants, types))
            Path(folder, "f.f90").write_text(fortran_probe(constants, types))
            run(arguments.cc, "-I", arguments.include.resolve(), "c.c", "-o", "c", cwd=folder)
            run(arguments.fortran, "-std=f2018", "-ffree-line-length-none", "f.f90", "-o", "f", cwd=folder)
            c_lines, f_lines = run("./c", cwd=folder).splitlines(), run("./f", cwd=folder).splitlines()
            complaints += [f"C has {c}, Fortran {f}" for c, f in zip(c_lines, f_lines) if c != f]
            if len(c_lines) != len(f_lines):
                complaints.append("the probes printed different numbers of lines")
    if complaints:
        sys.exit("\n".join(complaints))
    members = sum(len(m) for m in types.values())
    print(f"ok: {len(constants)} constants, {len(types)} types with {members} members, {len(functions)} functions")


if __name__ == "__main__":
    main()
