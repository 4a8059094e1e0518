"""Plane and axisymmetric models: patches under slivers, contrasts, units and beside the axis; a block against one layer in
space, under any friction, over an edge, through a gap."""

import numpy as np

import host
from cases.patch_meshes import SHIFTS
from cell import series
from plane_scenes import KINDS, MODELS, SETTLES, block, patch, patch_error, spaces
from scenes import patch_bound

MIXED = [f"{upper} on {lower}" for lower, upper in zip(KINDS, KINDS[1:] + KINDS[:1])]
RADII = ("1e3", "1", "1e-3", "1e-6", "1e-9", "1e-12", "0")
RATIOS = (1e2, 1e4, 1e6, 1e8, 1e10)
UNITS = {"inch_psi": (1 / 25.4, 145.04), "2^-60_2^70": (2.0**-60, 2.0**70), "1e-9_1e20": (1e-9, 1e20), "1e12_1e-15": (1e12, 1e-15)}
FRICTIONS = (0.0, 1e-6, 0.1, 0.3, 1.0, 1e3, 1e6)
# No node of the block lies on the edge: there slivers decide, by rounding.
OVER = (0.0, 0.6, 1.0, 1.3, 1.45)
# Of analytic floors; 0: straight.
ROUND = (0.0, 1e6, 1e3, 100.0, 20.0, -1e3, -1e6)
# A distance from a circle is that of its centre less the radius: it has so many roundings of the radius, and a gap of it gives a
# traction of Young's modulus over a facet of 1/3, beside a pressure of 20.
ROUNDINGS = 32 * np.finfo(float).eps * (1000 / (1 / 3)) / 20
GAPS = ("1e-12", "1e-6", "1e-3", "0.1", "0.5")
# A layer in space has the same equations; nodes are known to 100 times the forces' tolerance of 1e-11.
SAME = 1e-9


def patches(context, scenes):
    """The worst of several patches: (name, scene, keys of patch_error)."""
    result = None
    for name, scene, keys in scenes:
        run = context.solve(scene, name=name, kappa=True)
        result = result or host.outcome(run)
        if run.exit_code != host.CONVERGED:
            return host.outcome(run)
        bound = patch_bound(run)
        result.below(f"{name}: multiplier", patch_error(run, **keys), bound, "uniform and exact; max(1e-10, 100 eps kappa)")
    return result


def slivers(shift):
    inner = [0, 1 / 3, 2 / 3, 1]
    shifted = [0, 1 / 3 + float(shift), 2 / 3 - float(shift), 1]

    def run(context):
        return patches(
            context,
            (
                (f"{model}_{kind}_{space}", patch(model, kind, kind, space, x=(shifted, inner)), {"model": model})
                for model in MODELS
                for kind in ("quad", "tri6", "quad8")
                for space in spaces(kind)
            ),
        )

    return run


def kinds(text):
    upper, lower = text.split(" on ")

    def run(context):
        return patches(
            context,
            (
                (f"{model}_{space}", patch(model, lower, upper, space), {"model": model})
                for model in MODELS
                for space in spaces(upper)
            ),
        )

    return run


def beside_the_axis(radius):
    def run(context):
        made = (
            (kind, patch("axisymmetric", kind, kind, inside=float(radius)), {"model": "axisymmetric"}) for kind in ("quad", "tri", "quad8")
        )
        return patches(context, made)

    return run


def contrast(ratio):
    """Either body may be the stiff one. Without Poisson's effect, so that both stay as wide."""

    def run(context):
        return patches(
            context,
            (
                (f"{model}_{young[0]:g}", patch(model, "quad", "quad", young=young, poisson=0), {"model": model, "poisson": 0})
                for model in MODELS
                for young in ((ratio, 1), (1, ratio))
            ),
        )

    return run


def units(name):
    length, stress = UNITS[name]

    def run(context):
        return patches(
            context,
            (
                (model, patch(model, "quad8", "tri6", length=length, stress=stress), {"model": model, "stress": stress})
                for model in MODELS
            ),
        )

    return run


def as_in_space(context, *options, same=SAME, **keys):
    """The block in the plane against one layer: forces of every step, and iterations."""
    flat, solid = (context.solve(block(plane=plane, **keys), *options, name=name) for name, plane in (("plane", True), ("space", False)))
    result = host.outcome(flat)
    if result.refusal is not None:
        result.true("one layer in space is refused, too", solid.exit_code != host.CONVERGED, "the same equations")
        return result
    forces = [np.array([step["interfaces"]["base"]["force"] for step in run.steps]) for run in (flat, solid)]
    if len(forces[0]) != len(forces[1]):
        result.true("as many steps as one layer in space", False, "the same equations")
        return result
    error = np.abs(forces[0][:, :2] - forces[1][:, [0, 2]]).max() / np.abs(forces[1]).max()
    result.below("forces, against one layer in space", error, same, "the same equations")
    rows = [run.interface("base") for run in (flat, solid)]
    for name, other in (("ux", "ux"), ("uy", "uz"), ("lambda_n", "lambda_n")):
        there = np.array([rows[1][other][(rows[1]["X"] == x) & (rows[1]["Y"] == 0)][0] for x in rows[0]["X"]])
        scale = np.abs(rows[1][other]).max() if name == "lambda_n" else max(np.abs(rows[1][other]).max(), SETTLES)
        result.below(f"{name}, against one layer in space", np.abs(rows[0][name] - there).max() / scale, same, "the same equations")
    result.figures["iterations_in_space"] = solid.newton_iterations
    return result


def on_round(radius):
    return lambda context: as_in_space(context, friction=0.3, round=radius, same=max(SAME, ROUNDINGS * abs(radius)))


def cells():
    yield from series("plane patch, slivers of this width", SHIFTS, slivers, quick=("1e-11",))
    yield from series("plane patch, kinds", MIXED, kinds, quick=("quad on quad9",))
    yield from series("ring patch, inner radius over width", RADII, beside_the_axis, quick=("1e-9", "0"))
    yield from series("plane patch, one body N times stiffer", RATIOS, contrast, quick=(1e8,))
    yield from series("plane patch, units", UNITS, units, quick=("1e-9_1e20",))
    yield from series("plane block, friction", FRICTIONS, lambda mu: lambda c: as_in_space(c, friction=mu), quick=(0.3,))
    yield from series(
        "plane block, over an edge by", OVER, lambda d: lambda c: as_in_space(c, "-base_weak_coverage", "0.5", friction=0.3, over=d),
        quick=(1.3,),
    )
    yield from series(
        "plane block, on an analytic floor of radius", ROUND, on_round, quick=(20.0,)
    )
    yield from series(
        "plane block, on a straight line, friction", FRICTIONS, lambda mu: lambda c: as_in_space(c, friction=mu, round=0.0), quick=()
    )
    yield from series(
        "plane block, falls through a gap of", GAPS, lambda g: lambda c: as_in_space(c, friction=0.3, gap=float(g)), quick=("0.1",)
    )
