"""Assembled interfaces: noise on matching meshes, coverage that goes to nothing, corners on edges."""

import numpy as np

from cell import ELEMENT, Outcome, series
from library import GAP, STICK, Interface, fade
from scenes import EPS

NOISES = ("1e-15", "1e-14", "1e-13", "1e-12", "1e-11", "1e-10")
# The tangent of noisy matching meshes against the clean one's: what must hold for rounding noise. Beyond, the tangent
# itself changes, by some times the noise (second derivatives of the weights jump where edges cross).
NOISY, PER_NOISE = 1e-9, 100.0
CLOSED = 1e-8  # a gap over the root of the nodal area below this is closed at the start
COVERAGES = ("1e-1", "1e-3", "1e-5", "1e-7", "1e-9", "1e-11", "1e-12", "0")
CORNERS = ("1e-1", "1e-3", "1e-6", "1e-9", "1e-12", "1e-15", "0")
TOUCHES = ("-1e-2", "-1e-6", "-1e-9", "-1e-12", "0", "1e-12", "1e-9", "1e-6", "1e-2")
YOUNG, MU = 1000.0, 0.3
OPTIONS = {"modulus": YOUNG, "mu": MU}


def grid(n, lower=(0.0, 0.0), size=1.0, z=0.0, down=False, turn=0.0):
    """Nodes and facets of n x n quadrilaterals; `down`: the normal points down (a non-mortar side that lies above)."""
    t = np.linspace(0, size, n + 1)
    y, x = np.meshgrid(t, t, indexing="ij")
    nodes = np.stack([x.ravel() + lower[0], y.ravel() + lower[1], np.full(x.size, z)], axis=1)
    c, s = np.cos(turn), np.sin(turn)
    nodes[:, :2] = nodes[:, :2] @ np.array([[c, s], [-s, c]])
    k = np.arange(n * (n + 1)).reshape(n, n + 1)[:, :-1].ravel()
    facets = np.stack([k, k + 1, k + n + 2, k + n + 1], axis=1)
    return nodes, facets[:, ::-1] if down else facets


def pressed(nodes, traction=(0.1, 0.0, -1.0)):
    """The traction at each node; lines have none along the middle axis."""
    return np.tile(traction if nodes.shape[1] == 3 else (traction[0], traction[2]), (len(nodes), 1))


# A case of lines gives a `mesh` of its own, such as lines.grid, and the model among its options.
def noise(text, mesh=grid, **options):
    """Every node of a matching mesh moved by noise: the assembled tangent has no kink, so it hardly changes."""

    def run(context):
        outcome, library = Outcome(), context.library
        x1, f1 = mesh(3, down=True, z=-0.001)
        x2, f2 = mesh(5, lower=(-1 / 3, -1 / 3), size=5 / 3)  # around it, so that the edges inside coincide
        lam = pressed(x1)
        random = np.random.default_rng(20261121)
        tangents = []
        for size in (0.0, float(text)):
            y1, y2 = (x + size * random.uniform(-1, 1, x.shape) for x in (x1, x2))
            interface = Interface(library, y1, f1, y2, f2, **OPTIONS, **options)
            tangents.append(interface.tangent(y1, y2, lam))
            interface.close()
        error = np.abs(tangents[1] - tangents[0]).max() / np.abs(tangents[0]).max()
        bound = max(NOISY, PER_NOISE * float(text))
        outcome.below("tangent against the clean mesh's", error, bound, "the assembled weights have no kink")
        if float(text) <= 1e-12:
            outcome.figures["noise_error"] = error
        return outcome

    return run


def balance(outcome, interface, x1, x2, lam, scale):
    """Force balance, and the identity of moments sum x x f = sum g x p (p = lambda where forces use lambda)."""
    f1, f2, rows = interface.residual(x1, x2, lam)
    total = np.abs(f1.sum(axis=0) + f2.sum(axis=0)).max()
    outcome.below("sum of all forces", total / scale, 1e-13, "sum n_AB = sum n_AC")
    outcome.true("finite", all(np.isfinite(v).all() for v in (f1, f2, rows)), "no NaN")
    return f1, rows


def coverage(text, mesh=grid, **options):
    """A facet that overlaps with the mortar side by a strip of this part of it."""
    c = float(text)

    def run(context):
        outcome, library = Outcome(), context.library
        x1, f1 = mesh(1, down=True, z=-0.001)
        x2, f2 = mesh(1, lower=(c - 2, -0.5), size=2.0)
        half = mesh(1, lower=(-1.5, -0.5), size=2.0)  # what covers it by half
        start = Interface(library, x1, f1, *half, **OPTIONS, **options)
        lam = pressed(x1)
        states = start.states(x1, x2, lam)
        # int N_A over a strip of width c next to the nodes of x = 0, and those of x = 1
        share = 2 / len(x1)  # of nodes above each other
        near, far = share * (c - c**2 / 2), share * c**2 / 2
        exact = np.where(x1[:, 0] == 0, near, far) * fade(c)
        strip = np.spacing(1.0) * 2  # the width itself is a difference of coordinates of order one
        error = np.abs(states["coverage"] - exact).max()
        outcome.below("covered areas", error, strip + 1e-13 * c, "integrals over the strip")
        closed = exact > 1e-8 * share / 2
        outcome.true(
            "nodes covered to less than 1e-8 are open", (states["state"][~closed] == GAP).all(), "coverage_min"
        )
        f, _ = balance(outcome, start, x1, x2, lam, max(c, EPS))
        # the force is that of the traction on the strip, whatever the state: forces use lambda
        outcome.below(
            "force on the strip",
            np.abs(f.sum(axis=0) - lam[0] * exact.sum()).max(),
            4 * strip + 1e-13 * c,
            "traction times area",
        )
        block = start.tangent(x1, x2, lam)[-x1.size :]
        outcome.true(
            "no row of a multiplier vanishes", (np.abs(block).max(axis=1) > 0).all(), "regular at any coverage"
        )
        start.close()
        return outcome

    return run


def corner(text):
    """A facet whose corner hangs over a straight edge by this much, turned by 45 degrees: a triangle of that height."""
    d = float(text)

    def run(context):
        outcome, library = Outcome(), context.library
        x1, f1 = grid(1, down=True, z=-0.001, turn=np.pi / 4)
        reach = x1[:, 0].min()
        x2, f2 = grid(4, lower=(reach + d, -3.0), size=6.0)
        interface = Interface(library, x1, f1, x2, f2, **OPTIONS)
        lam = pressed(x1)
        states = interface.states(x1, x2, lam)
        error = abs(states["coverage"].sum() - (1 - d**2))
        outcome.below("covered area", error, 8 * EPS, "a square less a triangle")
        f, _ = balance(outcome, interface, x1, x2, lam, 1.0)
        outcome.below("force", np.abs(f.sum(axis=0) - lam[0] * (1 - d**2)).max(), 8 * EPS, "traction times area")
        interface.close()
        return outcome

    return run


def touching(text, mesh=grid, **options):
    """The first step of a body that nothing else holds: at a gap of this much, from multipliers of zero, and from
    those that the library gives to start with. What touches or has sunk in is closed then, and every row has its
    stiffness."""
    gap = float(text)

    def run(context):
        outcome, library = Outcome(), context.library
        x1, f1 = mesh(2, down=True, z=gap)
        x2, f2 = mesh(3, lower=(-0.5, -0.5), size=2.0)
        interface = Interface(library, x1, f1, x2, f2, **OPTIONS, **options)
        start, zero = interface.start(), np.zeros_like(x1)
        states = {name: interface.states(x1, x2, lam) for name, lam in (("start", start), ("zero", zero))}
        closed = gap <= CLOSED * states["start"]["area"] ** (1 / (x1.shape[1] - 1))
        outcome.true(
            "started multipliers press", ((start[:, -1] < 0) == closed).all(), "on closed nodes, and on no other"
        )
        state = np.where(closed, STICK, GAP)
        outcome.true("state with them", (states["start"]["state"] == state).all(), "closed nodes stick")
        state = STICK if gap < 0 else GAP
        outcome.true("state from zero", (states["zero"]["state"] == state).all(), "sigma_N >= 0 is gap")
        for name, lam in (("start", start), ("zero", zero)):
            balance(outcome, interface, x1, x2, lam, 1.0)
            tangent = interface.tangent(x1, x2, lam)
            of_displacements = np.abs(tangent[-x1.size :, : -x1.size]).max(axis=1)
            held = np.repeat(closed, x1.shape[1]) if name == "start" else gap < 0
            outcome.true(
                f"rows hold the body, {name}", ((of_displacements > 0) == held).all(), "stick has a stiffness"
            )
        interface.close()
        return outcome

    return run


def cells():
    kind = {"kind": ELEMENT}
    yield from series("interface, noise on matching meshes", NOISES, noise, quick=("1e-15", "1e-13"), **kind)
    yield from series("interface, covered by this part", COVERAGES, coverage, quick=("1e-3", "1e-9", "0"), **kind)
    yield from series("interface, first touch at a gap of", TOUCHES, touching, quick=("0", "-1e-9", "1e-9"), **kind)
    yield from series("interface, corner over an edge", CORNERS, corner, quick=("1e-6", "0"), **kind)
