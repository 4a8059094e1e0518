"""Two involute spur gears in plane strain, without friction: the force acts along the line of action, which is fixed, so that torques are as
the numbers of teeth, at every angle. A small, curved contact moves and changes teeth; the load is small, so that teeth hardly bend.

Both hubs are turned; the second one is held back by a small angle, which is the load."""

import itertools

import numpy as np

from plane_mesh import SQUARE, TYPES, PlaneMesh
from scene import write

TEETH = {"first": 20, "second": 30}
MODULE, PRESSURE_ANGLE = 1.0, np.radians(20)
TIP, ROOT, RIM = 1.0, 1.25, 1.5  # in modules; the rim is below the root
# Radius of curvature where flanks begin, in modules: the other gear's tips reach down to 0.98 and 2.8.
START = 0.5
# Of the parts that are meshed: about what touches over two pitches.
MESHED = {"first": 5, "second": 6}
YOUNG, POISSON = 1.0, 0.3
# The load: how far the second gear is held back along its pitch circle, in modules.
BACK = 5e-3
# Flanks of the next teeth are farther away.
NEAR = 0.5
NAME = "contact"
RATIO = TEETH["first"] / TEETH["second"]


class Gear(PlaneMesh):
    """`flank`: facets up to the tip; `across`: cells over a tooth. Steps of the lattice are numbered along the rim and
    upwards: the rim, below the flank, the flank."""

    BELOW, GAP = 2, 3  # cells from the root to the flank, and between teeth

    def __init__(self, kind, name, flank, across):
        z = TEETH[name]
        self.z, self.flank, self.across, self.count = z, flank, across, MESHED[name]
        self.pitch = MODULE * z / 2
        self.base = self.pitch * np.cos(PRESSURE_ANGLE)
        self.tip, self.root = self.pitch + TIP * MODULE, self.pitch - ROOT * MODULE
        self.rim = 4
        self.rows = self.rim + self.BELOW + flank
        self.period = across + self.GAP
        self.kind, self.numbers, self.points, self.bend = kind, {}, [], self.place
        columns = self.count * self.period
        self.planes = np.arange(columns + 1.0), np.arange(self.rows + 1.0)
        self.cells, self.edges = [], {side: [] for side in ("xmin", "xmax", "ymin", "ymax")}
        for i, j in itertools.product(range(columns), range(self.rows)):
            if j < self.rim or i % self.period < across:
                self._cell(np.array(SQUARE[0]) + (i, j), i % self.period, j)

    def _cell(self, corners, column, row):
        quadratic = self.kind[-1].isdigit()
        ends = list(zip(corners, np.roll(corners, -1, axis=0)))
        nodes = [*corners, *((a + b) / 2 for a, b in ends if quadratic)]
        nodes += [corners.mean(axis=0)] if self.kind == "quad9" else []
        self.cells.append([self._number(node) for node in nodes])
        side = lambda k: [self._number(n) for n in [*ends[k]] + [sum(ends[k]) / 2] * quadratic]
        if row == 0:
            self.edges["ymin"].append(side(0))  # the hub
        if row >= self.rim + self.BELOW and column == self.across - 1:
            self.edges["xmax"].append(side(1))  # the flank in front, anticlockwise

    def half(self, radius):
        """Angle of half a tooth."""
        involute = lambda a: np.tan(a) - a
        here = np.arccos(np.minimum(1, self.base / np.maximum(radius, self.base)))
        return np.pi / (2 * self.z) + involute(PRESSURE_ANGLE) - involute(here)

    def radius(self, row):
        hub = self.root - RIM * MODULE
        if row <= self.rim:
            return hub + (self.root - hub) * row / self.rim
        start, last = START * MODULE, np.sqrt(self.tip**2 - self.base**2)
        if row <= self.rim + self.BELOW:
            return self.root + (np.hypot(self.base, start) - self.root) * (row - self.rim) / self.BELOW
        # Equal steps of the radius of curvature, which is the angle that the involute is rolled off by.
        return np.hypot(self.base, start + (last - start) * (row - self.rim - self.BELOW) / self.flank)

    def place(self, p):
        tooth, column = divmod(p[0], self.period)
        r, pitch = self.radius(p[1]), 2 * np.pi / self.z
        half = self.half(max(r, self.root))
        if column <= self.across:
            angle = half * (2 * column / self.across - 1)
        else:
            angle = half + (pitch - 2 * half) * (column - self.across) / self.GAP
        angle += (tooth - (self.count - 1) / 2) * pitch
        return [r * np.cos(angle), r * np.sin(angle)]


def scene(folder, flank, steps, cell="quad", back=BACK, **interface):
    """`flank`: facets of the first gear's flanks; the second one has an eighth more. Over two pitches, in so many steps."""
    body = {"young": YOUNG, "poisson": POISSON, "material": "neo_hooke"}
    meshes = {}
    for name, facets in (("first", flank), ("second", round(1.13 * flank))):
        gear = Gear(cell, name, facets, max(4, flank // 3))
        if name == "second":  # to the right, its teeth to the left
            distance = MODULE * sum(TEETH.values()) / 2
            gear.points = [[distance - x, -y] for x, y in gear.points]
        meshes[name] = gear.write(folder / f"gear_{name}_{cell}_{flank}.msh").name
    turn = 2 * np.pi / TEETH["first"]  # on either side of the middle
    angle = back / (TEETH["second"] / 2)
    hub = lambda name, centre: {"surface": f"{name}.ymin", "components": ["x", "y"], "origin": [centre, 0]}
    return write(
        {
            "schema": 1,
            "model": "plane_strain",
            "bodies": list(meshes),
            **{name: {"type": "gmsh", "file": file, **body} for name, file in meshes.items()},
            "supports": ["drive", "load"],
            "drive": {**hub("first", 0), "rotate": turn, "rotate_curve": [0, 0, 1, -1, 2, 1]},
            "load": {**hub("second", distance), "rotate": -turn * RATIO,
                     "rotate_curve": [0, -angle / (turn * RATIO), 1, -1 - angle / (turn * RATIO), 2, 1 - angle / (turn * RATIO)]},
            "interfaces": [NAME],
            NAME: {"nonmortar": "first.xmax", "mortar": "second.xmax", "search_distance": NEAR, **interface},
            "steps": {"stages": [1, 4, 2, steps]},
            "output": {"vtu": "none", "csv": "last", "quiet": True},
        },
        folder / f"gears_{cell}_{flank}_{steps}{f'_{back:g}' if back != BACK else ''}.yaml",
    )


def torques(run):
    """(turn in pitches, ratio of the torques) of the steps over two pitches."""
    found = []
    for step in run.steps:
        if step["t"] >= 1 - 1e-9:
            first, second = (np.abs(step["moments"][name]).max() for name in ("drive", "load"))
            found.append((2 * step["t"] - 3, first / second))
    return np.array(found)
