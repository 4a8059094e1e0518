"""Laws in the place of Coulomb's: a block pulled with cohesion, a slider whose friction weakens, the direction in which a block on
an orthotropic surface slides; and a pad that falls onto a base and is pushed with a little less and a little more than friction bears.

The sliding blocks are stiff, so that each node slips by what the block is moved by, and the answers are closed."""

import numpy as np
from ranks import CONDENSED
from ranks_moving import SLIDING, moving
from scene import write

# Young's modulus over the pressure: of the slips, 1e-2 to 1e-1 of blocks 0.05 high, the strain takes away 1e-5.
STIFF, CLOSED = 1e5, 1e-4
# By this the top of a block is pressed in, where no load may press it.
PRESS = 1e-6
# Sums of nodal forces with all nodes slipping: no stiffness enters.
SUMS = 1e-10
# Two ways to one answer, each to Newton's tolerance of 1e-11 of forces that are 1e5 times the pressure at the stiffest.
CONVERGED = 1e-8
PRESSURE, MU = 2.0, 0.4
COHESION = 0.7
AFTER, CRITICAL = 0.15, 0.08
ACROSS = 0.1
ANGLE = np.radians(30)
ALONG = [float(np.cos(ANGLE)), float(np.sin(ANGLE)), 0]


def laws(verdicts, driver):
    driver.output.mkdir(parents=True, exist_ok=True)
    for basis in ("standard", "dual"):
        cohesion(verdicts, driver, basis)
        weakening(verdicts, driver, basis)
        orthotropic(verdicts, driver, basis)
        layers(verdicts, driver, basis)
    framed(verdicts, driver)
    condensed(verdicts, driver)
    ranks(verdicts, driver)
    pad(verdicts, driver)


def pulled(young, displacement, times, basis, free=False, **interface):
    """A block of 1 by 1 on a longer one, its top pressed and moved along (x, y) over the given times; free: not along y."""
    box = {"type": "box", "young": young, "poisson": 0, "small_strain": True}
    supports = {"floor": {"surface": "lower.zmin", "components": ["x", "y", "z"]}}
    for name, way in zip("xy", displacement):
        if name == "y" and free:
            continue
        curve = [value for t, part in times for value in (t, part)]
        supports[f"pull{name}"] = {"surface": "upper.zmax", "components": [name], "value": [way if i == name else 0 for i in "xyz"], "curve": curve}
    return {
        "schema": 1,
        "bodies": ["upper", "lower"],
        "upper": {**box, "lower": [0, 0, 0], "upper": [1, 1, 0.05], "cells": [3, 2, 1]},
        "lower": {**box, "lower": [-1, -1, -0.2], "upper": [2, 2, 0], "cells": [7, 8, 1]},
        "supports": list(supports),
        **supports,
        "loads": ["press"],
        "press": {"surface": "upper.zmax", "pressure": PRESSURE, "curve": [0, 1, 1, 1]},
        "interfaces": ["base"],
        "base": {"nonmortar": "upper.zmin", "mortar": "lower.zmax", "basis": basis, "friction": MU, **interface},
        "steps": {"times": [t for t, _ in times[1:]]},
        "output": {"csv": "last"},
    }


def force(run, step=-1):
    """Of the base on the block, along the surface."""
    return np.array(run.steps[step]["interfaces"]["base"]["force"])


def no_cutbacks(verdicts, what, run):
    verdicts.below(f"{what}: cut-backs", run.summary["cutbacks"], 0, "none")


def cohesion(verdicts, driver, basis):
    """Elastic, so that nodes slip one after the other; where all do, the force is that of area and pressure."""
    times = [(0, 0), (0.25, 0.0), (0.5, 0.3), (1, 1)]
    scene = pulled(1000, (0.05, 0), times, basis, law="cohesion", cohesion=COHESION)
    run = driver.run(write(scene, driver.output / f"cohesion_{basis}.yaml"))
    no_cutbacks(verdicts, f"cohesion, {basis}", run)
    table = run.interface("base")
    verdicts.below(f"cohesion, {basis}: nodes that do not slip", int(np.sum(table["state"] != "slip")), 0, "all do")
    shear = np.stack([table[f"lambda_t{i}"] for i in "xyz"], axis=1)
    limit = COHESION - MU * table["lambda_n"]
    verdicts.below(f"cohesion, {basis}: shear at the worst node", np.abs(np.linalg.norm(shear, axis=1) / limit - 1).max(), SUMS, "c + mu p")
    plain = driver.run(write(pulled(1000, (0.05, 0), times, basis, law="cohesion", cohesion=0), driver.output / f"cohesion_none_{basis}.yaml"))
    coulomb = driver.run(write(pulled(1000, (0.05, 0), times, basis, law="coulomb"), driver.output / f"coulomb_{basis}.yaml"))
    error = np.abs(force(plain) - force(coulomb)).max() / np.abs(force(coulomb)).max()
    verdicts.below(f"no cohesion, {basis}: force", error, SUMS, "Coulomb's")
    verdicts.near(f"no cohesion, {basis}: iterations", plain.newton_iterations, coulomb.newton_iterations, 0, "Coulomb's")


def weakening(verdicts, driver, basis):
    """There and back: the way counts, not the place."""
    ways = [0.0, 0.0, 0.25, 0.6, 0.5, 0.9, 2.0]
    times = [(k, part) for k, part in enumerate(ways)]
    scene = pulled(PRESSURE * STIFF, (CRITICAL, 0), times, basis, law="weakening", friction_after=AFTER, critical_slip=CRITICAL)
    run = driver.run(write(scene, driver.output / f"weakening_{basis}.yaml"))
    no_cutbacks(verdicts, f"weakening, {basis}", run)
    way = np.cumsum(np.abs(np.diff(ways)))
    for k in range(1, len(way)):
        exact = PRESSURE * (AFTER + (MU - AFTER) * max(0, 1 - way[k]))
        found = abs(force(run, k)[0])
        verdicts.near(f"weakening, {basis}: force after {way[k]:.2f} of the critical slip", found, exact, CLOSED, "mu of the way, times the load")


def orthotropic(verdicts, driver, basis):
    """Moved along x with y free, the block goes to where the traction across x vanishes; moved along a line, it is held by the point of
    the ellipse whose normal is that line."""
    axes = np.array([ALONG[:2], [-ALONG[1], ALONG[0]]])
    square = axes.T @ np.diag([MU**2, ACROSS**2]) @ axes
    law = {"law": "orthotropic", "friction_across": ACROSS, "direction": ALONG}
    # Friction alone holds the block across: it finds its way in small steps.
    times = [(0, 0), (1, 0), (2, 1e-3), (3, 1e-2), (4, 0.1), (5, 1)]
    run = driver.run(write(pulled(PRESSURE * STIFF, (0.1, 0), times, basis, free=True, **law), driver.output / f"orthotropic_free_{basis}.yaml"))
    no_cutbacks(verdicts, f"orthotropic, free across, {basis}", run)
    table = run.interface("base")
    exact = np.linalg.solve(square, [1.0, 0.0])
    found = table["slip_y"].mean() / table["slip_x"].mean()
    verdicts.near(f"orthotropic, {basis}: direction of the slide", found, exact[1] / exact[0], CLOSED, "at a right angle to the ellipse")
    verdicts.below(f"orthotropic, {basis}: force across", abs(force(run)[1]) / abs(force(run)[0]), CLOSED, "nothing holds it")
    away = np.array([np.cos(1.3), np.sin(1.3)])
    scene = pulled(PRESSURE * STIFF, tuple(0.1 * away), times, basis, **law)
    run = driver.run(write(scene, driver.output / f"orthotropic_{basis}.yaml"))
    no_cutbacks(verdicts, f"orthotropic, {basis}", run)
    exact = PRESSURE * square @ away / np.sqrt(away @ square @ away)
    found = force(run)[:2] * np.sign(force(run)[:2] @ away)
    verdicts.below(f"orthotropic, {basis}: force", np.abs(found / exact - 1).max(), CLOSED, "the point of the ellipse with that normal")


WEAR = 1e-3
BOND = {"bond_stiffness": 10, "bond_strength": 0.5, "bond_toughness": 0.05}
TABLE = {"overclosure": [0, 1e-3, 2e-3], "overclosure_pressure": [0, 1, 4]}


def layers(verdicts, driver, basis):
    """What lies between the block and its base: worn off, the product of pressure and way; a bond, its secant; a table, where the pressure is."""
    ways, way = [(0, 0), (1, 0), (2, 0.25), (3, 1)], 0.08
    run = driver.run(write(pulled(PRESSURE * STIFF, (way, 0), ways, basis, wear=WEAR), driver.output / f"worn_{basis}.yaml"))
    no_cutbacks(verdicts, f"worn, {basis}", run)
    table, volume = run.interface("base"), run.steps[-1]["interfaces"]["base"]["worn_volume"]
    exact = WEAR * PRESSURE * way  # of an area of 1; friction tilts the pressure, and the load stays
    verdicts.near(f"worn, {basis}: depth, the mean over k p s", table["worn"] @ table["area_covered"] / exact, 1, CLOSED, "one")
    verdicts.near(f"worn, {basis}: volume over k p s", volume / exact, 1, CLOSED, "the area")
    scene = pulled(PRESSURE * STIFF, (way, 0), ways, basis, **BOND)
    scene["base"]["friction"] = 0
    run = driver.run(write(scene, driver.output / f"bond_{basis}.yaml"))
    first, last = BOND["bond_strength"] / BOND["bond_stiffness"], 2 * BOND["bond_toughness"] / BOND["bond_strength"]
    for step, part in ((2, 0.25), (3, 1)):
        share = min(1, (last - part * way) / (last - first) * first / (part * way))
        verdicts.near(f"bond, {basis}: force at {part * way:g}", abs(force(run, step - 1)[0]), share * BOND["bond_stiffness"] * part * way, CLOSED, "the law's")
    lost = run.steps[-1]["interfaces"]["base"]["bond_loss"]
    verdicts.near(f"bond, {basis}: work lost", lost, BOND["bond_toughness"] * (way - first) / (last - first), CLOSED, "of its part of the toughness")
    run = driver.run(write(pulled(1000, (0, 0), [(0, 0), (1, 1)], basis, **TABLE), driver.output / f"table_{basis}.yaml"))
    table = run.interface("base")
    depth, pressure = -table["gap_weighted"] / table["area_covered"], -table["lambda_n"]
    exact = np.interp(pressure, TABLE["overclosure_pressure"], TABLE["overclosure"])
    verdicts.below(f"table, {basis}: overlaps", np.abs(depth / exact - 1).max(), CONVERGED, "those of the pressures")
    verdicts.near(f"table, {basis}: pressure", pressure @ table["area_covered"], PRESSURE, CLOSED, "the load")


def framed(verdicts, driver):
    """The direction of an orthotropic law turns with the frame, as all else in the scene does: the block, held in space, is moved along it."""
    scene = pulled(PRESSURE * STIFF, (0, 0), [(0, 0), (1, 1)], "standard", law="orthotropic", friction_across=ACROSS, direction=ALONG)
    way = 0.1
    scene["supports"] = ["floor", "pull"]
    scene["pull"] = {"surface": "upper.zmax", "components": ["x", "y", "z"], "value": [way * ALONG[0], way * ALONG[1], -PRESS]}
    for key in ("loads", "press", "pullx", "pully"):
        del scene[key]
    path, angles = write(scene, driver.output / "orthotropic_frame.yaml"), (0, 90)
    forces = [force(driver.run(path, "-frame_rotate", f"0,0,{angle}", label=f"orthotropic_frame_{angle}")) for angle in angles]
    x, y, z = forces[0]
    verdicts.below("orthotropic, the frame turned: force", np.abs(forces[1] - [-y, x, z]).max() / z, CONVERGED, "turned with it")
    verdicts.near("orthotropic, along its direction: force", np.hypot(x, y) / z, MU, CLOSED, "its friction times the pressure")


def condensed(verdicts, driver):
    """The scenes with dual multipliers once more, without multipliers among the unknowns."""
    for name in ("cohesion", "weakening", "orthotropic"):
        path = driver.output / f"{name}_dual.yaml"
        runs = [driver.run(path, *options, label=f"{name}_{label}") for options, label in (((), "whole"), (CONDENSED, "condensed"))]
        apart = max(np.abs(force(runs[0], k) - force(runs[1], k)).max() for k in range(len(runs[0].steps)))
        verdicts.below(f"{name}, condensed: forces of all steps", apart / PRESSURE, CONVERGED, "those with multipliers")


def ranks(verdicts, driver):
    """The way that nodes have slipped, and what is worn off and parted, goes with them where parts are shared out anew."""
    law = {"law": "weakening", "friction_after": 0.1, "critical_slip": 2.0}
    moving(verdicts, driver, "weakening slide", {**SLIDING, "contact": {**SLIDING["contact"], **law}}, (2,))
    moving(verdicts, driver, "worn and bonded slide", {**SLIDING, "contact": {**SLIDING["contact"], "wear": 1e-4, **BOND}}, (2,))


# The pad's facets are this long; it falls through two of them.
FACET = 0.25
LENGTH, HEIGHT, LEASH = 2.0, 0.5, 0.5
# The forces' ratio is mu times what is pushed where the surfaces are flat; the pad's ends sink into a softer base. (What the leash
# bears is at most a hundredth of the limit, too, and 0 where the pad sticks.) Ten times softer, and not five times, the base's own normals,
# which go round the pad's edges, would lean by more.
TILTED, SOFTER = 8e-3, 200


def fallen(young_of_base, push, side):
    """A pad in the plane below a soft leash whose top cannot move along x, but falls freely: nothing but the contact carries the
    pressure. Then a body force pushes the pad with `push` times the limit of friction."""
    load = PRESSURE * LENGTH
    shear = 0.01 * MU * load * LEASH / (LENGTH * 0.3 * FACET)  # so soft that a hundredth of the limit moves it by 0.3 facets
    box = {"type": "box", "small_strain": True}
    gap = 2 * FACET
    surfaces = ["pad.ymin", "base.ymax"]
    keys = {"weak_coverage": 0.5} if side else {}
    return {
        "schema": 1,
        "model": "plane_strain",
        "bodies": ["pad", "leash", "base"],
        "pad": {**box, "young": 1000, "poisson": 0.3, "density": 1, "lower": [0, gap], "upper": [LENGTH, gap + HEIGHT],
                "cells": [round(LENGTH / FACET), 2]},
        "leash": {**box, "young": 2 * shear, "poisson": 0, "lower": [0, gap + HEIGHT], "upper": [LENGTH, gap + HEIGHT + LEASH],
                  "cells": [round(LENGTH / FACET), 2]},
        "base": {**box, "young": young_of_base, "poisson": 0.3, "lower": [-1, -1], "upper": [3.1, 0], "cells": [21, 5]},
        "supports": ["floor", "hold"],
        "floor": {"surface": "base.ymin", "components": ["x", "y"]},
        "hold": {"surface": "leash.ymax", "components": ["x"]},
        "loads": ["press", "push"],
        "press": {"surface": "pad.ymax", "pressure": PRESSURE, "curve": [0, 1, 1, 1]},
        "push": {"body": "pad", "gravity": [push * MU * load / (LENGTH * HEIGHT), 0], "curve": [0, 0, 0.5, 0, 1, 1]},
        "interfaces": ["glue", "contact"],
        "glue": {"nonmortar": "leash.ymin", "mortar": "pad.ymax", "law": "tied"},
        "contact": {"nonmortar": surfaces[side], "mortar": surfaces[1 - side], "friction": MU, **keys},
        "steps": {"times": [0.5, 0.6, 0.7, 0.8, 0.9, 1]},
        "output": {"csv": "last"},
    }


def own_share(run):
    """What friction bears at all nodes, each along its own tangent, over mu times what presses along its normal."""
    table = run.interface("contact")
    shear = np.hypot(table["t_lumped_x"], table["t_lumped_y"])
    return shear @ table["area_covered"] / (MU * table["p_lumped"] @ table["area_covered"])


def pad(verdicts, driver):
    for name, young in (("softer", SOFTER), ("as stiff", 1000), ("stiffer", 10000)):
        for side, carries in enumerate(("pad", "base")):
            for push in (0.99, 1.01):
                what = f"pad on a {name} base, {carries} non-mortar, {push} of the limit"
                label = f"pad_{young}_{carries}_{push}"
                run = driver.run(write(fallen(young, push, side), driver.output / f"{label}.yaml"))
                no_cutbacks(verdicts, what, run)
                shear, normal = np.abs(run.resultant("contact")[:2])
                verdicts.near(f"{what}: pressure", normal, PRESSURE * LENGTH, 1e-9, "the load")
                share, states = shear / (MU * normal), run.interface("contact")["state"]
                if push < 1:
                    verdicts.near(f"{what}: friction", share, push, TILTED, "bears the push: it sticks")
                    verdicts.at_least(f"{what}: nodes that stick", int(np.sum(states == "stick")), 1, "some do")
                else:
                    verdicts.near(f"{what}: friction", share, 1, TILTED, "its limit: it slides")
                    if carries == "pad":  # along its own normals, wherever these point
                        verdicts.near(f"{what}: friction of its nodes", own_share(run), 1, SUMS, "mu times the pressure")
                    verdicts.below(f"{what}: nodes that stick", int(np.sum(states == "stick")), 0, "none does")
