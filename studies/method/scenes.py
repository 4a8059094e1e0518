"""Every scene with the library's default and with the paper's element: `make method`.

scenes.py --build DIR [--jobs N] [--only SCENE...] [--renew]; results go to DIR/method: scenes.csv (a row per scene), index.md. A
run that is newer than its inputs is kept, so that what was stopped goes on. Per scene: Newton iterations, those of failed attempts
included, cut-backs, exit code, warnings, and, where there is something to compare with (references.py), the error. --renew writes the
digest into docs/method.md. What comes out is told, not judged: exits with 1 only if a tool fails.
"""

import argparse
import csv
import math
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "common"))
import folders  # noqa: E402  (puts the others on the path)
import friction_checks as friction  # noqa: E402
import ironing  # noqa: E402
from documents import put_between  # noqa: E402
from references import REFERENCES, moved_border  # noqa: E402
from scene import SCENES, Driver, SceneError, interfaces  # noqa: E402

DOCUMENT, MARKS = folders.ROOT / "docs" / "method.md", ("<!-- scenes -->\n", "<!-- /scenes -->\n")
METHODS = {"default": (), "paper": ("-method", "paper")}
# Of these both runs would take more than six minutes: a coarser mesh, or fewer steps.
COARSER = {
    "shallow_ironing": (*ironing.COARSE, "-steps_stages", "1,10,1.5,125"),
    "torsion": (*friction.TORSION_COARSE.options(0), "-steps_times", friction.TORSION_COARSE.times),
}
# The error of these hangs on where in its facet the border of the contact lies: of several loads, too.
LOADED = ("hertz_line_coarse", "hertz_line_fine")
QUIET = ("-output_vtu", "none", "-output_quiet", "true")
WARNS = "stickslip: warning:"
# Below this an answer is exact: Newton's tolerance and rounding. Above: what errors may grow by before a scene is named.
EXACT, MORE = 1e-7, 1.05
MOST = 5  # scenes in which the paper's element takes most more, which would hide the others in a sum
COLUMNS = ("exit", "iterations", "cutbacks", "warnings", "error")


class Progress:
    """A line per run. Those that answers are compared with come on top of the total."""

    def __init__(self, total):
        self.start, self.total, self.done, self.lock = time.monotonic(), total, 0, threading.Lock()

    def report(self, label, run, seconds):
        with self.lock:
            self.done += not label.startswith("reference/")
            gone = (time.monotonic() - self.start) / 60
            spent = "kept" if seconds is None else f"{seconds:.1f} s"
            print(f"[{gone:5.1f} min] {self.done:4d}/{self.total} {label:<40} exit code {run.exit_code} {spent:>9}", flush=True)


def measure(driver, scene, method):
    """The figures of one run."""
    options = METHODS[method] if interfaces(scene) else ()  # where nothing touches, nothing reads it
    run = driver.run(scene, *COARSER.get(scene, ()), *QUIET, *options, label=f"{method}/{scene}", expect=None)
    failed = sum(attempt["newton_iterations"] for attempt in run.summary.get("failed_attempts", ()))
    found = {"exit": run.exit_code, "warnings": run.text.count(WARNS), "iterations": "", "cutbacks": "", "error": ""}
    if run.summary:
        found.update(iterations=run.newton_iterations + failed, cutbacks=run.summary["cutbacks"])
    if run.exit_code == 0 and scene in REFERENCES:
        found["error"] = float(REFERENCES[scene][1](run, driver))
    return found


def row_of(driver, scene):
    row = {"scene": scene, "compared": REFERENCES.get(scene, ("",))[0], "coarser": scene in COARSER}
    for method in METHODS:
        row.update({f"{key}_{method}": value for key, value in measure(driver, scene, method).items()})
    return row


def over_loads(driver, scene):
    """Errors at loads that move the border through a facet, by method."""
    loads, found = moved_border(driver, scene), {}
    for method, options in METHODS.items():
        runs = [driver.run(scene, *QUIET, *options, *load, label=f"{method}/loads/{scene}_{k}") for k, load in enumerate(loads)]
        found[method] = [REFERENCES[scene][1](run, driver) for run in runs]
    return found


def loads_text(loaded):
    return [f"- **{scene} at {len(found['default'])} loads** that move the border through a facet: mean "
            + " / ".join(error_text(sum(found[method]) / len(found[method])) for method in METHODS) + ", worst "
            + " / ".join(error_text(max(found[method])) for method in METHODS) + "."
            for scene, found in loaded.items()]


def pair(row, key):
    return [row[f"{key}_{method}"] for method in METHODS]


def grown(row):
    """Error over the paper's; None where there is none to compare."""
    ours, theirs = pair(row, "error")
    if "" in (ours, theirs):
        return None
    return 1.0 if max(ours, theirs) < EXACT else ours / theirs if theirs else math.inf


def error_text(value):
    return "-" if value == "" else "exact" if value < EXACT else f"{100 * value:.2g} %" if value >= 1e-4 else f"{value:.0e}"


def table(rows):
    lines = ["| scene | iterations | cut-backs | exit code | warnings | compared | error |", "|---|---:|---:|---:|---:|---|---:|"]
    for row in rows:
        both = lambda key, text=str: " / ".join(text(value) for value in pair(row, key))
        name = row["scene"] + (" (coarser)" if row["coarser"] else "")
        error = both("error", error_text) if row["compared"] else "-"
        lines.append(f"| {name} | {both('iterations')} | {both('cutbacks')} | {both('exit')} | {both('warnings')} | {row['compared'] or '-'} | {error} |")
    return lines


def digest(rows, loaded):
    """Sums, one of them without those scenes in which the paper's element takes most more, and by name the scenes in which something grew or shrank."""
    solved = [row for row in rows if pair(row, "exit") == [0, 0]]
    sums = {key: [sum(values) for values in zip(*(pair(row, key) for row in solved))] for key in ("iterations", "cutbacks", "warnings")}
    ours, theirs = sums["iterations"]
    compared = [row for row in solved if grown(row) is not None]
    names = lambda chosen, text: ", ".join(f"{row['scene']} ({text(row)})" for row in chosen) or "none"
    counts = lambda key: lambda row: "{} / {}".format(*pair(row, key))
    errors = lambda row: " / ".join(error_text(value) for value in pair(row, "error"))
    more = [row for row in solved if pair(row, "iterations")[0] > pair(row, "iterations")[1]]
    more.sort(key=lambda row: pair(row, "iterations")[1] - pair(row, "iterations")[0])
    cut = [row for row in solved if pair(row, "cutbacks")[0] > pair(row, "cutbacks")[1]]
    told = [row for row in solved if pair(row, "warnings")[0] > pair(row, "warnings")[1]]
    worse = sorted((row for row in compared if grown(row) > MORE), key=lambda row: -grown(row))
    better = sorted((row for row in compared if grown(row) < 1 / MORE), key=grown)
    ended = [row for row in rows if pair(row, "exit") != [0, 0]]
    most = sorted(solved, key=lambda row: pair(row, "iterations")[0] - pair(row, "iterations")[1])[:MOST]
    left = [sum(pair(row, "iterations")[k] for row in solved if row not in most) for k in (0, 1)]
    said = [
        f"| {len(solved)} scenes | default | paper | default over paper |", "|---|---:|---:|---:|",
        f"| Newton iterations | {ours} | {theirs} | {ours / theirs:.2f} |" if theirs else "| Newton iterations | 0 | 0 | |",
        *([f"| the same without {', '.join(row['scene'] for row in most)} | {left[0]} | {left[1]} | {left[0] / left[1]:.2f} |"] if left[1] else []),
        "| cut-backs | {} | {} | |".format(*sums["cutbacks"]),
        "| warnings | {} | {} | |".format(*sums["warnings"]),
        f"| larger error, by more than {MORE - 1:.0%} | {len(worse)} of {len(compared)} | {len(better)} of {len(compared)} | |",
        "",
        f"- **More iterations**, default / paper: {names(more, counts('iterations'))}.",
        f"- **More cut-backs**: {names(cut, counts('cutbacks'))}. **More warnings**: {names(told, counts('warnings'))}.",
        f"- **Larger errors**: {names(worse, errors)}.",
        f"- **Smaller errors**: {names(better, errors)}.",
    ]
    said += loads_text(loaded)
    if ended:
        said.append(f"- **Not solved** (exit codes): {names(ended, counts('exit'))}.")
    return said


def study(arguments):
    scenes = [path.stem for path in sorted(SCENES.glob("*.yaml")) if not arguments.only or path.stem in arguments.only]
    progress = Progress(len(METHODS) * len(scenes))
    output = arguments.build / "method"
    driver = Driver(arguments.build, output, keep=True, report=progress.report)
    with ThreadPoolExecutor(arguments.jobs) as pool:
        rows = list(pool.map(lambda scene: row_of(driver, scene), scenes))
        chosen = [scene for scene in scenes if scene in LOADED]
        loaded = dict(zip(chosen, pool.map(lambda scene: over_loads(driver, scene), chosen)))
    output.mkdir(parents=True, exist_ok=True)
    with (output / "scenes.csv").open("w", newline="") as file:
        written = csv.DictWriter(file, list(rows[0]))
        written.writeheader()
        written.writerows(rows)
    text = "\n".join(["# Scenes, default / paper", "", *digest(rows, loaded), "", *table(rows)]) + "\n"
    (output / "index.md").write_text(text)
    print(text)
    if arguments.renew:
        put_between(DOCUMENT, MARKS, "\n" + "\n".join(digest(rows, loaded)) + "\n\n")
    print((output / "index.md").resolve())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, required=True, help="CMake's build tree")
    parser.add_argument("--jobs", type=int, default=1, help="scenes solved at the same time")
    parser.add_argument("--only", nargs="+", metavar="SCENE", help="these scenes alone")
    parser.add_argument("--renew", action="store_true", help="renew the digest in docs/method.md")
    arguments = parser.parse_args()
    if arguments.only and arguments.renew:
        parser.error("--renew: the digest is of all scenes")
    try:
        study(arguments)
    except SceneError as problem:
        print(f"\n{problem}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
