"""Patch tests whose bodies are hard: far from the origin, of unlike stiffness, of long facets, nearly
incompressible."""

from cell import series
from scenes import EPS, check_patch, patch, patch_cell

OFFSETS = tuple(f"1e{k}" for k in range(10))
STIFFNESS = (1, 1e2, 1e4, 1e6, 1e7, 1e8)
ASPECTS = (1, 10, 100, 1000, 3000, 10000)
POISSON = (0.3, 0.45, 0.49, 0.499, 0.4999, 0.49999)

FACET = 1 / 3
YOUNG, PRESSURE = 1000, 10
# A position is rounded to offset times eps; a gap of that size is a traction of E / h times it. Both sides are rounded,
# and so is what is added up of them: some of these.
ROUNDINGS = 10
FAR = r"not converged|tolerance|vertex"  # beyond 1e6 facets Newton's tolerance may be below the rounding of positions


def offset(facets):
    distance = float(facets) * FACET
    rounding = ROUNDINGS * EPS * distance / FACET * YOUNG / PRESSURE

    def run(context):
        result = context.solve(patch(lower=(distance,) * 3), kappa=True)
        reason = "uniform; positions are rounded to offset times eps"
        return check_patch(result, floor=max(1e-10, rounding), reason=reason)

    return run


def stiff(side):
    """Without Poisson effect: bricks that widen unlike each other would slip."""
    young = lambda ratio: (1000 * ratio, 1000) if side == "upper" else (1000, 1000 * ratio)
    return lambda ratio: patch_cell(patch(young=young(ratio), poisson=0.0))


def aspect(ratio):
    return patch_cell(patch(size=(ratio, 1, 1)))


def poisson(dilatation):
    return lambda nu: patch_cell(patch(poisson=nu, body={"dilatation": dilatation}))


def cells():
    far = lambda severity: FAR if float(severity) > 1e6 else None
    yield from series("patch, offset in facets", OFFSETS, offset, quick=("1e3", "1e6", "1e9"), may_refuse=far)
    yield from series("patch, mortar side N times stiffer", STIFFNESS, stiff("lower"), quick=(1e8,))
    yield from series("patch, non-mortar side N times stiffer", STIFFNESS, stiff("upper"), quick=(1e8,))
    yield from series("patch, facets 1:N", ASPECTS, aspect, quick=(10000,))
    yield from series("patch, Poisson's ratio, strain by point", POISSON, poisson("pointwise"), quick=(0.4999,))
    yield from series("patch, Poisson's ratio, mean dilatation", POISSON, poisson("mean"), quick=(0.4999,))
