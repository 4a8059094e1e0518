"""Time and iterations of the linear solvers against the number of unknowns: `make scaling`. scaling.py --build DIR; results
go to DIR/scaling.

Two blocks of equal cells, one pressed on the other and drawn along it with friction, all nodes slipping at the end: the
scene two_blocks with dual multipliers, condensed. Of each size one step, by multigrid and, as far as it is not too dear, by
MUMPS. Seconds are the processor's, of linear solves alone, a solve. Table: printed, scaling.json, scaling.md.

With --standard the same with standard multipliers among the unknowns. With --ranks what each rank holds of the mesh, in place of
this: on 1, 2 and 4 ranks.
"""

import argparse
import json
import os
import subprocess
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "common"))
import folders  # noqa: E402, F401  (puts the others on the path)
from documents import put_between  # noqa: E402
from mpi import environment  # noqa: E402
from scene import SCENES, SceneError  # noqa: E402

DOC = Path(__file__).resolve().parents[2] / "docs" / "scaling.md"
BEGIN, END = "<!-- scaling.py writes from here -->", "<!-- to here -->"
RANKS_BEGIN, RANKS_END = "<!-- scaling.py writes of ranks from here -->", "<!-- ranks to here -->"
# Cells along an edge of the upper block.
SIZES = (8, 16, 24)
# LU takes minutes and 6 GB beyond this.
LARGEST_DIRECT = 24
# Cells along an edge of the upper block, and ranks, of which each holds its piece.
HELD_SIZE, HELD_RANKS = 24, (1, 2, 4)
OPTIONS = ("-unknowns", "displacements", "-contact_basis", "dual", "-output_quiet", "true")
STANDARD = ("-contact_basis", "standard", "-output_quiet", "true")
# What the table is made for, in place of blocks that slip.
CASES = {
    "slipping": (),
    "frictionless": ("-contact_law", "none", "-contact_friction", "0"),
    "sticking": ("-contact_friction", "1"),
    "tied": ("-contact_law", "tied", "-contact_friction", "0"),
    "held": ("-grip_components", "z", "-contact_friction", "1"),
}
STANDARD_BEGIN, STANDARD_END = "<!-- scaling.py writes of multipliers from here -->", "<!-- multipliers to here -->"


def launch(build, output, n, solver, options, name=None, expect=0):
    """Runs blocks of n cells along an edge. Returns the folder of the results, what was printed, and the process' usage."""
    name = name or f"{solver}_{n}"
    folder, log = output / name, output / f"{name}.txt"
    cells = ("-upper_cells", f"{n},{n},{n}", "-lower_cells", f"{n + 1},{n + 1},{n}")
    command = [build / "program" / "stickslip", "-scene", SCENES / "two_blocks.yaml", "-output_dir", folder, *options,
               *cells, "-solver", solver]
    with open(log, "w") as text:
        process = subprocess.Popen([str(word) for word in command], stdout=text, stderr=subprocess.STDOUT,
                                   env=environment())
        _, status, usage = os.wait4(process.pid, 0)
    if os.waitstatus_to_exitcode(status) != expect:
        raise SceneError(f"{solver} with {n} cells: see {log}")
    return folder, log, usage


def measure(build, output, n, solver, options):
    folder, _, usage = launch(build, output, n, solver, options)
    summary = json.loads((folder / "summary.json").read_text())
    newton, seconds = sum(step["newton_iterations"] for step in summary["steps"]), summary["seconds"]
    linear = summary.get("linear_solver", {})
    return {
        "cells": n,
        "solver": solver,
        "unknowns": summary["unknowns"],
        "newton": newton,
        "most": linear.get("most"),
        "mean": linear["iterations"] / linear["solves"] if linear else None,
        "direct": linear.get("direct"),
        "seconds": seconds["linear_solve"] / newton * seconds["processor"] / seconds["total"],
        "total": seconds["processor"],
        "gigabytes": usage.ru_maxrss / 1e6,
    }


def holdings(build, output):
    """Of each number of ranks the most that one of them holds, in MB."""
    n, rows = HELD_SIZE, []
    for ranks in HELD_RANKS:
        print(f"{ranks} ranks", file=sys.stderr, flush=True)
        folder = output / f"ranks_{ranks}"
        command = ["mpirun", "--oversubscribe", "-n", ranks, build / "program" / "stickslip", "-scene", SCENES / "two_blocks.yaml",
                   "-output_dir", folder, *OPTIONS, "-upper_cells", f"{n},{n},{n}", "-lower_cells", f"{n + 1},{n + 1},{n}",
                   "-solver", "iterative", "-output_vtu", "none", "-output_csv", "none"]
        with open(output / f"ranks_{ranks}.txt", "w") as text:
            status = subprocess.call([str(word) for word in command], stdout=text, stderr=subprocess.STDOUT, env=environment())
        if status:
            raise SceneError(f"{ranks} ranks: see {text.name}")
        mesh = json.loads((folder / "summary.json").read_text())["mesh"]
        rows.append({"ranks": ranks, "cells": mesh["cells"],
                     **{k: max(rank[k] for rank in mesh["ranks"]) / 1e6 for k in ("bytes_read", "bytes", "resident_most")}})
    return rows


def holdings_table(rows):
    lines = ["| ranks | cells | the most of a rank: its piece as read, MB | of the distributed mesh, MB | its process, MB |",
             "|---|---|---|---|---|"]
    for row in rows:
        lines.append(f"| {row['ranks']} | {row['cells']} | {row['bytes_read']:.2f} | {row['bytes']:.2f} | {row['resident_most']:.0f} |")
    return "\n".join(lines) + "\n"


def renew(begin, end, text):
    put_between(DOC, (begin, end), f"\n{text}")


def table(rows):
    lines = ["| unknowns | solver | Newton iterations | GMRES' iterations a solve: mean, most | seconds a solve | "
             "seconds of the run | memory, GB |", "|---|---|---|---|---|---|---|"]
    for row in rows:
        krylov = f"{row['mean']:.1f}, {row['most']}" if row["most"] else "-"
        name = {"iterative": "multigrid", "direct": "MUMPS"}[row["solver"]]
        lines.append(f"| {row['unknowns']} | {name} | {row['newton']} | {krylov} | {row['seconds']:.2f} | {row['total']:.1f} "
                     f"| {row['gigabytes']:.2f} |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", type=Path, required=True)
    parser.add_argument("--sizes", type=lambda text: [int(n) for n in text.split(",")], default=SIZES)
    parser.add_argument("--largest-direct", type=int, default=LARGEST_DIRECT)
    parser.add_argument("--renew", action="store_true", help="write the table into docs/scaling.md")
    parser.add_argument("--standard", action="store_true", help="with standard multipliers among the unknowns")
    parser.add_argument("--rtol", help="of GMRES, in place of the driver's")
    parser.add_argument("--case", choices=CASES, default="slipping", help="of the contact; held: the upper block by contact alone, with friction 1")
    parser.add_argument("--ranks", action="store_true", help="what ranks hold, in place of the solvers")
    args = parser.parse_args()
    output = args.build / "scaling"
    output.mkdir(parents=True, exist_ok=True)
    if args.ranks:
        held = holdings_table(holdings(args.build, output))
        print(held)
        if args.renew:
            renew(RANKS_BEGIN, RANKS_END, held)
        return
    options = STANDARD if args.standard else OPTIONS
    options += ("-iterative_ksp_rtol", args.rtol) if args.rtol else ()
    options += CASES[args.case]
    rows = []
    for n in args.sizes:
        for solver in ("iterative", "direct")[: 1 if n > args.largest_direct else 2]:
            print(f"{solver}, {n} cells", file=sys.stderr, flush=True)
            rows.append(measure(args.build, output, n, solver, options))
    (output / "scaling.json").write_text(json.dumps(rows, indent=1))
    (output / "scaling.md").write_text(table(rows))
    print(table(rows))
    if args.renew:
        renew(*((STANDARD_BEGIN, STANDARD_END) if args.standard else (BEGIN, END)), table(rows))


if __name__ == "__main__":
    try:
        main()
    except SceneError as error:
        sys.exit(f"scaling.py: {error}")
