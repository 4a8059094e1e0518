"""What multigrid takes of MUMPS' time and memory where MUMPS does not fit: ratio.py --build DIR; results go to DIR/scaling.

The blocks of scaling.py. Multigrid runs at the largest size, MUMPS at the largest that it fits at. Both times are the processor's, of the run
and of the share of its linear solves. MUMPS' at the largest size are extrapolated by what its analysis, which takes
little time and memory, says there and here of operations and of memory. Table: printed, ratio.json, ratio.md.
"""

import argparse
import json
import re
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "common"))
import folders  # noqa: E402, F401  (puts the others on the path)
from scaling import OPTIONS, launch, renew  # noqa: E402
from scene import SceneError  # noqa: E402

BEGIN, END = "<!-- ratio.py writes from here -->", "<!-- to here: ratio.py -->"
# Cells along an edge of the upper block: 413 400 unknowns; 215 520, of which MUMPS wants 12 GB.
LARGEST, LARGEST_DIRECT = 40, 32
# MUMPS analyses, says what it would take, and has not the memory for it.
ANALYSIS = ("-mat_mumps_icntl_4", "2", "-mat_mumps_icntl_23", "1", "-steps_smallest", "1")
NO_MEMORY = 2  # the exit code of a run that does not converge
FILES = ("-output_csv", "none", "-output_vtu", "none")


def measure(build, output, n, solver):
    print(f"{solver}, {n} cells", file=sys.stderr, flush=True)
    folder, _, usage = launch(build, output, n, solver, (*OPTIONS, *FILES))
    summary = json.loads((folder / "summary.json").read_text())
    seconds, took = summary["seconds"], usage.ru_utime + usage.ru_stime
    return {
        "unknowns": summary["unknowns"],
        "solver": solver,
        "solves": sum(step["newton_iterations"] for step in summary["steps"]),
        "run": took,
        "linear": took * seconds["linear_solve"] / seconds["total"],
        "gigabytes": usage.ru_maxrss / 1e6,
    }


def analysis(build, output, n):
    print(f"MUMPS' analysis, {n} cells", file=sys.stderr, flush=True)
    _, log, _ = launch(build, output, n, "direct", (*OPTIONS, *FILES, *ANALYSIS), name=f"analysis_{n}", expect=NO_MEMORY)
    text = log.read_text()
    operations = re.search(r"RINFOG\(1\).*= *([\d.]+)D([+-]\d+)", text)
    megabytes = re.search(r"INFOG\(17\)\): *(\d+)", text)
    if not operations or not megabytes:
        raise SceneError(f"MUMPS does not say what it would take: see {log}")
    return {"operations": float(f"{operations[1]}e{operations[2]}"), "gigabytes": int(megabytes[1]) / 1e3}


def extrapolated(multigrid, direct, here, there):
    """MUMPS' run at the size of `multigrid`: solves as its operations, memory by as much more as it estimates, the
    rest as with multigrid."""
    linear = direct["linear"] * there["operations"] / here["operations"] * multigrid["solves"] / direct["solves"]
    return {
        **multigrid,
        "solver": "MUMPS, extrapolated",
        "run": linear + multigrid["run"] - multigrid["linear"],
        "linear": linear,
        "gigabytes": direct["gigabytes"] + there["gigabytes"] - here["gigabytes"],
    }


def table(rows, multigrid, mumps):
    lines = ["| unknowns | solver | linear solves | seconds of them | of the run | memory, GB |", "|---|---|---|---|---|---|"]
    lines += [f"| {row['unknowns']} | {row['solver']} | {row['solves']} | {row['linear']:.1f} | {row['run']:.1f} | {row['gigabytes']:.2f} |"
              for row in rows]
    shares = (f"{multigrid[key] / mumps[key]:.2f}" for key in ("linear", "run", "gigabytes"))
    return "\n".join([*lines, f"| {multigrid['unknowns']} | multigrid over MUMPS | | {' | '.join(shares)} |"]) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", type=Path, required=True)
    parser.add_argument("--largest", type=int, default=LARGEST, help="cells along an edge, of multigrid")
    parser.add_argument("--largest-direct", type=int, default=LARGEST_DIRECT, help="of MUMPS")
    parser.add_argument("--renew", action="store_true", help="write the table into docs/scaling.md")
    args = parser.parse_args()
    output = args.build / "scaling"
    output.mkdir(parents=True, exist_ok=True)
    here, there = (analysis(args.build, output, n) for n in (args.largest_direct, args.largest))
    direct, small = (measure(args.build, output, args.largest_direct, solver) for solver in ("direct", "iterative"))
    multigrid = measure(args.build, output, args.largest, "iterative")
    mumps = extrapolated(multigrid, direct, here, there)
    rows = [{**row, "solver": {"direct": "MUMPS", "iterative": "multigrid"}.get(row["solver"], row["solver"])}
            for row in (small, direct, multigrid, mumps)]
    text = table(rows, multigrid, mumps)
    (output / "ratio.json").write_text(json.dumps({"rows": rows, "analysis": {"here": here, "there": there}}, indent=1))
    (output / "ratio.md").write_text(text)
    print(text)
    if args.renew:
        renew(BEGIN, END, text)


if __name__ == "__main__":
    try:
        main()
    except SceneError as error:
        sys.exit(f"ratio.py: {error}")
