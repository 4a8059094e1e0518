"""A Gmsh file of second order, written here: one block of cells with curved edges, in Gmsh's own order of nodes."""

import itertools

import numpy as np

# Where the nodes of Gmsh's elements lie: the corners between which each one is, in the order of Gmsh's manual.
TET_EDGES = [(0, 1), (1, 2), (0, 2), (0, 3), (2, 3), (1, 3)]
HEX_EDGES = [(0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3), (2, 6), (3, 7), (4, 5), (4, 7), (5, 6), (6, 7)]
HEX_FACES = [(0, 1, 2, 3), (0, 1, 5, 4), (0, 3, 7, 4), (1, 2, 6, 5), (2, 3, 7, 6), (4, 5, 6, 7)]
TET_FACES = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (3, 1, 2)]
# Gmsh's numbers of the elements: of the cell, of its face
TYPES = {"tet10": (11, 9), "hex20": (17, 16), "hex27": (12, 10)}
# In a cube of size 1: nodes of up to 100 cells a side are further apart.
SAME_PLACE = 1e-3
STEPS = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)])


def corners_of_nodes(kind):
    cell = [(c,) for c in range(4 if kind == "tet10" else 8)]
    cell += TET_EDGES if kind == "tet10" else HEX_EDGES
    return cell + HEX_FACES + [tuple(range(8))] if kind == "hex27" else cell


def cells_of(kind, counts):
    """Corners of the cells of a unit cube, as points of a lattice with so many cells along each axis."""
    for place in itertools.product(*map(range, counts)):
        if kind != "tet10":
            yield STEPS + place
            continue
        for order in itertools.permutations(range(3)):
            path = np.zeros((4, 3), int)
            for k, axis in enumerate(order):
                path[k + 1 :, axis] = 1
            if np.linalg.det(path[1:] - path[0]) < 0:
                path[[1, 2]] = path[[2, 1]]
            yield path + place


class SecondOrder:
    """Nodes, cells and the faces in the plane `side` (axis, 0 or 1) of a unit cube with n cells a side, or with so many
    along each axis; `bend` moves points."""

    def __init__(self, kind, n, bend):
        counts = np.broadcast_to(n, 3)
        self.kind, self.numbers, self.points = kind, {}, []
        nodes = corners_of_nodes(kind)
        self.cells, self.faces = [], {}
        for corners in cells_of(kind, counts):
            positions = [np.mean([corners[c] for c in its], axis=0) / counts for its in nodes]
            self.cells.append([self._number(p, bend) for p in positions])
            self._add_faces(nodes, positions)

    def _number(self, position, bend):
        key = tuple(np.round(position / SAME_PLACE).astype(int))
        if key not in self.numbers:
            self.numbers[key] = len(self.points) + 1
            self.points.append(bend(position))
        return self.numbers[key]

    def _add_faces(self, nodes, positions):
        cell = self.cells[-1]
        for face in TET_FACES if self.kind == "tet10" else HEX_FACES:
            size = len(face)
            its = [(c,) for c in face] + [(face[k], face[(k + 1) % size]) for k in range(size)]
            its += [face] if self.kind == "hex27" else []
            chosen = [next(a for a, n in enumerate(nodes) if set(n) == set(i)) for i in its]
            for axis, value in itertools.product(range(3), (0, 1)):
                if all(positions[a][axis] == value for a in chosen):
                    self.faces.setdefault((axis, value), []).append([cell[a] for a in chosen])

    def _elements(self):
        """(dimension, tag of entity and group, Gmsh's type, nodes) of each block"""
        cell, face = TYPES[self.kind]
        yield from ((2, 1 + 2 * a + v, face, faces) for (a, v), faces in sorted(self.faces.items()))
        yield 3, 1, cell, self.cells

    def _names(self):
        names = [f'2 {1 + 2 * a + v} "{"xyz"[a]}{"min" if v == 0 else "max"}"' for a, v in sorted(self.faces)]
        return "\n".join(["$PhysicalNames", str(len(names) + 1), *names, '3 1 "cube"', "$EndPhysicalNames"])

    def write_41(self, path):
        count = sum(len(block) for *_, block in self._elements())
        box = "0 0 0 1 1 1"
        entities = [f"{tag} {box} 1 {-tag} 0" for _, tag, _, _ in list(self._elements())[:-1]]
        lines = ["$MeshFormat", "4.1 0 8", "$EndMeshFormat", self._names()]
        lines += ["$Entities", f"0 0 {len(entities)} 1", *entities, f"1 {box} 1 1 0", "$EndEntities"]
        n = len(self.points)
        lines += ["$Nodes", f"1 {n} 1 {n}", f"3 1 0 {n}", *map(str, range(1, n + 1))]
        lines += [" ".join(f"{c:.17g}" for c in p) for p in self.points] + ["$EndNodes", "$Elements"]
        lines += [f"{len(self.faces) + 1} {count} 1 {count}"]
        tag = itertools.count(1)
        for dimension, entity, kind, block in self._elements():
            lines += [f"{dimension} {entity} {kind} {len(block)}"]
            lines += [f"{next(tag)} {' '.join(map(str, nodes))}" for nodes in block]
        path.write_text("\n".join([*lines, "$EndElements", ""]))
        return path

    def write_22(self, path):
        count = sum(len(block) for *_, block in self._elements())
        lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", self._names(), "$Nodes", str(len(self.points))]
        lines += [f"{k} {' '.join(f'{c:.17g}' for c in p)}" for k, p in enumerate(self.points, 1)]
        lines += ["$EndNodes", "$Elements", str(count)]
        tag = itertools.count(1)
        for _, entity, kind, block in self._elements():
            lines += [f"{next(tag)} {kind} 2 {entity} {entity} {' '.join(map(str, nodes))}" for nodes in block]
        path.write_text("\n".join([*lines, "$EndElements", ""]))
        return path
