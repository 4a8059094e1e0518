"""Friction that is decided at points: uniform tractions that stick up to the limit and hold a slope, over stiffness, meshes, r and units;
a block that is drawn along, stuck, tilted until it lifts off, and drawn to and fro."""

import numpy as np

import host
from cases import friction, held
from cases.points import CONTRASTS, NO_ANSWER, OF_CONTRAST, PRESSURE, STATICS, UNIFORM, UNITS, YOUNG, blocks
from cell import series
from comparisons import difference, multiplier
from scenes import patch_bound

SLIDES = ("0", "1e-12", "1e-6", "1e-3", "0.1", "0.3", "0.5", "1")
STICKS = ("1e1", "1e2", "1e4", "1e6")
TILTS = ("0", "0.3", "0.5", "0.7", "0.9")
# Friction of a block that is drawn to and fro, and in how many steps each way.
TURNS = [f"{mu} in {steps}" for mu in (0.1, 0.3, 0.6) for steps in (1, 2, 8)]
# Slip in one direction everywhere leaves nothing of what was before it: to Newton's tolerance, 1e-11 of all forces, times a hundred forces.
SAME = 1e-9
# Beside it another friction that nothing slips under.
ROUGH = 1e8
MU = 0.3
MESHES = ((3, 4), (2, 10), (10, 2), (1, 7), (7, 1))
SCALES = ("1e0", "1e1", "1e-1", "1e2", "1e-2", "1e4", "1e-4")
# Of the scene `patch_shear`. With the last r a step of Newton's method that is off by rounding passes the cone.
SHEAR = np.array([2.5, 0, -10])
SHEARED = ("1e0", "1e1", "1e-1", "1e2", "1e-2", "1e-4", "1e4")
# The matrix may be about standard multipliers or normals of now, which points do not have.
OF_POINTS = {"basis": "dual", "normals": "committed", "weights": "reference", "decision": "points"}


def law(name):
    return tuple(word for key, value in OF_POINTS.items() for word in (f"-{name}_{key}", value))


class Points:
    """A Context whose scenes are decided at points."""

    def __init__(self, context, name="base"):
        self.context, self.name = context, name

    def solve(self, scene, *options, **more):
        return self.context.solve(scene, *law(self.name), *options, **more)


def at_points(run):
    """A run of another family, its interface decided at points."""
    return lambda context: run(Points(context))


def uniform(scene, *options, pressure=PRESSURE, bound=UNIFORM):
    """Blocks that expand alike: nothing draws at the interface, which sticks."""

    def run(context):
        for side in ("upper", "lower"):
            scene[side]["poisson"] = 0.0
        scene["contact"] |= {"law": "coulomb", "friction": MU}
        run = Points(context, "contact").solve(scene, *options, kappa=True)
        outcome = host.outcome(run)
        if outcome.refusal is None:
            table = run.interface("contact")
            outcome.below("pressure, worst node", np.abs(table["p_lumped"] / pressure - 1).max(), bound, "uniform")
            along = np.hypot(table["lambda_tx"], table["lambda_ty"]).max() / pressure
            outcome.below("shear over pressure, worst node", along, bound, "nothing draws at it")
            outcome.true("sticks", (table["state"] == "stick").all(), "nothing draws at it")
        return outcome

    return run


def contrast(text):
    return uniform(blocks(contrast=float(text)), bound=UNIFORM + OF_CONTRAST * max(float(text), 1 / float(text)))


def augmentation(text):
    right = YOUNG / 2
    return uniform(blocks(), "-contact_modulus", right, "-contact_augmentation", float(text) * 0.9 * right * 3)


def sheared(friction, *options):
    """A brick held by stick alone, under a uniform shear. Weights and loads are both over areas of the first configuration."""

    def run(context):
        solved = Points(context).solve("patch_shear", "-base_friction", repr(friction), *options, kappa=True)
        result = host.outcome(solved)
        if result.refusal is None:
            error = np.abs(multiplier(solved.interface("base")) - SHEAR).max() / np.linalg.norm(SHEAR)
            result.below("multiplier", error, patch_bound(solved), "uniform and exact; max(1e-10, 100 eps kappa)")
        return result

    return run


def over_r(text):
    """Below the limit, with another r."""
    return sheared(MU, "-base_augmentation", float(text) * 0.9 * YOUNG / 2 * 3)


def drawn(text):
    """Every point slips: friction is mu times the pressure against the motion."""
    mu = float(text)

    def run(context):
        run = Points(context).solve(friction.scene(mu))
        result = host.outcome(run)
        if result.refusal is None:
            force, table = run.resultant("base"), run.interface("base")
            beyond = (np.hypot(table["fx"], table["fy"]) - mu * table["fz"]).max() / table["fz"].max()
            result.below("nodal forces beyond the cone, over the largest", max(beyond, 0.0), friction.NODES * friction.NEWTON, "no point is")
            if mu <= friction.FLAT:
                excess = abs(np.hypot(force[0], force[1]) - mu * force[2]) / force[2]
                result.below("|T| - mu N over N", excess, friction.NODES * friction.NEWTON, "every point slips along x")
            result.true("friction is against the motion", mu <= 1e-9 or force[0] < 0, "Coulomb")
            if mu <= 1e-12:
                without = Points(context).solve(friction.scene(mu, "none"), name="none")
                result.below("against the frictionless law", difference(run, without), friction.SAME, "mu = 0 is its limit")
        return result

    return run


def stuck(text):
    """Nothing slips, whatever friction is."""

    def run(context):
        run, other = (Points(context).solve(friction.scene(mu, drawn=friction.DRAWN / 10), name=f"mu_{mu:g}") for mu in (float(text), ROUGH))
        result = host.outcome(run)
        if result.refusal is None and other.exit_code == host.CONVERGED:
            result.below("against ever more friction", difference(run, other), friction.SAME, "nothing slips in either")
        return result

    return run


def tilted(text):
    """The block is pressed with a moment until it lifts off on one side: all three forces by statics, no point beyond its cone."""
    share = float(text)

    def run(context):
        scene = blocks((6, 7))
        scene["front"]["surface"] = ["upper.ymin", "lower.ymin"]
        scene["left"]["surface"] = "lower.xmin"
        scene["supports"].append("top")
        scene["top"] = {"surface": "upper.zmax", "components": ["x", "z"], "value": [0.002, 0, -0.01], "origin": [0.5, 0, 1],
                        "gradient": [0, 0, 0, 0, 0, 0, 0.04 * share, 0, 0]}
        scene["contact"] |= {"law": "coulomb", "friction": MU}
        del scene["loads"], scene["press"]
        run = Points(context, "contact").solve(scene, kappa=True)
        outcome = host.outcome(run)
        if outcome.refusal is None:
            table, reactions = run.interface("contact"), run.steps[-1]["reactions"]
            force, scale = run.resultant("contact"), np.abs(table["fz"]).sum()
            lower = np.array(reactions["floor"]) + [reactions["left"][0], 0, 0]
            outcome.below("forces against those that hold the lower body", np.abs(force - lower)[::2].max() / scale, STATICS, "statics")
            outcome.true("no node pulls", (table["fz"] >= -1e-6 * scale).all(), "contact")
            outcome.below("shear of all over mu times the pressure", np.hypot(force[0], force[1]) / (MU * force[2]), 1 + STATICS, "Coulomb")
        return outcome

    return run


def to_and_fro(text):
    """In the plane, where slip has two directions: drawn one way, back beyond the start and the first way again, in so many steps each
    way. Where all points slip, what was before leaves nothing: the forces are those of being drawn there at once."""
    mu, _, steps = text.split()

    def run(context):
        scene = friction.scene(mu, drawn=friction.DRAWN)
        for side in ("upper", "lower"):
            scene[side] = scene[side] | {"small_strain": True, **{end: scene[side][end][::2] for end in ("lower", "upper", "cells")}}
        scene |= {"model": "plane_strain", "interfaces": ["base"]}
        scene["base"] |= {"nonmortar": "upper.ymin", "mortar": "lower.ymax"}
        scene["bottom"] = {"body": "lower", "components": ["x", "y"]}
        scene["press"] = scene["press"] | {"surface": "upper.ymax", "components": ["y"], "value": [0, -friction.PRESSED]}
        scene["draw"] = scene["draw"] | {"surface": "upper.ymax", "components": ["x"], "value": [friction.DRAWN, 0]}
        once = Points(context).solve(scene | {"steps": {"times": [1, 2]}}, name="once")
        scene["draw"] |= {"curve": [1, 0, 2, 1, 3, -1, 4, 1]}
        times = [1.0, *(1 + np.arange(1, 3 * int(steps) + 1) / int(steps))]
        run = Points(context).solve(scene | {"steps": {"times": times}})
        result = host.outcome(run)
        if result.refusal is None and once.exit_code == host.CONVERGED:
            table, other = run.interface("base"), once.interface("base")
            worst = max(np.abs(table[f] - other[f]).max() for f in ("fx", "fy")) / np.abs(other["fy"]).max()
            result.below("forces against those of one way, over the largest", worst, SAME, "slip leaves nothing of what was before")
            result.below("|T| - mu N over N", abs(abs(table["fx"].sum()) / table["fy"].sum() - float(mu)), SAME, "all points slip")
        return result

    return run


def cells():
    yield from series("points with friction, contrast of stiffness", CONTRASTS, contrast, quick=("1e-4",))
    yield from series("points with friction, meshes", [f"{a}:{b}" for a, b in MESHES],
                      lambda t: uniform(blocks(tuple(map(int, t.split(":"))))), quick=("2:20",))
    yield from series("points with friction, r over its default", SCALES, augmentation, quick=("1e2",))
    far_off = lambda text: NO_ANSWER if text == SHEARED[-1] else None
    yield from series("points with friction, sheared, r over its default", SHEARED, over_r, may_refuse=far_off)
    yield from series("points with friction, unit of length", UNITS, lambda t: uniform(blocks(size=float(t))), quick=("1e-3",))
    yield from series("points with friction, unit of stress", UNITS,
                      lambda t: uniform(blocks(stress=float(t)), pressure=PRESSURE * float(t)))
    at_limit = lambda share: sheared(-SHEAR[0] / SHEAR[2] / float(share))
    yield from series("points, held by stick, share of its limit", held.SHARES, at_limit, quick=("0.999999",))
    yield from series("points, slope, friction in excess of need", held.MARGINS, lambda t: at_points(held.slope(t)), quick=("1e-8",))
    yield from series("points, slope too steep by this part", held.EXCESS[::-1], lambda t: at_points(held.slope(f"-{t}")), may_refuse=held.FREE)
    yield from series("points, a block drawn along", SLIDES, drawn, quick=("0.5",))
    yield from series("points, the same block stuck", STICKS, stuck)
    yield from series("points, the block tilted", TILTS, tilted, quick=("0.9",))
    yield from series("points, a block drawn to and fro", TURNS, to_and_fro, quick=("0.6 in 1",))
