#!/usr/bin/env python3
"""What the documents tell a new user to type, typed in an empty place, with the time that it takes.

    newcomer.py --wheels FOLDER --out FOLDER [python|program|deal.II|MFEM|Fortran ...]

The commands are read from the documents, so one that has gone wrong is found. What is committed is cloned to OUT; the home folder
is empty but for cargo's. What the documents ask apt for has to be there. `make newcomer` makes the wheel and runs all.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import time
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# Seconds. Of the wheel from nothing to a picture; of each host and of Fortran with the library's own build.
PICTURE, HOST = 600, 1800
WHEEL_BYTES = 5_000_000
# A drawn picture; an empty one has a tenth of it.
PICTURE_BYTES = 10_000
FIXED_FORM = """      subroutine elmt01(status)
      use stickslip, only: STICKSLIP_OK
      integer status
      status = STICKSLIP_OK
      end
"""


def expect(holds, what):
    print(f"{'ok    ' if holds else 'FAILED'}  {what}", flush=True)
    if not holds:
        sys.exit(1)


def typed(lines, folder, **environment):
    """Runs lines of a document in a shell that stops at the first failure; the seconds, and what was printed."""
    print("".join(f"        $ {line}\n" for line in lines.splitlines()), end="", flush=True)
    start = time.monotonic()
    done = subprocess.run(["/bin/sh", "-ec", lines], cwd=folder, env={**os.environ, **environment}, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if done.returncode != 0:
        raise SystemExit(f"FAILED  exit code {done.returncode}\n{done.stdout[-4000:]}")
    return time.monotonic() - start, done.stdout


def blocks(document):
    """The indented blocks of a document."""
    found = re.findall(r"\n\n((?:    .*\n|\n(?=    ))+)", document.read_text())
    return [re.sub(r"(?m)^    ", "", block) for block in found]


def python(wheels, out):
    found = sorted(wheels.iterdir())
    expect(len(found) == 1, f"one file: {', '.join(path.name for path in found)}")
    wheel = found[0]
    expect(re.search(r"-py3-none-manylinux[\w.]*_x86_64\.whl$", wheel.name), "manylinux, no ABI of a Python")
    expect(wheel.stat().st_size < WHEEL_BYTES, f"{wheel.stat().st_size / 1e6:.1f} MB, below {WHEEL_BYTES / 1e6:.0f}")
    with zipfile.ZipFile(wheel) as files:
        library = b"".join(files.read(name) for name in files.namelist() if ".so" in name)
    paths = [str(ROOT), os.environ.get("CARGO_HOME", str(Path.home() / ".cargo"))]
    expect(library and not any(path.encode() in library for path in paths), "no path of this machine in the library")
    place = out / "python"
    place.mkdir()
    shutil.copy(wheel, place)
    start = time.monotonic()
    subprocess.run([sys.executable, "-m", "venv", place / "environment"], check=True)
    tools = str(place / "environment" / "bin")
    expect(not any(shutil.which(tool, path=tools) for tool in ("cc", "gcc", "cargo")), "no compiler in the PATH")
    lines = blocks(ROOT / "python" / "README.md")[0]
    typed(lines, place, PATH=tools, HOME=str(place))
    seconds = time.monotonic() - start
    expect((place / "picture.png").stat().st_size > PICTURE_BYTES, "a picture")
    expect(seconds < PICTURE, f"python: {seconds:.0f} s, below {PICTURE}")


def program(wheels, out):
    """The command of the wheel, with a compiler and PETSc of the machine."""
    place = out / "program"
    place.mkdir()
    shutil.copy(next(wheels.iterdir()), place)
    shutil.copy(ROOT / "c_examples" / "scenes" / "two_blocks.yaml", place / "scene.yaml")
    start = time.monotonic()
    subprocess.run([sys.executable, "-m", "venv", place / "environment"], check=True)
    tools = f"{place / 'environment' / 'bin'}:{os.environ['PATH']}"
    install = blocks(ROOT / "python" / "README.md")[0].splitlines()[0]
    solve = next(block for block in blocks(ROOT / "python" / "README.md") if block.startswith("stickslip "))
    _, printed = typed(f"{install}\n{solve}", place, PATH=tools, HOME=str(place), XDG_CACHE_HOME=str(place / "cache"))
    seconds = time.monotonic() - start
    expect((place / "scene_results" / "summary.json").stat().st_size > 0, f"a scene: {printed.strip().splitlines()[-1]}")
    expect(seconds < PICTURE, f"program: {seconds:.0f} s, below {PICTURE}")


class Checkout:
    """What is committed, and the library that was installed from it as hosts/README.md says."""

    def __init__(self, out):
        home = Path(os.environ["HOME"])
        self.folder = out / "stickslip"
        subprocess.run(["git", "clone", "-q", ROOT, self.folder], check=True)
        self.home = out / "home"
        self.home.mkdir()
        self.environment = {"HOME": str(self.home), "PREFIX": str(self.home / "stickslip"),
                            "CARGO_HOME": os.environ.get("CARGO_HOME", str(home / ".cargo")),
                            "RUSTUP_HOME": os.environ.get("RUSTUP_HOME", str(home / ".rustup"))}
        self.readme = self.folder / "hosts" / "README.md"
        line = re.search(r"`(make install PREFIX=[^`]*)`", self.readme.read_text())[1]
        self.seconds, _ = self.typed(line, self.folder)
        print(f"        the library: {self.seconds:.0f} s", flush=True)

    def typed(self, lines, folder):
        return typed(lines, folder, **self.environment)

    def judge(self, name, seconds):
        expect(self.seconds + seconds < HOST, f"{name}: {self.seconds + seconds:.0f} s with the library's own, below {HOST}")


def host(checkout, name):
    text = next(block for block in blocks(checkout.readme) if f"# {name}:" in block)
    lines = re.search(rf"# {name}:.*\n((?:(?!#).*\S.*\n?)+)", text)[1]
    nodes = checkout.folder / "nodes.txt"
    nodes.unlink(missing_ok=True)
    seconds, printed = checkout.typed(lines, checkout.folder)
    expect(nodes.stat().st_size > 0 and "step 4" in printed, f"{name}: {printed.strip().splitlines()[-1]}")
    checkout.judge(name, seconds)


def fortran(checkout):
    documents = checkout.home / "stickslip" / "share" / "doc" / "stickslip"
    place = checkout.home / "fortran"
    place.mkdir()
    page = documents / "docs" / "first_program.md"
    (place / "demo.f90").write_text(page.read_text().split("```fortran\n")[1].split("```")[0])
    first, printed = checkout.typed(next(block for block in blocks(page) if "demo.f90" in block), place)
    expect(printed.strip() in page.read_text(), f"Fortran, a first program: {printed.strip()}")
    # A code that has elements only: its own comment says how to build it.
    elements = documents / "c_examples" / "fortran"
    comment = (elements / "block_elements.f90").read_text().split("program block_elements")[0]
    command = re.search(r"!   (gfortran .*)\\\n!\s+(.*)\n", comment)
    second, printed = checkout.typed(f"{command[1]} {command[2]}\n./block_elements nodes.txt", elements)
    expect((elements / "nodes.txt").stat().st_size > 0, f"Fortran, elements only: {printed.strip().splitlines()[-1]}")
    # A makefile that compiles .f first.
    (place / "elmt01.f").write_text(FIXED_FORM)
    lines = next(block for block in blocks_in_lists(documents / "docs" / "feap.md") if "-J modules" in block)
    lines = "\n".join(line for line in lines.splitlines() if not line.startswith("make "))
    third, _ = checkout.typed(f"{lines}\ngfortran -O2 -Imodules -c elmt01.f", place)
    checkout.judge("Fortran", first + second + third)


def blocks_in_lists(document):
    """Indented blocks below the points of a list."""
    return [re.sub(r"(?m)^      ", "", block) for block in re.findall(r"\n\n((?:      .*\n)+)", document.read_text())]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--wheels", required=True, type=Path)
    parser.add_argument("--out", required=True, type=Path)
    parser.add_argument("names", nargs="*", default=["python", "program", "deal.II", "MFEM", "Fortran"])
    arguments = parser.parse_args()
    out = arguments.out.resolve()
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    checkout = None
    for name in arguments.names:
        if name == "python":
            python(arguments.wheels.resolve(), out)
            continue
        if name == "program":
            program(arguments.wheels.resolve(), out)
            continue
        checkout = checkout or Checkout(out)
        if name == "Fortran":
            fortran(checkout)
        else:
            host(checkout, name)


if __name__ == "__main__":
    main()
