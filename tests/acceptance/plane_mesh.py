"""A plane Gmsh file, written here: a rectangle of cells of any kind, which may turn clockwise."""

import itertools

import numpy as np

# Gmsh's numbers of the cell and of its edges
TYPES = {"tri": (2, 1), "quad": (3, 1), "tri6": (9, 8), "quad8": (16, 8), "quad9": (10, 8)}
SIDES = ("xmin", "xmax", "ymin", "ymax")
TRIANGLES = (((0, 0), (1, 0), (1, 1)), ((0, 0), (1, 1), (0, 1)))
SQUARE = (((0, 0), (1, 0), (1, 1), (0, 1)),)


class PlaneMesh:
    def __init__(self, kind, x, y, clockwise, bend=list):
        """`bend` moves each node."""
        self.bend = bend
        self.kind, self.planes, self.numbers, self.points = kind, (x, y), {}, []
        self.cells, self.edges = [], {side: [] for side in SIDES}
        for place in itertools.product(range(len(x) - 1), range(len(y) - 1)):
            for corners in TRIANGLES if kind.startswith("tri") else SQUARE:
                corners = np.array(corners[::-1] if clockwise else corners) + place
                self._add(corners)

    def _number(self, step):
        """`step`: a place counted in planes; halves lie between two."""
        key = tuple(np.round(2 * step).astype(int))
        if key not in self.numbers:
            self.numbers[key] = len(self.points) + 1
            low, high = np.floor(step).astype(int), np.ceil(step).astype(int)
            self.points.append(self.bend([(planes[a] + planes[b]) / 2 for planes, a, b in zip(self.planes, low, high)]))
        return self.numbers[key]

    def _add(self, corners):
        quadratic = self.kind[-1].isdigit()
        ends = list(zip(corners, np.roll(corners, -1, axis=0)))
        nodes = [*corners, *((a + b) / 2 for a, b in ends if quadratic)]
        nodes += [corners.mean(axis=0)] if self.kind == "quad9" else []
        self.cells.append([self._number(node) for node in nodes])
        for a, b in ends:
            for side, axis, level in zip(SIDES, (0, 0, 1, 1), (0, len(self.planes[0]) - 1, 0, len(self.planes[1]) - 1)):
                if a[axis] == b[axis] == level:
                    self.edges[side].append([self._number(node) for node in [a, b] + [(a + b) / 2] * quadratic])

    def write(self, path):
        """Format 2.2"""
        names = [f'1 {tag} "{side}"' for tag, side in enumerate(SIDES, 1)] + ['2 5 "rectangle"']
        cell, edge = TYPES[self.kind]
        elements = [(edge, tag, nodes) for tag, side in enumerate(SIDES, 1) for nodes in self.edges[side]]
        elements += [(cell, 5, nodes) for nodes in self.cells]
        lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names)), *names, "$EndPhysicalNames"]
        lines += ["$Nodes", str(len(self.points))]
        lines += [f"{k} {x:.17g} {y:.17g} 0" for k, (x, y) in enumerate(self.points, 1)] + ["$EndNodes", "$Elements"]
        lines += [str(len(elements))]
        lines += [f"{k} {kind} 2 {tag} {tag} {' '.join(map(str, nodes))}" for k, (kind, tag, nodes) in enumerate(elements, 1)]
        path.write_text("\n".join([*lines, "$EndElements", ""]))
        return path
