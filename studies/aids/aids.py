"""What each convergence aid is good for: `make aids`. aids.py --build DIR; results go to DIR/aids.

A handful of scenes, each with all aids, then with one of them switched off: Newton iterations, those of failed attempts
included, cut-backs, and whether the run reached its end. An aid must not cost iterations where it is not needed. Table:
printed, aids.json, aids.md.
"""

import argparse
import json
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "common"))
import folders  # noqa: E402, F401  (puts the others on the path)
from scene import SCENES as FOLDER  # noqa: E402
from scene import Driver, SceneError  # noqa: E402

# Short ones: friction, several solutions, states at a margin, a corner, a contact that grows.
SCENES = ["block_bottom_mu02", "klarbring", "incline", "rigid_punch", "ball_on_plane"]
# Their answers are compared elsewhere. A run that does not converge is given up after five halvings of a step.
OPTIONS = ("-steps_smallest", "0.03125", "-output_vtu", "none", "-output_csv", "none")

# What is switched off, and how; {} is the interface.
AIDS = [
    ("nothing", ()),
    ("rows not scaled", ("-{}_row_scale", "none")),
    ("one r of 1 for all nodes", ("-{}_augmentation", "1")),
    ("one r, 1e3 of the default", ("-{}_augmentation_scale", "1e3")),
    ("the same, no look-out for cycles", ("-{}_augmentation_scale", "1e3", "-steps_cycles", "false")),
    ("no initial contact", ("-{}_initial_contact", "false")),
    ("no look-out for cycles", ("-steps_cycles", "false")),
    ("no predictor", ("-steps_predictor", "false")),
    ("full steps: backtracking throughout", ("-snes_linesearch_type", "bt")),
    ("the same, rows not scaled", ("-snes_linesearch_type", "bt", "-{}_row_scale", "none")),
]


def interface_of(path):
    """The first interface that the scene names."""
    for line in path.read_text().splitlines():
        if line.startswith("interfaces:"):
            return line.split("[")[1].split("]")[0].split(",")[0].strip()
    raise SceneError(f"{path} names no interface")


def measure(driver, scene):
    rows, name = [], interface_of(FOLDER / f"{scene}.yaml")
    for k, (aid, switch) in enumerate(AIDS):
        given = [part.format(name) for part in switch]
        run = driver.run(scene, *OPTIONS, *given, label=f"{scene}_{k}", expect=None)
        if run.exit_code not in (0, 2, 3):
            raise SceneError(f"{scene} with {aid}: exit code {run.exit_code}\n{run.text[-800:]}")
        failed = sum(attempt["newton_iterations"] for attempt in run.summary["failed_attempts"])
        rows.append({
            "aid": aid,
            "verdict": {0: "done", 2: "not converged", 3: "refused"}[run.exit_code],
            "iterations": run.newton_iterations,
            "of_failed_attempts": failed,
            "cutbacks": run.summary["cutbacks"],
        })
    return rows


def markdown(results):
    lines = ["| switched off | " + " | ".join(results) + " |", "|---|" + "---:|" * len(results)]
    for k, (aid, _) in enumerate(AIDS):
        cells = []
        for rows in results.values():
            row = rows[k]
            text = str(row["iterations"]) + (f", {row['cutbacks']} cut-backs" if row["cutbacks"] else "")
            cells.append(text if row["verdict"] == "done" else f"**{row['verdict']}** after {text}")
        lines.append(f"| {aid} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, default=Path("build"))
    parser.add_argument("--only", nargs="+", metavar="SCENE", help="these scenes")
    arguments = parser.parse_args()
    told = lambda label, run, seconds: print(f"  {label}: exit code {run.exit_code}, {seconds:.0f} s", flush=True)
    driver = Driver(arguments.build, arguments.build / "aids", report=told)
    results = {}
    for scene in arguments.only or SCENES:
        results[scene] = measure(driver, scene)
    text = markdown(results)
    print(text)
    (driver.output / "aids.json").write_text(json.dumps(results, indent=1) + "\n")
    (driver.output / "aids.md").write_text(text)


if __name__ == "__main__":
    try:
        main()
    except SceneError as problem:
        sys.exit(f"aids.py: {problem}")
