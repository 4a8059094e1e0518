"""A pair of lines that is hard to integrate, in plane strain and in an axisymmetric model, against exact arithmetic
(oracle_lines.py): weights with both spaces of multipliers, and how they change along a random motion."""

import numpy as np

import oracle_lines as oracle
from cell import ELEMENT, Outcome, series
from library import SPACES, Refused
from lines import MET, MODELS, NAMES, line, other_side, turn
from oracle import as_floats
from scenes import EPS

# Rounding of sums of some ten products, over the largest weight that such a line can have.
WEIGHTS = 4e-15
# The same of derivatives, over the largest of their kind.
DERIVATIVES = 4e-14
# Seen end-on a line of length 1 is as short as this; its functions rise that much faster.
WIDTHS = ("1", "1e-1", "1e-2", "1e-4", "1e-6")
SLIVERS = ("1e-3", "1e-5", "1e-7", "1e-9", "1e-11", "1e-13", "1e-14")
APART = ("1e-3", "1e-6", "1e-9", "1e-12", "1e-15", "0")
OFFSETS = ("1e0", "1e3", "1e6", "1e9")
SIZES = ("1e-6", "1e6", "1e-60", "1e60", "1e-150", "1e100")
LONGER = ("1", "1e2", "1e4", "1e6", "1e8")
AXIS = ("1", "1e-3", "1e-6", "1e-12", "1e-100", "0")
DRAWN = (0.01, 0.1, 0.2, 0.24, 0.26, 0.4, 0.6)
BOWED = (0.001, 0.01, 0.1, 0.2, 0.4)
# From a quarter on the middle node's map turns over at an end.
OUT_OF_ORDER = r"at its node \d|its part between the nodes"


def compare(outcome, library, label, x, y, random, *, ring, size=1.0, derivatives=True, weights=1.0, slopes=1.0):
    """`weights`, `slopes`: by how much more than of plain lines rounding counts."""
    model = MODELS["ring" if ring else "strain"]
    radius = 2 * np.pi * max(np.abs(x[:, 0]).max(), size) if ring else 1.0
    for space in SPACES:
        name = f"{label}, {space}"
        found = library.weights(x, y, derivatives, space=space, **model)
        exact = as_floats(oracle.weights(x, y, space, ring))
        error = max(np.abs(a - b).max() for a, b in zip(found, exact)) / (size * radius)
        outcome.below(f"{name}: weights", error, WEIGHTS * weights, "exact arithmetic")
        if derivatives:
            step = random.uniform(-1, 1, (len(x) + len(y), 2))
            exact = oracle.change(x, y, space, ring, step)
            error = max(np.abs(d @ step.ravel() - e).max() for d, e in zip(found[2:], exact)) / radius
            outcome.below(f"{name}: derivatives", error, DERIVATIVES * slopes, "differences of exact arithmetic")


def each_pair(pair, models=MODELS, kinds=MET):
    """The run of a cell: all lines that meet, in each model."""

    def run(context):
        outcome, library = Outcome(), context.library
        random = np.random.default_rng(20261123)
        try:
            for model in models:
                for n, m in kinds:
                    label = f"{model}, {NAMES[n]} on {NAMES[m]}"
                    pair(outcome, library, label, line(n), line(m), random, model == "ring")
        except Refused as refusal:
            outcome.refusal = str(refusal)
        return outcome

    return run


def placed(x, y, random, ring):
    """Both lines somewhere in the plane, as far from the axis as it takes."""
    q = turn(random.uniform(0, 2 * np.pi)).T
    shift = [2.5, 0.3] if ring else [0, 0]
    return x @ q + shift, y @ q + shift


def inclined(text):
    """The mortar line is seen nearly end-on."""
    width = float(text)

    def pair(outcome, library, label, x, y, random, ring):
        y = other_side((y - [0.5, 0]) @ turn(np.arccos(width)).T + [0.43, -0.01])
        more = 1 / width
        compare(outcome, library, label, *placed(x, y, random, ring), random, ring=ring, weights=more, slopes=more**2)

    return each_pair(pair)


def sliver(text):
    """Overlaps of this width."""
    d = float(text)

    def pair(outcome, library, label, x, y, random, ring):
        for shift in (d - 1, 1 - d):
            both = placed(x, other_side(y + [shift, -0.01]), random, ring)
            compare(outcome, library, label, *both, random, ring=ring)

    return each_pair(pair)


def apart(text):
    """Ends this far from ends, inside and outside. At 0 one pair's derivative has two sides: weights alone."""
    d = float(text)

    def pair(outcome, library, label, x, y, random, ring):
        shift = [1.0, 0] if ring else [0, 0]
        for sign in (1, -1):
            near = other_side(y * [1 + 2 * sign * d, 1] - [sign * d, 0.01])
            compare(outcome, library, label, x + shift, near + shift, random, ring=ring, derivatives=d > EPS)

    return each_pair(pair)


def offset(text):
    """Far away; of the coordinates that are left there the weights are exact."""
    shift = np.array([1.0, -0.7]) * float(text)

    def pair(outcome, library, label, x, y, random, ring):
        y = other_side(y @ turn(0.3).T + [0.1, -0.01])
        compare(outcome, library, label, x + shift, y + shift, random, ring=ring)

    return each_pair(pair)


def size(text):
    """Other units of length."""
    s = float(text)

    def pair(outcome, library, label, x, y, random, ring):
        y = other_side(y @ turn(0.3).T + [0.1, -0.01])
        shift = [0.5, 0] if ring else [0, 0]
        compare(outcome, library, label, (x + shift) * s, (y + shift) * s, random, ring=ring, size=s)

    return each_pair(pair)


def longer(text):
    """A mortar line N times as long."""
    n = float(text)

    def pair(outcome, library, label, x, y, random, ring):
        y = other_side((y - [0.4, 0]) * n + [0.43, -0.01])
        shift = [2.5 * n, 0] if ring else [0, 0]
        compare(outcome, library, label, x + shift, y + shift, random, ring=ring)

    return each_pair(pair)


def near_axis(text):
    """An end of the non-mortar line this far from the axis."""
    r = float(text)

    def pair(outcome, library, label, x, y, random, ring):
        for slope in (0, 0.7):
            down = np.array([[1, slope], [0, 1]])
            one, two = (x + [r, 0]) @ down, other_side(y * [1.2, 1] + [0, -0.01]) @ down
            compare(outcome, library, f"{label}, slope {slope}", one, two, random, ring=ring)
            one, two = map(other_side, (one, two))
            compare(outcome, library, f"{label}, slope {slope}, the other way", one, two, random, ring=ring)

    return each_pair(pair, ["ring"])


def bent(move):
    """The run of cells whose middle nodes lie elsewhere: `move` their way over the length, of both lines."""

    def make(s):
        def pair(outcome, library, label, x, y, random, ring):
            for sign in (1, -1):
                one, two = x.copy(), y.copy()
                one[2:] += sign * s * np.array(move)
                two[2:] -= s * np.array(move)
                two = other_side(two @ turn(0.2).T + [0.1, -0.01])
                compare(outcome, library, label, *placed(one, two, random, ring), random, ring=ring, slopes=4)

        return each_pair(pair, kinds=[k for k in MET if 3 in k])

    return make


def drawn(s):
    """From a quarter on there must be a refusal."""
    run = bent((1, 0))(s)

    def checked(context):
        outcome = run(context)
        if outcome.refusal is None and s > 0.25:
            outcome.true("refused", False, "the map turns over at an end")
        return outcome

    return checked


def cells():
    kind = {"kind": ELEMENT}
    beyond = lambda s: OUT_OF_ORDER if s > 0.25 else None
    yield from series("line pair, seen end-on with this width", WIDTHS, inclined, quick=("1e-2",), **kind)
    yield from series("line pair, slivers of this width", SLIVERS, sliver, quick=("1e-14",), **kind)
    yield from series("line pair, ends this far from coincidence", APART, apart, quick=("1e-15", "0"), **kind)
    yield from series("line pair, offset in lines", OFFSETS, offset, quick=("1e6",), **kind)
    yield from series("line pair, size of the lines", SIZES, size, quick=("1e60",), **kind)
    yield from series("line pair, lines 1:N", LONGER, longer, quick=("1e4",), **kind)
    yield from series("line pair, an end this far from the axis", AXIS, near_axis, quick=("1e-12", "0"), **kind)
    yield from series("line pair, middle nodes drawn by", DRAWN, drawn, quick=(0.24,), may_refuse=beyond, **kind)
    yield from series("line pair, lines bowed by", BOWED, bent((0, 1)), quick=(0.1,), **kind)
