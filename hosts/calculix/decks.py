"""Meshes and input decks of the problems that check.py solves with CalculiX."""

import itertools
from dataclasses import dataclass, field

import numpy as np

# Corners of a cell in CalculiX' order, then its edges, whose middles are the other nodes of a quadratic cell.
CUBE = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)])
EDGES = {8: [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)],
         6: [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)],
         4: [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]}
FACES = {8: [(0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)],
         6: [(0, 1, 2), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)],
         4: [(0, 1, 2), (0, 1, 3), (1, 2, 3), (2, 0, 3)]}
# A cube of six tetrahedra around its diagonal.
TETRAHEDRA = [(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)]
# A cube of two wedges that stand.
WEDGES = [(0, 1, 2, 4, 5, 6), (0, 2, 3, 4, 6, 7)]
PER_LINE = 16
# Places are equal below this part of a unit.
SAME = 1e-9
# Forces and corrections that are far below what is compared.
CONTROLS = "*CONTROLS, PARAMETERS=FIELD\n1.E-12, 1.E-10, , , , 1.E-12"


def number(value):
    """CalculiX reads 20 characters of a number."""
    return f"{value:.13g}"


@dataclass
class Mesh:
    points: np.ndarray
    cells: np.ndarray
    corners: int  # of a cell: 8, 6 or 4

    @property
    def kind(self):
        return f"C3D{self.cells.shape[1]}"

    def nodes(self, where):
        return [n for n in range(len(self.points)) if where(*self.points[n])]

    def faces(self, where):
        """(cell, number of its face), all of whose corners are there."""
        on = np.zeros(len(self.points), bool)
        on[self.nodes(where)] = True
        return [(cell, face) for cell, face in itertools.product(range(len(self.cells)), range(len(FACES[self.corners])))
                if on[self.cells[cell][list(FACES[self.corners][face])]].all()]


def grid(cells, place):
    """Hexahedra with nodes at place(s, t, u), each from 0 to 1."""
    n = np.array(cells)
    index = np.arange(np.prod(n + 1)).reshape(n + 1)
    steps = [np.arange(k + 1) / k for k in cells]
    points = np.array([place(*where) for where in itertools.product(*steps)], float)
    return Mesh(points, np.array([[index[tuple(corner + first)] for corner in CUBE] for first in np.ndindex(*n)]), 8)


def box(lower, upper, cells):
    low, high = np.array(lower, float), np.array(upper, float)
    return grid(cells, lambda *where: low + (high - low) * np.array(where))


def tetrahedra(mesh):
    return Mesh(mesh.points, np.concatenate([mesh.cells[:, list(t)] for t in TETRAHEDRA]), 4)


def wedges(mesh):
    return Mesh(mesh.points, np.concatenate([mesh.cells[:, list(w)] for w in WEDGES]), 6)


def quadratic(mesh, project=None):
    """With nodes in the middle of all edges; project(ends, middle) may move one."""
    points, number, cells = list(mesh.points), {}, []
    for cell in mesh.cells:
        row = list(cell)
        for a, b in EDGES[mesh.corners]:
            ends = tuple(sorted((cell[a], cell[b])))
            if ends not in number:
                number[ends] = len(points)
                middle = (mesh.points[ends[0]] + mesh.points[ends[1]]) / 2
                points.append(project(mesh.points[list(ends)], middle) if project else middle)
            row.append(number[ends])
        cells.append(row)
    return Mesh(np.array(points), np.array(cells), mesh.corners)


@dataclass
class Deck:
    """Bodies with materials, then sets, surfaces and steps as lines of their own."""

    bodies: list  # (mesh, lines of the material)
    pairs: list  # (slave, master), each (body, where)
    contact: str  # parameters of *CONTACT PAIR
    interaction: str  # lines behind *SURFACE INTERACTION
    steps: list  # lines of each
    model: str = ""  # lines in front of the steps
    suffix: str = ""  # of the elements' type, R
    first: list = field(init=False)

    def __post_init__(self):
        self.first = list(itertools.accumulate([len(mesh.points) for mesh, _ in self.bodies], initial=1))

    def numbers(self, body, where):
        return [n + self.first[body] for n in self.bodies[body][0].nodes(where)]

    def fixed(self, body, where, component, value=0.0):
        """value: a number, or a function of the node's place."""
        at = value if callable(value) else lambda *_: value
        points = self.bodies[body][0].points
        return "\n".join(f"{n}, {component}, {component}, {number(at(*points[n - self.first[body]]))}" for n in self.numbers(body, where))

    def text(self):
        lines, cell = [], 1
        first_cells = []
        for k, (mesh, material) in enumerate(self.bodies):
            first_cells.append(cell)
            lines += [f"*NODE, NSET=N{k}"]
            lines += [f"{n + self.first[k]}, {number(x)}, {number(y)}, {number(z)}" for n, (x, y, z) in enumerate(mesh.points)]
            lines += [f"*ELEMENT, TYPE={mesh.kind}{self.suffix}, ELSET=E{k}"]
            for nodes in mesh.cells:
                words = [str(cell), *(str(n + self.first[k]) for n in nodes)]
                lines += [", ".join(words[:PER_LINE]) + ("," if words[PER_LINE:] else "")]
                lines += [", ".join(words[PER_LINE:])] if words[PER_LINE:] else []
                cell += 1
            lines += [f"*MATERIAL, NAME=M{k}", material, f"*SOLID SECTION, ELSET=E{k}, MATERIAL=M{k}"]
        for k, pair in enumerate(self.pairs):
            for name, (body, where) in zip("SM", pair):
                lines += [f"*SURFACE, NAME={name}{k}, TYPE=ELEMENT"]
                lines += [f"{c + first_cells[body]}, S{f + 1}" for c, f in self.bodies[body][0].faces(where)]
        lines += ["*SURFACE INTERACTION, NAME=SI", self.interaction] if self.pairs else []
        lines += [f"*CONTACT PAIR, INTERACTION=SI, {self.contact}", *(f"S{k}, M{k}" for k in range(len(self.pairs)))]
        lines += [self.model, *self.steps]
        return "\n".join(line for line in lines if line) + "\n"


def shell_on_block(kind, unit, pressure):
    """A plate of shells, 0.2 thick, that lies on a block and is held by it alone; S4, S8 or S8R."""
    top, block = lambda x, y, z: abs(z - 0.8) < SAME, box((0, 0, 0), (1, 1, 0.8), (5, 5, 4))
    solid = box((0, 0, 0.9), (1, 1, 1), (4, 4, 1))
    solid = solid if kind == "S4" else quadratic(solid)
    cells = solid.cells[:, [0, 1, 2, 3] if kind == "S4" else [0, 1, 2, 3, 8, 9, 10, 11]]
    used = np.unique(cells)
    number_of, first, first_cell = {node: k + 1 for k, node in enumerate(used)}, len(used) + 1, len(cells) + 1
    lines = ["*NODE", *(f"{number_of[n]}, " + ", ".join(map(number, solid.points[n])) for n in used)]
    lines += [f"*ELEMENT, TYPE={kind}, ELSET=PLATE"]
    lines += [", ".join(map(str, [k + 1, *(number_of[n] for n in cell)])) for k, cell in enumerate(cells)]
    lines += ["*NODE", *(f"{n + first}, " + ", ".join(map(number, place)) for n, place in enumerate(block.points))]
    lines += ["*ELEMENT, TYPE=C3D8, ELSET=BLOCK"]
    lines += [", ".join(map(str, [k + first_cell, *(cell + first)])) for k, cell in enumerate(block.cells)]
    lines += ["*MATERIAL, NAME=M", f"*ELASTIC\n{1000 * unit}, 0.", "*SHELL SECTION, ELSET=PLATE, MATERIAL=M\n0.2",
              "*SOLID SECTION, ELSET=BLOCK, MATERIAL=M", "*SURFACE, NAME=S, TYPE=ELEMENT\nPLATE, SNEG", "*SURFACE, NAME=M, TYPE=ELEMENT"]
    lines += [f"{cell + first_cell}, S{face + 1}" for cell, face in block.faces(top)]
    lines += ["*SURFACE INTERACTION, NAME=SI\n*FRICTION\n0.3, 1000.", "*CONTACT PAIR, INTERACTION=SI, TYPE=STICKSLIP\nS, M"]
    lines += ["*STEP", "*STATIC\n1., 1.", CONTROLS, "*BOUNDARY"]
    lines += [f"{n + first}, 1, 3" for n in block.nodes(lambda x, y, z: abs(z) < SAME)]
    return "\n".join([*lines, f"*DLOAD\nPLATE, P, {-pressure}", "*END STEP"]) + "\n"
