#!/usr/bin/env python3
"""The installed tree, used as a user would: from C, C++ and Fortran, shared and static, without the checkout.

    test_install.py --build BUILD --cmake cmake tree|programs|documents|pkg_config|cmake|suites

Each group installs from BUILD into a temporary folder and moves the tree (it must work anywhere). Programs are
compiled and run with the checkout hidden, where the system lets a process hide a folder from itself (user namespaces);
the groups say so when it does not.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
# Open MPI asks for leave.
AS_ROOT = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
OTHER_LIBRARIES = re.compile(r"lib(c|m|gcc_s|gfortran|quadmath|stdc\+\+|stickslip)\.so|ld-linux|linux-vdso")


def run(*command, cwd=None, env=None):
    """Runs a command that must succeed; what it printed."""
    words = [str(word) for word in command]
    done = subprocess.run(words, cwd=cwd, env=env, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        raise SystemExit(f"FAILED  {' '.join(words)}: exit code {done.returncode}\n{done.stdout}")
    return done.stdout


def expect(holds, what):
    if not holds:
        raise SystemExit(f"FAILED  {what}")
    print(f"ok      {what}")


class Tree:
    """An installed tree that has been moved since, and a folder for a user's work."""

    def __init__(self, folder, build, cmake):
        self.build, self.cmake = build, cmake
        first = folder / "first place" / "stickslip"
        run(cmake, "--install", build, "--prefix", first)
        self.prefix = folder / "moved"
        shutil.move(first, self.prefix)
        self.work = folder / "work"
        self.work.mkdir()
        page = self.prefix / "share/doc/stickslip/docs/first_program.md"
        self.page = page.read_text()
        for language, name in (("c", "demo.c"), ("fortran", "demo.f90")):
            (self.work / name).write_text(self.page.split(f"```{language}\n")[1].split("```")[0])
        self.printed = re.search(r"it prints `([^`]*)`", self.page)[1]
        hide = ["unshare", "--map-root-user", "--mount"]
        self.can_hide = subprocess.run([*hide, "true"], capture_output=True).returncode == 0
        self.hide = hide if self.can_hide else []
        if not self.can_hide:
            print("note    the checkout cannot be hidden on this system; programs run with it in sight")

    def shell(self, line, **environment):
        """A user's command line in the work folder, with the checkout out of sight."""
        hidden = f"mount -t tmpfs none '{ROOT}' && test ! -e '{ROOT}/Cargo.toml' && " if self.can_hide else ""
        environment = {**os.environ, "PREFIX": str(self.prefix), **environment}
        return run(*self.hide, "sh", "-c", hidden + line, cwd=self.work, env=environment)

    def demo(self, line, what, **environment):
        """A command line that builds ./demo, which must print what docs/first_program.md says."""
        printed = self.shell(f"{line} && ./demo", **environment).strip()
        expect(printed == self.printed, f"{what}: {printed}")


def named_files(document, text):
    """What a document names: targets of its links, and files of docs, include and examples in code letters."""
    links = [link.split("#")[0] for link in re.findall(r"\]\(([^)\s]+)\)", text) if "://" not in link]
    words = re.findall(r"`((?:docs|include)/[\w./]+\.(?:md|h|f90)|[A-Z]+\.(?:md|cff))`", text)
    return {(document.parent / link).resolve() for link in links if link}, set(words)


PATH = re.compile(r"(?<![\w/.$<-])(?:[\w.+-]+/)+[\w.*+-]*")
OF_THE_SOURCE_TREE = re.compile(r"[Pp]aths\s+that\s+begin\s+with\s+([^.]*?)\s+are\s+those\s+of\s+the\s+source\s+tree")


def lost_paths(document, text, documents, folders):
    """Paths below the checkout's folders that are not installed, and of which the document does not say where they are."""
    told = {name for names in OF_THE_SOURCE_TREE.findall(text) for name in re.findall(r"`(\w+)`", names)}
    lost = set()
    for path in {found.rstrip("./") for found in PATH.findall(text)}:
        top = path.split("/")[0]
        there = any(any(place.glob(path)) for place in (documents, document.parent)) or top == "include"
        if top in folders and top not in told and not there:
            lost.add(path)
    return lost


def check_named_files(documents, include):
    """Every file that an installed document names is installed, too. Words are relative to the root of the checkout."""
    missing = []
    folders = {path.name for path in ROOT.iterdir() if path.is_dir()} | {"build"}
    for document in sorted(documents.rglob("*.md")):
        links, words = named_files(document, document.read_text())
        missing += [f"{document.name}: {path}" for path in lost_paths(document, document.read_text(), documents, folders)]
        missing += [f"{document.name}: {link}" for link in links if not link.exists()]
        missing += [f"{document.name}: {word}" for word in words
                    if not (documents / word).exists() and not (include / Path(word).name).exists()]
    expect(not missing, f"files that documents name are there {missing}")
    planted = named_files(documents / "a.md", "[b](gone.md#c) and `docs/gone.md`, [d](https://e.f)")
    expect([len(names) for names in planted] == [1, 1], "a file that is not there would be noticed")
    text = "Paths that begin with `src` are those of the source tree: src/lib.rs. See tests/a.c, c_examples/block_host.c and c_examples/no.c."
    lost = lost_paths(documents / "a.md", text, documents, folders)
    expect(lost == {"tests/a.c", "c_examples/no.c"}, "a path that is not there would be noticed")


def test_tree(tree):
    """Files, links, no path of the checkout or the first place in any text; the uninstall list is complete."""
    files = sorted(str(p.relative_to(tree.prefix)) for p in tree.prefix.rglob("*") if not p.is_dir())
    listed = (tree.prefix / "share/stickslip/installed.txt").read_text().splitlines()
    expect(files == sorted(listed), f"the uninstall list names the {len(files)} files that are there")
    for name in ("include/stickslip.h", "include/stickslip.hpp", "include/stickslip.f90", "lib/libstickslip.a", "lib/pkgconfig/stickslip.pc",
                 "lib/cmake/stickslip/stickslip-config.cmake", "share/doc/stickslip/docs/plug_in.md",
                 "share/doc/stickslip/docs/host_convergence.md", "share/doc/stickslip/c_examples/scenes/interface.md"):
        expect(name in files, name)
    check_named_files(tree.prefix / "share/doc/stickslip", tree.prefix / "include")
    link = tree.prefix / "lib/libstickslip.so"
    chain = [str(link.readlink()), str((link.parent / link.readlink()).readlink())]
    expect(re.fullmatch(r"libstickslip\.so\.\d+\.\d+\.\d+", chain[1]), f"libstickslip.so -> {' -> '.join(chain)}")
    for name in files:
        data = (tree.prefix / name).read_bytes()
        if name.startswith(("lib/cmake", "lib/pkgconfig", "include", "share")):
            places = [place for place in (str(ROOT), str(tree.build), "first place") if place.encode() in data]
            expect(not places, f"{name}: no path of the machine that built it")
    # As the page says: make uninstall.
    run("make", "-C", ROOT, "--no-print-directory", "uninstall", f"PREFIX={tree.prefix}")
    left = [p for p in tree.prefix.rglob("*")] if tree.prefix.exists() else []
    expect(not left, "uninstalled without a trace")
    # DESTDIR, as packagers use it.
    stage = tree.work / "stage"
    run(tree.cmake, "--install", tree.build, "--prefix", "/usr", env={**os.environ, "DESTDIR": str(stage)})
    staged = (stage / "usr/share/stickslip/installed.txt").read_text().splitlines()
    there = all((stage / "usr" / name).exists() for name in staged)
    expect(there and len(staged) == len(listed), "DESTDIR is honoured")


def test_programs(tree):
    """The programs of docs/first_program.md by its command lines, and their variants."""
    is_command = re.compile(r"    (cc demo\.c -I|gfortran .*demo\.f90 )")
    lines = [line.strip() for line in tree.page.splitlines() if is_command.match(line)]
    expect(len(lines) == 2, "the page has a command line for C and one for Fortran")
    shared = "-L$PREFIX/lib -lstickslip -Wl,-rpath,$PREFIX/lib"
    expect(shared in tree.page, "the page has the flags of the shared library")
    for line in lines:
        command = line.removesuffix(" && ./demo")
        archive = re.search(r"\$PREFIX/lib/libstickslip\.a( -l\w+)*", command)[0]
        tree.demo(command, command)
        tree.demo(command.replace(archive, shared), f"{command.split()[0]}, shared")
        needed = tree.shell("ldd ./demo")
        foreign = [line for line in needed.splitlines() if not OTHER_LIBRARIES.search(line)]
        own = f"{tree.prefix}/lib/libstickslip.so" in needed
        expect(not foreign and own, "needs only itself and the compiler's libraries")
    # The linker warns of functions of std that nothing here calls.
    command = lines[0].removesuffix(" && ./demo").replace("cc ", "cc -static ", 1)
    tree.demo(f"{command} 2>/dev/null", "C, everything static")
    # The driver is there where PETSc is: a scene by its name alone, as its page has it.
    if (tree.prefix / "bin/stickslip").exists():
        scene = "share/doc/stickslip/c_examples/scenes/patch_flat_3_4"
        tree.shell(f"$PREFIX/bin/stickslip $PREFIX/{scene}.yaml", OMPI_MCA_ess_singleton_isolated="1")
        expect((tree.work / f"{Path(scene).name}_results/summary.json").is_file(), "stickslip runs a scene")


def squeezed(text):
    """The lines of a text without indentation and empty ones."""
    return [line.strip() for line in text.splitlines() if line.strip()]


def quoted(block, sources):
    """Whether a block's lines stand together in one of the sources."""
    lines = squeezed(block)
    return any(lines == source[k:k + len(lines)] for source in sources for k in range(len(source) - len(lines) + 1))


def test_documents(tree):
    """Every code block of the guides is a program that prints what the next block says, or quotes an example."""
    compilers = {"c": ("cc -std=c99 -Wall -Wextra -Wpedantic -Werror", "block.c"),
                 "cpp": ("c++ -std=c++17 -Wall -Wextra -Wpedantic -Werror", "block.cpp"),
                 "fortran": ("gfortran -Wall $PREFIX/include/stickslip.f90", "block.f90")}
    examples = [p for suffix in ("c", "f90") for folder in ("c_examples", "program") for p in (ROOT / folder).rglob(f"*.{suffix}")]
    sources = [squeezed(p.read_text()) for p in examples]
    guide = "".join(p.read_text() for p in [ROOT / "docs/plug_in.md", *(ROOT / "docs").glob("host_*.md")])
    expect(guide.count("```c\n") >= 20 and "```fortran" in guide and "```cpp" in guide, "the guide has its code blocks")
    for document in sorted((ROOT / "docs").rglob("*.md")):
        text = document.read_text()
        for match in re.finditer(r"```(c|cpp|fortran)\n(.*?)```\n(?:\n```text\n(.*?)```)?", text, flags=re.S):
            language, block, output = match.groups()
            where = f"{document.name}, line {text[:match.start()].count(chr(10)) + 1}"
            if re.search(r"^(int main|program )", block, flags=re.M):
                compiler, name = compilers[language]
                (tree.work / name).write_text(block)
                library = "-I$PREFIX/include $PREFIX/lib/libstickslip.a -lm"
                printed = tree.shell(f"{compiler} {name} {library} -o block && ./block")
                expect(printed == output, f"{where}: the program prints what stands there")
            else:
                expect(quoted(block, sources), f"{where}: quoted from an example")


def test_pkg_config(tree):
    """pkg-config from the moved tree, shared and static, C, C++ and Fortran."""
    path = {"PKG_CONFIG_PATH": str(tree.prefix / "lib/pkgconfig")}
    rpath = "-Wl,-rpath,$PREFIX/lib"
    line = re.search(r"^    (cc demo\.c \$\(pkg-config.*) && \./demo$", tree.page, flags=re.M)[1]
    tree.demo(f"export PKG_CONFIG_PATH=$PREFIX/lib/pkgconfig; {line}", "the page's line")
    for package in ("stickslip", "stickslip-static"):
        flags = f"$(pkg-config --cflags --libs {package})"
        tree.demo(f"cc demo.c {flags} {rpath} -o demo", f"cc, {package}", **path)
        module = f"$(pkg-config --variable=fortran_module {package})"
        tree.demo(f"gfortran {module} demo.f90 {flags} {rpath} -o demo", f"gfortran, {package}", **path)
        shutil.copy(ROOT / "tests/install/consumer/main.cpp", tree.work)
        printed = tree.shell(f"c++ -std=c++17 main.cpp {flags} {rpath} -o cpp && ./cpp", **path)
        expect(printed.startswith("overlap 0.500"), f"c++, {package}: {printed.strip()}")
    if (tree.prefix / "lib/libstickslip_mpi.a").exists():
        shutil.copy(ROOT / "tests/install/consumer/mpi.c", tree.work)
        printed = tree.shell(f"mpicc mpi.c $(pkg-config --cflags --libs stickslip_mpi) {rpath} -lm -o mpi && ./mpi", **path, **AS_ROOT)
        expect("nonmortar is NULL" in printed, f"mpicc, stickslip_mpi: {printed.strip()}")
    static = tree.shell("pkg-config --static --libs stickslip", **path).split()
    native = (tree.build / "native-static-libs.txt").read_text().split()
    expect([f for f in native if f != "-lgcc_s"] == [f for f in static if f.startswith("-l") and f != "-lstickslip"],
           f"static private libraries as rustc names them: {' '.join(native)}")


def test_cmake(tree):
    """find_package from the moved tree: C, C++ and Fortran, shared and static."""
    project = tree.work / "consumer"
    shutil.copytree(ROOT / "tests/install/consumer", project)
    version = re.search(r"^## .*?(\d+)\.(\d+)\.", (ROOT / "CHANGELOG.md").read_text(), flags=re.M)
    major, minor = int(version[1]), int(version[2])
    configure = f"'{tree.cmake}' -S consumer -DCMAKE_PREFIX_PATH=$PREFIX -DFIRST_PROGRAMS={tree.work}"
    tree.shell(f"{configure} -DVERSION={major}.{minor} -B build && '{tree.cmake}' --build build")
    refused = tree.shell(f"! {configure} -DVERSION={major}.{minor + 1} -B newer 2>&1")
    expect("compatible with requested version" in refused, f"a request for version {major}.{minor + 1} is refused")
    for kind in ("stickslip", "static"):
        for language in ("c", "fortran"):
            tree.demo(f"ln -sf build/{language}_{kind} demo", f"{language}, stickslip::{kind}")
        expect(tree.shell(f"build/cpp_{kind}").startswith("overlap 0.500"), f"cpp, stickslip::{kind}")
        if (tree.prefix / "lib/libstickslip_mpi.a").exists():
            expect("nonmortar is NULL" in tree.shell(f"build/mpi_{kind}", **AS_ROOT), f"c, stickslip::mpi, stickslip::{kind}")
    loaded = tree.shell("ldd build/c_stickslip")
    expect(f"{tree.prefix}/lib/libstickslip.so" in loaded, "the shared library is the installed one")


def test_suites(tree):
    """The ABI's unit tests in C and Fortran on the installed shared library, and that they call every function."""
    folders = {}
    for suite in ("capi", "fortran"):
        source, build = ROOT / "tests" / suite, tree.work / suite
        run(tree.cmake, "-S", source, "-B", build, f"-DCMAKE_PREFIX_PATH={tree.prefix}",
            "-DSTICKSLIP_LIBRARY=stickslip::stickslip", "-DCMAKE_EXE_LINKER_FLAGS=-Wl,-z,lazy")
        run(tree.cmake, "--build", build, "--parallel", 2)
        printed = run("ctest", "--test-dir", build, "--output-on-failure", "--no-tests=error", "--parallel", 2)
        expect("100% tests passed" in printed, re.search(r"100% tests passed.*", printed)[0] + f" ({suite}, installed)")
        folders[suite] = build
    print(run(sys.executable, ROOT / "tests/abi/coverage.py", "--c", folders["capi"], "--fortran", folders["fortran"]))


GROUPS = {"tree": test_tree, "programs": test_programs, "documents": test_documents,
          "pkg_config": test_pkg_config, "cmake": test_cmake, "suites": test_suites}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", required=True, type=Path, help="the build directory to install from")
    parser.add_argument("--cmake", default="cmake")
    parser.add_argument("group", choices=GROUPS)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="stickslip-") as folder:
        GROUPS[arguments.group](Tree(Path(folder).resolve(), arguments.build.resolve(), arguments.cmake))


if __name__ == "__main__":
    main()
