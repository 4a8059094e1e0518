"""What a rank holds of the surfaces and does for the contact, over what one rank would: `make scaling-ranks`. ranks.py --build DIR;
results go to DIR/scaling.

Two flat sheets of equal cells, the lower one held, the upper one pressed on it and drawn along, free across: all that a step needs of
the contact, and a linear system that any size can be solved with. One half is pressed on, the other lifted. Three steps, on 1, 2 and 4
ranks, with both bases. Table: printed, ranks.json, ranks.md.

With --bytes one step, and all that a rank holds of mesh and surfaces, whether the sheets are boxes or come from a Gmsh file that is
converted once and then read by all ranks: bytes.json, bytes.md.
"""

import argparse
import json
import subprocess
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "common"))
import folders  # noqa: E402, F401  (puts the others on the path)
import numpy as np  # noqa: E402
from mpi import environment  # noqa: E402
from scaling import renew  # noqa: E402
from scene import SceneError, write  # noqa: E402

BEGIN, END = "<!-- ranks.py writes from here -->", "<!-- to here: ranks.py -->"
BYTES_BEGIN, BYTES_END = "<!-- ranks.py writes of bytes from here -->", "<!-- bytes to here: ranks.py -->"
# Rows of facets on either side; 316 are 1e5 facets.
SIZES = (60, 316)
RANKS = (1, 2, 4)
# Dual multipliers condensed: of these sheets next to a diagonal matrix is left.
OPTIONS = {"standard": (), "dual": ("-unknowns", "displacements")}
BASES = tuple(OPTIONS)
# The saddle point of standard multipliers takes minutes a solve beyond this.
LARGEST_STANDARD = 100


def corners(rows):
    """Least and largest corner of each sheet."""
    away = 0.3 / rows
    return {"upper": ([away, away, 0], [1 + away, 1 + away, 0.05]), "lower": ([0, 0, -0.05], [1, 1, 0])}


def boxes(rows):
    return {body: {"type": "box", "cells": [rows, rows, 1], "lower": low, "upper": high} for body, (low, high) in corners(rows).items()}


def scene(rows, basis, meshes):
    away = 0.3 / rows
    return {
        "schema": 1,
        "bodies": ["upper", "lower"],
        **{body: {**mesh, "young": 1000, "poisson": 0.3} for body, mesh in meshes.items()},
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


def gmsh(path, rows, low, high):
    """A sheet as a Gmsh file of format 2.2, its faces zmin and zmax named."""
    x, y, z = (np.linspace(low[k], high[k], n) for k, n in enumerate((rows + 1, rows + 1, 2)))
    z, y, x = (c.ravel() for c in np.meshgrid(z, y, x, indexing="ij"))
    row, layer = rows + 1, (rows + 1) ** 2
    first = 1 + (np.arange(rows)[:, None] * row + np.arange(rows)).ravel()
    below = np.stack([first, first + 1, first + row + 1, first + row], axis=1)
    cells, n = np.hstack([below, below + layer]), len(first)
    with open(path, "w") as file:
        file.write('$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n2 1 "zmin"\n2 2 "zmax"\n3 3 "sheet"\n$EndPhysicalNames\n')
        file.write(f"$Nodes\n{2 * layer}\n")
        np.savetxt(file, np.column_stack([np.arange(1, 2 * layer + 1), x, y, z]), fmt="%d %.17g %.17g %.17g")
        file.write(f"$EndNodes\n$Elements\n{3 * n}\n")
        for k, (kind, tag, nodes) in enumerate(((3, 1, below[:, ::-1]), (3, 2, below + layer), (5, 3, cells))):
            numbers = np.arange(k * n + 1, (k + 1) * n + 1)
            about = np.broadcast_to([kind, 2, tag, tag], (n, 4))
            np.savetxt(file, np.column_stack([numbers, about, nodes]), fmt="%d")
        file.write("$EndElements\n")


def converted(build, output, rows):
    """The sheets of a file that was converted once."""
    file = (output / f"sheets_{rows}.h5").resolve()
    meshes = {}
    for body, (low, high) in corners(rows).items():
        gmsh(output / f"sheet_{rows}_{body}.msh", rows, low, high)
        meshes[body] = {"type": "gmsh", "file": f"sheet_{rows}_{body}.msh"}
    path = write(scene(rows, "dual", meshes), output / f"sheets_{rows}_gmsh.yaml")
    call([program(build), "-scene", path, "-convert", file], output / f"convert_{rows}.txt")
    return {body: {"type": "hdf5", "file": str(file)} for body in meshes}


def program(build):
    return build.resolve() / "program" / "stickslip"


def call(command, log):
    with open(log, "w") as text:
        done = subprocess.run([str(word) for word in command], stdout=text, stderr=subprocess.STDOUT, env=environment())
    if done.returncode:
        raise SceneError(f"{log.stem}: see {log}")


def summary(build, output, name, path, ranks, options):
    command = [program(build), "-scene", path, "-output_dir", output / name, *options]
    if ranks > 1:
        command = ["mpirun", "--oversubscribe", "-n", ranks, *command]
    call(command, output / f"{name}.txt")
    return json.loads((output / name / "summary.json").read_text())


def run(build, output, rows, basis, ranks):
    path = write(scene(rows, basis, boxes(rows)), output / f"sheets_{rows}_{basis}.yaml")
    return summary(build, output, f"{rows}_{basis}_{ranks}", path, ranks, OPTIONS[basis])["interfaces"]["contact"]


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


def weigh(build, output, rows, source, meshes):
    """Of each number of ranks the most that one of them holds, and its seconds."""
    path = write(scene(rows, "dual", meshes), output / f"sheets_{rows}_{source}.yaml")
    found = []
    for ranks in RANKS:
        print(f"{rows} rows, {source}, {ranks} ranks", file=sys.stderr, flush=True)
        told = summary(build, output, f"{rows}_{source}_{ranks}", path, ranks, (*OPTIONS["dual"], "-steps_count", 1))
        contact = told["interfaces"]["contact"]
        each = list(zip(told["mesh"]["ranks"], contact.get("ranks", [contact])))
        found.append({
            "rows": rows,
            "source": source,
            "ranks": ranks,
            "read": max(mesh["bytes_read"] for mesh, _ in each),
            "mesh": max(mesh["bytes"] for mesh, _ in each),
            "home": max(part["bytes_home"] for _, part in each),
            "all": max(mesh["bytes"] + sum(part[key] for key in ("bytes_home", "bytes_part", "bytes")) for mesh, part in each),
            "seconds": max(part["processor"] for _, part in each),
        })
    return found


def bytes_table(rows):
    lines = ["| sheets | ranks | its piece as read, MB | mesh, MB | at home, MB | all, MB | in shares of 1 / ranks | seconds | over one rank's |",
             "|---|---|---|---|---|---|---|---|---|"]
    for row in rows:
        one = next(other for other in rows if other["source"] == row["source"] and other["rows"] == row["rows"])
        megabytes = " | ".join(f"{row[key] / 1e6:.1f}" for key in ("read", "mesh", "home", "all"))
        lines.append(f"| {row['source']} | {row['ranks']} | {megabytes} | {row['all'] / one['all'] * row['ranks']:.2f} | "
                     f"{row['seconds']:.1f} | {row['seconds'] / one['seconds']:.2f} |")
    return "\n".join(lines) + "\n"


def bytes_held(build, output, sizes):
    return [row for n in sizes for source, meshes in (("boxes", boxes(n)), ("HDF5", converted(build, output, n)))
            for row in weigh(build, output, n, source, meshes)]


def shares(build, output, sizes):
    rows = []
    for n in sizes:
        for basis in BASES if n <= LARGEST_STANDARD else ("dual",):
            print(f"{n} rows, {basis}", file=sys.stderr, flush=True)
            rows += measure(build, output, n, basis)
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", type=Path, required=True)
    parser.add_argument("--sizes", type=lambda text: [int(n) for n in text.split(",")])
    parser.add_argument("--bytes", action="store_true", help="all that a rank holds of mesh and surfaces")
    parser.add_argument("--renew", action="store_true", help="write the table into docs/scaling.md")
    args = parser.parse_args()
    output = args.build / "scaling"
    output.mkdir(parents=True, exist_ok=True)
    name, marks = ("bytes", (BYTES_BEGIN, BYTES_END)) if args.bytes else ("ranks", (BEGIN, END))
    rows = (bytes_held if args.bytes else shares)(args.build, output, args.sizes or (SIZES[-1:] if args.bytes else SIZES))
    text = (bytes_table if args.bytes else table)(rows)
    (output / f"{name}.json").write_text(json.dumps(rows, indent=1))
    (output / f"{name}.md").write_text(text)
    print(text)
    if args.renew:
        renew(*marks, text)


if __name__ == "__main__":
    try:
        main()
    except SceneError as error:
        sys.exit(f"ranks.py: {error}")
