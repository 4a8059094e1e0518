"""What is compared on each family of scenes, and how closely. Used by the demonstration and by the acceptance checks.

Each function takes the Verdicts to add to and a finished run. All figures are per unit thickness.
"""

from dataclasses import dataclass

import numpy as np

from reference import BLOCK, Hertz, clamped_block, fit_hertz
from scene import multiplier

INTERFACE = "base"  # its name in the patch and block scenes

# The multiplier of a patch test is exact: what is left is the linear solver's round-off, about 1e-12 on 20 x 20 facets.
PATCH_BOUND = 1e-10
# Resultants follow from equilibrium on any mesh: only the Newton tolerance enters.
RESULTANT_BOUND = 1e-10
# Same plane problem solved by another program: 1e-6 leaves room for the two linear solvers and the Newton tolerance.
STICK_FORCE_BOUND = 1e-6
# Coulomb's law acts on the multiplier field here, on nodal forces in the reference: O(h) next to the ends, little inside.
INNER_TRACTION_BOUND = 1e-2
INNER = (1.4, 2.6)
# Same reason; displacements and work are integrals and differ less.
SLIP_GLOBAL_BOUND = 1e-3
# Finite bodies stop at O(a/R) = 8 %, most of which is in the approach; pressure and width stay within 3 %.
HERTZ_BOUND = 0.03


def thickness(run, interface=INTERFACE):
    return np.ptp(run.interface(interface)["Y"])


def stretch(table):
    """Current over reference area of a flat interface that deforms homogeneously: from the best affine map."""
    reference = np.stack([table["X"], table["Y"], table["Z"]], axis=1)
    moved = reference + np.stack([table["ux"], table["uy"], table["uz"]], axis=1)
    reference, moved = reference - reference.mean(axis=0), moved - moved.mean(axis=0)
    plane = np.linalg.svd(reference, full_matrices=False)[2][:2]  # two unit vectors in the interface
    mapped = np.linalg.lstsq(reference @ plane.T, moved, rcond=None)[0]
    return np.linalg.norm(np.cross(mapped[0], mapped[1]))


@dataclass
class PatchCase:
    """One patch scene, and the exact traction on its undeformed non-mortar face."""

    scene: str
    traction: tuple
    options: tuple = ()
    series: str = "with friction"
    short: str = ""  # for the figure

    @property
    def label(self):
        return f"{self.scene}_{self.series}" if self.options else self.scene


PATCH_MESHES = [(3, 4), (5, 7), (8, 11), (10, 12), (20, 23)]


def patch_cases():
    for n, m in PATCH_MESHES:
        scene, short = f"patch_flat_{n}_{m}", f"{n}² on\n{m}²"
        yield PatchCase(scene, (0, 0, 10), short=short)
        yield PatchCase(scene, (0, 0, 10), ("-base_friction", "0"), "frictionless", short)
    yield PatchCase("patch_gmsh", (0, 0, 10), short="tets,\nGmsh")
    yield PatchCase("patch_mixed", (0, 0, 10), short="tet on\nhex")
    yield PatchCase("patch_punch", (0, 0, 10), ("-base_friction", "0"), "frictionless", short="punch")
    yield PatchCase("patch_shear", (-2.5, 0, 10), short="shear")
    yield PatchCase("patch_swapped", (0, 0, -10), short="roles\nswapped")
    # the load acts on the horizontal top, the interface is larger by 1 / cos(20 degrees)
    yield PatchCase("patch_inclined", (0, 0, 10 * np.cos(np.radians(20))), short="inclined")
    x, y = np.radians(20), np.radians(30)
    about_x = np.array([[1, 0, 0], [0, np.cos(x), -np.sin(x)], [0, np.sin(x), np.cos(x)]])
    about_y = np.array([[np.cos(y), 0, np.sin(y)], [0, 1, 0], [-np.sin(y), 0, np.cos(y)]])
    yield PatchCase("patch_rotated", tuple(about_y @ about_x @ (0, 0, 10)), short="rotated")


def patch_error(run, case, deformed=True, interface=INTERFACE):
    """Largest relative error of the nodal multipliers.

    With weights of the current configuration the exact multiplier is minus the force over the *deformed* area.
    """
    table = run.interface(interface)
    exact = -np.asarray(case.traction) / (stretch(table) if deformed else 1)
    return np.linalg.norm(multiplier(table) - exact, axis=1).max() / np.linalg.norm(exact)


def difference(run, other, interface=INTERFACE, length=1.0, force=1.0):
    """Largest difference of displacements (interface nodes and probes) and of nodal forces at the end, each relative to
    its largest value; the first run is in units `length` and `force` times those of the other."""

    def fields(run):
        table = run.interface(interface)
        order = np.lexsort([table[name] for name in "ZYX"])  # on several ranks nodes come in any
        vectors = lambda *names: np.stack([table[name] for name in names], axis=1)[order]
        probes = np.reshape(list(run.steps[-1]["probes"].values()), (-1, 3))
        return np.concatenate([vectors("ux", "uy", "uz"), probes]), vectors("fx", "fy", "fz")

    return max(
        np.abs(ours / unit - theirs).max() / np.abs(theirs).max()
        for ours, theirs, unit in zip(fields(run), fields(other), (length, force))
    )


def block_resultants(verdicts, label, run):
    force = run.resultant(INTERFACE) / thickness(run)
    exact = BLOCK["resultants"]
    verdicts.near(f"{label}: normal resultant", force[2], exact["normal"], RESULTANT_BOUND, "statics")
    verdicts.near(f"{label}: tangential resultant", -force[0], exact["tangential"], RESULTANT_BOUND, "statics")


def block_all_stick(verdicts, label, run, columns=20, rows=10):
    """Every node sticks: the nodal forces are those of the clamped block."""
    line = run.line(INTERFACE)
    x, force = clamped_block(columns, rows)
    verdicts.true(
        f"{label}: every node sticks",
        set(line.state) == {"stick"},
        "mu is large enough for multipliers and forces alike",
    )
    if len(x) != len(line.x):
        verdicts.failed(f"{label}: nodal forces", f"{len(line.x)} nodes along x instead of {len(x)}")
        return
    worst = np.abs(line.force[:, [0, 2]] - force).max() / np.abs(force).max()
    verdicts.below(
        f"{label}: nodal forces against the clamped block",
        worst,
        STICK_FORCE_BOUND,
        "same discrete problem, other program",
    )


def block_inner_tractions(verdicts, label, run):
    line, table = run.line(INTERFACE), BLOCK["zone36_stick"]
    for component, values, key in (
        ("normal", line.traction[:, 2], "p_n_20x10"),
        ("tangential", -line.traction[:, 0], "p_t_20x10"),
    ):
        inner = [(x, reference) for x, reference in zip(table["x"], table[key]) if INNER[0] <= x <= INNER[1]]
        worst = max(abs(np.interp(x, line.x, values) / reference - 1) for x, reference in inner)
        verdicts.below(
            f"{label}: {component} traction, {INNER[0]} <= x <= {INNER[1]}",
            worst,
            INNER_TRACTION_BOUND,
            "largest of the table's nodes there",
        )


def stick_zone(line):
    """(first, last) x of the stick nodes."""
    stick = line.x[line.state == "stick"]
    return (stick.min(), stick.max()) if len(stick) else (np.nan, np.nan)


def vertical_step(run):
    """Index of the step that ends the vertical load, at t = 1."""
    return next(i for i, step in enumerate(run.steps) if abs(step["t"] - 1) < 1e-12)


def slip_traction_error(run):
    """Largest difference from the 320x160 tractions, relative to the largest of each component."""
    line, table = run.line(INTERFACE), BLOCK["bottom_slip"]
    components = ((line.traction[:, 2], "p_n_320x160"), (-line.traction[:, 0], "p_t_320x160"))
    return max(np.abs(np.interp(table["x"], line.x, v) - table[key]).max() / max(table[key]) for v, key in components)


def block_slip(verdicts, label, run, size=0.2):
    """Contact on the whole bottom, mu = 0.2: stick zone, displacement, work."""
    table, low_high = BLOCK["bottom_slip"], stick_zone(run.line(INTERFACE))
    for name, computed, reference in zip(("first", "last"), low_high, table["stick_20x10"]):
        verdicts.near(
            f"{label}: x of the {name} stick node (error in facets)", computed, reference, 1.0 + 1e-9, "one facet; in facets", scale=size
        )
    verdicts.near(
        f"{label}: u_x of the top left corner",
        run.steps[-1]["probes"]["topleft"][0],
        table["u_x_top_left_20x10"],
        SLIP_GLOBAL_BOUND,
        "Coulomb on multipliers, not on forces",
    )
    depth = thickness(run)
    for name, step in (("vertical", vertical_step(run)), ("lateral", -1)):
        work = run.steps[step]["external_work_half_fu"] / depth
        verdicts.near(
            f"{label}: 0.5 f.u, {name}",
            work,
            table[f"half_work_{name}_20x10"],
            SLIP_GLOBAL_BOUND,
            "Coulomb on multipliers, not on forces",
        )


def hertz(verdicts, label, run):
    """Peak pressure and half-width; returns the pair for the figure."""
    line = run.line("contact")
    pressure = line.traction[:, 2]
    peak, half_width = pressure.max(), fit_hertz(line.x, pressure)[1]
    verdicts.near(
        f"{label}: peak pressure, largest nodal value",
        peak,
        Hertz.peak,
        HERTZ_BOUND,
        "finite body, a/R = 0.085",
    )
    verdicts.near(
        f"{label}: half-width, ellipse through the profile",
        half_width,
        Hertz.half_width,
        HERTZ_BOUND,
        "finite body, a/R = 0.085",
    )
    return peak, half_width
