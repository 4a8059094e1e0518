"""Patch tests of lines whose bodies are hard: both kinds of cells on each other, all multipliers, plane strain and rings."""

from itertools import product

from cases.patch_bodies import EPS, ROUNDINGS
from cell import ELEMENT, series
from scenes import PATCH_FLOOR, PATCH_KAPPA
from two_bodies import POISSON, SPACES, YOUNG, Body, answered, choices, kappa, pressed

PRESSURE = 2.0
RATIOS = (1, 10, 100, 300)
ASPECTS = (1, 10, 100, 1000)
OFFSETS = ("1e0", "1e3", "1e6", "1e9")
INCOMPRESSIBLE = (0.3, 0.49, 0.4999, 0.499999)
KINDS = list(product((4, 8), (4, 8)))


def bodies(model, nodes, *, upper=3, lower=4, poisson=POISSON, length=2.0, base=-1.0):
    """Two bodies of one height, one on the other."""
    left = 1.0 if model == "ring" else 0.0
    boxes = (left, base + 1, left + length, base + 2), (left, base, left + length, base + 1)
    return [Body((n, 1), box, k, model, YOUNG, poisson, 0.7) for n, box, k in zip((upper, lower), boxes, nodes)]


def case(models=("strain", "ring"), kinds=KINDS, rounding=0.0, **more):
    """The run of a cell whose bodies are `bodies(model, nodes, **more)`; `rounding` of the positions."""

    def check(outcome, library):
        outcome.iterations, outcome.kappa = 0, 0.0
        for model, nodes, space in product(models, kinds, SPACES):
            upper, lower = bodies(model, nodes, **more)
            error, iterations, host = pressed(library, upper, lower, PRESSURE, modulus=YOUNG, mu=0.3, **choices(space))
            found = kappa(host)
            bound = max(PATCH_FLOOR, rounding, PATCH_KAPPA * EPS * found)
            name = f"{model}, {nodes[0]} on {nodes[1]} nodes, {space}"
            outcome.below(f"{name}: multiplier", error, bound, "uniform and exact; max(1e-10, 100 eps kappa)")
            outcome.iterations, outcome.kappa = max(outcome.iterations, iterations), max(outcome.kappa, found)

    return answered(check)


def ratio(side):
    """One line on a row of many, and the other way round."""
    numbers = {"upper": 1, "lower": 1}
    return lambda n: case(("strain",), [(4, 4)], **numbers | {side: n})


def offset(text):
    """Far away along the axis; positions are rounded there."""
    return case(rounding=ROUNDINGS * EPS * float(text) * YOUNG / PRESSURE, base=float(text))


def cells():
    kind = {"kind": ELEMENT}
    yield from series("line patch, 1 line on N", RATIOS, ratio("lower"), quick=(100,), **kind)
    yield from series("line patch, N lines on 1", RATIOS, ratio("upper"), quick=(100,), **kind)
    longer = lambda n: case(("strain",), length=2.0 * n)
    yield from series("line patch, cells 1:N", ASPECTS, longer, quick=(100,), **kind)
    yield from series("line patch, offset in lines", OFFSETS, offset, quick=("1e6",), **kind)
    soft = lambda nu: case(poisson=nu)
    yield from series("line patch, Poisson's ratio", INCOMPRESSIBLE, soft, quick=(0.4999,), **kind)
