"""What a rank holds of the surfaces and does for the contact, over what one rank would: `make scaling-ranks`. ranks.py --build DIR;
results go to DIR/scaling.

Two flat sheets of equal cells, the lower one held, the upper one pressed on it and drawn along, free across: all that a step needs of
the contact, and a linear system that any size can be solved with. One half is pressed on, the other lifted. Three steps, on 1, 2 and 4
ranks, with both bases. Table: printed, ranks.json, ranks.md.
"""

import argparse
import json
import os
import subprocess
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "common"))
import folders  # noqa: E402, F401  (puts the others on the path)
from scaling import renew  # noqa: E402
from scene import SceneError, write  # noqa: E402

BEGIN, END = "<!-- ranks.py writes from here -->", "<!-- to here: ranks.py -->"
# Rows of facets on either side; 316 are 1e5 facets.
SIZES = (60, 316)
RANKS = (1, 2, 4)
# Dual multipliers condensed: of these sheets next to a diagonal matrix is left.
OPTIONS = {"standard": (), "dual": ("-unknowns", "displacements")}
BASES = tuple(OPTIONS)
# The saddle point of standard multipliers takes minutes a solve beyond this.
LARGEST_STANDARD = 100


def scene(rows, basis):
    sheet = {"type": "box", "cells": [rows, rows, 1], "young": 1000, "poisson": 0.3}
    away = 0.3 / rows
    return {
        "schema": 1,
        "bodies": ["upper", "lower"],
        "upper": {**sheet, "lower": [away, away, 0], "upper": [1 + away, 1 + away, 0.05]},
        "lower": {**sheet, "lower": [0, 0, -0.05], "upper": [1, 1, 0]},
        "supports": ["ground", "grip", "guide"],
        "ground": {"surface": ["lower.zmin", "lower.zmax"], "components": ["x", "y", "z"]},
        "grip": {"surface": "upper.zmax", "components": ["x", "y", "z"], "value": [away, 0, -1e-4],
                 "gradient": [0, 0, 0, 0, 0, 0, 2e-4, 0, 0]},
        "guide": {"surface": "upper.zmin", "components": ["x", "y"], "value": [away, 0, 0]},
        "interfaces": ["contact"],
        "contact": {"nonmortar": "upper.zmin", "mortar": "lower.zmax", "basis": basis},
        "steps": {"count": 3},
        "output": {"csv": "none", "vtu": "none", "quiet": True},
    }


def run(build, output, rows, basis, ranks):
    name = f"{rows}_{basis}_{ranks}"
    path = write(scene(rows, basis), output / f"sheets_{rows}_{basis}.yaml")
    command = [build.resolve() / "c_examples" / "snes_contact", "-scene", path, "-output_dir", output / name, *OPTIONS[basis]]
    if ranks > 1:
        command = ["mpirun", "--oversubscribe", "-n", ranks, *command]
    environment = {**os.environ, "OMP_NUM_THREADS": "1", "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    with open(output / f"{name}.txt", "w") as text:
        done = subprocess.run([str(word) for word in command], stdout=text, stderr=subprocess.STDOUT, env=environment)
    if done.returncode:
        raise SceneError(f"{name}: see {text.name}")
    return json.loads((output / name / "summary.json").read_text())["interfaces"]["contact"]


def measure(build, output, rows, basis):
    """The most of any rank, over one rank's."""
    whole = run(build, output, rows, basis, 1)
    found = []
    for ranks in RANKS[1:]:
        contact = run(build, output, rows, basis, ranks)
        most = {key: max(rank[key] for rank in contact["ranks"]) for key in contact["ranks"][0]}
        found.append({
            "rows": rows,
            "basis": basis,
            "ranks": ranks,
            "integrated": most["pairs_integrated"] / whole["pairs_integrated"],
            "linearised": most["pairs_linearised"] / whole["pairs_linearised"],
            "held": max(rank["facets_held"] + rank["mortar_facets_held"] for rank in contact["ranks"]) / (2 * rows * rows),
            "bytes": most["bytes"] / whole["bytes"],
        })
    return found


def table(rows):
    lines = ["| rows of facets | basis | ranks | pairs integrated by a rank | pairs linearised | facets of both sides held | in shares of "
             "1 / ranks | memory of the handle |", "|---|---|---|---|---|---|---|---|"]
    for row in rows:
        lines.append(f"| {row['rows']} | {row['basis']} | {row['ranks']} | {row['integrated']:.3f} | {row['linearised']:.3f} | "
                     f"{row['held']:.3f} | {row['held'] * row['ranks']:.2f} | {row['bytes']:.2f} |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", type=Path, required=True)
    parser.add_argument("--sizes", type=lambda text: [int(n) for n in text.split(",")], default=SIZES)
    parser.add_argument("--renew", action="store_true", help="write the table into docs/scaling.md")
    args = parser.parse_args()
    output = args.build / "scaling"
    output.mkdir(parents=True, exist_ok=True)
    rows = []
    for n in args.sizes:
        for basis in BASES if n <= LARGEST_STANDARD else ("dual",):
            print(f"{n} rows, {basis}", file=sys.stderr, flush=True)
            rows += measure(args.build, output, n, basis)
    (output / "ranks.json").write_text(json.dumps(rows, indent=1))
    (output / "ranks.md").write_text(table(rows))
    print(table(rows))
    if args.renew:
        renew(BEGIN, END, table(rows))


if __name__ == "__main__":
    try:
        main()
    except SceneError as error:
        sys.exit(f"ranks.py: {error}")
