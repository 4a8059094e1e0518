"""A block pressed and drawn on a floor, in plane strain and as a ring: the augmentation, depth and gap at the start, stick at
its limit, the limits of the law, rest."""

from itertools import product

import numpy as np

from cell import ELEMENT, series
from library import AUTO, OF_COMMIT
from two_bodies import MU, SAME, SPACES, YOUNG, Body, Host, answer, answered, apart, block_on_floor, choices, follow, moved

DRAWN = [(0.004, 0.0), (0.006, 0.0), (0.006, 0.002), (0.006, 0.02)]
STUCK = [(0.004, 0.0), (0.006, 0.0), (0.006, 0.0001)]
FRICTIONS = ("0", "1e-12", "1e-6", "1e-2", "0.1")
STICKS = ("1e1", "1e3", "1e6")
SMALL = 1e-3
SCALES = ("1e-6", "1e-4", "1e-2", "1e0", "1e2", "1e4")  # of the augmentation
DEPTHS = (1e-6, 1e-2, 0.3, 0.49)  # of a line of the block, a quarter; the parts of one with a middle node are half as long
DEEPER = (0.6, 1.2, 1.9)
GAPS = (0, 1e-12, 1e-6, 0.1, 1, 10)
HELD = ("0.5", "0.99", "0.9999", "0.999999")
ROUGH = 3  # the law's number
# A linear problem whose system is solved once or twice.
EXACT = 1e-9
# Rounding of a position, in strain.
ROUNDED = 1e-14
# Full steps, no line search: nodes may go from state to state for ever, where the augmentation is far too large, and two in the
# middle of a line with `sub` multipliers over lines of two nodes, at a friction of 0.1, however short the steps.
CYCLES = r"no solution in \d+ iterations"
REST, FEW = 4, 2  # steps without load; iterations of the last one, which finds its answer and confirms it
CELLS = ((4, 4), (8, 8), (8, 4))  # nodes of a cell of the block and the floor
CHOICES = list(product(CELLS, SPACES))


def path_of(model):
    """Rings are drawn nowhere: they would widen."""
    return DRAWN if model == "strain" else STUCK[:2]


def slides(text, space):
    """Drawn along with little friction every node slips, T = mu N; without any it is the frictionless law."""
    mu = float(text)

    def check(outcome, library):
        outcome.iterations = 0
        for nodes in CELLS:
            name = f"{nodes[0]} on {nodes[1]} nodes"
            host = block_on_floor(library, nodes=nodes, space=space, mu=mu)
            outcome.iterations += sum(follow(host, DRAWN))
            normal, traction = (host.states[name][host.contact.has_row] for name in ("normal", "traction"))
            across = (traction * normal).sum(axis=1)
            tangential = traction - across[:, None] * normal
            along = np.linalg.norm(tangential, axis=1)
            off = np.abs(along - mu * np.abs(across)).max() / np.abs(across).max()
            outcome.below(f"{name}: nodes off the cone", off, SAME, "all of them slip")
            # A multiplier is minus the traction on the block.
            against = mu < 1e-9 or (tangential[across < 0, 0] > 0).all()
            outcome.true(f"{name}: friction is against the motion", against, "Coulomb")
            if mu <= 1e-12:
                without = block_on_floor(library, nodes=nodes, space=space, mu=0.0)
                follow(without, DRAWN)
                outcome.below(f"{name}: against no friction", apart(answer(host), answer(without)), SAME, "its limit")

    return answered(check)


def sticks(text):
    def check(outcome, library):
        for nodes, space in CHOICES:
            found = []
            for law in ({"mu": float(text)}, {"friction": ROUGH, "mu": 0.0}):
                host = block_on_floor(library, nodes=nodes, space=space, **law)
                outcome.iterations = sum(follow(host, STUCK))
                found.append(answer(host))
            name = f"{nodes[0]} on {nodes[1]} nodes, {space}"
            outcome.below(f"{name}: against the rough law", apart(*found), SAME, "nothing slips in either")

    return answered(check)


def augmentation(text):
    """It may steer the iterations, never the answer."""

    # With normals of now full steps go from state to state for ever where the augmentation is far too small.
    normals = AUTO if float(text) > SMALL else OF_COMMIT

    def check(outcome, library):
        for model, space in product(("strain", "ring"), SPACES):
            found = []
            for scale in (1.0, float(text)):
                host = block_on_floor(library, model, space=space, augmentation=0.4 * YOUNG * scale, normals=normals)
                outcome.iterations = sum(follow(host, path_of(model)))
                found.append(answer(host))
            outcome.below(f"{model}, {space}: against the default", apart(*found), SAME, "the same answer")

    return answered(check)


def springs(lowered, down, **options):
    """Two bodies of no Poisson effect, the upper one lowered by this at the start, its top by that: two springs in a row."""

    def check(outcome, library):
        for model, nodes, space in product(("strain", "ring"), ((4, 4), (8, 8)), SPACES):
            left = 1.0 if model == "ring" else 0.0
            upper = Body((4, 2), (left, -lowered, left + 1, 0.5 - lowered), nodes[0], model, YOUNG, 0.0)
            lower = Body((3, 2), (left, -0.5, left + 1, 0.0), nodes[1], model, YOUNG, 0.0)
            host = Host(library, (upper, lower), ("bottom", "top"), modulus=YOUNG, mu=MU, **choices(space), **options)
            outcome.iterations = host.step(moved(host, down))
            strain = lowered + down  # over a height of 1
            error = np.abs(host.lam[host.contact.has_row] / YOUNG + [0, strain]).max() / strain
            name = f"{model}, {nodes[0]} nodes, {space}"
            outcome.below(f"{name}: multiplier", error, EXACT + ROUNDED / strain, "two springs in a row; rounding")

    return answered(check)


def held(text):
    """A block held by stick alone, under this part of the shear that friction can carry: a uniform stress, exact."""
    shear, pressure = 2.5, 10.0

    def check(outcome, library):
        for nodes, space in CHOICES:
            mu = shear / pressure / float(text)
            host = block_on_floor(library, nodes=nodes, space=space, floor=(-1.0, -0.5, 2.0, 0.0), poisson=0.0, mu=mu)
            block, floor = host.bodies
            # The displacement of this stress over a floor at rest; its forces, but for those that the contact has.
            field = np.column_stack([2 * shear * block.x[:, 1], -pressure * block.x[:, 1]]) / YOUNG
            loads, n = np.zeros(len(host.u)), block.x.size
            loads[:n] = host.k[:n, :n] @ field.ravel() - block.drawn("bottom", (-shear, pressure)).ravel()
            still = {host.dof(1, k, c): 0.0 for k in range(len(floor.x)) for c in (0, 1)}
            host.lam[host.contact.has_row] = host.contact.interface.start()[host.contact.has_row]
            outcome.iterations = host.step(still, loads)
            error = np.abs(host.lam[host.contact.has_row] - [shear, -pressure]).max() / pressure
            outcome.below(f"{nodes[0]} on {nodes[1]} nodes, {space}: multiplier", error, EXACT, "uniform and exact")

    return answered(check)


def at_rest(space):
    """Steps without more load: nothing moves, nothing is iterated."""

    def check(outcome, library):
        for model, nodes in product(("strain", "ring"), ((4, 4), (8, 8))):
            host = block_on_floor(library, model, nodes=nodes, space=space)
            steps, answers = follow(host, path_of(model)), []
            for _ in range(REST):
                steps += follow(host, path_of(model)[-1:])
                answers.append(answer(host))
            name = f"{model}, {nodes[0]} nodes"
            outcome.below(f"{name}: last change", apart(*answers[-2:]), SAME, "no load was added")
            outcome.below(f"{name}: iterations of the last step", steps[-1], FEW, "it starts at its answer")
            outcome.iterations = sum(steps)

    return answered(check)


def cells():
    kind = {"kind": ELEMENT}
    for space in SPACES:
        cycles = lambda text, space=space: CYCLES if (space, text) == ("sub", "0.1") else None
        along = lambda text, space=space: slides(text, space)
        yield from series(
            f"line block drawn along, {space}, friction", FRICTIONS, along, quick=("0", "0.1"), may_refuse=cycles, **kind
        )
    yield from series("line block stuck, friction", STICKS, sticks, quick=("1e6",), **kind)
    large = lambda scale: CYCLES if float(scale) > 1 else None
    yield from series(
        "line block, augmentation of its default", SCALES, augmentation, quick=("1e-6", "1e2"), may_refuse=large, **kind
    )
    deep = lambda depth: springs(depth / 4, 0.0)
    told = lambda depth: springs(depth / 4, 0.0, search_distance=depth / 2)
    yield from series("line bodies start this deep, in lines", DEPTHS, deep, quick=(0.49,), **kind)
    yield from series("the same of lines with search_distance", DEEPER, told, quick=(1.2,), **kind)
    closing = lambda gap: springs(-gap / 4, gap / 4 + 0.01)
    yield from series("line bodies close a gap, in lines", GAPS, closing, quick=(1e-6, 10), **kind)
    yield from series("line block held by stick, share of its limit", HELD, held, quick=("0.999999",), **kind)
    yield from series("line block at rest, multipliers", SPACES, at_rest, quick=("dual",), **kind)
