"""Two boxes that meet at z = 0: Hertz' line and ball on pieces of half-planes and half-spaces, whose other sides follow the
exact fields; a block on a wider block; a patch test. Contact nodes alone are unknown in Newton's method."""

from dataclasses import dataclass

import numpy as np

import fields
import formulas
from bodies import ON, Box, Condensed, Tetrahedra, graded, heights, outwards
from friction_checks import profile_error
from laws import Pair
from overlaps import Surface, hats
from scene import Line

YOUNG, POISSON = 1.0, 0.3
PLANE = formulas.plane_modulus(YOUNG, POISSON)
# Of facets on the mortar side over those on the other one, and where they begin: no meshes match.
RATIO, SHIFT = 1.18, 0.37
# Of Newton's method: the last step over all displacements, after which an active set does not change; and iterations.
TOLERANCE, ITERATIONS = 1e-9, 60
# In half-widths: of the zone with fine cells along and across; of the piece in the plane and in space.
FINE, DEEP, FAR = 1.35, 1.0, {2: 5.0, 3: 4.0}
# Of both parabolas together, over half-widths: nothing turns.
FLAT = 1000.0
# Of cells from one to the next outside of it.
GROWTH = {2: 1.2, 3: 1.5}
# Of triangles' nodes, over the size of a facet.
JITTER = 0.2
# Cattaneo and Mindlin: friction, pull over mu times the force. 0.64: the inner 0.6 of the half-width sticks.
MU, PULL = 0.3, 0.64


class NoAnswer(Exception):
    """Newton's method has no end."""


@dataclass
class Answer:
    force: np.ndarray  # (nodes, d) of the other body on the non-mortar nodes
    lam: np.ndarray
    u: tuple  # of both sides' nodes
    iterations: int


class Scene:
    """`bodies`: the upper one, whose side is the non-mortar one, and the lower one; `zones`: how far their contact nodes are
    from the axis; `components`: of their displacements, those that are unknown; `fixed`: masks of what is prescribed."""

    def __init__(self, bodies, zones, components, fixed):
        surfaces, self.bodies = [], []
        for box, zone, mask in zip(bodies, zones, fixed):
            near = (np.abs(box.x[:, :-1]) <= zone + ON).all(axis=1)
            facets = box.facets()
            nodes, local = np.unique(facets[near[facets].all(axis=1)], return_inverse=True)
            surfaces.append(Surface(box.x[nodes], np.ascontiguousarray(local.reshape(-1, facets.shape[1]))))
            self.bodies.append(Condensed(box, nodes, components, mask))
        together = formulas.together(*[formulas.plane_modulus(box.young, box.poisson) for box in bodies])
        self.pair = Pair(*surfaces, together)
        self.heights = np.zeros(len(surfaces[0].x))
        self.sizes = [s.x.size for s in surfaces]
        d = bodies[0].dimension
        own = [(d * np.arange(len(s.x))[:, None] + np.array(components)).ravel() for s in surfaces]
        self.unknown = np.append(own[0], self.sizes[0] + own[1])

    def start(self):
        """Positions at rest: the upper surface has its heights."""
        one, two = self.pair.one.x.copy(), self.pair.two.x.copy()
        one[:, -1] += self.heights
        return one, two

    def solve(self, law, prescribed, start=None):
        """From nothing, or from another answer, of which the normal multipliers may be all.
        `prescribed`: displacements of all nodes of each body."""
        load = np.concatenate([body.load(u) for body, u in zip(self.bodies, prescribed)])
        at, n, m, rest = len(self.bodies[0].own), len(load), law.components * len(self.heights), self.start()
        stiffness = np.zeros((n + m, n + m))
        stiffness[:at, :at], stiffness[at:n, at:n] = (body.stiffness for body in self.bodies)
        u, lam = np.zeros(sum(self.sizes)), np.zeros((len(self.heights), law.components))
        if start is not None:
            u = np.concatenate([v.ravel() for v in start.u])
            lam[:, -start.lam.shape[1] :] = start.lam
        parts = lambda: [v.reshape(x.shape) for v, x in zip(np.split(u, self.sizes[:1]), rest)]
        place = lambda: [x + v for x, v in zip(rest, parts())]
        rows = np.append(self.unknown, len(u) + np.arange(m))
        for iteration in range(1, ITERATIONS + 1):
            residual = law.residual(*place(), lam)[rows]
            residual[:n] += stiffness[:n, :n] @ u[self.unknown] - load
            step = np.linalg.solve(stiffness + law.tangent(*place(), lam)[np.ix_(rows, rows)], -residual)
            u[self.unknown] += step[:n]
            lam += step[n:].reshape(lam.shape)
            if np.abs(step[:n]).max() <= TOLERANCE * np.abs(u).max():
                force = -law.residual(*place(), lam)[: self.sizes[0]]
                return Answer(force.reshape(rest[0].shape), lam, tuple(parts()), iteration)
        raise NoAnswer(f"no answer in {ITERATIONS} iterations")

    def commit(self, law, answer):
        law.commit(*(x + v for x, v in zip(self.start(), answer.u)), answer.lam)

    def line(self, answer):
        """Nodal forces over tributary lengths, as `make compare` has them."""
        x = self.pair.one.x[:, 0]
        half = np.diff(x) / 2
        return Line(x, answer.force, np.append(half, 0) + np.append(0, half), np.full(len(x), "slip"))


def follow(box, field, outer):
    """Displacements of the nodes `outer` by a field of a lower body; an upper one is its mirror."""
    sign = np.ones(box.dimension)
    sign[-1] = -1 if box.upper else 1
    u = np.zeros_like(box.x)
    u[outer] = field(box.x[outer] * sign) * sign
    return u


class Hertz:
    """Two parabolas on half-planes (`dimension` 2), or paraboloids on half-spaces, of which a quarter is meshed; `facets` over a
    half-width or radius of 1. `stiffer`: the upper body's modulus over the lower one's; `uneven`: facets of 1 : 2 in turn;
    `triangles`: in space, of tetrahedra with nodes moved at random; `ratio`: of facets on the mortar side over the others;
    `radius`: of both parabolas together, which counts only where weights are those of now."""

    def __init__(self, facets, dimension=2, stiffer=1.0, uneven=False, triangles=False, ratio=RATIO, radius=FLAT):
        self.dimension, self.facets, self.radius, self.young = dimension, facets, radius, (stiffer * YOUNG, YOUNG)
        h, far, growth = 1 / facets, FAR[dimension], GROWTH[dimension]
        self.boxes, self.outer, fixed = [], [], []
        for size, upper, young in zip((h, ratio * h), (True, False), self.young):
            # The mortar side reaches further. In space nodes at 0 keep the symmetry.
            shift = 0.0 if upper or dimension == 3 else SHIFT * size
            along = graded(size, FINE if upper else FINE + 2 * h, far, growth, shift)
            if uneven:
                along[np.flatnonzero(np.abs(along) < FINE + ON)[1:-1:2]] += size / 3
            planes = [along] if dimension == 2 else [along[along > -ON]] * 2
            planes.append(heights(size, DEEP, far, growth, upper))
            box = Tetrahedra(planes, young, POISSON, JITTER * size, FINE, facets) if triangles else Box(planes, young, POISSON)
            ends = (np.abs(np.abs(box.x) - far) < ON).any(axis=1)
            mask = np.tile(ends[:, None], dimension)
            if dimension == 3:
                mask[:, :2] |= np.abs(box.x[:, :2]) < ON
            self.boxes.append(box), self.outer.append(ends), fixed.append(mask)
        components = (0, 1) if dimension == 2 else (2,)
        self.scene = Scene(self.boxes, (FINE + h - 2 * ON, FINE + 2 * h + 2 * ratio * h), components, fixed)
        self.modulus = self.scene.pair.modulus
        self.scene.heights = (self.scene.pair.one.x[:, :-1] ** 2).sum(axis=1) / (2 * radius)

    def loads(self, count=10):
        """Half-widths that move the border through a facet."""
        return (self.facets - 0.5 + np.arange(count) / count) / self.facets

    def prescribed(self, a, pull=0.0, back=0.0):
        """`pull` over mu times the force; `back`: of it, what has been taken back."""
        sides = zip(self.boxes, self.young, self.outer, (-1, 1))
        if self.dimension == 3:
            peak = 2 * self.modulus * a / (np.pi * self.radius)
            return [follow(box, lambda x: fields.pressed_circle(x, a, peak, e, POISSON), out) for box, e, out, _ in sides]
        peak, ellipses = self.modulus * a / (2 * self.radius), []
        for share, times in ((pull, 1), (back / 2, -2)):
            stick = a * np.sqrt(1 - share)
            ellipses += [(a, times), (stick, -times * stick / a)] if share else []
        found = []
        for box, e, out, sign in sides:
            def field(x):
                u = fields.pressed_line(x, a, peak, e, POISSON)
                return u + sum(fields.sheared_line(x, width, sign * part * MU * peak, e, POISSON) for width, part in ellipses)
            found.append(follow(box, field, out))
        return found

    def error(self, answer, within=np.inf):
        """Of the pressure, as `make compare` defines it, at nodes `within` so many half-widths; in space with areas in place of
        lengths, of all nodes."""
        if self.dimension == 3:
            force = answer.force[:, 2]
            hertz = formulas.PointContact(4 * force.sum(), self.modulus, self.radius)
            area, exact = hats(self.scene.pair.one, lambda x: hertz.pressure(np.linalg.norm(x, axis=-1)))
            return np.sqrt(((force - exact) ** 2 / area).sum() / (exact**2 / area).sum())
        line = self.scene.line(answer)
        hertz = formulas.LineContact(line.force[:, 1].sum(), self.modulus, self.radius)
        return profile_error(line, line.traction[:, 1], hertz.pressure, np.abs(line.x) <= within * hertz.half_width)

    def error_of_shear(self, answer, largest=None):
        """`largest`: the answer from which the pull has been taken back (Mindlin and Deresiewicz); over the traction there."""
        line = self.scene.line(answer)
        along, across = -line.force[:, 0], line.force[:, 1]
        shear = lambda pull: formulas.LineContact(across.sum(), self.modulus, self.radius, MU, pull).shear
        if largest is None:
            return profile_error(line, along / line.length, shear(along.sum()))
        most = -largest.force[:, 0].sum()
        first, second = shear(most), shear((most - along.sum()) / 2)
        now, then = (formulas.nodal_mean(f, line.x) for f in (lambda x: first(x) - 2 * second(x), first))
        return np.sqrt((line.length * (along / line.length - now) ** 2).sum() / (line.length * then**2).sum())


class Corner:
    """A block of width 1 on a wider block, without friction, that is pressed onto it. The reference: the same on a mesh that is
    graded towards the corners, all closed, its nodal forces weighted by the hats of the coarse nodes. `wide`: the wider
    block has the non-mortar side, which the corners cover in part. `shift`: of the wider block's nodes, over its facets."""

    # Widths from the middle and heights of the block and the wider one; how far the block's far side moves.
    WIDTH, HEIGHT, DOWN = (0.5, 1.5), (1.0, 1.5), 0.01
    # Fine cells across.
    DEEP = 0.3
    # Cells of the reference over the width, and how often the first of them is halved.
    CELLS, HALVED = 160, 10

    def __init__(self, facets, shift, wide=False):
        h, growth = 1 / facets, GROWTH[2]
        sizes = (RATIO * h, h) if wide else (h, RATIO * h)
        across = np.linspace(-0.5, 0.5, facets + 1), graded(sizes[1], 0.5 + sizes[1], self.WIDTH[1], growth, shift * sizes[1])
        if wide:
            across = np.linspace(-0.5, 0.5, int(round(facets / RATIO)) + 1), across[1]
        planes = [(x, heights(size, self.DEEP, far, growth, (k == 0) != wide))
                  for k, (x, size, far) in enumerate(zip(across, sizes, self.HEIGHT))]
        self.wide = wide
        self.scene = self.of(planes, (0.5, 0.5 + 2 * sizes[1]), (0, 1), wide)

    @classmethod
    def of(cls, planes, zones, components, wide=False):
        """`planes`, `zones`: of the block and of the wider one."""
        boxes = [Box(p, YOUNG, POISSON) for p in planes]
        held = [np.abs(np.abs(box.x[:, 1]) - far) < ON for box, far in zip(boxes, cls.HEIGHT)]
        fixed = [np.tile(h[:, None], 2) for h in held]
        order = -1 if wide else 1
        scene = Scene(boxes[::order], zones[::order], components, fixed[::order])
        scene.prescribed = [np.zeros_like(box.x) for box in boxes]
        scene.prescribed[0][held[0], 1] = cls.DOWN if wide else -cls.DOWN
        scene.prescribed = scene.prescribed[::order]
        return scene

    @classmethod
    def reference(cls):
        """(x, force) of the nodes of the graded mesh."""
        size = 1 / cls.CELLS
        halves = size * 0.5 ** np.arange(cls.HALVED, -1, -1)
        corner = np.append(0, halves[:-1])
        inside = np.concatenate([-0.5 + corner, np.linspace(-0.5, 0.5, cls.CELLS + 1)[1:-1], (0.5 - corner)[::-1]])
        away = lambda far: np.append(corner, outwards(size, size, far, GROWTH[2]))
        beyond = 0.5 + away(cls.WIDTH[1] - 0.5)[1:]
        planes = (inside, away(cls.HEIGHT[0])), (np.concatenate([-beyond[::-1], inside, beyond]), -away(cls.HEIGHT[1])[::-1])
        scene = cls.of(planes, (0.5, 0.5), (1,))
        (one, two), loads = scene.bodies, [body.load(u) for body, u in zip(scene.bodies, scene.prescribed)]
        force = one.stiffness @ np.linalg.solve(one.stiffness + two.stiffness, sum(loads)) - loads[0]
        if force.min() < 0:
            raise NoAnswer("the reference is open somewhere")
        return inside, force

    def error(self, answer, reference):
        """Root mean square of nodal forces over lengths, at equal force."""
        line, (x, fine) = self.scene.line(answer), reference
        hat = np.array([np.interp(x, line.x, row) for row in np.eye(len(line.x))])
        exact = hat @ fine * (line.force[:, 1].sum() / fine.sum())
        return np.sqrt(((line.force[:, 1] - exact) ** 2 / line.length).sum() / (exact**2 / line.length).sum())


class Patch:
    """Two blocks of the same width whose meshes do not match, the upper one's top goes down: uniform pressure."""

    DOWN = 0.01

    def __init__(self, facets=(7, 5), uneven=False):
        boxes, fixed = [], []
        for n, upper in zip(facets, (True, False)):
            along, height = np.linspace(-0.5, 0.5, n + 1), np.linspace(0, 1, 4)
            if uneven:
                along[1:-1:2] += 1 / (3 * n)
            box = Box((along, height if upper else -height[::-1]), YOUNG, POISSON)
            mask = np.zeros(box.x.shape, bool)
            mask[:, 1] = np.abs(box.x[:, 1]) == 1
            mask[np.flatnonzero(mask[:, 1])[0], 0] = True
            boxes.append(box), fixed.append(mask)
        self.scene = Scene(boxes, (0.5, 0.5), (0, 1), fixed)
        self.prescribed = [np.zeros_like(box.x) for box in boxes]
        self.prescribed[0][boxes[0].x[:, 1] == 1, 1] = -self.DOWN

    def error(self, answer):
        """Of the worst nodal traction."""
        return np.abs(self.scene.line(answer).traction[:, 1] / (PLANE * self.DOWN / 2) - 1).max()
