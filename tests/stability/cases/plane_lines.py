"""Interfaces of lines: nodes that stand anywhere, coverage that goes to nothing, an axis beside them."""

import numpy as np

from cases.assembled import COVERAGES, MU, YOUNG
from cell import ELEMENT, Outcome, series
from library import ENDS, GAP, SPACES, Interface, Refused, fade, mid_nodes, spaces_in_question
from scenes import EPS

OPTIONS = {"modulus": YOUNG, "mu": MU}
PLANE, RING = 1, 2
MODELS = {PLANE: "plane", RING: "ring"}
OFF = (0.0, 0.01, 0.03, 0.1, 0.2)  # of a line
# From here on a mid node may come too near to an end.
MUCH, REFUSED = 0.2, r"at its node \d a line turns back"
RADII = ("1", "1e-3", "1e-6", "1e-9", "1e-12", "0")
# Sums of some hundred products.
BALANCE = 1e-13
# Rotated positions are rounded; the largest force decides.
TURNED = 1e-10
# Central differences with a step of 1e-7 of a line: the second power of the step, and rounding over the step.
DIFFERENCES, STEP = 1e-7, 1e-7


def chain(n, nodes, left, right, y=0.0, from_right=False):
    """Positions and lines of n lines with 2 or 3 nodes; the body is to the left of each."""
    step = nodes - 1
    t = np.linspace(right, left, step * n + 1) if from_right else np.linspace(left, right, step * n + 1)
    x = np.column_stack([t, np.full(len(t), y)])
    return x, [[step * k, step * (k + 1), *range(step * k + 1, step * (k + 1))] for k in range(n)]


def off(s):
    """Identities of residual and tangent where nothing is straight."""

    def run(context):
        outcome, random = Outcome(), np.random.default_rng(20261123)
        try:
            for model, name in MODELS.items():
                for nodes in ((2, 2), (3, 2), (2, 3), (3, 3)):
                    for space in range(len(spaces_in_question())):
                        label = f"{name}, {nodes[0]} on {nodes[1]}, {SPACES[space]}"
                        check(outcome, context.library, label, (model, nodes, space), s, random)
        except Refused as refusal:
            outcome.refusal = str(refusal)
        return outcome

    return run


def check(outcome, library, name, kind, s, random):
    model, nodes, space = kind
    x1, f1 = chain(4, nodes[0], 1.0, 3.0, y=-0.001)
    x2, f2 = chain(3, nodes[1], 0.9, 3.2, from_right=True)
    x1, x2 = (x + s / 2 * random.uniform(-1, 1, x.shape) for x in (x1, x2))
    lam = np.tile((0.1, -1.0), (len(x1), 1)) * random.uniform(0.5, 1, (len(x1), 1))
    angle = random.uniform(0, 2 * np.pi)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    found = []
    for q in (np.eye(2), turn)[: 2 if model == PLANE else 1]:
        interface = Interface(library, x1 @ q.T, f1, x2 @ q.T, f2, model=model, multiplier_space=space, **OPTIONS)
        at = x1 @ q.T, x2 @ q.T, lam @ q.T
        found.append(interface.residual(*at))
        if len(found) == 1:
            differences(outcome, interface, name, at, random)
        interface.close()
    size = max(np.abs(f).max() for f in found[0][:2])
    total = np.abs(found[0][0].sum(axis=0) + found[0][1].sum(axis=0))[0 if model == PLANE else 1 :].max()
    outcome.below(f"{name}: sum of all forces", total / size, BALANCE, "sum n_AB = sum n_AC; of rings along the axis")
    if model == PLANE:
        turned = max(np.abs(b - a @ turn.T).max() / np.abs(a).max() for a, b in zip(*found))
        outcome.below(f"{name}: all turned together", turned, TURNED, "forces and rows turn with it")


def differences(outcome, interface, name, at, random):
    """The tangent along a random direction against central differences."""
    step = [random.uniform(-1, 1, v.shape) for v in at]
    sides = [interface.residual(*(v + sign * STEP * d for v, d in zip(at, step))) for sign in (1, -1)]
    change = np.concatenate([((a - b) / (2 * STEP)).ravel() for a, b in zip(*sides)])
    found = interface.tangent(*at) @ np.concatenate([d.ravel() for d in step])
    error = np.abs(found - change).max() / np.abs(change).max()
    outcome.below(f"{name}: tangent", error, DIFFERENCES, "differences")
    outcome.figures["tangent_error"] = max(error, outcome.figures.get("tangent_error", 0))


def coverage(text):
    """A line that overlaps with the mortar side by this part of it."""
    c = float(text)

    def run(context):
        outcome = Outcome()
        for nodes in (2, 3):
            for space in range(len(spaces_in_question())):
                strip(outcome, context.library, nodes, space, c)
        return outcome

    return run


def strip(outcome, library, nodes, space, c):
    name = f"line{nodes}, {SPACES[space]}"
    x1, f1 = chain(1, nodes, 0.0, 1.0, y=-0.001)
    x2, f2 = chain(1, 2, c - 2, c, from_right=True)
    start = chain(1, 2, -1.5, 0.5, from_right=True)  # covers it by half
    interface = Interface(library, x1, f1, *start, model=PLANE, multiplier_space=space, **OPTIONS)
    lam = np.tile((0.1, -1.0), (len(x1), 1))
    states = interface.states(x1, x2, lam)
    width = 2 * np.spacing(1.0)  # it is itself a difference of coordinates of order one
    bound = width + 1e-13 * c
    outcome.below(f"{name}: covered length", abs(states["coverage"].sum() - c * fade(c, SPACES[space])), bound, "the functions add up to one")
    outcome.true(f"{name}: none is negative", (states["coverage"] >= 0).all(), "positive functions")
    bare = states["coverage"] == 0
    outcome.true(f"{name}: nodes that nothing covers are open", (states["state"][bare] == GAP).all(), "no traction")
    f1_, f2_, rows = interface.residual(x1, x2, lam)
    outcome.true(f"{name}: finite", all(np.isfinite(v).all() for v in (f1_, f2_, rows)), "no NaN")
    outcome.below(f"{name}: sum of all forces", np.abs(f1_.sum(axis=0) + f2_.sum(axis=0)).max(), BALANCE * max(c, EPS), "momentum")
    error = np.abs(f1_.sum(axis=0) - lam[0] * c * fade(c, SPACES[space])).max()
    outcome.below(f"{name}: force on the strip", error, 4 * bound, "traction times length")
    block = interface.tangent(x1, x2, lam)[-2 * len(x1) :]
    held = np.repeat(~mid_nodes(len(x1), f1, ENDS) if space == 0 else np.full(len(x1), True), 2)
    outcome.true(f"{name}: no row of a multiplier vanishes", (np.abs(block[held]).max(axis=1) > 0).all(), "regular at any coverage")
    interface.close()


def beside_the_axis(text):
    """Rings from this radius on: covered areas against circles in closed form, finite rows and tangent, also on the axis."""
    r = float(text)

    def run(context):
        outcome = Outcome()
        for nodes in (2, 3):
            for space in range(len(spaces_in_question())):
                name = f"line{nodes}, {SPACES[space]}"
                x1, f1 = chain(3, nodes, r, r + 1.0, y=-0.001)
                x2, f2 = chain(2, 2, r, r + 1.3, from_right=True)
                interface = Interface(context.library, x1, f1, x2, f2, model=RING, multiplier_space=space, **OPTIONS)
                lam = np.tile((0.1, -1.0), (len(x1), 1))
                states = interface.states(x1, x2, lam)
                exact = np.pi * (1 + 2 * r)
                outcome.below(f"{name}: covered area", abs(states["coverage"].sum() - exact) / exact, BALANCE, "pi (r2^2 - r1^2)")
                has_row = ~mid_nodes(len(x1), f1, ENDS) if space == 0 else np.full(len(x1), True)
                outcome.true(f"{name}: every node has an area", (states["coverage"][has_row] > 0).all(), "positive functions")
                values = [*interface.residual(x1, x2, lam), interface.tangent(x1, x2, lam)]
                outcome.true(f"{name}: finite", all(np.isfinite(v).all() for v in values), "no NaN")
                interface.close()
        return outcome

    return run


def cells():
    kind = {"kind": ELEMENT}
    much = lambda s: REFUSED if s >= MUCH else None
    yield from series("line interface, nodes off by", OFF, off, quick=(0.1,), may_refuse=much, **kind)
    yield from series("line interface, covered by", COVERAGES, coverage, quick=("1e-3", "1e-9", "0"), **kind)
    yield from series("line interface, inner radius", RADII, beside_the_axis, quick=("1e-9", "0"), **kind)
