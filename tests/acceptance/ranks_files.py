"""Checks of what several ranks read and write: the mesh is that of one rank to the bit, whoever made its pieces, and so are files
put together; fields are those of one rank to rounding."""

import re
import shutil
import struct
import subprocess
from pathlib import Path

import numpy as np
from condensed import TIGHT
from mpi import environment
from ranks import apart
from scene import SCENES, SceneError, write

# Displacements, stresses, tractions over their largest: ranks add the same numbers in another order. Stresses have six digits in files.
SAME = 1e-9
DIGITS = 1e-5
LAST = ("-output_csv", "last", "-output_vtu", "last", "-options_left", "no")
BLOCK = {"type": "box", "lower": [0, 0, 1], "upper": [3, 2, 2], "young": 1000, "poisson": 0.3}
RAIL = {"type": "box", "lower": [-1, -1, 0], "upper": [4, 3, 1], "cells": [3, 4, 2], "young": 2000, "poisson": 0.3}
# A box whose cells are odd in number along each axis, of every kind; the first cells of ranks lie within rows and layers.
KINDS = ("hex", "tet", "tet10", "hex20", "hex27")
PLANE_KINDS = ("quad", "tri", "tri6", "quad8", "quad9")


def boxes(kind, dimension):
    pressed = {
        "schema": 1,
        "bodies": ["block", "rail"],
        "block": {**BLOCK, "cells": [3, 5, 3], "cell": kind},
        "rail": {**RAIL, "cell": kind},
        "surfaces": ["zone"],
        "zone": {"of": ["rail.zmax"], "within": [-1, -1, 0, 4, 3, 2]},
        "supports": ["ground", "grip"],
        "ground": {"surface": "rail.zmin", "components": ["x", "y", "z"]},
        "grip": {"surface": "block.zmax", "components": ["x", "y", "z"], "value": [0.01, 0, -0.02]},
        "probes": ["corner"],
        "corner": {"body": "block", "point": [3, 2, 1]},
        "interfaces": ["contact"],
        "contact": {"nonmortar": "block.zmin", "mortar": "zone", "friction": 0.3},
        "steps": {"count": 1},
        "output": {"quiet": True},
    }
    if dimension == 2:
        pressed |= {
            "model": "plane_strain",
            "block": {**BLOCK, "lower": [0, 1], "upper": [3, 2], "cells": [5, 3], "cell": kind},
            "rail": {**RAIL, "lower": [-1, 0], "upper": [4, 1], "cells": [3, 3], "cell": kind},
            "zone": {"of": ["rail.ymax"], "within": [-1, 0, 4, 2]},
            "ground": {"surface": "rail.ymin", "components": ["x", "y"]},
            "grip": {"surface": "block.ymax", "components": ["x", "y"], "value": [0.01, -0.02]},
            "corner": {"body": "block", "point": [3, 1]},
            "contact": {"nonmortar": "block.ymin", "mortar": "zone", "friction": 0.3},
        }
    return pressed


def ranks_files(verdicts, driver):
    for kinds, dimension in ((KINDS, 3), (PLANE_KINDS, 2)):
        for kind in kinds:
            path = write(boxes(kind, dimension), driver.output / f"{kind}.yaml")
            compare(verdicts, driver, path, kind, (3,))
    compare(verdicts, driver, "shrink_fit", "full circles", (2,))
    compare(verdicts, driver, "ball_on_plane", "analytic", (3,))
    compare(verdicts, driver, "klarbring", "more ranks than cells", (5,))
    converted(verdicts, driver)
    pieces(verdicts, driver)
    stale(verdicts, driver)


def compare(verdicts, driver, scene, label, several, options=(), one=None):
    tag = label.replace(" ", "_").replace(",", "")
    one = one or driver.run(scene, *TIGHT, *LAST, *options, label=f"{tag}_1")
    for ranks in several:
        other = driver.run(scene, *TIGHT, *LAST, *options, label=f"{tag}_{ranks}", ranks=ranks)
        same(verdicts, f"{label}, {ranks} ranks", one, other)
    return one


def same(verdicts, name, one, other, sorted_rows=False):
    here, there = one.mesh(), other.mesh()
    bits = np.array_equal(here[0], there[0]) and same_cells(here[1], there[1])
    verdicts.true(f"{name}: vertices and cells", bits, f"{len(there[0])} vertices, equal bits")
    scale = np.abs(here[2]).max()
    verdicts.below(f"{name}: displacements", np.abs(there[2] - here[2]).max() / scale, SAME, "of all vertices")
    stress = one.cell_stress()
    verdicts.below(f"{name}: stresses", np.abs(other.cell_stress() - stress).max() / np.abs(stress).max(), DIGITS, "of all cells")
    for i in one.steps[-1]["interfaces"]:
        tables = [run.interface(i) for run in (one, other)]
        if sorted_rows:
            tables = [table[np.argsort(table["node"])] for table in tables]
        verdicts.true(f"{name}: rows of {i}", np.array_equal(tables[0]["node"], tables[1]["node"]), f"{len(tables[1])} nodes")
        verdicts.below(f"{name}: forces of {i}", apart([tables], ("fx", "fy", "fz")), SAME, "of all nodes")
        field = f"traction_{i}"
        values = [run.point_field(field) for run in (one, other)]
        largest = max(np.abs(values[0]).max(), 1e-300)
        verdicts.below(f"{name}: {field}", np.abs(values[1] - values[0]).max() / largest, SAME, "of all vertices")
    for probe, u in one.steps[-1]["probes"].items():
        apart_by = np.abs(np.subtract(other.steps[-1]["probes"][probe], u)).max()
        verdicts.below(f"{name}: probe {probe}", apart_by / scale, SAME, "over the largest displacement")


def same_cells(here, there):
    return here.keys() == there.keys() and all(np.array_equal(here[kind], there[kind]) for kind in here)


def converted(verdicts, driver):
    """A Gmsh file that is converted once and read by all ranks is the mesh that rank 0 reads."""
    for scene, bodies in (("patch_gmsh", ("lower", "upper")), ("plane_hertz", ("lower", "upper"))):
        file = driver.output / f"{scene}.h5"
        command = [driver.program, "-scene", SCENES / f"{scene}.yaml", "-convert", file]
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
        if "needs a PETSc built with HDF5" in done.stderr:
            verdicts.true(f"{scene}: refused without HDF5", done.returncode == 1, done.stderr.strip())
            continue
        if done.returncode:
            raise SceneError(f"{scene}: -convert: {done.stdout}{done.stderr}")
        one = driver.run(scene, *TIGHT, *LAST, label=f"{scene}_gmsh")
        options = [word for body in bodies for word in (f"-{body}_type", "hdf5", f"-{body}_file", str(file))]
        for ranks in (1, 3):
            other = driver.run(scene, *TIGHT, *LAST, *options, label=f"{scene}_h5_{ranks}", ranks=ranks)
            same(verdicts, f"{scene}, converted, {ranks} ranks", one, other, sorted_rows=True)
        damaged(verdicts, driver, scene, file, options)
        nowhere = [str(word) for word in (*command[:-1], driver.output / "nowhere" / "mesh.h5")]
        done = subprocess.run(nowhere, capture_output=True, text=True)
        verdicts.true(f"{scene}: no folder to convert into", done.returncode == 1 and "-convert cannot write" in done.stderr, "refused")
        overwritten(verdicts, driver, scene)


def overwritten(verdicts, driver, scene):
    """-convert writes over none of the files that the scene is read from, by whatever path it comes to them."""
    folder = driver.output / f"{scene}_sources"
    folder.mkdir(parents=True, exist_ok=True)
    yaml, link = folder / "scene.yaml", folder / "link.h5"
    text = (SCENES / f"{scene}.yaml").read_text()
    mesh = re.search(r"file: (\S+\.msh)", text)[1]
    copy = folder / Path(mesh).name
    copy.write_bytes((SCENES / mesh).read_bytes())
    yaml.write_text(text.replace(mesh, copy.name).replace("file: ../", f"file: {SCENES.parent}/"))
    link.unlink(missing_ok=True)
    link.symlink_to(copy)
    for name, path in (("its scene", yaml), ("its mesh", copy), ("its mesh by a link", link)):
        before = path.read_bytes()
        words = [str(word) for word in (driver.program, "-scene", yaml, "-convert", path)]
        done = subprocess.run(words, capture_output=True, text=True)
        told = done.returncode == 1 and "which this scene is read from" in done.stderr
        verdicts.true(f"{scene}: {name} is not written over", told and path.read_bytes() == before, "refused, and left as it was")


# A vertex of both scenes, in their lists of cells' vertices alone, and one that none has.
VERTEX, NO_VERTEX = struct.pack("<d", 60), struct.pack("<d", 1e6)


def damaged(verdicts, driver, scene, file, options):
    """A converted file with other contents than it says it has is refused by all ranks, in one sentence."""
    whole = file.read_bytes()
    for what, old, new in (("list", b"connectivity\0", b"connectivitx\0"), ("vertex", VERTEX, NO_VERTEX)):
        path = driver.output / f"{scene}_no_{what}.h5"
        path.write_bytes(whole.replace(old, new))
        verdicts.true(f"{scene}: a file without a {what} that it names", path.read_bytes() != whole, "written")
        there = [str(path) if word == str(file) else word for word in options]
        for ranks in (1, 2):
            run = driver.run(scene, *LAST, *there, label=f"{scene}_no_{what}_{ranks}", ranks=ranks, expect=1)
            verdicts.true(f"{scene}, no such {what}, {ranks} ranks", "write it anew" in run.text, "refused")


# Bytes that a rank holds of the mesh, read and kept, over those of one rank: half, and the layers of vertices on borders.
HELD = 0.62


def pieces(verdicts, driver):
    """Each rank makes a piece of a box and holds a piece of the mesh."""
    cells = ("-upper_cells", "12,12,12", "-lower_cells", "13,13,12", "-output_csv", "none", "-output_vtu", "none")
    one, two = (driver.run("two_blocks", *cells, label=f"pieces_{n}", ranks=n).summary["mesh"] for n in (1, 2))
    verdicts.true("each cell is held once", sum(rank["cells"] for rank in two["ranks"]) == one["cells"], f"{one['cells']} cells")
    for kind, bound in (("bytes_read", HELD), ("bytes", HELD)):
        most = max(rank[kind] for rank in two["ranks"]) / one["ranks"][0][kind]
        verdicts.below(f"{kind} of a rank, over those of one", most, bound, "half, and the border")


def stale(verdicts, driver):
    """Of two runs into one folder, on other numbers of ranks, each step has the files of the second one alone. A folder that
    cannot take the summary is refused before anything is solved."""

    def run(folder, ranks):
        words = ["mpirun", "--oversubscribe", "-n", ranks, driver.program, "-scene", SCENES / "two_blocks.yaml", "-output_dir", folder, *LAST]
        return subprocess.run([str(word) for word in words], capture_output=True, text=True, env=environment(), stdin=subprocess.DEVNULL)

    for first, second, left in ((2, 1, ".vtu"), (1, 2, ".pvtu")):
        folder = driver.output / f"stale_{first}"
        shutil.rmtree(folder, ignore_errors=True)
        codes = [run(folder, ranks).returncode for ranks in (first, second)]
        ends = {file.suffix for file in folder.glob("step_*") if file.stem.count("_") == 1}
        verdicts.true(f"on {first}, then on {second} ranks into one folder", codes == [0, 0] and ends == {left}, f"the files of the last: {left}")
    folder = driver.output / "no_summary"
    (folder / "summary.json").mkdir(parents=True, exist_ok=True)
    done = run(folder, 2)
    told = done.returncode == 1 and "summary.json" in done.stderr and not list(folder.glob("step_*"))
    verdicts.true("a folder of the name summary.json", told, "refused at the start")
