"""One pair of facets that is hard to cut, against exact arithmetic (oracle.py): weights, and their derivatives."""

import numpy as np

import oracle
from cell import ELEMENT, Outcome, series
from library import DEGREE_10, DEGREE_5, Refused
from scenes import EPS

# Weights: rounding of the largest, and of coordinates of the size of the facet.
WEIGHTS = 4e-15  # of the facet's area
DERIVATIVES = 1e-10  # of its size: what must hold at every angle
ANGLES = ("1e-2", "1e-4", "1e-6", "1e-8", "1e-10", "1e-12", "1e-14", "1e-15")
SLIVERS = ("1e-3", "1e-5", "1e-7", "1e-9", "1e-11", "1e-13", "1e-14")
APART = ("1e-3", "1e-6", "1e-9", "1e-12", "1e-15", "1e-17", "0")
OFFSETS = ("1e0", "1e2", "1e4", "1e6", "1e7", "1e8", "1e9")
ASPECTS = ("1", "10", "1e2", "1e3", "1e4", "1e6")
SIZES = ("1e-6", "1e6", "1e-12", "1e12", "1e-60", "1e60", "1e-150", "1e100")
TOO_SMALL_OR_LARGE = r"status 7"  # products of four lengths beyond what a double can be
DRAWN = (0.01, 0.1, 0.2, 0.3, 0.4, 0.45, 0.49, 0.5, 0.6)
WARPS = (0.001, 0.01, 0.05, 0.1, 0.2, 0.4, 0.8, 1.6)

QUAD = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
TRIANGLE = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], float)


def turned(x, angle, about):
    c, s = np.cos(angle), np.sin(angle)
    return (x - about) @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]) + about


def compare(outcome, library, name, x1, x2, derivatives=True, size=1.0):
    """Weights and derivatives of a pair against exact arithmetic, over powers of the facet's size."""
    exact = oracle.as_floats(oracle.weights(x1, x2))
    found = library.weights(x1, x2, derivatives)
    error = max(np.abs(a - b).max() for a, b in zip(found, exact)) / size**2
    outcome.below(f"{name}: weights", error, WEIGHTS, "exact arithmetic")
    if derivatives:
        exact = oracle.derivatives(x1, x2)
        error = max(np.abs(a - b).max() for a, b in zip(found[2:], exact)) / size
        outcome.below(f"{name}: derivatives", error, DERIVATIVES, "differences of exact arithmetic")
        outcome.figures["derivative_error"] = max(error, outcome.figures.get("derivative_error", 0))


def each_kind(compare_pair):
    """The run of a cell: the same for quadrilaterals and triangles."""

    def run(context):
        outcome, library = Outcome(), context.library
        try:
            for name, facet in (("quad4", QUAD), ("tri3", TRIANGLE)):
                compare_pair(outcome, library, name, facet)
        except Refused as refusal:
            outcome.refusal = str(refusal)
        return outcome

    return run


def angle(text):
    """The same facet twice, turned about an inner point: every edge crosses its image at this angle."""
    about = np.array([0.3, 0.25, 0])

    def pair(outcome, library, name, x):
        y = turned(x, float(text), about)[::-1]
        compare(outcome, library, name, x, y)
        compare(outcome, library, f"{name} over a gap", x, y - [0, 0, 0.01])

    return each_kind(pair)


# Where a facet is turned about: an inner point, a vertex, a point of an edge.
ABOUT = {"": [0.3, 0.25, 0], ", vertex on vertex": [0, 0, 0], ", about a point of an edge": [0.375, 0, 0]}


def rotation(random):
    """A random orientation in space."""
    q, _ = np.linalg.qr(random.normal(size=(3, 3)))
    return q * np.linalg.det(q)


def slanted(text):
    """The same with the plane in general position, where the projection rounds: at each place that they are turned
    about, touching but for rounding and over a gap, the same facets, and another kind or a part of the facet."""
    random = np.random.default_rng(20261121)

    def pair(outcome, library, name, x):
        others = {"": x, " on the other kind": TRIANGLE if len(x) == 4 else QUAD, " on a quarter": 0.5 * x}
        for (what, about), (kind, y) in zip(ABOUT.items(), others.items()):
            for gap in (0, 0.01):
                q = rotation(random)
                y2 = (turned(y, float(text), np.array(about)) - [0, 0, gap])[::-1]
                compare(outcome, library, f"{name}{kind}{what}, gap {gap:g}", x @ q.T, y2 @ q.T)

    return each_kind(pair)


def summed(text):
    """A facet over nine of its size, turned by this angle: the derivatives summed over the pairs have no kink, and
    what one pair does not know of a crossing its neighbour takes."""
    t = np.arange(-1.0, 3.0)
    nodes = turned(np.array([[x, y, 0] for y in t for x in t]), float(text), np.array([0.3, 0.25, 0]))
    facets = [
        [k + 4, k + 5, k + 1, k] for k in range(11) if k % 4 < 3
    ]  # clockwise seen from above: the normal is down

    def pair(outcome, library, name, x):
        n1, total = len(x), [np.zeros((len(x), 16, 3 * (len(x) + 16))) for _ in range(2)]
        for facet in facets:
            columns = np.concatenate([np.arange(3 * n1), *(3 * (n1 + c) + np.arange(3) for c in facet)])
            found, exact = library.weights(x, nodes[facet], True)[3], oracle.derivatives(x, nodes[facet])[1]
            for array, part in zip(total, (found, exact)):
                for k, c in enumerate(facet):
                    array[:, c, columns] += part[:, k, :]
        error = np.abs(total[0] - total[1]).max()
        outcome.below(f"{name}: derivatives of n_AC, summed", error, DERIVATIVES, "differences of exact arithmetic")
        outcome.figures["summed_error"] = max(error, outcome.figures.get("summed_error", 0))

    return each_kind(pair)


def sliver(text):
    """Overlaps of this width: a strip along an edge and a corner; derivatives too."""
    d = float(text)

    def pair(outcome, library, name, x):
        for what, shift in (("strip", [d - 1, 0.1, 0]), ("corner", [d - 1, d - 1, 0])):
            compare(outcome, library, f"{name}, {what}", QUAD, (x + shift)[::-1])
        compare(outcome, library, f"{name}, all but a strip", x, (QUAD + [d, d, 0])[::-1])

    return each_kind(pair)


def touching(text):
    """A vertex this far from a vertex, from an edge; an edge this far from an edge. At 0 the derivative of one pair
    has two sides, so weights alone are compared; assembled ones have no kink (case `noise on matching meshes`)."""
    d = float(text)

    def pair(outcome, library, name, x):
        cuts = float(text) > 1e-16  # nearer, the sums are rounded to coincidence
        corner = turned(x, 0.3, x[0])
        for what, y in (
            ("vertex at vertex", corner + [d, d / 3, 0]),
            ("vertex at edge", corner + [0.5, d, 0]),
            ("edge at edge", x + [0.25, d, 0]),
        ):
            compare(outcome, library, f"{name}, {what}", x, y[::-1], cuts)

    return each_kind(pair)


def offset(text):
    """The pair far away. Its coordinates are rounded there; of those that are left the weights are exact."""
    shift = np.array([1.0, -0.7, 0.3]) * float(text)

    def pair(outcome, library, name, x):
        y = turned(x, 0.3, np.array([0.3, 0.25, 0]))[::-1]
        far = x + shift, y + shift
        found = library.weights(*far)
        # warped by the rounding, a quadrilateral is no parallelogram any more: the rule's error is of that size
        rounded = EPS * np.abs(shift).max()
        exact = oracle.as_floats(oracle.weights(x, y))
        error = max(np.abs(a - b).max() for a, b in zip(found, exact))
        outcome.below(f"{name}: weights", error, WEIGHTS + 4 * rounded, "coordinates are rounded to offset times eps")
        outcome.figures["relative_to_rounding"] = error / (EPS * max(1.0, float(text)))

    return each_kind(pair)


def aspect(text):
    """Both facets long and thin, turned by a small part of their narrow angle."""
    a = float(text)

    def pair(outcome, library, name, x):
        y = turned(x, 0.3, np.array([0.3, 0.25, 0]))[::-1]
        stretch = np.array([1.0, 1 / a, 1.0])
        exact = oracle.as_floats(oracle.weights(x * stretch, y * stretch))
        found = library.weights(x * stretch, y * stretch)
        error = max(np.abs(p - q).max() for p, q in zip(found, exact)) * a
        # the second coordinate is divided by a as it stands; the plane's axes carry eps of the long side across
        outcome.below(f"{name}: weights", error, WEIGHTS * max(1.0, a), "exact arithmetic; eps of the long side")

    return each_kind(pair)


def size(text):
    """The pair in other units of length."""
    s = float(text)

    def pair(outcome, library, name, x):
        y = turned(x, 0.3, np.array([0.3, 0.25, 0]))[::-1]
        compare(outcome, library, name, x * s, y * s, size=s)

    return each_kind(pair)


# The rules' own error on quadrilaterals that are no parallelograms, as measured here: of the fourth and the tenth
# power of the warp over the facet's size, of the third and the eighth power of what a corner is drawn in.
RULES = {"degree 5": DEGREE_5, "degree 10": DEGREE_10}
WARP_ERROR = {"degree 5": lambda w: 1e-5 * w**4, "degree 10": lambda w: 1e-9 * w**10}
DRAWN_ERROR = {"degree 5": lambda s: 5e-3 * s**3, "degree 10": lambda s: 5e-3 * s**8}
GAUSS_POINTS = 24  # a side; more change nothing
NOT_CONVEX = r"not convex|folded"


def against_many_points(context, x, y, allowed):
    outcome, library = Outcome(), context.library
    try:
        found = {name: library.weights(x, y, quadrature=rule) for name, rule in RULES.items()}
    except Refused as refusal:
        outcome.refusal = str(refusal)
        return outcome
    exact = oracle.as_floats(oracle.weights(x, y, number=float, points=GAUSS_POINTS))
    for name, weights in found.items():
        error = max(np.abs(p - q).max() for p, q in zip(weights, exact))
        outcome.below(f"weights, {name}", error, WEIGHTS + allowed[name], "the rule's own error")
        sums = np.abs(weights[0].sum(axis=1) - weights[1].sum(axis=1)).max()
        outcome.below(f"sum n_AB - sum n_AC, {name}", sums, WEIGHTS, "both partitions of unity at the same points")
    return outcome


def warped(warp):
    """Quadrilaterals, a corner of each lifted by this part of their size."""
    x = QUAD + np.array([[0, 0, 0], [0, 0, 0], [0, 0, warp], [0, 0, 0]])
    y = turned(QUAD + np.array([[0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, -warp]]), 0.3, np.array([0.3, 0.25, 0]))[::-1]
    return lambda context: against_many_points(context, x, y, {k: f(warp) for k, f in WARP_ERROR.items()})


def drawn_in(part):
    """Quadrilaterals, a corner drawn towards the opposite one by this part of the diagonal: at half of it they fold."""
    x = QUAD.copy()
    x[2, :2] -= part
    y = turned(QUAD, 0.3, np.array([0.3, 0.25, 0]))[::-1]
    allowed = {k: f(part) if part < 0.5 else 0 for k, f in DRAWN_ERROR.items()}
    return lambda context: against_many_points(context, x, y, allowed)


def cells():
    kind = {"kind": ELEMENT}
    yield from series("pair, crossing angle", ANGLES, angle, quick=("1e-4", "1e-10", "1e-15"), **kind)
    yield from series("pair slanted in space, crossing angle", ANGLES, slanted, quick=("1e-8", "1e-15"), **kind)
    yield from series("pairs of a facet, crossing angle", ANGLES, summed, quick=("1e-15",), **kind)
    yield from series("pair, slivers of this width", SLIVERS, sliver, quick=("1e-5", "1e-14"), **kind)
    yield from series("pair, this far from coincidence", APART, touching, quick=("1e-9", "1e-17", "0"), **kind)
    yield from series("pair, offset in facets", OFFSETS, offset, quick=("1e6", "1e9"), **kind)
    yield from series("pair, facets 1:N", ASPECTS, aspect, quick=("1e4",), **kind)
    extreme = lambda text: TOO_SMALL_OR_LARGE if not 1e-70 < float(text) < 1e70 else None
    yield from series("pair, size of the facets", SIZES, size, quick=("1e-6", "1e60"), may_refuse=extreme, **kind)
    yield from series("pair, warp over size", WARPS, warped, quick=(0.1, 1.6), **kind)
    folded = lambda part: NOT_CONVEX if part >= 0.5 else None
    yield from series("pair, a corner drawn in by", DRAWN, drawn_in, quick=(0.2, 0.5), may_refuse=folded, **kind)
