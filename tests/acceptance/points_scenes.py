"""Scenes for decisions at points, whose exact answers are known: Hertz' line and ball on pieces of half-planes and half-spaces
whose outer sides follow the exact fields, so that the formulas have no error of finite bodies; a block on a wider one.

The upper body has the multipliers. Half-widths are near 1, the load moves the border of the contact through a facet."""

import numpy as np

import fields
import formulas
from friction_checks import both_ways, graded, profile_error
from scene import Line, write

YOUNG, POISSON = 1.0, 0.3
# Of both bodies together.
MODULUS = formulas.together(*[formulas.plane_modulus(YOUNG, POISSON)] * 2)
# Of mortar facets over the others, and how far they are moved along the line, of theirs: no meshes match.
RATIO, SHIFT = 1.18, 0.37
# So flat that nothing turns: half-widths over it are 1e-3.
RADIUS = 1000.0
# In half-widths: the zone with facets of one size, across the surface and into the bodies; the pieces' ends.
FINE, DEEP, FAR = 1.35, 1.0, {"plane": 5.0, "layer": 5.0, "ball": 4.0}
GROWTH = {"plane": 1.2, "layer": 1.2, "ball": 1.5}
# Cattaneo and Mindlin: friction, pull over mu times the force. 0.64: the inner 0.6 of the half-width sticks.
MU, PULL = 0.3, 0.64
# Of the one layer of cells that a line is in space.
THICK = 0.1
# Hats over a facet: points of a Gauss rule a direction.
RULE = 20
NAME = "contact"
# Further options of the interface by the law's name.
NODES = {"nodes, standard": {"basis": "standard"}, "nodes, dual": {"basis": "dual"}}
POINTS = {"basis": "dual", "decision": "points"}
LAWS = {**NODES, "points": POINTS}


def half_widths(facets, count):
    """That move the border through one facet."""
    return (facets - 0.5 + np.arange(count) / count) / facets


def places(size, fine, far, growth, shift=0.0):
    """From -far to far: steps of `size` over -fine to fine, moved by `shift`, then growing ones."""
    half = int(np.ceil(fine / size - 1e-9))
    middle = size * np.arange(-half, half + 1) + shift
    left, right = (graded(size, 0, far - end, growth)[1:] for end in (-middle[0], middle[-1]))
    return np.concatenate([(middle[0] - left)[::-1], middle, middle[-1] + right])


class Hertz:
    """`kind`: plane, layer (one layer of cells in space) or ball (a quarter)."""

    def __init__(self, kind, facets):
        self.kind, self.facets, self.h = kind, facets, 1 / facets
        self.sides = {"upper": self.h, "lower": RATIO * self.h}

    def planes(self, side):
        """Along the surface and away from it."""
        size, far, growth = self.sides[side], FAR[self.kind], GROWTH[self.kind]
        fine = FINE if side == "upper" else FINE + 2 * self.h
        depth = graded(size, DEEP, far, growth)
        if self.kind == "ball":
            return graded(size, fine, far, growth), depth
        return places(size, fine, far, growth, SHIFT * size if side == "lower" else 0), depth

    @property
    def thick(self):
        return [0, THICK] if self.kind == "layer" else None

    def box(self, side):
        along, depth = self.planes(side)
        across = depth if side == "upper" else -depth[::-1]
        box = {"type": "box", "young": YOUNG, "poisson": POISSON, "small_strain": True, "x": along.tolist()}
        if self.kind == "plane":
            round_off = {"ball": [0, RADIUS]}
            box |= {"y": across.tolist()}
        elif self.kind == "layer":
            round_off = {"cylinder": [0, 0, RADIUS], "axis": "y"}
            box |= {"y": self.thick, "z": across.tolist()}
        else:
            round_off = {"ball": [0, 0, RADIUS]}
            box |= {"y": along.tolist(), "z": across.tolist()}
        return box | round_off if side == "upper" else box

    def follow(self, a, side, file, pull):
        """Writes what the nodes of the outer sides do, those with another one at the same place in the plane, too. `pull`: over mu times
        the force, of lines."""
        along, depth = self.planes(side)
        sign = 1 if side == "upper" else -1
        others = {"plane": [0.0], "layer": self.thick, "ball": along}[self.kind]
        grid = np.stack([g.ravel() for g in np.meshgrid(along, others, sign * depth, indexing="ij")], axis=1)
        far = FAR[self.kind] - 1e-9
        outer = (np.abs(grid[:, 0]) > far) | (np.abs(grid[:, 2]) > far) | ((np.abs(grid[:, 1]) > far) & (self.kind == "ball"))
        X = grid[outer]
        if self.kind == "ball":
            peak = 2 * MODULUS * a / (np.pi * RADIUS)
            u = fields.pressed_circle(X * [1, 1, -sign], a, peak, YOUNG, POISSON)
            u[:, :2][X[:, :2] == 0] = 0  # but for rounding
        else:
            peak = MODULUS * a / (2 * RADIUS)
            u = np.zeros_like(X)
            x, stick = X[:, ::2] * [1, -sign], a * np.sqrt(1 - pull)
            u[:, ::2] = fields.pressed_line(x, a, peak, YOUNG, POISSON)
            for width, part in ((a, 1), (stick, -stick / a)) if pull else ():
                u[:, ::2] += fields.sheared_line(x, width, -sign * part * MU * peak, YOUNG, POISSON)
        u[:, 2] *= -sign
        if side == "upper":
            X = bend(X, 1 if self.kind != "ball" else None)
        if self.kind == "plane":
            X, u = X[:, [0, 2, 1]], u[:, [0, 2, 1]]
        np.savetxt(file, np.hstack([X, u]), fmt="%.17g")
        return file.name

    def scene(self, driver, a, pull=0.0, rest=0, **interface):
        """The path of the scene whose half-width is a: pressed and pulled, then `rest` steps in which nothing moves. From nothing both in
        one step are what one after the other is: pressed bodies of one material do not slip."""
        up, end = ("y", "z")[self.kind != "plane"], FINE + self.h
        stem = f"{self.kind}_{self.facets}_{a:.4f}" + (f"_pull_{rest}" if pull else "")
        law = {"law": "coulomb", "friction": MU} if pull else {"law": "none"}
        beyond = {"plane": ["xmin", "xmax"], "layer": ["xmin", "xmax"], "ball": ["xmax", "ymax"]}[self.kind]
        free = ["x", up] if self.kind != "ball" else ["x", "y", "z"]
        low = {"plane": [-end, -1], "layer": [-end, 0, -1], "ball": [0, 0, -1]}[self.kind]
        high = {"plane": [end, 1], "layer": [end, THICK, 1], "ball": [end, end, 1]}[self.kind]
        scene = {
            "schema": 1,
            **({"model": "plane_strain"} if self.kind == "plane" else {}),
            "bodies": list(self.sides),
            **{side: self.box(side) for side in self.sides},
            "surfaces": ["foot"],
            "foot": {"of": f"upper.{up}min", "within": low + high},
            "supports": ["above", "below"],
        }
        for name, side, last in (("above", "upper", "max"), ("below", "lower", "min")):
            file = self.follow(a, side, driver.output / f"{stem}_{side}.txt", pull)
            scene[name] = {"surface": [f"{side}.{up}{last}", *(f"{side}.{b}" for b in beyond)], "components": free, "file": file,
                           "curve": [0, 0, 1, 1]}
        if self.kind == "layer":
            scene["supports"] += ["strain"]
            scene["strain"] = {"body": list(self.sides), "components": ["y"]}
        if self.kind == "ball":
            scene["supports"] += ["left", "front"]
            scene["left"] = {"surface": [f"{side}.xmin" for side in self.sides], "components": ["x"]}
            scene["front"] = {"surface": [f"{side}.ymin" for side in self.sides], "components": ["y"]}
        scene |= {
            "interfaces": [NAME],
            NAME: {"nonmortar": "foot", "mortar": f"lower.{up}max", **law, "weights": "reference", **interface},
            "steps": {"times": list(range(1, 2 + rest))},
            "output": {"vtu": "none", "csv": "all" if rest else "last", "quiet": True},
        }
        return write(scene, driver.output / f"{stem}.yaml")

    def error_of_shear(self, run):
        """Of the traction along a line, by Cattaneo and Mindlin, at equal force and pull."""
        table, thick = run.interface(NAME), THICK if self.kind == "layer" else 1
        along, across = (line_of(table, table[f], thick) for f in ("fx", "fy" if self.kind == "plane" else "fz"))
        exact = formulas.LineContact(across.force.sum(), MODULUS, RADIUS, MU, -along.force.sum()).shear
        return profile_error(along, -along.force / along.length, exact)

    def error(self, run):
        """Of the pressure, as `make compare` defines it: nodal forces over lengths or areas, at equal force."""
        table = run.interface(NAME)
        force = table["fy" if self.kind == "plane" else "fz"]
        if self.kind == "ball":
            _, off, whole = self.squares(table, force)
            return np.sqrt(off.sum() / whole)
        line = line_of(table, force, THICK if self.kind == "layer" else 1)
        hertz = formulas.LineContact(line.force.sum(), MODULUS, RADIUS)
        return profile_error(line, line.force / line.length, hertz.pressure)

    @staticmethod
    def squares(table, force):
        """Of a ball: distances of the nodes from the axis, squared errors of their pressures times areas, the sum of the exact ones'."""
        x, i = np.unique(np.round(table["X"] * RADIUS / (RADIUS - table["Z"]), 6), return_inverse=True)
        y, j = np.unique(np.round(table["Y"] * RADIUS / (RADIUS - table["Z"]), 6), return_inverse=True)
        nodal = np.zeros((len(x), len(y)))
        nodal[i, j] = force
        hertz = formulas.PointContact(4 * force.sum(), MODULUS, RADIUS)
        (at, hat), (_, other) = hats(x), hats(y)
        exact = hat @ hertz.pressure(np.hypot(at[:, None], at[None])) @ other.T
        area = np.outer(hat.sum(axis=1), other.sum(axis=1))
        return np.hypot(x[:, None], y[None]), (nodal - exact) ** 2 / area, (exact**2 / area).sum()

    def parts(self, run, a):
        """Of a ball of this radius of contact: the parts of the error within 0.6 a, and of nodes at most one facet from the border."""
        table = run.interface(NAME)
        r, off, whole = self.squares(table, table["fz"])
        return [np.sqrt(off[part].sum() / whole) for part in (r < 0.6 * a, np.abs(r - a) <= self.h)]


def bend(X, axis):
    """As the driver bends boxes: the cube about the centre becomes a sphere, the square across an axis a circle."""
    v = X - [0, 0, RADIUS]
    w = np.delete(v, axis, axis=1) if axis is not None else v
    factor = np.abs(w).max(axis=1) / np.linalg.norm(w, axis=1)
    out = v * factor[:, None]
    if axis is not None:
        out[:, axis] = v[:, axis]
    return out + [0, 0, RADIUS]


def line_of(table, force, thick):
    x, group = np.unique(np.round(table["X"], 9), return_inverse=True)
    half = np.diff(x) / 2
    total = np.bincount(group, weights=force) / thick
    return Line(x, total, np.append(half, 0) + np.append(0, half), np.full(len(x), "slip"))


def hats(x):
    """Gauss points over all facets of a line, and each node's function times the weights there."""
    share, weight = np.polynomial.legendre.leggauss(RULE)
    at = (x[:-1, None] + np.diff(x)[:, None] * (share + 1) / 2).ravel()
    w = (np.diff(x)[:, None] * weight / 2).ravel()
    return at, np.array([np.interp(at, x, row) for row in np.eye(len(x))]) * w


class Corner:
    """A block of width 1, the upper body, pressed onto a wider one without friction, in plane strain. Reference: the same on meshes
    that match and are graded to the corners, its nodal forces weighted by the hats of the coarse nodes. `shift`: of the wider
    block's nodes, over its facets."""

    # Of the wider block its half-width and height; how far the upper side moves.
    WIDE, HEIGHTS, DOWN = 1.5, (1.0, 1.5), 0.01
    DEEP, GROWTH = 0.3, 1.2
    # Cells of the reference over the width, and how often the outermost is halved.
    CELLS, HALVED = 160, 10

    @classmethod
    def scene(cls, driver, stem, planes, **interface):
        """`planes`: x and heights of the block, of the wider one."""
        common = {"type": "box", "young": YOUNG, "poisson": POISSON, "small_strain": True}
        scene = {
            "schema": 1,
            "model": "plane_strain",
            "bodies": ["block", "base"],
            **{name: {**common, "x": list(x), "y": list(y)} for name, (x, y) in zip(("block", "base"), planes)},
            "supports": ["push", "ground"],
            "push": {"surface": "block.ymax", "components": ["x", "y"], "value": [0, -cls.DOWN]},
            "ground": {"surface": "base.ymin", "components": ["x", "y"]},
            "interfaces": [NAME],
            NAME: {"nonmortar": "block.ymin", "mortar": "base.ymax", "law": "none", "weights": "reference", **interface},
            "steps": {"count": 1},
            "output": {"vtu": "none", "csv": "last", "quiet": True},
        }
        return write(scene, driver.output / f"{stem}.yaml")

    @classmethod
    def coarse(cls, driver, facets, shift, **interface):
        sizes = 1 / facets, RATIO / facets
        up, down = (graded(s, cls.DEEP, far, cls.GROWTH) for s, far in zip(sizes, cls.HEIGHTS))
        wide = places(sizes[1], 0.5 + sizes[1], cls.WIDE, cls.GROWTH, shift * sizes[1])
        planes = (np.linspace(-0.5, 0.5, facets + 1), up), (wide, -down[::-1])
        return cls.scene(driver, f"corner_{facets}_{shift:.2f}", planes, **interface)

    @classmethod
    def matching(cls, driver, facets):
        """Both sides' nodes on each other: nothing is left but the error of the bodies' elements."""
        size = 1 / facets
        up, down = (graded(size, cls.DEEP, far, cls.GROWTH) for far in cls.HEIGHTS)
        inside, beside = np.linspace(-0.5, 0.5, facets + 1), 0.5 + graded(size, 0, cls.WIDE - 0.5, cls.GROWTH)[1:]
        wide = np.concatenate([-beside[::-1], inside, beside])
        return cls.scene(driver, f"corner_{facets}_matching", ((inside, up), (wide, -down[::-1])))

    @classmethod
    def reference(cls, driver):
        """A Line."""
        size = 1 / cls.CELLS
        corner = np.append(0, size * 0.5 ** np.arange(cls.HALVED, 0, -1))
        inside = np.concatenate([-0.5 + corner, np.linspace(-0.5, 0.5, cls.CELLS + 1)[1:-1], (0.5 - corner)[::-1]])
        away = lambda far: np.append(corner, size + graded(size, 0, far - size, cls.GROWTH))
        beyond = 0.5 + away(cls.WIDE - 0.5)[1:]
        wide = np.concatenate([-beyond[::-1], inside, beyond])
        planes = (inside, away(cls.HEIGHTS[0])), (wide, -away(cls.HEIGHTS[1])[::-1])
        table = driver.run(cls.scene(driver, "corner_reference", planes)).interface(NAME)
        if table["fy"].min() < 0:
            raise ValueError("the reference is open somewhere")
        return line_of(table, table["fy"], 1)

    @staticmethod
    def profile(run, reference):
        """Nodes, and their exact forces."""
        table = run.interface(NAME)
        line = line_of(table, table["fy"], 1)
        hat = np.array([np.interp(reference.x, line.x, row) for row in np.eye(len(line.x))])
        return line, hat @ reference.force * (line.force.sum() / reference.force.sum())

    @classmethod
    def error(cls, run, reference):
        line, exact = cls.profile(run, reference)
        return np.sqrt(((line.force - exact) ** 2 / line.length).sum() / (exact**2 / line.length).sum())

    @classmethod
    def at_edge(cls, run, reference):
        """How much too large the forces of the edge's node and of the next one are, over what they should be."""
        line, exact = cls.profile(run, reference)
        return (line.force / exact - 1)[:2]
