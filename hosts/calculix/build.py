#!/usr/bin/env python3
"""CalculiX 2.20 with contact pairs of the library stickslip: gets the sources, adds our lines, compiles.

    build.py --prefix WHERE_STICKSLIP_IS_INSTALLED --out FOLDER [--source FOLDER_WITH_nonlingeo.c] [--jobs N]

Without --source Debian's source package is fetched by apt-get.
The program is FOLDER/ccx_stickslip. Exit code 77: the sources cannot be had.
"""

import argparse
import re
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
NOT_THERE = 77
PACKAGE, VERSION = "calculix-ccx", "2.20"
NUMBERS = "(PairsNumbers){nactdof,ipompc,nodempc,coefmpc}"
# Our lines, each before ("-") or after ("+") every line of a file in which the words stand, and how many of these there are.
LINES = {
    "nonlingeo.c": [
        ("+", 1, '#include "mortar.h"', '#include "pairs.h"'),
        ("-", 1, "newstep=1;", f"""\
  pairs_begin(&(PairsModel){{*ntie,*nset,*ne,*ncmat_,*ntmat_,mi,*istep,tieset,set,lakon,
              jobnamec,tietol,elcon,co,istartset,iendset,ialset,kon,ipkon,nelcon,ielmat,
              *nmethod,*ithermal,ncont,*mcs,*iexpl}},{NUMBERS});"""),
        ("-", 1, "/* mortar contact */", f"      pairs_forces(b,vold,{NUMBERS});"),
        ("+", 1, 'printf("icol=%"', """\
	if(pairs_solve(ad,au,b,icol,irow,neq[0],nzs[2],nasym,*isolver)){}
	else"""),
        ("-", 1, "/* fix residuals for mortar contact", f"      pairs_forces(b,v,{NUMBERS});"),
        ("-", 1, "FORTRAN(writecvg,", "	pairs_judge(iit,&iflagact,qa);"),
        ("-", 1, "SFREE(resold);", "    pairs_end(icutb==0,iinc,*ttime+time);"),
        ("-", 2, "SFREE(v);SFREE(fn);SFREE(stn);SFREE(inum);SFREE(stx);",
         "    pairs_frd(*kode,*ttime+time,*istep,iinc,*nmethod,output);"),
    ],
    "calinput.f": [
        ("-", 1, "elseif(textpart(1)(1:12).eq.'*CONTACTPAIR') then", """\
      elseif((textpart(1)(1:12).eq.'*CONTACTPAIR').and.
     &       any(textpart(2:n)(1:14).eq.'TYPE=STICKSLIP')) then
        call stickslippairs(textpart,tieset,istep,istat,n,iline,
     &       ipol,inl,ipoinp,inp,ntie,ntie_,iperturb,matname,nmat,
     &       inpc,ipoinpc,tietol,ier)
!"""),
    ],
    "Makefile.inc": [
        ("+", 1, "SCCXF = \\", "pairs_deck.f \\"),
        ("+", 1, "SCCXC = \\", "pairs.c \\\npairs_results.c \\\npairs_sides.c \\\npairs_system.c \\"),
    ],
}
FLAGS = ["-w", "-O2", "-DARCH=Linux", "-DSPOOLES", "-DARPACK", "-DMATRIXSTORAGE", "-DUSE_MT=1", "-I/usr/include/spooles"]
LIBRARIES = ["-lspooles", "-lpthread", "-larpack", "-llapack", "-lblas", "-lm", "-lc"]


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options)
    return done.returncode == 0, done.stdout


def leave_out(why):
    print(f"left out  CalculiX: {why}")
    sys.exit(NOT_THERE)


def source_entries():
    """The system's entries of Debian's archives, for sources: lists of packages seldom name them."""
    etc = Path("/etc/apt")
    for path in sorted([*etc.glob("sources.list"), *etc.glob("sources.list.d/*.list")]):
        lines = [re.sub(r"^deb\s", "deb-src ", line) for line in path.read_text().splitlines() if re.match(r"deb\s.*/debian", line)]
        yield path.stem + ".list", "\n".join(lines) + "\n"
    for path in sorted(etc.glob("sources.list.d/*.sources")):
        entries = [entry for entry in re.split(r"\n\s*\n", path.read_text()) if re.search(r"(?m)^URIs:.*/debian", entry)]
        yield path.name, "\n\n".join(re.sub(r"(?m)^Types:.*", "Types: deb-src", entry) for entry in entries) + "\n"


def fetched(folder):
    """The folder of the sources of Debian's package."""
    archive = folder / "sources"
    found = list(archive.glob("CalculiX/*/src/nonlingeo.c"))
    if not found:
        if shutil.which("apt-get") is None:
            leave_out("its sources come from Debian by apt-get; or give --source")
        for place in (archive / "entries", archive / "lists/partial"):
            place.mkdir(parents=True, exist_ok=True)
        for name, text in source_entries():
            (archive / "entries" / name).write_text(text)
        # Lists of our own: the system's stay as they are.
        apt = ["apt-get", "-q", "-o", "Dir::Etc::sourcelist=-", "-o", f"Dir::Etc::sourceparts={archive / 'entries'}",
               "-o", f"Dir::State::lists={archive / 'lists'}", "-o", "APT::Sandbox::User="]
        for words in (["update"], ["source", "--download-only", PACKAGE]):
            good, said = run(*apt, *words, cwd=archive)
            if not good:
                leave_out(f"apt-get {' '.join(words)} fails: {said.strip().splitlines()[-1]}")
        for original in archive.glob(f"{PACKAGE}_*.orig.tar.*"):
            run("tar", "-xf", original, "-C", archive)
        found = list(archive.glob("CalculiX/*/src/nonlingeo.c"))
    if not found or VERSION not in str(found[0]):
        leave_out(f"Debian's archive is not of version {VERSION}")
    return found[0].parent


def with_our_lines(name, text):
    for place, expected, words, ours in LINES[name]:
        lines, found = [], 0
        for line in text.split("\n"):
            here = words in line
            found += here
            lines += [*([ours] if here and place == "-" else []), line, *([ours] if here and place == "+" else [])]
        if found != expected:
            raise SystemExit(f"{name} has {found} lines with {words!r} in place of {expected}: not CalculiX {VERSION}")
        text = "\n".join(lines)
    return text


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--prefix", required=True, type=Path)
    parser.add_argument("--out", required=True, type=Path)
    parser.add_argument("--source", type=Path)
    parser.add_argument("--jobs", type=int, default=1)
    arguments = parser.parse_args()
    out, prefix = arguments.out.resolve(), arguments.prefix.resolve()
    out.mkdir(parents=True, exist_ok=True)
    for library in ("spooles", "arpack", "lapack"):
        if not run("gfortran", "-x", "c", "/dev/null", "-shared", "-o", "/dev/null", f"-l{library}")[0]:
            leave_out(f"lib{library} is not installed (Debian: libspooles-dev libarpack2-dev liblapack-dev gfortran)")
    source, build = arguments.source or fetched(out), out / "src"
    if not (build / "Makefile").exists():
        shutil.copytree(source, build)
    changed = {name: with_our_lines(name, (source / name).read_text(encoding="latin-1")) for name in LINES}
    changed |= {path.name: path.read_text() for path in sorted(HERE.glob("pairs*"))}
    for name, text in changed.items():
        path = build / name
        if not path.exists() or path.read_text(encoding="latin-1") != text:
            path.write_text(text, encoding="latin-1")
            for stale in (path.with_suffix(".o"), build / f"ccx_{VERSION}"):
                stale.unlink(missing_ok=True)
            if name.endswith(".h"):
                for user in [*build.glob("pairs*.o"), build / "nonlingeo.o"]:
                    user.unlink(missing_ok=True)
    # -fallow-argument-mismatch: GNU Fortran 10 and newer.
    good, said = run("make", f"-j{arguments.jobs}", f"ccx_{VERSION}.a", f"CFLAGS={' '.join(FLAGS)} -I{prefix}/include",
                     "FFLAGS=-w -O2 -fallow-argument-mismatch", "LIBS=", cwd=build)
    if good:
        good, said = run("cc", *FLAGS, "-c", f"ccx_{VERSION}.c", cwd=build)
    if good:
        good, said = run("gfortran", "-fopenmp", "-o", out / "ccx_stickslip", f"ccx_{VERSION}.o", f"ccx_{VERSION}.a",
                         f"-L{prefix}/lib", f"-Wl,-rpath,{prefix}/lib", "-lstickslip", *LIBRARIES, cwd=build)
    if not good:
        raise SystemExit(f"FAILED  CalculiX does not compile\n{said[-4000:]}")
    print(f"ok      {out / 'ccx_stickslip'}")


if __name__ == "__main__":
    main()
