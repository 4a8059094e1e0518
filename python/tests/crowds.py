"""Scenes of general contact: bodies, what is prescribed at a time, the ends of the steps."""

import numpy as np
from solids import Solids, block

NAN = np.nan


class Scene:
    """``cut``: nodes on planes of symmetry, whose facets are no skin."""

    def __init__(self, solids, prescribe, times, cut=(), **options):
        solids.cut = np.asarray(cut, int)
        self.solids, self.prescribe, self.times, self.options = solids, prescribe, times, options


def where(solids, body, chosen):
    """Nodes of a body by their coordinates."""
    nodes = solids.nodes[body]
    return nodes[chosen(solids.X[nodes].T)]


def three_blocks(dimension):
    """Two blocks side by side on a third; each touches both others. No node is gripped on both sides of the seam."""
    if dimension == 2:
        s = Solids(block((0, 0), (2, 1), (8, 4)), block((0.1, 1), (1.0, 2), (4, 4)), block((1.0, 1), (1.9, 2), (5, 5)), young=[2, 1, 1])
    else:
        s = Solids(block((0, 0, 0), (2, 1, 1), (5, 3, 2)), block((0.1, 0.1, 1), (1.0, 0.9, 2), (3, 2, 3)),
                   block((1.0, 0.05, 1), (1.9, 0.95, 2), (2, 3, 2)), young=[2, 1, 1])
    up = dimension - 1
    bottom = where(s, 0, lambda x: x[up] == 0)
    tops = [where(s, k, lambda x: (x[up] == 2) & (np.abs(x[0] - 1) > 0.05)) for k in (1, 2)]
    along = np.eye(dimension)
    return Scene(s, lambda t: [(bottom, 0.0), (tops[0], t * (0.03 * along[0] - 0.06 * along[up])),
                               (tops[1], t * (-0.03 * along[0] - 0.05 * along[up]))], [0.25, 0.5, 0.75, 1.0])


def stack():
    """Three plates on each other: pressed, then sheared."""
    s = Solids(block((0, 0), (2, 0.3), (9, 2)), block((0.2, 0.3), (1.8, 0.6), (8, 2)), block((0.4, 0.6), (1.6, 0.9), (5, 2)))
    bottom, top = where(s, 0, lambda x: x[1] == 0), where(s, 2, lambda x: x[1] == 0.9)
    return Scene(s, lambda t: [(bottom, 0.0), (top, (0.008 * max(t - 2, 0), -0.01 * min(t, 2)))], [1, 2, 3, 4, 5, 6])


def slide():
    """A block slides off one block onto a second one, whose gap of 0.03 it crosses."""
    rounded = lambda X: X + np.column_stack([0 * X[:, 0], (0.7 - X[:, 1]) / 0.3 * 1.5 * np.maximum(np.abs(X[:, 0] - 0.5) - 0.15, 0) ** 2])
    s = Solids(block((0, 0), (1, 0.4), (9, 3)), block((1.03, 0), (2.03, 0.4), (10, 3)), block((0.2, 0.4), (0.8, 0.7), (8, 3), rounded))
    bottom = np.concatenate([where(s, k, lambda x: x[1] == 0) for k in (0, 1)])
    top = where(s, 2, lambda x: x[1] == 0.7)
    # The gap closes while the slider crosses it.
    shift = lambda t: np.column_stack([np.where(s.X[bottom, 0] > 1, -0.0006 * t, 0.0), np.zeros(len(bottom))])
    return Scene(s, lambda t: [(bottom, shift(t)), (top, (0.02 * max(t - 1, 0), -0.01 * min(t, 1)))], list(range(1, 47)))


def folded(shape, thickness, lines):
    """A strip along a line, (n, 2) points from a parameter in [0, 1]: nodes and cells."""
    def mapped(X):
        point, ahead = shape(X[:, 0]), shape(X[:, 0] + 1e-7)
        along = (ahead - point) / np.linalg.norm(ahead - point, axis=1)[:, None]
        return point + X[:, 1:] * thickness * np.column_stack([-along[:, 1], along[:, 0]])

    return block((0, -0.5), (1, 0.5), lines, mapped)


def strip():
    """A folded strip: its upper arm is pressed on the lower one, and drawn."""
    length, radius = 1.2, 0.15
    whole = 2 * length + np.pi * radius

    def line(s):
        s = s * whole
        angle = np.clip((s - length) / radius, 0, np.pi)
        x = np.where(s < length, s, length) + radius * np.sin(angle)
        x = np.where(s > length + np.pi * radius, length - (s - length - np.pi * radius), x)
        return np.column_stack([x, radius * (1 - np.cos(angle))])

    s = Solids(folded(line, 0.1, (40, 2)))
    lower = where(s, 0, lambda x: (x[1] < -0.049) & (x[0] < 1.19))
    upper = where(s, 0, lambda x: (x[1] > 0.349) & (x[0] < 0.4))
    return Scene(s, lambda t: [(lower, 0.0), (upper, (-0.02 * max(t - 8, 0), -0.028 * min(t, 8)))], list(range(1, 21)))


def arc(angle):
    """The upper half of a circle, or all of its right half, from its end at the top."""
    return lambda s: np.column_stack([np.sin(np.pi - angle * (1 - s)), -np.cos(np.pi - angle * (1 - s))])


def punch(sign):
    """A thick round shell above or below the ring, which touches it at its top."""
    def mapped(X):
        angle, r = 1.4 * (X[:, 0] - 0.5), 0.18 + 0.42 * X[:, 1]
        return np.column_stack([-sign * r * np.sin(angle), sign * (1.7 - r * np.cos(angle))])
    return block((0, 0), (1, 1), (8, 2), mapped)


def gripped(s, body):
    """The inner edge of a punch."""
    return where(s, body, lambda x: np.abs(np.hypot(x[0], np.abs(x[1]) - 1.7) - 0.18) < 1e-9)


RING_TIMES = [*range(2, 31, 2), 30.5, 31, 31.5, 32]


def ring(lines=24, thick=3, times=RING_TIMES):
    """Half a ring between two round punches; its inner wall closes. The cuts at x = 0 are planes of symmetry."""
    s = Solids(folded(arc(np.pi), 0.2, (lines, thick)), punch(1), punch(-1))
    s.X[np.abs(s.X) < 1e-6] = 0.0
    cut, grips = where(s, 0, lambda x: x[0] == 0), [gripped(s, k) for k in (1, 2)]
    return Scene(s, lambda t: [(cut, (0.0, NAN)), (grips[0], (0.0, -0.03 * t)), (grips[1], (0.0, 0.03 * t))], times, cut=cut)


def quarter(lines=12, thick=3):
    """Its upper half, and the nodes on the plane y = 0, which its inner wall comes to lie on."""
    s = Solids(folded(arc(np.pi / 2), 0.2, (lines, thick)), punch(1))
    s.X[np.abs(s.X) < 1e-6] = 0.0
    cuts = [where(s, 0, lambda x: x[axis] == 0) for axis in (0, 1)]
    grip = gripped(s, 1)
    return Scene(s, lambda t: [(cuts[0], (0.0, NAN)), (cuts[1], (NAN, 0.0)), (grip, (0.0, -0.03 * t))], RING_TIMES, cut=np.concatenate(cuts)), cuts[1]


def slit(X, cells, across, beyond, opening):
    """Cuts a body where its coordinate ``across`` is 0 and ``beyond`` above 0, and opens the cut in proportion to it."""
    far = beyond(X.T)
    split = np.flatnonzero((X[:, across] == 0) & (far > 1e-9))
    twin = np.arange(len(X))
    twin[split] = len(X) + np.arange(len(split))
    upper = X[cells].mean(axis=1)[:, across] > 0
    X, cells = np.vstack([X, X[split]]), np.where(upper[:, None], twin[cells], cells)
    X[split, across] -= opening * far[split]
    X[twin[split], across] += opening * far[split]
    return X, cells


def notch(n=8, dimension=2):
    """A block with a V notch that closes from its root."""
    box = ((-1, 0), (1, 1), (2 * n, n)) if dimension == 2 else ((-1, 0, 0), (1, 1, 0.5), (2 * n, n, 3))
    s = Solids(slit(*block(*box), 0, lambda x: x[1] - 0.5, 0.1))
    return Scene(s, notched(s), [0.25, 0.5, 0.75, 1.0])


def half_notch(n=8, dimension=2):
    """The half of it that is beside the plane x = 0, and the facets of its flank."""
    whole = notch(n, dimension).solids
    right = whole.X[whole.cells].mean(axis=1)[:, 0] > 0
    used = np.unique(whole.cells[right])
    s = Solids((whole.X[used], np.searchsorted(used, whole.cells[right])))
    held = where(s, 0, lambda x: (np.abs(x[0]) < 1e-12) & (x[1] < 0.5 + 1e-9))
    flank = where(s, 0, lambda x: (x[0] < 0.1 * np.maximum(x[1] - 0.5, 0) + 1e-9) & (x[1] > 0.5 - 1e-9))
    prescribe, along = notched(s), only(s, 0)
    return Scene(s, lambda t: [*prescribe(t), (held, along(0.0))], [0.25, 0.5, 0.75, 1.0]), held, flank


def only(s, axis):
    """What prescribes one component alone."""
    return lambda value: np.where(np.arange(s.dimension) == axis, value, NAN)


def notched(s):
    """Its sides are pressed, and its lower edge glides; in space so does one of its faces, and the other one bulges."""
    sides = [where(s, 0, lambda x, end=end: x[0] == end) for end in (-1, 1)]
    rest = [(where(s, 0, lambda x, axis=axis: x[axis] == 0), only(s, axis)(0.0)) for axis in range(1, s.dimension)]
    along = only(s, 0)
    return lambda t: [(sides[0], along(0.08 * t)), (sides[1], along(-0.08 * t)), *rest]


def slit_block():
    """A block in space with a slit that closes and slides."""
    s = Solids(slit(*block((0, 0, -0.5), (1, 0.5, 0.5), (6, 3, 4)), 2, lambda x: x[0] - 1 / 3, 0.03))
    bottom, top = where(s, 0, lambda x: x[2] == -0.5), where(s, 0, lambda x: x[2] == 0.5)
    return Scene(s, lambda t: [(bottom, 0.0), (top, (0.02 * max(t - 3, 0), 0.0, -0.02 * min(t, 3)))], [1, 2, 3, 4, 5])


def plates():
    """Four plates, thinner than the skin looks, in a stack."""
    s = Solids(*(block((0.05 * k, 0.05 * k), (1 - 0.04 * k, 0.05 * (k + 1)), (8 + k, 2)) for k in range(4)))
    bottom, top = where(s, 0, lambda x: x[1] == 0), where(s, 3, lambda x: np.isclose(x[1], 0.2))
    return Scene(s, lambda t: [(bottom, 0.0), (top, (0.001 * max(t - 1, 0), -0.002 * min(t, 1)))], [1, 2, 3, 4], search_distance=0.4)


def drop():
    """A block over a gap of 0.3, six times the reach."""
    s = Solids(block((0, 0), (1, 0.3), (5, 2)), block((0.2, 0.6), (0.8, 0.9), (4, 2)))
    bottom, top = where(s, 0, lambda x: x[1] == 0), where(s, 1, lambda x: x[1] == 0.9)
    return Scene(s, lambda t: [(bottom, 0.0), (top, (0.0, -0.31 * t))], [1.0], search_distance=0.05)


def patch(dimension):
    """Three blocks that fill a box: all is pressed evenly, each border of two bodies too."""
    if dimension == 2:
        s = Solids(block((0, 0), (2, 1), (7, 3)), block((0, 1), (0.9, 2), (4, 3)), block((0.9, 1), (2, 2), (5, 5)))
    else:
        s = Solids(block((0, 0, 0), (2, 1, 1), (4, 2, 2)), block((0, 0, 1), (0.9, 1, 2), (2, 3, 2)), block((0.9, 0, 1), (2, 1, 2), (3, 2, 3)))
    walls = [[np.concatenate([where(s, k, lambda x: x[axis] == end) for k in range(3)]) for end in (0, far)]
             for axis, far in ((0, 2), (1, 2) if dimension == 2 else (1, 1), (2, 2))[:dimension]]

    def prescribe(t):
        out = []
        for axis, (near, far) in enumerate(walls):
            one, other = np.full(dimension, NAN), np.full(dimension, NAN)
            one[axis], other[axis] = 0.0, -0.02 * (axis + 1) * t
            out += [(near, one), (far, other)]
        return out

    return Scene(s, prescribe, [1.0]), walls


def exchange():
    """A slider comes near a rigid body on the same plate, whose side there is the other one: facets in contact change theirs."""
    s = Solids(block((0, 0), (2, 0.4), (20, 3)), block((0.1, 0.4), (0.6, 0.7), (5, 3)), block((1.3, 0.4), (1.8, 0.7), (3, 3)))
    bottom, top = where(s, 0, lambda x: x[1] == 0), where(s, 1, lambda x: x[1] == 0.7)
    s.rigid = s.nodes[2]
    return Scene(s, lambda t: [(s.rigid, 0.0), (bottom, (0.0, 0.004 * min(t, 1))), (top, (0.03 * max(t - 1, 0), -0.002 * min(t, 1)))],
                 list(range(1, 22)))


def force(done, chosen, body=0):
    """The sum of the forces on chosen nodes of a body at the end of a run."""
    s = done.solids
    return s.residual(done.ends[-1][: s.X.size]).reshape(s.X.shape)[where(s, body, chosen)].sum(axis=0)
