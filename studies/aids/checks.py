"""What it costs to ask whether a converged step is what it seems: `make aids` after its table. checks.py --build DIR; results go to DIR/checks.

Balance of bodies, forces out of proportion, overlaps that weighted gaps do not see, normals that lag: their part of a run's time (`checks` of the
`seconds` in summary.json), the least of some runs, for a machine that does other things has no less. Ends with 1 where it is above the bound.
"""

import argparse
import json
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "common"))
import folders  # noqa: E402, F401  (puts the others on the path)
from scene import Driver, SceneError  # noqa: E402

# From one iteration a step, all of it in contact, to many; plane and space.
SCENES = ["block_bottom_mu02", "capstan", "press_fit", "two_bars", "ball_on_plane", "shrink_fit"]
OPTIONS = ("-output_vtu", "none", "-output_csv", "none")
RUNS = 3
# What is asked once a step may cost of it.
MOST = 0.02


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, default=Path("build"))
    parser.add_argument("--only", nargs="+", metavar="SCENE", help="these scenes")
    arguments = parser.parse_args()
    driver = Driver(arguments.build, arguments.build / "checks")
    results = {}
    print("| scene | steps | iterations | checks, s | run, s | part |\n|---|---:|---:|---:|---:|---:|")
    for scene in arguments.only or SCENES:
        runs = [driver.run(scene, *OPTIONS, label=f"{scene}_{k}") for k in range(RUNS)]
        part, run = min(((run.summary["seconds"]["checks"] / run.summary["seconds"]["total"], run) for run in runs), key=lambda pair: pair[0])
        seconds = run.summary["seconds"]
        results[scene] = part
        print(f"| {scene} | {len(run.steps)} | {run.newton_iterations} | {seconds['checks']:.4f} | {seconds['total']:.2f} | {100 * part:.2f} % |", flush=True)
    (driver.output / "checks.json").write_text(json.dumps(results, indent=1) + "\n")
    above = [scene for scene, part in results.items() if part > MOST]
    if above:
        sys.exit(f"checks.py: above {100 * MOST:g} % of a run: {', '.join(above)}")


if __name__ == "__main__":
    try:
        main()
    except SceneError as problem:
        sys.exit(f"checks.py: {problem}")
