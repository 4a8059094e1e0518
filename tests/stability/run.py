"""The stability matrix: hard cases x severity, every cell a run that is compared with an exact or refined answer.

run.py --build DIR [--jobs N] [--quick] [--only FILE...] [--kind KIND] [--basis BASIS]
       [--normals NORMALS] [--ranks N] [--again] [--renew-figures]

Each cell runs in a process of its own, so that a crash or a hang is that cell's verdict and no end of the matrix.
What it found goes to DIR/stability/cells/CELL.json; one that is newer than the programs and than the sources of its
case is kept. Report: DIR/stability/index.html, its tables and heat maps beside it. Exits with 1 if a cell is wrong or
a line that must hold does not.
"""

import argparse
import importlib
import json
import multiprocessing
import multiprocessing.connection
import os
import signal
import sys
import time
import traceback
from dataclasses import asdict
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import cell as cells  # noqa: E402
import must_hold  # noqa: E402
import report  # noqa: E402
from host import RANKS, Context, matrix_folder  # noqa: E402
from library import BASES, BASIS, NORMALS, NORMALS_OF  # noqa: E402

# A cell that takes longer hangs: the slowest takes some two minutes alone.
HANGS = 600.0  # seconds
SHARED = ("cell.py", "condition.py", "host.py", "library.py", "meshes.py", "oracle.py", "scenes.py")


# Of files with cases.
NAMES = sorted(path.stem for path in (HERE / "cases").glob("[a-z]*.py"))


def families():
    """name of the file -> its cells, in the files' order. Some ask which multipliers and normals the matrix is about."""
    return {name: list(importlib.import_module(f"cases.{name}").cells()) for name in NAMES}


def work(cell, context, path):
    """In the cell's own process."""
    os.setpgrp()  # so that its children can be ended with it
    os.environ["OMP_NUM_THREADS"] = "1"
    start = time.monotonic()
    try:
        outcome = cell.run(context)
        verdict, why = cells.verdict(cell, outcome)
    except Exception as problem:  # whatever it was, the cell has no answer
        outcome, verdict = cells.Outcome(), cells.WRONG
        why = f"{type(problem).__name__}: {problem}\n{traceback.format_exc()}"
    store(cell, outcome, verdict, why, time.monotonic() - start, path)


def store(cell, outcome, verdict, why, seconds, path):
    result = {
        "case": cell.case,
        "severity": cell.severity,
        "level": cell.level,
        "kind": cell.kind,
        "quick": cell.quick,
    }
    result |= {"verdict": verdict, "why": why, "seconds": seconds, **asdict(outcome)}
    partial = path.with_suffix(".part")
    partial.write_text(json.dumps(result, indent=1, default=float) + "\n")
    partial.replace(path)


class Matrix:
    def __init__(self, build, jobs, chosen, again):
        self.build, self.jobs, self.chosen = build, jobs, chosen
        self.folder = build / matrix_folder() / "cells"
        self.folder.mkdir(parents=True, exist_ok=True)
        self.programs = [build / "program" / "stickslip", build / "lib" / "libstickslip.so"]
        self.again, self.start, self.done = again, time.monotonic(), 0

    def path(self, cell):
        return self.folder / f"{cell.label}.json"

    def is_kept(self, family, cell):
        if self.again or not self.path(cell).is_file():
            return False
        made = self.path(cell).stat().st_mtime
        sources = [HERE / "cases" / f"{family}.py", *(HERE / name for name in SHARED), *self.programs]
        return all(source.stat().st_mtime < made for source in sources)

    def say(self, cell, kept):
        result = json.loads(self.path(cell).read_text())
        self.done += 1
        minutes, seconds = divmod(int(time.monotonic() - self.start), 60)
        iterations = "" if result["iterations"] is None else f"{result['iterations']} iterations"
        spent = "kept" if kept else f"{result['seconds']:.1f} s"
        line = f"[{minutes:3d}:{seconds:02d}] {self.done:4d}/{len(self.chosen)}  {cell.case:<44} {cell.severity:<12}"
        print(f"{line} {result['verdict']:<8} {iterations:>15} {spent:>8}", flush=True)
        if result["verdict"] == cells.WRONG:
            print(f"          {result['why']}", flush=True)

    def run(self):
        """Every chosen cell that is not kept."""
        waiting = []
        for family, cell in self.chosen:
            if self.is_kept(family, cell):
                self.say(cell, True)
            else:
                self.path(cell).unlink(missing_ok=True)  # an old result must never be read as a new one
                waiting.append(cell)
        self.running = {}
        try:
            self.work_off(waiting)
        finally:  # interrupted: nothing goes on alone
            for process, _, _ in self.running.values():
                os.killpg(process.pid, signal.SIGKILL)

    def work_off(self, waiting):
        running = self.running
        while waiting or running:
            while waiting and len(running) < self.jobs:
                cell = waiting.pop(0)
                process = multiprocessing.Process(
                    target=work, args=(cell, Context(self.build, cell.label), self.path(cell))
                )
                process.start()
                running[process.sentinel] = (process, cell, time.monotonic())
            multiprocessing.connection.wait(list(running), timeout=1)
            for sentinel, (process, cell, start) in list(running.items()):
                hangs = time.monotonic() - start > HANGS
                if process.is_alive() and not hangs:
                    continue
                if process.is_alive():
                    os.killpg(process.pid, signal.SIGKILL)
                process.join()
                del running[sentinel]
                if not self.path(cell).is_file():
                    why = f"no end after {HANGS:g} s" if hangs else f"its process ended with {process.exitcode}"
                    store(cell, cells.Outcome(), cells.WRONG, why, time.monotonic() - start, self.path(cell))
                self.say(cell, False)

    def forget_others(self):
        """Cells that the matrix no longer has."""
        kept = {self.path(cell) for _, cell in self.chosen}
        for path in self.folder.glob("*.json"):
            if path not in kept:
                path.unlink()

    def results(self):
        return [json.loads(self.path(cell).read_text()) for _, cell in self.chosen]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, required=True, help="CMake's build tree")
    parser.add_argument("--jobs", type=int, default=1, help="cells at the same time")
    parser.add_argument("--quick", action="store_true", help="the short run alone")
    parser.add_argument("--only", nargs="+", choices=NAMES, metavar="FILE", help=f"of {', '.join(NAMES)}")
    parser.add_argument(
        "--kind", choices=(cells.SCENE, cells.ELEMENT), help="cells of the driver, or of single calls"
    )
    parser.add_argument("--basis", choices=BASES, help="of the multipliers, where a cell says nothing, for the library's choice; a report of its own")
    parser.add_argument("--normals", choices=NORMALS_OF, help="the same of the normals, where weights are not frozen")
    parser.add_argument("--ranks", type=int, help="of the driver, where they are not 1: cells of single calls are left out; a report of its own")
    parser.add_argument("--again", action="store_true", help="keep nothing")
    parser.add_argument("--renew-figures", action="store_true", help="renew the committed figures too; all cells only")
    arguments = parser.parse_args()
    if arguments.basis:
        os.environ[BASIS] = arguments.basis
    if arguments.normals:
        os.environ[NORMALS] = arguments.normals
    if arguments.ranks:
        os.environ[RANKS] = str(arguments.ranks)
        arguments.kind = cells.SCENE
    if arguments.renew_figures and (arguments.quick or arguments.only or arguments.kind):
        parser.error("--renew-figures wants the whole matrix")

    every = families()
    chosen = [
        (family, cell)
        for family, of_family in every.items()
        if not arguments.only or family in arguments.only
        for cell in of_family
        if (cell.quick or not arguments.quick) and arguments.kind in (None, cell.kind)
    ]
    signal.signal(signal.SIGTERM, lambda *_: sys.exit("terminated"))
    matrix = Matrix(arguments.build.resolve(), arguments.jobs, chosen, arguments.again)
    matrix.run()
    if len(chosen) == sum(map(len, every.values())):
        matrix.forget_others()
    results = matrix.results()
    lines = must_hold.lines(results)
    name = "some" if arguments.only else "index"
    if arguments.quick or arguments.kind:
        name = "_".join(["quick"] * arguments.quick + [arguments.kind] * bool(arguments.kind))
    page = report.write(matrix.build / matrix_folder(), name, results, lines, arguments.renew_figures)
    print(report.summary(results, lines))
    if page:
        print(f"written: {page}")
    wrong = any(result["verdict"] == cells.WRONG for result in results)
    return 1 if wrong or not all(line.holds for line in lines) else 0


if __name__ == "__main__":
    sys.exit(main())
