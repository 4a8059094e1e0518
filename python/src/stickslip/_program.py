"""The command ``stickslip``, which solves scenes: built once from the sources in this package, where PETSc and a compiler are.

A wheel cannot bring the program itself, for it is linked with the PETSc and the MPI of the machine. It brings the library, which
the program is linked with, and the program's sources, which take a minute to compile.
"""

import fcntl
import hashlib
import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from ._library import HEADER, _path

_HERE = Path(__file__).resolve().parent
#: What pkg-config calls what the program needs, by what Debian calls it.
_PACKAGES = {"PETSc >= 3.18": "petsc-dev", "libcjson": "libcjson-dev", "yaml-0.1": "libyaml-dev"}
_FLAGS = ("-std=c11", "-DNDEBUG", "-D_POSIX_C_SOURCE=200809L")
#: Further ones, as of other C programs; CFLAGS of the environment takes their place.
_OPTIMISED = "-O2"


class Missing(Exception):
    """What the machine lacks, with what to install."""


def _sources() -> Path:
    """Of the wheel, or the checkout's."""
    places = [_HERE / "program", _HERE.parents[2] / "program"]
    for place in places:
        if (place / "main.c").exists():
            return place
    raise Missing(f"the program's sources are not in {' or '.join(map(str, places))}")


def _said(*command: str) -> list[str]:
    """The words that a command prints."""
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.split()


def _needs() -> tuple[list[str], list[str]]:
    """The flags of compiler and linker for all that the program stands on."""
    tools = {"pkg-config": "pkg-config", "mpicc": "libopenmpi-dev"}
    missing = {tool: package for tool, package in tools.items() if not shutil.which(tool)}
    if "pkg-config" not in missing:
        found = {name: subprocess.run(["pkg-config", "--exists", name], check=False).returncode == 0 for name in _PACKAGES}
        missing |= {name: package for name, package in _PACKAGES.items() if not found[name]}
    if missing:
        raise Missing(f"the program needs {', '.join(missing)}, and does not find {'them' if len(missing) > 1 else 'it'}; on Debian: "
                      f"apt install {' '.join(missing.values())} liblapack-dev")
    names = list(_PACKAGES)
    flags = _said("pkg-config", "--cflags", *names)
    if subprocess.run(["pkg-config", "--exists", "hdf5-mpi"], check=False).returncode == 0:
        flags += [*_said("pkg-config", "--cflags", "hdf5-mpi"), "-DSTICKSLIP_PROGRAM_HDF5"]
    return flags, [*_said("pkg-config", "--libs", *names), "-llapack", "-lblas", "-lm"]


def _compile(sources: Path, folder: Path) -> None:
    """Compiles all files, and links them with this package's library."""
    flags, libraries = _needs()
    assert HEADER is not None
    files = sorted(path for path in sources.rglob("*.c") if "tests" not in path.relative_to(sources).parts)
    optimised = os.environ.get("CFLAGS", _OPTIMISED).split()
    objects = [folder / f"{k}.o" for k in range(len(files))]
    flags = [*_FLAGS, *optimised, f"-I{sources}", f"-I{HEADER.parent}", *flags]

    def one(k: int) -> None:
        done = subprocess.run(["mpicc", *flags, "-c", str(files[k]), "-o", str(objects[k])], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise Missing(f"{files[k]} does not compile:\n{done.stderr[-2000:]}")

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for count, _ in enumerate(pool.map(one, range(len(files))), 1):
            if count % 20 == 0 or count == len(files):
                print(f"\rstickslip: the program is built, once: {count} of {len(files)} files", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    # The loader looks for the library by its soname.
    soname = next(word for word in _said("readelf", "-d", _path()) if word.startswith("[libstickslip"))
    (folder / soname.strip("[]")).symlink_to(Path(_path()).resolve())
    link = ["mpicc", "-o", str(folder / "linked"), *map(str, objects), _path(), f"-Wl,-rpath,{folder}", *libraries]
    done = subprocess.run(link, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise Missing(f"the program cannot be linked:\n{done.stderr[-2000:]}")
    for path in objects:
        path.unlink()
    (folder / "linked").rename(folder / "stickslip")


def _folder(sources: Path) -> Path:
    """Where the program of these sources and this library is kept."""
    known = hashlib.sha256()
    for path in [*sorted(sources.rglob("*.[ch]")), Path(_path())]:
        known.update(path.read_bytes())
    cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return cache / "stickslip" / known.hexdigest()[:16]


def program() -> Path:
    """The program, built if it is not there. One process builds it, others wait.

    Raises:
        Missing: what the machine lacks.
    """
    sources = _sources()
    folder = _folder(sources)
    made = folder / "stickslip"
    if made.exists():
        return made
    folder.parent.mkdir(parents=True, exist_ok=True)
    with open(folder.parent / f"{folder.name}.lock", "w", encoding="ascii") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not made.exists():
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir()
            _compile(sources, folder)
    return made


def main(arguments: Sequence[str] | None = None) -> None:
    """Becomes the program."""
    try:
        made = str(program())
    except (Missing, OSError) as error:
        print(f"stickslip: {error}", file=sys.stderr)
        raise SystemExit(1) from None
    os.execv(made, [made, *(sys.argv[1:] if arguments is None else arguments)])


if __name__ == "__main__":
    main()
