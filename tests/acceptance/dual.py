"""Checks of dual multipliers (`basis: dual`): the tractions that the standard basis makes oscillate beside a corner and
under a ball are those of the references; patches are exact; no scene takes more iterations."""

import comparisons
import numpy as np
from comparisons import BLOCK
from reference import clamped_block
from scene import SCENES, interfaces

DUAL = ("-base_basis", "dual")
# Digits of the reference: five or six.
TABLE_BOUND = 1e-3
# Over the largest pressure of a ball, about a smooth profile within 0.75 of the contact radius, which is four facets:
# 0.46 % and 1.4 % are measured, and 8.9 % with the standard basis.
SCATTER_BOUND, LARGEST_BOUND = 0.005, 0.02
STANDARD_SCATTER = 0.02
INNER = 0.75
# A node's force is its multiplier times its covered area: only rounding is left, over the largest traction.
TRACTION_BOUND = 1e-12
# Four facets a contact radius: both bases are as far from the limit.
RESULTANT_BOUND = 0.01
# Eight and twelve facets over the contact radius, 16 and 24 across the contact: 0.5 and 1 % are asked for.
FINE_SCATTER, FINE_LARGEST = 0.005, 0.01
FINE_BALLS = (8, 12)
# Against an independent solver on the same mesh, without the two nodes at the ends, which are singular.
BLOCKS, BLOCK_BOUND = ((40, 20), (80, 40), (160, 80)), 0.01
# Of a scene more than so many, and more than this part, count; the longest scene is left out.
MORE_ITERATIONS, MORE_PART, TOO_LONG = 3, 0.2, ("shallow_ironing",)
# A node that is open has no force.
FORCELESS = 0.01


def dual(verdicts, driver):
    block(verdicts, driver)
    ball(verdicts, driver)
    for case in comparisons.patch_cases():
        run = driver.run(case.scene, *case.options, *DUAL, label=f"dual_{case.label}")
        error = comparisons.patch_error(run, case)
        verdicts.below(f"{case.label}: multiplier error", error, comparisons.PATCH_BOUND, "exact solution")
    for scene, interface in (("mindlin", "contact"), ("symmetry_plane", "contact"), ("block_bottom_mu02_current", "base"),
                             ("ball_on_plane", "contact"), ("ball_on_plane_friction", "contact")):
        standard, run = (driver.run(scene, f"-{interface}_basis", basis, label=f"{scene}_{basis}")
                         for basis in ("standard", "dual"))
        verdicts.below(f"{scene}: Newton iterations", run.newton_iterations, standard.newton_iterations, "standard basis")
        if scene.startswith("ball_on_plane"):  # analytic: no facets to compare with
            forces = [np.array(r.resultant(interface)) for r in (standard, run)]
            apart = np.linalg.norm(forces[1] - forces[0]) / np.linalg.norm(forces[0])
            verdicts.below(f"{scene}: resultant", apart, RESULTANT_BOUND, "standard basis")
        verdicts.below(f"{scene}: cut-backs", run.summary["cutbacks"], 0, "as with the standard basis")


def traction(verdicts, label, run, interface):
    """The driver's tractions, nodal forces over covered areas, are minus the multipliers."""
    table = run.interface(interface)
    covered = table[table["area_covered"] > 0]
    fields = {name: run.point_field(f"{name}_{interface}")[covered["node"]] for name in ("traction", "multiplier")}
    largest = np.linalg.norm(fields["multiplier"], axis=1).max()
    worst = np.linalg.norm(fields["traction"] + fields["multiplier"], axis=1).max() / largest
    verdicts.below(f"{label}: traction_{interface} and the multiplier, VTU", worst, TRACTION_BOUND, "the same at covered nodes")
    normal = np.stack([covered["nx"], covered["ny"], covered["nz"]], axis=1)
    tangential = np.stack([covered[f"t_lumped_{k}"] for k in "xyz"], axis=1)
    worst = np.linalg.norm(covered["p_lumped"][:, None] * normal + tangential - fields["traction"], axis=1).max() / largest
    verdicts.below(f"{label}: p_lumped and t_lumped, CSV", worst, TRACTION_BOUND, f"parts of traction_{interface}")


def block(verdicts, driver):
    run = driver.run("block_zone_mu05", *DUAL, label="block")
    traction(verdicts, "block", run, "base")
    table, reference = run.interface("base"), BLOCK["zone36_stick"]
    front = np.flatnonzero(table["Y"] == table["Y"].min())
    front = front[np.argsort(table["X"][front])]
    for what, column, sign in (("normal", "lambda_n", -1), ("tangential", "lambda_tx", 1)):
        values = np.interp(reference["x"], table["X"][front], sign * table[column][front])
        key = {"normal": "p_n_20x10", "tangential": "p_t_20x10"}[what]
        worst = np.abs(values / reference[key] - 1).max()
        verdicts.below(f"block: {what} traction at the table's nodes", worst, TABLE_BOUND, "independent solver")
    verdicts.below("block: nodes that do not stick", int((table["state"] != "stick").sum()), 0, "reference: all stick")
    changes = int((np.diff(np.sign(table["lambda_tx"][front])) != 0).sum())
    verdicts.below("block: changes of the shear's sign", changes, 1, "smooth")


def about_profile(table):
    """Root mean square and largest deviation of nodal pressures from a smooth radial profile, over the largest one; and of
    how many nodes: those of an interface's table within INNER of the contact radius."""
    r, p = np.hypot(table["X"], table["Y"]), -table["lambda_n"]
    radius = r[table["state"] != "gap"].max()
    inner = r < INNER * radius
    fit = np.linalg.lstsq(np.stack([r[inner] ** k for k in (0, 2, 4)], axis=1), p[inner] ** 2, rcond=None)[0]
    smooth = np.sqrt(sum(c * r[inner] ** k for c, k in zip(fit, (0, 2, 4))))
    off = np.abs(p[inner] - smooth) / smooth.max()
    return np.sqrt((off**2).mean()), off.max(), len(off)


def scatter(run):
    """about_profile(), and the largest force of a node in gap over the largest of all."""
    table = run.interface("contact")
    rms, largest, _ = about_profile(table)
    forces = np.abs(table["fz"])
    return rms, largest, forces[table["state"] == "gap"].max() / forces.max()


def ball(verdicts, driver):
    runs = {basis: driver.run("ball_on_block", "-contact_basis", basis, "-output_vtu", "last", label=f"ball_{basis}")
            for basis in ("standard", "dual")}
    traction(verdicts, "ball", runs["dual"], "contact")
    found = {basis: scatter(run) for basis, run in runs.items()}
    rms, largest, of_open = found["dual"]
    verdicts.below("ball: scatter of the pressure", rms, SCATTER_BOUND, "a smooth profile")
    verdicts.below("ball: largest deviation", largest, LARGEST_BOUND, "a smooth profile")
    verdicts.below("ball: largest force of an open node", of_open, FORCELESS, "open")
    verdicts.at_least("ball: scatter with the standard basis", found["standard"][0], STANDARD_SCATTER, "it oscillates")


def dual_full(verdicts, driver):
    """Minutes: finer blocks and balls."""
    for columns, rows in BLOCKS:
        fine_block(verdicts, driver, columns, rows)
    for facets in FINE_BALLS:
        fine_ball(verdicts, driver, facets)


def fine_block(verdicts, driver, columns, rows):
    """All nodes stick, so that the independent solver's nodal forces are those of a clamped block."""
    mesh = ("-block_cells", f"{columns},1,{rows}", "-floor_cells", f"{columns * 13 // 20},3,1", "-steps_count", "4")
    run = driver.run("block_zone_mu05", *DUAL, *mesh, "-output_vtu", "none", label=f"block_{columns}")
    table, label = run.interface("base"), f"block {columns} x {rows}"
    front = table[table["Y"] == table["Y"].min()]
    front = np.sort(front, order="X")
    x, force = clamped_block(columns, rows)
    length = np.gradient(x)
    length[[0, -1]] = (x[1] - x[0]) / 2
    inner, pressure = slice(1, -1), force[:, 1] / length
    for what, found, column in (("normal", -front["lambda_n"], 1), ("tangential", front["lambda_tx"], 0)):
        expected = np.abs(force[:, column] / length) if column else -force[:, 0] / length
        worst = (np.abs(found - expected) / pressure)[inner].max()
        verdicts.below(f"{label}: {what} traction at a node, over the pressure there", worst, BLOCK_BOUND, "independent solver")
    verdicts.below(f"{label}: nodes that do not stick", int((table["state"] != "stick").sum()), 0, "reference: all stick")
    # On 40 x 20 the independent solver's own shear is negative at x = 0.4: the cells' doing, no multiplier's.
    changes, theirs = (int((np.diff(np.sign(t[inner])) != 0).sum()) for t in (front["lambda_tx"], -force[:, 0]))
    verdicts.below(f"{label}: changes of the shear's sign", changes, max(1, theirs), f"independent solver: {theirs}")


def fine_ball(verdicts, driver, facets):
    """So many facets over the contact radius of 0.1."""
    h = 0.1 / facets
    fine = [k * h for k in range(round(0.15 / h) + 1)]
    text = lambda values: ",".join(f"{v:.10g}" for v in values)
    ball, block = text([*fine, 0.2, 0.32, 0.56, 1]), text([*(1.16 * x for x in fine), 0.23, 0.36, 0.63, 1.2])
    deep = [-1 + k * h for k in range(4)] + [-0.95, -0.92, -0.87, -0.76, -0.5, 0]
    down = [-2.2, -1.6, -1.28, -1.14, -1.09, -1.05, *(-1 - 1.16 * k * h for k in (3, 2, 1)), -1]
    mesh = ("-ball_x", ball, "-ball_y", ball, "-ball_z", text(deep), "-block_x", block, "-block_y", block, "-block_z", text(down))
    run = driver.run("ball_on_block", "-contact_basis", "dual", *mesh, label=f"ball_{facets}")
    rms, largest, of_open = scatter(run)
    label = f"ball, {2 * facets} facets across the contact"
    verdicts.below(f"{label}: scatter of the pressure", rms, FINE_SCATTER, "a smooth profile")
    verdicts.below(f"{label}: largest deviation", largest, FINE_LARGEST, "a smooth profile")
    verdicts.below(f"{label}: largest force of an open node", of_open, FORCELESS, "open")


def dual_iterations(verdicts, driver):
    """A quarter of an hour: Newton's iterations over all scenes, with both bases."""
    total = {"standard": 0, "dual": 0}
    for path in sorted(SCENES.glob("*.yaml")):
        names = interfaces(path)
        if not names or path.stem in TOO_LONG:
            continue
        counts = {}
        for basis in total:
            options = [word for name in names for word in (f"-{name}_basis", basis)]
            run = driver.run(path.stem, *options, "-output_vtu", "none", "-output_csv", "none", label=f"{path.stem}_{basis}")
            counts[basis] = run.newton_iterations
            total[basis] += run.newton_iterations
        more = counts["dual"] - counts["standard"]
        allowed = max(MORE_ITERATIONS, MORE_PART * counts["standard"])
        verdicts.below(f"{path.stem}: more iterations", more, allowed, f"{counts['standard']}, dual {counts['dual']}")
    verdicts.below("all scenes: iterations", total["dual"], total["standard"], "standard basis")
