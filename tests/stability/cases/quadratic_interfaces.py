"""Interfaces of quadratic facets: mid nodes that stand anywhere, coverage that goes to nothing, kinds mixed."""

import numpy as np

from cases.assembled import COVERAGES, MU, YOUNG
from cases.pairs import rotation
from cell import ELEMENT, Outcome, series
from library import GAP, SPACES, Interface, Refused, fade, mid_nodes, spaces_in_question
from quadratic import NAMES, grid
from scenes import EPS

OPTIONS = {"modulus": YOUNG, "mu": MU}
OFF = (0.0, 0.01, 0.03, 0.06, 0.1, 0.15, 0.2, 0.3)  # of the edge
# From here on a mid node may come too near to a corner, or a part look the other way.
MUCH = 0.1
REFUSED = r"at its node \d|its part between the nodes|not convex"
KINDS_ON_KINDS = [(6, 9), (8, 6), (9, 8), (8, 8)]
# Sums of some thousand products.
BALANCE = 1e-13
# Rotated positions are rounded; the largest force decides.
TURNED = 1e-10
# Central differences with a step of 1e-7 of a facet: the second power of the step, and rounding over the step. The rest is
# the rule's, whose error the derivative does not see (docs/formulation 12.3), as measured: of the offset's square, with
# standard multipliers up to 1.5e-4 of it, with dual ones up to 1.65e-4.
DIFFERENCES, STEP = 1e-7, 1e-7
PER_OFFSET = 1.7e-4


def moved(x, facets, s, random, size):
    """Mid nodes anywhere within s of an edge's length, in all directions."""
    x = x.copy()
    mids = mid_nodes(len(x), facets)
    x[mids] += s * size * random.uniform(-1, 1, (mids.sum(), 3)) / np.sqrt(3)
    return x


def mid_nodes_off(s):
    def run(context):
        outcome = Outcome()
        try:
            for kinds in KINDS_ON_KINDS:
                for space in range(len(spaces_in_question())):
                    check(outcome, context.library, kinds, space, s)
        except Refused as refusal:
            outcome.refusal = str(refusal)
        return outcome

    return run


def check(outcome, library, kinds, space, s):
    """Identities of residual and tangent where nothing is flat."""
    random = np.random.default_rng(20261123)
    x1, f1 = grid(2, kinds[0], down=True, z=-0.001)
    x2, f2 = grid(2, kinds[1], lower=(-0.21, -0.33), size=1.6)
    x1, x2 = moved(x1, f1, s, random, 0.5), moved(x2, f2, s, random, 0.8)
    lam = np.tile((0.1, 0.05, -1.0), (len(x1), 1)) * random.uniform(0.5, 1, (len(x1), 1))
    now = x1 + 1e-3 * random.uniform(-1, 1, x1.shape)
    q, found = rotation(random), []
    name = f"{NAMES[kinds[0]]} on {NAMES[kinds[1]]}, {SPACES[space]}"
    for turn in (np.eye(3), q):
        interface = Interface(library, x1 @ turn.T, f1, x2 @ turn.T, f2, multiplier_space=space, **OPTIONS)
        at = now @ turn.T, x2 @ turn.T, lam @ turn.T
        found.append(interface.residual(*at))
        if turn is not q:
            differences(outcome, interface, name, at, s, random)
        interface.close()
    size = max(np.abs(f).max() for f in found[0][:2])
    total = np.abs(found[0][0].sum(axis=0) + found[0][1].sum(axis=0)).max()
    outcome.below(f"{name}: sum of all forces", total / size, BALANCE, "sum n_AB = sum n_AC")
    turned = max(np.abs(b - a @ q.T).max() / np.abs(a).max() for a, b in zip(*found))
    outcome.below(f"{name}: all turned together", turned, TURNED, "forces and rows turn with it")


def differences(outcome, interface, name, at, s, random):
    """The tangent along a random direction against central differences."""
    step = [random.uniform(-1, 1, v.shape) for v in at]
    sides = [interface.residual(*(v + sign * STEP * d for v, d in zip(at, step))) for sign in (1, -1)]
    change = np.concatenate([((a - b) / (2 * STEP)).ravel() for a, b in zip(*sides)])
    found = interface.tangent(*at) @ np.concatenate([d.ravel() for d in step])
    error = np.abs(found - change).max() / np.abs(change).max()
    outcome.below(f"{name}: tangent", error, DIFFERENCES + PER_OFFSET * s**2, "differences; the rule's error")
    outcome.figures["tangent_error"] = max(error, outcome.figures.get("tangent_error", 0))


def coverage(text):
    """A facet that overlaps with the mortar side by a strip of this part of it."""
    c = float(text)

    def run(context):
        outcome, library = Outcome(), context.library
        for kind in (8, 9):
            for space in range(len(spaces_in_question())):
                strip(outcome, library, kind, space, c)
        return outcome

    return run


def strip(outcome, library, kind, space, c):
    name = f"{NAMES[kind]}, {SPACES[space]}"
    x1, f1 = grid(1, kind, down=True, z=-0.001)
    x2, f2 = grid(1, 6, lower=(c - 2, -0.5), size=2.0)
    start = grid(1, 6, lower=(-1.5, -0.5), size=2.0)  # covers it by half
    interface = Interface(library, x1, f1, *start, multiplier_space=space, **OPTIONS)
    lam = np.tile((0.1, 0.0, -1.0), (len(x1), 1))
    states = interface.states(x1, x2, lam)
    width = 2 * np.spacing(1.0)  # it is itself a difference of coordinates of order one
    total = states["coverage"].sum()
    bound = width + 1e-13 * c
    outcome.below(f"{name}: covered areas", abs(total - c * fade(c, SPACES[space])), bound, "the functions add up to one")
    outcome.true(f"{name}: none is negative", (states["coverage"] >= 0).all(), "positive functions")
    bare = states["coverage"] == 0
    outcome.true(f"{name}: nodes that nothing covers are open", (states["state"][bare] == GAP).all(), "no traction")
    f1, f2, rows = interface.residual(x1, x2, lam)
    finite = all(np.isfinite(v).all() for v in (f1, f2, rows))
    outcome.true(f"{name}: finite", finite, "no NaN")
    outcome.below(f"{name}: sum of all forces", np.abs(f1.sum(axis=0) + f2.sum(axis=0)).max(), BALANCE * max(c, EPS), "momentum")
    error = np.abs(f1.sum(axis=0) - lam[0] * c * fade(c, SPACES[space])).max()
    outcome.below(f"{name}: force on the strip", error, 4 * bound, "traction times area")
    block = interface.tangent(x1, x2, lam)[-3 * len(x1) :]
    held = np.repeat(~mid_nodes(len(x1), grid(1, kind)[1]) if space == 0 else np.full(len(x1), True), 3)
    regular = (np.abs(block[held]).max(axis=1) > 0).all()
    outcome.true(f"{name}: no row of a multiplier vanishes", regular, "regular at any coverage")
    interface.close()


def cells():
    kind = {"kind": ELEMENT}
    much = lambda s: REFUSED if s >= MUCH else None
    yield from series(
        "quadratic interface, mid nodes off by", OFF, mid_nodes_off, quick=(0.1,), may_refuse=much, **kind
    )
    yield from series("quadratic interface, covered by", COVERAGES, coverage, quick=("1e-3", "1e-9", "0"), **kind)
