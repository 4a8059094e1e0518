"""A pair of facets, one at least quadratic, that is hard to cut or whose edges are bent, against another road to its weights
(oracle_quadratic.py): exact arithmetic where all parts are triangles and parallelograms, many points elsewhere."""

import numpy as np

import oracle_quadratic as oracle
from cases.pairs import DERIVATIVES, rotation, turned
from cell import ELEMENT, Outcome, series
from library import SPACES, Refused
from oracle import as_floats
from quadratic import KINDS, NAMES, facet, other_side

# Rounding of the sum over some ten pairs of parts, of the facet's area.
WEIGHTS = 1e-14
ANGLES = ("1e-2", "1e-4", "1e-6", "1e-8", "1e-10", "1e-12", "1e-14", "1e-15")
SLIVERS = ("1e-3", "1e-5", "1e-7", "1e-9", "1e-11", "1e-13", "1e-14")
# A quarter of the edge is where the mapping has no area at the corner.
DRAWN = (0.01, 0.05, 0.1, 0.15, 0.2, 0.24, 0.25, 0.26, 0.35, 0.45, 0.6)
BOWED = (0.001, 0.01, 0.03, 0.1, 0.12, 0.2, 0.4)
LIFTED = (0.001, 0.01, 0.03, 0.1, 0.2, 0.4)
# From here on a corner between two bent edges may have no angle, and a part may be too steep for its opposite.
MUCH = 0.12
OUT_OF_ORDER = r"at its node \d|its part between the nodes"
# What meets what: every kind on itself, on another quadratic kind, and on and under a linear one.
MET = [(6, 6), (6, 8), (8, 8), (8, 9), (9, 6), (9, 9), (6, 4), (8, 3), (9, 4), (3, 8), (4, 6), (4, 9)]
ABOUT = np.array([0.3, 0.25, 0])
GAUSS_POINTS = 14  # a side; more change nothing


def compare(outcome, library, label, x, y, random):
    """Weights of both spaces, and their change along a random motion, against exact arithmetic."""
    for space in SPACES:
        name = f"{label}, {space}"
        found = library.weights(x, y, True, space=space)
        exact = as_floats(oracle.weights(x, y, space))
        error = max(np.abs(a - b).max() for a, b in zip(found, exact))
        outcome.below(f"{name}: weights", error, WEIGHTS, "exact arithmetic")
    step = random.uniform(-1, 1, (len(x) + len(y), 3))
    exact = oracle.change(x, y, space, step)
    error = max(np.abs(d @ step.ravel() - e).max() for d, e in zip(found[2:], exact))
    outcome.below(f"{name}: derivatives", error, DERIVATIVES, "differences of exact arithmetic")
    outcome.figures["derivative_error"] = max(error, outcome.figures.get("derivative_error", 0))


def each_pair(compare_pair):
    """The run of a cell: all that meet."""

    def run(context):
        outcome, library = Outcome(), context.library
        random = np.random.default_rng(20261123)
        try:
            for n, m in MET:
                compare_pair(outcome, library, f"{NAMES[n]} on {NAMES[m]}", facet(n), facet(m), random)
        except Refused as refusal:
            outcome.refusal = str(refusal)
        return outcome

    return run


def angle(text):
    """Facets that coincide but for this angle, somewhere in space, over a gap."""

    def pair(outcome, library, label, x, y, random):
        q = rotation(random)
        y = other_side(turned(y, float(text), ABOUT)) - [0, 0, 0.01]
        compare(outcome, library, label, x @ q.T, y @ q.T, random)

    return each_pair(pair)


def sliver(text):
    """Overlaps of this width: a strip along an edge."""
    d = float(text)

    def pair(outcome, library, label, x, y, random):
        compare(outcome, library, label, x, other_side(y + [d - 1, 0.1, 0]), random)

    return each_pair(pair)


# The rule's own error where parts are warped quadrilaterals, or no parallelograms, as measured here; of the facet's area.
RULE = {
    "drawn": lambda s: 5e-5 * s**2,
    "bowed": lambda s: 1e-5 * s**2,
    "lifted": lambda s: 1e-5 * s**4,
}


def bent(what, move):
    """The run of cells whose mid nodes are moved: `move(mids, along, across, random)` gives their moves, from the edges'
    vectors and their normals in the plane."""

    def make(s):
        def run(context):
            outcome, library = Outcome(), context.library
            random = np.random.default_rng(20261123)
            try:
                for n, m in MET:
                    x, y = (moved(facet(k), s, move, random) for k in (n, m))
                    y = other_side(turned(y, 0.3, ABOUT)) - [0, 0, 0.01]
                    against_many_points(outcome, library, f"{NAMES[n]} on {NAMES[m]}", x, y, RULE[what](s))
            except Refused as refusal:
                outcome.refusal = str(refusal)
            return outcome

        return run

    return make


def moved(x, s, move, random):
    corners = 3 if len(x) in (3, 6) else 4
    if len(x) == corners:
        return x
    along = np.roll(x[:corners], -1, axis=0) - x[:corners]
    across = np.cross(along, [0, 0, 1])
    x[corners : 2 * corners] += s * move(along, across, random)
    return x


def against_many_points(outcome, library, label, x, y, allowed):
    triangles = {len(x), len(y)} <= {3, 6}
    for space in SPACES:
        found = library.weights(x, y, space=space)
        exact = as_floats(oracle.weights(x, y, space, number=float, points=GAUSS_POINTS))
        error = max(np.abs(a - b).max() for a, b in zip(found, exact))
        bound, reason = (0, "triangles: exact") if triangles else (allowed, "the rule's own error")
        outcome.below(f"{label}, {space}: weights", error, WEIGHTS + bound, reason)
        sums = np.abs(found[0].sum(axis=1) - found[1].sum(axis=1)).max()
        outcome.below(f"{label}, {space}: sum n_AB - sum n_AC", sums, WEIGHTS, "both partitions of unity")
        outcome.figures["rule_error"] = max(error, outcome.figures.get("rule_error", 0))


def signs(random, n):
    return random.choice([-1.0, 1.0], (n, 1))


def along_edges(along, across, random):
    return along * signs(random, len(along))


def across_edges(along, across, random):
    return across * signs(random, len(along))


def out_of_plane(along, across, random):
    return np.array([0, 0, 1.0]) * signs(random, len(along))


def beyond(s):
    return OUT_OF_ORDER if s >= 0.25 else None


def steep(s):
    return f"{OUT_OF_ORDER}|not convex" if s >= MUCH else None


def refused_beyond(s):
    """From a quarter on there must be a refusal."""
    run = bent("drawn", along_edges)(s)

    def checked(context):
        outcome = run(context)
        if outcome.refusal is None and s >= 0.25:
            outcome.true("refused", False, "the mapping turns over at a corner")
        return outcome

    return checked


def cells():
    kind = {"kind": ELEMENT}
    bowed, lifted = bent("bowed", across_edges), bent("lifted", out_of_plane)
    yield from series("quadratic pair, crossing angle", ANGLES, angle, quick=("1e-15",), **kind)
    yield from series("quadratic pair, slivers of this width", SLIVERS, sliver, quick=("1e-14",), **kind)
    yield from series(
        "quadratic pair, mid nodes drawn by", DRAWN, refused_beyond, quick=(0.24, 0.26), may_refuse=beyond, **kind
    )
    yield from series("quadratic pair, edges bowed by", BOWED, bowed, may_refuse=steep, **kind)
    yield from series("quadratic pair, mid nodes lifted by", LIFTED, lifted, may_refuse=steep, **kind)
