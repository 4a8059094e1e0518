"""What accuracy costs in time: `make study`.

study.py --build DIR [--quick] [--jobs N] [--only NAME...] [--renew-figures]; all goes to DIR/study: study.csv (a row
per setting), tails.csv, share.csv, one page, index.html. A run that is newer than its inputs is kept, so a study that
was stopped goes on. Every setting runs three times, the settings in turn, so that the machine's moods spread over
all; the least processor time counts, and how much more the others took is shown. --quick: coarse meshes, one run
each, no page; exits with 1 unless errors and counters have the order that they must have (times are never judged).
"""

import argparse
import csv
import math
import shutil
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "common"))
import folders  # noqa: E402  (puts the others on the path)
import bases  # noqa: E402
import cells  # noqa: E402
import study_figures  # noqa: E402
import study_page  # noqa: E402
import study_share  # noqa: E402
from scene import Driver, SceneError  # noqa: E402
from study_problems import DEFAULT, PAPER, PROBLEMS, QUIET, STANDARD  # noqa: E402
from verdict import Verdicts  # noqa: E402

ROOT = folders.ROOT
RUNS = 3
PHASES = ("search", "integration", "contact_assembly", "contact_forces", "contact_tangent", "bulk_assembly",
          "linear_solve", "total", "processor")
COUNTERS = ("bytes", "searches", "pairs_tested", "pairs_clipped", "pairs_integrated", "pairs_linearised")
# What a user may want, relative.
GOALS = (0.1, 0.01, 0.001)


class Progress:
    """A line per run: how many, since when, how much longer at this rate."""

    def __init__(self, total):
        self.start, self.total, self.done = time.monotonic(), total, 0

    def report(self, label, run, seconds):
        self.done += 1
        gone = time.monotonic() - self.start
        left = gone / self.done * (self.total - self.done)
        spent = "kept" if seconds is None else f"{seconds:.1f} s"
        failed = "" if run.exit_code == 0 else "  no answer"
        at = f"[{gone / 60:5.1f} min, {left / 60:4.1f} left] {self.done:4d}/{self.total}"
        print(f"{at} {label:<40} {spent:>8}{failed}", flush=True)


def seconds_of(run):
    seconds = run.summary["seconds"]
    return {**seconds, "processor": seconds.get("processor", math.nan)}


def solve(driver, problem, setting, repetition):
    """A run of one setting; None, and why, where it gave no answer."""
    label = f"{problem.name}/{setting.name}/{repetition}"
    try:
        lag = (f"-{problem.interface}_lag_max", 1)  # whatever normals of the last step lag by
        return driver.run(problem.scene, *lag, *problem.options, *QUIET, *setting.options, label=label), ""
    except SceneError as refused:
        return None, str(refused).splitlines()[-1]


def row_of(problem, setting, runs, driver):
    """What is recorded of one setting: the errors of its answer, the least times of its runs."""
    row = {"problem": problem.name, "setting": setting.name, "knob": setting.knob, "label": setting.short}
    found = [run for run, _ in runs if run]
    if not found:
        return {**row, "failure": next(why for _, why in runs)}
    run = min(found, key=lambda each: seconds_of(each)["processor"])
    times = [seconds_of(each)["processor"] for each in found]
    errors = problem.errors(run, setting, driver)
    row.update(error=next(iter(errors.values())), **{f"error_{name}": value for name, value in errors.items()})
    row.update(unknowns=run.summary["unknowns"], steps=len(run.steps), newton=run.newton_iterations)
    row.update(cutbacks=run.summary["cutbacks"], runs=len(times))
    row.update(seconds=min(times), spread=max(times) / min(times) - 1)
    row.update({f"seconds_{phase}": min(seconds_of(each)[phase] for each in found) for phase in PHASES})
    row.update({name: run.summary["interfaces"][problem.interface][name] for name in COUNTERS})
    return row


def sweep(driver, problems, repetitions, jobs, quick):
    """Rows of all settings; repetition by repetition."""
    work = [(p, s, k) for k in range(repetitions) for p in problems for s in p.settings(quick)]
    runs = {}
    with ThreadPoolExecutor(jobs) as pool:
        for (problem, setting, _), run in zip(work, pool.map(lambda each: solve(driver, *each), work)):
            runs.setdefault((problem.name, setting.name), []).append(run)
    return [row_of(p, s, runs[p.name, s.name], driver) for p in problems for s in p.settings(quick)]


# An error that is smaller by less than this is the same.
NOTICEABLE = 0.98


def front(rows):
    """Those that no cheaper one equals in error, from the cheapest on."""
    best, least = [], math.inf
    for row in sorted((r for r in rows if "error" in r), key=lambda r: (r["seconds"], r["error"])):
        if row["error"] < NOTICEABLE * least:
            best.append(row)
            least = row["error"]
    return best


def goals(rows):
    """Per goal the cheapest setting that reaches it; None where none does."""
    reached = [[r for r in rows if r.get("error", math.inf) <= goal] for goal in GOALS]
    return [min(found, key=lambda r: r["seconds"]) if found else None for found in reached]


def write(path, rows):
    names = list(dict.fromkeys(name for row in rows for name in row))
    with path.open("w", newline="") as file:
        table = csv.DictWriter(file, names)
        table.writeheader()
        table.writerows(rows)


def order(rows):
    """Errors and counters must have this order on any machine."""
    verdicts = Verdicts()
    at = {(r["problem"], r["setting"]): r for r in rows}
    may_fail = ("frozen_weights",)
    for row in rows:
        if row["setting"] not in may_fail:
            name = f"{row['problem']}, {row['setting']}: has an answer"
            verdicts.true(name, "error" in row, row.get("failure", "")[:60])
    if not verdicts.passed:
        return verdicts
    error = lambda problem, setting: at[problem, setting]["error"]
    falls = lambda what, less, more: verdicts.true(f"{what}: {less:.1e} < {more:.1e}", less < more, "order")
    falls("patch: 36 points beat 7", error("patch", "cells_36"), error("patch", DEFAULT))
    falls("patch: 7 points beat 3", error("patch", DEFAULT), error("patch", "cells_3"))
    falls("patch: 3 points beat 1", error("patch", "cells_3"), error("patch", "cells_1"))
    falls("patch: 10 x 10 points beat 2 x 2", error("patch", "elements_10"), error("patch", "elements_2"))
    falls("patch: cells beat any number of points", error("patch", DEFAULT), error("patch", "elements_10"))
    # The default on distorted facets: the rule's own error; a tenth of a thousandth would still be a patch test passed.
    verdicts.below("patch: default", error("patch", DEFAULT), 1e-4, "the rule's error on quadrilaterals")
    verdicts.below("patch: the paper's element", error("patch", PAPER), 1e-4, "the rule's error on quadrilaterals")
    own = lambda setting: at["hertz_line", setting]["error_multiplier"]
    falls("hertz_line: dual multipliers beat standard ones", own(DEFAULT), own(STANDARD))
    for problem in {r["problem"] for r in rows}:
        of = lambda setting: at[problem, setting]
        verdicts.true(f"{problem}: points clip nothing", of("elements_2")["pairs_clipped"] == 0, "counter")
        # Over the searches: a commit looks again at what it knows, but for the hybrid scheme, which begins anew.
        clipped = lambda setting: of(setting)["pairs_clipped"] / of(setting)["searches"]
        verdicts.true(f"{problem}: hybrid clips less than cells", clipped("hybrid_3") < clipped(DEFAULT), "counter")
        frozen = of("frozen_weights")
        if "error" in frozen:
            name = f"{problem}: frozen weights are not differentiated"
            verdicts.true(name, frozen["pairs_linearised"] == 0, "counter")
            name = f"{problem}: the exact tangent takes no more iterations than frozen weights"
            verdicts.true(name, of(DEFAULT)["newton"] <= frozen["newton"], "counter")
        meshes = [r for r in rows if r["problem"] == problem and r["knob"] in ("mesh", DEFAULT)]
        meshes.sort(key=lambda r: r["unknowns"])
        if problem != "patch":  # exact on every mesh, up to the rule; from one mesh to the next the border's place in its facet decides
            falls(f"{problem}: the finest mesh is closer than the coarsest", meshes[-1]["error"], meshes[0]["error"])
    return verdicts


def study(arguments):
    problems = [p for p in PROBLEMS if not arguments.only or p.name in arguments.only]
    output = arguments.build / ("study_quick" if arguments.quick else "study")
    output.mkdir(parents=True, exist_ok=True)
    if arguments.quick:
        problems = [p for p in problems if p.name in ("patch", "hertz_line")]
    repetitions = 1 if arguments.quick else arguments.runs
    count = repetitions * sum(len(p.settings(arguments.quick)) for p in problems)
    if not arguments.quick:
        count += study_share.count(repetitions) + bases.COUNT + cells.COUNT
    progress = Progress(count)
    driver = Driver(arguments.build, output, keep=True, report=progress.report)
    start = time.monotonic()
    rows = sweep(driver, problems, repetitions, arguments.jobs, arguments.quick)
    write(output / "study.csv", rows)
    if arguments.quick:
        verdicts = order(rows)
        cells.quick(driver, verdicts)
        verdicts.print()
        return verdicts.passed
    shares, tails = study_share.shares(driver, repetitions), study_share.tails(driver, repetitions)
    write(output / "share.csv", shares)
    write(output / "tails.csv", [{**t, "norms": " ".join(f"{n:.2e}" for n in t["norms"])} for t in tails])
    figures = [study_figures.precision(p, [r for r in rows if r["problem"] == p.name], front, output) for p in problems]
    figures += [study_figures.share(shares, output), study_figures.tails(tails, output)]
    summary = study_figures.summary(problems, rows, front, output / "accuracy.png")
    both = bases.draw(driver, output)
    figures.append(both)
    kinds, kinds_table = cells.draw(driver, output)
    figures.append(kinds)
    page = study_page.write(output, problems, rows, (shares, tails, kinds_table), (front, goals, GOALS), summary, figures,
                            (time.monotonic() - start, arguments.jobs))
    if arguments.renew_figures:
        for figure in (summary, both):
            shutil.copy(figure, folders.FIGURES / figure.name)
        cells.renew(kinds, kinds_table)
        study_page.renew(ROOT / "docs" / "accuracy.md", output / "accuracy.md")
    print(f"{page.resolve()}\n{(output / 'study.csv').resolve()}")
    return True


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, required=True, help="CMake's build tree")
    parser.add_argument("--quick", action="store_true", help="coarse meshes, one run each: checks the order of errors")
    parser.add_argument("--jobs", type=int, default=1, help="runs at the same time; they disturb each other's times")
    parser.add_argument("--runs", type=int, default=RUNS, help="runs of each setting")
    parser.add_argument("--only", nargs="+", choices=[p.name for p in PROBLEMS], help="these problems alone")
    parser.add_argument("--renew-figures", action="store_true", help="renew docs/accuracy.md and the figures too")
    try:
        return 0 if study(parser.parse_args()) else 1
    except SceneError as problem:
        print(f"\n{problem}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
