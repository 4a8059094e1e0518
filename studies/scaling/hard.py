"""GMRES' iterations of the reduced form in cases that are hard for multigrid: hard.py --build DIR [--renew]. Of each case the linear solves
of a run, with dual multipliers, condensed, `solver: iterative`. Table: printed, and with --renew written into docs/scaling.md.
"""

import argparse
import json
import subprocess
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "common"))
import folders  # noqa: E402, F401  (puts the others on the path)
from mpi import environment  # noqa: E402
from scaling import renew  # noqa: E402
from scene import SCENES, SceneError, interfaces  # noqa: E402

BEGIN, END = "<!-- hard.py writes from here -->", "<!-- to here: hard.py -->"
FINE = ("-upper_cells", "16,16,16", "-lower_cells", "17,17,16")
# Case, scene, options; the lower block, the mortar body, is twice as stiff as the upper one, of 1000.
CASES = (
    ("two blocks, all nodes slip", "two_blocks", ()),
    ("friction 1", "two_blocks", ("-contact_friction", "1")),
    ("held by contact alone, friction 1", "two_blocks", ("-grip_components", "z", "-contact_friction", "1")),
    ("non-mortar body 10 times stiffer", "two_blocks", ("-upper_young", "2e4")),
    ("100 times", "two_blocks", ("-upper_young", "2e5")),
    ("1000 times", "two_blocks", ("-upper_young", "2e6")),
    ("100 times, a finer mesh", "two_blocks", ("-upper_young", "2e5", *FINE)),
    ("1000 times, a finer mesh", "two_blocks", ("-upper_young", "2e6", *FINE)),
    ("mortar body 1000 times stiffer", "two_blocks", ("-lower_young", "1e6")),
    ("mortar mesh twice as fine", "two_blocks", ("-lower_cells", "17,17,8")),
    ("non-mortar mesh twice as fine", "two_blocks", ("-upper_cells", "16,16,8")),
    ("Poisson's ratio 0.45", "two_blocks", ("-upper_poisson", "0.45", "-lower_poisson", "0.45")),
    ("half covered, nodes carried", "two_blocks", ("-lower_upper", "0.5,1,0.8")),
    ("curved", "ball_on_block", ()),
    ("supports of single components", "hertz_line_coarse", ()),
    ("a line that partly sticks", "cattaneo_line", ()),
    ("curved, turned while it slips", "turned_shaft", ()),
    ("a third body, 1e13 times stiffer", "third_body", ()),
    ("tied", "patch_tied", ()),
)


def measure(build, output, label, scene, options):
    folder = output / "hard" / "".join(c if c.isalnum() else "_" for c in label)
    dual = [word for i in interfaces(scene) for word in (f"-{i}_basis", "dual", f"-{i}_weak_coverage", "0")]
    command = [build / "program" / "stickslip", "-scene", SCENES / f"{scene}.yaml", "-output_dir", folder, *dual, *options,
               "-unknowns", "displacements", "-solver", "iterative", "-output_csv", "none", "-output_vtu", "none", "-options_left", "no"]
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / "run.txt", "w") as text:
        status = subprocess.call([str(word) for word in command], stdout=text, stderr=subprocess.STDOUT,
                                 env=environment())
    if status:
        raise SceneError(f"{label}: see {text.name}")
    summary = json.loads((folder / "summary.json").read_text())
    linear = summary["linear_solver"]
    return {"case": label, "unknowns": summary["unknowns"], "solves": linear["solves"], "most": linear["most"], "direct": linear["direct"],
            "mean": linear["iterations"] / max(linear["solves"], 1)}


def table(rows):
    lines = ["| case | unknowns | solves | iterations a solve: mean, most | left to the direct solver |", "|---|---|---|---|---|"]
    for row in rows:
        lines.append(f"| {row['case']} | {row['unknowns']} | {row['solves']} | {row['mean']:.0f}, {row['most']} | {row['direct']} |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", type=Path, required=True)
    parser.add_argument("--renew", action="store_true", help="write the table into docs/scaling.md")
    args = parser.parse_args()
    rows = []
    for case in CASES:
        print(case[0], file=sys.stderr, flush=True)
        rows.append(measure(args.build, args.build / "scaling", *case))
    print(table(rows))
    if args.renew:
        renew(BEGIN, END, table(rows))


if __name__ == "__main__":
    try:
        main()
    except SceneError as error:
        sys.exit(f"hard.py: {error}")
