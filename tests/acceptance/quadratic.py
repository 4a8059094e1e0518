"""Quadratic cells of the bulk: patch tests with curved edges, one rank and two, second order of Gmsh, consistent loads,
convergence.

(Single cells and faces: `cells_test`, in C.)
"""

import numpy as np

from jacobian import whole_matrix
from scene import write
from second_order import SecondOrder

# The discrete solution is the exact one: rounding of some hundred unknowns, and Newton's tolerance of 1e-11.
EXACT_BOUND = 1e-10
# The .vtu has six digits of a stress; half of the last.
STRESS_DIGITS = 1e-5
# Forces add up to what acts, to the roundings of the sum and of the solver.
BALANCE_BOUND = 1e-11
# Displacements of quadratic cells err by h^3, as a mean over the body; here are 3.1 to 3.8.
LEAST_ORDER = 2.7
# Linear cells have order 2, here 1.9: the check can fail.
LINEAR_ORDER = 2.3
# The same cells, or their images in planes of symmetry: an error of 1e-3 that both have, to its rounding of 1e-12.
SAME_BOUND = 1e-6
# Six tetrahedra of a hexahedron have no such planes: errors of one size.
SPLIT_BOUND = 0.5
# A cantilever of one layer of cells: what is left is the clamped end, where the theory of beams is wrong by parts of a per
# cent of a slender one.
BEAM_BOUND = 0.01
# One layer of linear tetrahedra is too stiff by more than this: what the quadratic ones are for.
STIFF = 2.0

# Cells half as large with one pressure each have an error of 2 % themselves (group `materials`); tet10 miss 7 %.
LOCKING_BOUND = 0.1

KINDS = {"tet10": "tetra10", "hex20": "hexahedron20", "hex27": "hexahedron27"}
LAWS = ("linear", "neo_hooke", "st_venant_kirchhoff")
SIDES = ("xmin", "xmax", "ymin", "ymax", "zmin", "zmax")
YOUNG, POISSON = 1000.0, 0.3


def quadratic(verdicts, driver):
    driver.output.mkdir(parents=True, exist_ok=True)
    patch(verdicts, driver)
    gmsh(verdicts, driver)
    pressure(verdicts, driver)
    tube(verdicts, driver)
    closed(verdicts, driver)
    beam(verdicts, driver)
    locking(verdicts, driver)
    contact(verdicts, driver)


def shear():
    gradient = np.zeros((3, 3))
    gradient[0, 1] = 0.8
    return gradient


def affine_error(run):
    points, _, displacement = run.mesh()
    return np.abs(displacement - points @ shear().T).max()


def patch(verdicts, driver):
    """The faces within the skew block are not flat, so that edges in them are curved; all of its surface follows u = H X."""
    for kind, name in KINDS.items():
        for law in LAWS:
            for ranks in (1, 2) if law == "neo_hooke" else (1,):
                options = ("-block_cell", kind, "-block_material", law, "-block_small_strain", "true")
                run = driver.run("large_strain_affine", *options, label=f"patch_{kind}_{law}_{ranks}", ranks=ranks)
                label = f"{kind}, {law}, {ranks} ranks"
                verdicts.below(f"{label}: shear, displacements", affine_error(run), EXACT_BOUND, "linear field")
                stress = run.cell_stress()
                spread = np.ptp(stress, axis=0).max() / np.abs(stress).max()
                verdicts.below(f"{label}: shear, stress is uniform", spread, STRESS_DIGITS, "digits in the file")
                verdicts.true(f"{label}: VTK's kind of cell", list(run.mesh()[1]) == [name], name)


def wavy(p):
    """Curves the inside and the top; the other sides, and the edges of the top, stay straight."""
    x, y, z = p
    bubble = x * (1 - x) * y * (1 - y)
    return np.array([x + 0.5 * bubble * z * (1 - z), y - 0.7 * bubble * z * (1 - z), z + 0.8 * bubble * z])


def gmsh(verdicts, driver):
    """Both formats: every node where the file has it, and the patch test, which a wrong order of nodes would fail."""
    for kind in KINDS:
        mesh = SecondOrder(kind, 2, wavy)
        for form in ("41", "22"):
            file = getattr(mesh, f"write_{form}")(driver.output / f"{kind}_{form}.msh")
            run = driver.run(cube(driver, file, "patch", patch_of_all_sides()), label=f"gmsh_{kind}_{form}")
            points = {tuple(p) for p in run.mesh()[0]}
            same = points == {tuple(p) for p in mesh.points}
            verdicts.true(f"Gmsh {form}, {kind}: nodes are those of the file", same, "curved edges stay")
            verdicts.below(f"Gmsh {form}, {kind}: shear, displacements", affine_error(run), EXACT_BOUND, "linear field")


def cube(driver, file, name, rest):
    block = {"type": "gmsh", "file": file.name, "young": YOUNG, "poisson": POISSON, "small_strain": True}
    scene = {"schema": 1, "bodies": ["block"], "block": block, "steps": {"count": 1}, **rest}
    return write(scene, driver.output / f"{file.stem}_{name}.yaml")


def patch_of_all_sides():
    surfaces = [f"block.{side}" for side in SIDES]
    grip = {"surface": surfaces, "components": ["x", "y", "z"], "gradient": shear().ravel().tolist()}
    return {"supports": ["grip"], "grip": grip}


def pressure(verdicts, driver):
    """On a curved top with straight edges a pressure adds up to its product with the flat area, and a traction on a flat
    side to its own with it."""
    for kind in KINDS:
        file = SecondOrder(kind, 2, wavy).write_41(driver.output / f"{kind}_loads.msh")
        rest = {
            "supports": ["ground"],
            "ground": {"surface": "block.zmin", "components": ["x", "y", "z"]},
            "loads": ["press", "pull"],
            "press": {"surface": "block.zmax", "pressure": 7},
            "pull": {"surface": "block.xmax", "traction": [3, -1, 2]},
        }
        for ranks in (1, 2):
            label = f"loads_{kind}_{ranks}"
            run = driver.run(cube(driver, file, "loads", rest), label=label, ranks=ranks)
            error = np.abs(np.array(run.steps[-1]["reactions"]["ground"]) - (-3, 1, 5)).max() / 7
            what = f"{kind}, {ranks} ranks: pressure on a curved side, traction on a flat one: reactions"
            verdicts.below(what, error, BALANCE_BOUND, "they add up")


def tube_scene(kind, n, angle):
    body = {"type": "box", "lower": [1, 0, 0], "upper": [2, angle, 1 / n], "cells": [n, 2 * n * angle // 90, 1]}
    body |= {"polar": True, "cell": kind, "young": YOUNG, "poisson": POISSON, "small_strain": True}
    return {
        "schema": 1,
        "bodies": ["tube"],
        "tube": body,
        "loads": ["press"],
        "press": {"surface": "tube.xmin", "pressure": 10},
        "steps": {"count": 1},
    }


def lame_errors(run):
    """Of the displacements, relative, as root mean square over nodes and the largest: a tube in plane strain under inner
    pressure."""
    points, _, displacement = run.mesh()
    shear_modulus, a, b, p = YOUNG / (2 * (1 + POISSON)), 1, 2, 10
    radius = np.hypot(points[:, 0], points[:, 1])
    radial = p * a * a / (b * b - a * a) / (2 * shear_modulus) * ((1 - 2 * POISSON) * radius + b * b / radius)
    exact = np.zeros_like(points)
    exact[:, :2] = (radial / radius)[:, None] * points[:, :2]
    mean = np.linalg.norm(displacement - exact) / np.linalg.norm(exact)
    return mean, np.abs(displacement - exact).max() / np.abs(exact).max()


def tube(verdicts, driver):
    """A quarter of a tube, its edges on the circles."""
    walls = {"ends": ("tube.zmin", "tube.zmax", "z"), "left": ("tube.ymax", "x"), "low": ("tube.ymin", "y")}
    supports = {k: {"surface": list(v[:-1]), "components": [v[-1]]} for k, v in walls.items()}
    for kind in (*KINDS, "hex"):
        errors = []
        for n in (2, 4):
            scene = tube_scene(kind, n, 90) | {"supports": list(supports)} | supports
            path = write(scene, driver.output / f"tube_{kind}_{n}.yaml")
            errors.append(lame_errors(driver.run(path, label=path.stem))[0])
        order = np.log2(errors[0] / errors[1])
        if kind == "hex":
            verdicts.within("tube of hex8: order of displacements", order, 1.5, LINEAR_ORDER, "linear: 2")
        else:
            verdicts.at_least(f"tube of {kind}: order of displacements", order, LEAST_ORDER, "quadratic: 3")


def closed(verdicts, driver):
    """The whole tube, closed in itself: as good as the quarter on the same mesh."""
    fixed = {"top": ([0, 1, 0], "x"), "right": ([1, 0, 0], "y"), "left": ([-1, 0, 0], "y")}
    points = {k: {"body": "tube", "point": at, "components": [c]} for k, (at, c) in fixed.items()}
    points["ends"] = {"body": "tube", "components": ["z"]}
    for kind in KINDS:
        path = write(tube_scene(kind, 2, 360) | {"supports": list(points)} | points, driver.output / f"closed_{kind}.yaml")
        error = lame_errors(driver.run(path, label=path.stem))[1]
        flat = {"left": "tube.ymax", "low": "tube.ymin"}
        walls = {k: {"surface": s, "components": ["x" if k == "left" else "y"]} for k, s in flat.items()}
        walls["ends"] = points["ends"]
        path = write(tube_scene(kind, 2, 90) | {"supports": list(walls)} | walls, driver.output / f"quarter_{kind}.yaml")
        quarter = lame_errors(driver.run(path, label=path.stem))[1]
        if kind == "tet10":  # the split of hexahedra has no planes of symmetry: as good, not the same
            verdicts.near("closed tube of tet10: error", error, quarter, SPLIT_BOUND, "the quarter of it")
        else:
            verdicts.near(f"closed tube of {kind}: error", error, quarter, SAME_BOUND, "the quarter of it")


def beam(verdicts, driver):
    """A slender cantilever, 1 x 1 x 20, one layer of cells: tip under a force, bending and shear after Timoshenko."""
    length, force = 20.0, 0.01
    body = {"type": "box", "lower": [0, 0, 0], "upper": [length, 1, 1], "cells": [10, 1, 1], "young": YOUNG}
    scene = {
        "schema": 1,
        "bodies": ["beam"],
        "beam": body | {"poisson": 0.0, "small_strain": True},
        "supports": ["clamp"],
        "clamp": {"surface": "beam.xmin", "components": ["x", "y", "z"]},
        "loads": ["pull"],
        "pull": {"surface": "beam.xmax", "traction": [0, 0, force]},
        "probes": ["tip"],
        "tip": {"body": "beam", "point": [length, 0, 0]},
        "steps": {"count": 1},
    }
    path = write(scene, driver.output / "beam.yaml")
    exact = force * length**3 / (3 * YOUNG / 12) + force * length / (5 / 6 * YOUNG / 2)
    for kind in (*KINDS, "tet"):
        tip = driver.run(path, "-beam_cell", kind, label=f"beam_{kind}").steps[-1]["probes"]["tip"][2]
        if kind == "tet":
            verdicts.at_least("cantilever, one layer of tet4: stiffness over the beam's", exact / tip, STIFF, "tet4 lock")
        else:
            verdicts.near(f"cantilever, one layer of {kind}: tip", tip, exact, BEAM_BOUND, "Timoshenko's beam")


def locking(verdicts, driver):
    """Cook's membrane, nearly incompressible, pointwise: linear hexahedra are 2.9 times too stiff (group `materials`)."""
    fine = driver.run("cook", label="cook_hex8_mean").steps[-1]["probes"]["tip"][1]
    for kind in KINDS:
        options = ("-panel_cell", kind, "-panel_dilatation", "pointwise", "-panel_cells", "8,8,1")
        tip = driver.run("cook", *options, label=f"cook_{kind}").steps[-1]["probes"]["tip"][1]
        verdicts.near(f"Cook, nu 0.4999, 8 cells of {kind}, pointwise: tip", tip, fine, LOCKING_BOUND, "16 of hex8, mean")


def contact(verdicts, driver):
    """Two bodies with quadratic faces: the patch test, with multipliers at corners alone and at all nodes; the tangent."""
    for kind in KINDS:
        options = ("-upper_cell", kind, "-lower_cell", kind, "-base_weights", "reference")
        run = driver.run("patch_flat_5_7", *options, label=f"contact_{kind}")
        table = run.interface("base")
        corners = np.isclose((table["X"] * 5) % 1, 0) | np.isclose((table["X"] * 5) % 1, 1)
        corners &= np.isclose((table["Y"] * 5) % 1, 0) | np.isclose((table["Y"] * 5) % 1, 1)
        error = np.abs(table["lambda_n"][corners] + 10).max() / 10
        verdicts.below(f"patch test of contact, {kind}: multipliers at corners", error, EXACT_BOUND, "exact solution")
        others = np.abs(table["lambda_n"][~corners]).max()
        verdicts.below(f"patch test of contact, {kind}: at other nodes", others, 0, "they have none")
        error = np.abs(table["p_lumped"] - 10).max() / 10
        verdicts.below(f"patch test of contact, {kind}: nodal tractions", error, EXACT_BOUND, "exact, at every node")
        everywhere = driver.run("patch_flat_5_7", *options, "-base_multiplier_space", "sub", label=f"sub_{kind}")
        error = np.abs(everywhere.interface("base")["p_lumped"] - 10).max() / 10
        verdicts.below(f"patch test of contact, {kind}, sub: nodal tractions", error, EXACT_BOUND, "exact, at every node")
        pair = ("-upper_cell", kind, "-lower_cell", kind)
        run = driver.run("jacobian_states", *pair, "-snes_test_jacobian", label=f"tangent_{kind}")
        whole_matrix(verdicts, f"contact, {kind}", run)
