"""NAFEMS' second contact benchmark (Konter), code_aster's SSNA122 B: a steel punch with a rounded edge on a base, axisymmetric."""

import numpy as np

from friction_checks import graded
from plane_mesh import PlaneMesh
from scene import write

# mm, MPa.
RADIUS, HEIGHT, FILLET, BASE = 50.0, 100.0, 10.0, (100.0, 200.0)
PUNCH = {"young": 210e3, "poisson": 0.3, "small_strain": True}
SOFT = {"young": 70e3, "poisson": 0.3, "small_strain": True}
PRESSURE = 100.0
FLAT = RADIUS - FILLET
# Displacement and stress along the axis by friction, told of the middle of the base's surface. Two programs differ by 3e-4 and 0.5 %.
PUBLISHED = {0.0: (-0.132941, -94.122), 0.1: (-0.130794, -95.474)}
NAME = "contact"
GROWTH = 1.15
# Half of the fillet is a part of the foot; the corner of the mesh lies in the middle of the fillet, far from the contact.
SPLIT = np.pi / 4


class Punch:
    """Maps a rectangle of nodes, x from 0 to 1 and y from 0 to 1, by its four sides; `along` and `up`: places of its planes."""

    def __init__(self, facet):
        arc = int(np.ceil(FILLET * SPLIT / facet))
        flat = FLAT - graded(facet, 2 * FILLET * SPLIT, FLAT, GROWTH)[::-1]
        flat[0] = 0
        angles = SPLIT * np.arange(1, arc + 1) / arc
        self.length = np.append(flat, FLAT + FILLET * angles)
        up = graded(facet, FILLET * SPLIT, HEIGHT, GROWTH)
        self.up, self.arc = up, np.searchsorted(up, FILLET * SPLIT - 1e-9)
        self.planes = self.length / self.length[-1], up / up[-1]

    def bottom(self, s):
        s = s * self.length[-1]
        angle = max(0.0, s - FLAT) / FILLET
        return np.array([min(s, FLAT) + FILLET * np.sin(angle), FILLET * (1 - np.cos(angle))])

    def right(self, t):
        """First the rest of the fillet, then straight up."""
        start = self.up[self.arc] / self.up[-1]
        if t <= start:
            angle = SPLIT + (np.pi / 2 - SPLIT) * t / start
            return np.array([FLAT + FILLET * np.sin(angle), FILLET * (1 - np.cos(angle))])
        return np.array([RADIUS, FILLET + (HEIGHT - FILLET) * (t - start) / (1 - start)])

    def place(self, p):
        s, t = p
        bottom, right, corner = self.bottom(s), self.right(t), self.bottom(1)
        top, left = np.array([RADIUS * bottom[0] / corner[0], HEIGHT]), np.array([0, HEIGHT * t])
        flat = s * (1 - t) * corner + (1 - s) * t * np.array([0, HEIGHT]) + s * t * np.array([RADIUS, HEIGHT])
        return list((1 - t) * bottom + t * top + (1 - s) * left + s * right - flat)


def scene(folder, facet, friction, cell="quad", **interface):
    """`facet`: its length at the edge of the contact, mm."""
    punch = Punch(facet)
    mesh = PlaneMesh(cell, *punch.planes, False, punch.place).write(folder / f"punch_{cell}_{facet:g}.msh")
    beyond = FLAT + graded(0.8 * facet, 6, BASE[0] - FLAT, GROWTH)
    inside = FLAT - graded(0.8 * facet, 8, FLAT, GROWTH)[:0:-1]
    inside[0] = 0
    deep = graded(0.8 * facet, 6, BASE[1], GROWTH)
    return write(
        {
            "schema": 1,
            "model": "axisymmetric",
            "bodies": ["punch", "base"],
            "punch": {"type": "gmsh", "file": mesh.name, **PUNCH},
            "base": {"type": "box", "x": np.append(inside, beyond).tolist(), "y": (-deep[::-1]).tolist(), "cell": cell, **SOFT},
            "supports": ["ground"],
            "ground": {"surface": "base.ymin", "components": ["x", "y"]},
            "loads": ["press"],
            "press": {"surface": "punch.ymax", "pressure": PRESSURE},
            "interfaces": [NAME],
            NAME: {"nonmortar": "punch.ymin", "mortar": "base.ymax", "friction": friction, **interface},
            "probes": ["middle"],
            "middle": {"body": "base", "point": [0, 0]},
            "steps": {"count": 1},
            "output": {"vtu": "last", "csv": "last", "quiet": True},
        },
        folder / f"nafems_{cell}_{facet:g}_{friction:g}.yaml",
    )


def middle(run):
    """(displacement, stress along the axis) of the base's middle."""
    points, _, _ = run.mesh()
    stress = run.point_field("stress_xx_yy_zz_xy_yz_xz")
    there = [k for k in np.flatnonzero(np.hypot(points[:, 0], points[:, 1]) < 1e-9)]
    return run.steps[-1]["probes"]["middle"][1], stress[there[-1]][1]
