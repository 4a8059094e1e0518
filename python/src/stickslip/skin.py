"""The skin of a body: outward facets from cells, as :class:`stickslip.Surface` and :class:`stickslip.Contact` take them.

Cells have their corners in VTK's order. Mid nodes may follow in any order: they are found by where they lie.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import InvalidSize, InvalidValue, WrongType

Integers = NDArray[np.int64]
Reals = NDArray[np.float64]
#: (m, k) node numbers, or a list of such rows where facets are of several kinds.
Facets = Integers | list[Integers]


@dataclass(frozen=True)
class _Shape:
    """The faces of a cell by its corners, and other orders that programs have its corners in."""

    corners: int
    faces: tuple[tuple[int, ...], ...]
    # Of a corner in VTK's order: its place in the tensor order of FEniCSx, and in scikit-fem's.
    orders: tuple[tuple[int, ...], ...] = ()


_TETRAHEDRON = _Shape(4, ((0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3)))
_HEXAHEDRON = _Shape(8, ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)),
                     ((0, 1, 3, 2, 4, 5, 7, 6), (0, 3, 6, 2, 1, 5, 7, 4)))
_WEDGE = _Shape(6, ((0, 1, 2), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)))
_PYRAMID = _Shape(5, ((0, 1, 2, 3), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)), ((0, 1, 3, 2, 4),))
_TRIANGLE = _Shape(3, ((0, 1), (1, 2), (2, 0)))
_QUADRILATERAL = _Shape(4, ((0, 1), (1, 2), (2, 3), (3, 0)), ((0, 1, 3, 2),))

# By the number of a cell's nodes, in space and in the plane.
_SHAPES = {
    3: {4: _TETRAHEDRON, 10: _TETRAHEDRON, 8: _HEXAHEDRON, 20: _HEXAHEDRON, 27: _HEXAHEDRON, 6: _WEDGE, 15: _WEDGE,
        18: _WEDGE, 5: _PYRAMID, 13: _PYRAMID, 14: _PYRAMID},
    2: {3: _TRIANGLE, 6: _TRIANGLE, 4: _QUADRILATERAL, 8: _QUADRILATERAL, 9: _QUADRILATERAL},
}
# How names of kinds begin (meshio's, and others like tet10 and hex8), and VTK's numbers of them.
_NAMES = {3: ("tet", "hex", "wedge", "pyr"), 2: ("tri", "quad")}
_VTK = {3: (10, 12, 13, 14, 24, 25, 26, 27, 29, 32, 71, 72, 73), 2: (5, 9, 22, 23, 28, 69, 70)}
# A mid node is farther from the middle of its edge than this part of the edge only if cells are not what they seem: an arc that
# bows so much spans 150 degrees.
_BOW = 0.4
# All cells of a block have their mid nodes in the same order: so many tell which.
_SAMPLE = 1000


def skin(cells: Any, X: ArrayLike | None = None, select: Callable[[Reals], ArrayLike] | ArrayLike | None = None) -> Facets:
    """The facets of a body that no two of its cells share, seen from outside: corners, then mid nodes, then the centre.

    Parameters
    ----------
    cells : of one body: (m, k) node numbers, a list of such blocks, a dict of them by meshio's name or VTK's number of a kind, or a
        mesh: of meshio, pyvista, FElupe or scikit-fem. In space tetrahedra, hexahedra, wedges and pyramids, in the plane triangles
        and quadrilaterals, with mid nodes or without. Of a dict other kinds are left out.
    X : (n, 3), or (n, 2) in the plane: where the nodes are; not needed with a mesh
    select : which facets: those whose corners are all among the chosen nodes. A function of coordinates, ``lambda x: x[2] < 1e-9``
        (x[0], x[1], x[2] are arrays), or node numbers. None: the whole skin.

    Returns
    -------
    (m, k) node numbers, or a list of rows where facets are of several kinds. In the plane lines, with the body to their left.
    """
    blocks, points = _blocks_of(cells, X)
    inside = [_Block(block, points) for block in blocks]
    corners = np.concatenate([face for block in inside for face in block.keys()])
    _, which, count = np.unique(corners, axis=0, return_inverse=True, return_counts=True)
    single = (count == 1)[which.ravel()]
    chosen = _chosen(select, points)
    rows: list[Integers] = []
    start = 0
    for block in inside:
        for nodes, n_corners in block.facets():
            outer = single[start : start + len(nodes)] & chosen[nodes[:, :n_corners]].all(axis=1)
            start += len(nodes)
            rows.append(nodes[outer])
    rows = [part for part in rows if len(part)]
    if not rows:
        raise InvalidValue("select: no facet of the skin has all its corners among the chosen nodes")
    if len({part.shape[1] for part in rows}) == 1:
        return np.concatenate(rows)
    return [row for part in rows for row in part]


def _blocks_of(cells: Any, X: ArrayLike | None) -> tuple[list[Integers], Reals]:
    """Blocks of cells that have an inside, and the points of the nodes in as many dimensions as these."""
    cells, X = _of_mesh(cells, X)
    if X is None:
        raise InvalidValue("X: where the nodes are is needed, as (n, 3) or (n, 2)")
    points = np.asarray(X, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] not in (2, 3):
        raise InvalidSize(f"X: shape {points.shape}, (n, 3) or (n, 2) is needed")
    if isinstance(cells, Mapping):
        solid = [block for name, block in cells.items() if _is(name, 3)] if points.shape[1] == 3 else []
        found = solid or [block for name, block in cells.items() if _is(name, 2)]
        if not found:
            raise InvalidValue(f"cells: none has an inside; there are {', '.join(map(str, cells))}")
        if not solid:
            points = points[:, :2]
    else:
        found = list(cells) if isinstance(cells, (list, tuple)) and np.ndim(cells[0]) == 2 else [cells]
    blocks = []
    for block in map(np.asarray, found):
        known = _SHAPES[points.shape[1]]
        if block.ndim != 2 or block.dtype.kind not in "iu":
            raise WrongType(f"cells: {block.ndim}-D {block.dtype}, (m, k) integers are needed")
        if block.shape[1] not in known:
            raise InvalidSize(f"cells: {block.shape[1]} nodes a cell, in {points.shape[1]} dimensions {sorted(known)} are possible")
        if block.size and not 0 <= block.min() <= block.max() < len(points):
            raise InvalidValue(f"cells: node {block.max() if block.min() >= 0 else block.min()}, X has 0 to {len(points) - 1}")
        blocks.append(block.astype(np.int64))
    return blocks, points


def _of_mesh(cells: Any, X: Any) -> tuple[Any, Any]:
    """Cells and points of a mesh that another library has made; what is no mesh is left as it is."""
    if hasattr(cells, "cells_dict") and hasattr(cells, "points"):  # meshio, pyvista
        return cells.cells_dict, cells.points if X is None else X
    if hasattr(cells, "t") and hasattr(cells, "p"):  # scikit-fem: the arrays are the other way round
        return cells.t.T, cells.p.T if X is None else X
    if hasattr(cells, "cells") and hasattr(cells, "points"):  # FElupe
        return cells.cells, cells.points if X is None else X
    return cells, X


def _is(name: Any, dimension: int) -> bool:
    if isinstance(name, str):
        return name.lower().startswith(_NAMES[dimension])
    return int(name) in _VTK[dimension]


def _chosen(select: Any, points: Reals) -> NDArray[np.bool_]:
    """Which nodes are chosen."""
    if select is None:
        return np.ones(len(points), dtype=bool)
    if callable(select):
        chosen = np.asarray(select(points.T))
        if chosen.shape != (len(points),) or chosen.dtype != bool:
            raise WrongType(f"select: gives {chosen.dtype} of shape {chosen.shape}, a boolean for each of {len(points)} nodes is needed")
        return chosen
    numbers = np.asarray(select)
    if numbers.dtype.kind not in "iu":
        raise WrongType(f"select: {numbers.dtype}, a function of coordinates or node numbers are needed")
    chosen = np.zeros(len(points), dtype=bool)
    chosen[numbers] = True
    return chosen


class _Block:
    """Cells of one kind, corners in VTK's order."""

    def __init__(self, cells: Integers, points: Reals):
        self.shape = _SHAPES[points.shape[1]][cells.shape[1]]
        self.points = points
        self.cells = self._ordered(cells)
        self.mids = self._mids()

    def _ordered(self, cells: Integers) -> Integers:
        """The corners in VTK's order, from that or one of the orders that have a name."""
        n = self.shape.corners
        for order in (tuple(range(n)), *self.shape.orders):
            ordered: Integers = np.concatenate([cells[:, order], cells[:, n:]], axis=1)
            if self._goes_round(ordered):
                return ordered
        raise InvalidValue(f"cells: the corners of cells with {cells.shape[1]} nodes are not in VTK's order")

    def _goes_round(self, cells: Integers) -> bool:
        """Whether no quadrilateral of most cells crosses itself."""
        n = self.points.shape[1]
        rings = [face for face in self.shape.faces if len(face) == 4] if n == 3 else [tuple(range(self.shape.corners))]
        for ring in rings:
            x = self.points[cells[:, ring]]
            ahead, behind = np.roll(x, -1, axis=1) - x, np.roll(x, 1, axis=1) - x
            turns = _cross(ahead, behind)
            if np.mean((turns * np.roll(turns, 1, axis=1)).sum(axis=2).min(axis=1) > 0) < 0.5:
                return False
        return True

    def _mids(self) -> dict[tuple[int, ...], int]:
        """Where in a cell's row the mid nodes stand, by the corners that each is between.

        They are matched with the middles of edges, then faces, then the cell, so that the squares of the distances add up to the least
        over all cells: of thin cells that bow much the nearest one could be that of the opposite edge.
        """
        from scipy.optimize import linear_sum_assignment

        n, count = self.shape.corners, self.cells.shape[1]
        around = [tuple(sorted(pair)) for face in self.shape.faces for pair in zip(face, np.roll(face, -1).tolist())]
        quadrilaterals = [tuple(sorted(face)) for face in self.shape.faces if len(face) == 4]
        places = [*dict.fromkeys(around), *quadrilaterals, tuple(range(n))][: count - n]
        if not places or not len(self.cells):
            return {}
        x = self.points[self.cells[:_SAMPLE]]
        middles = np.stack([x[:, place].mean(axis=1) for place in places], axis=1)
        distance = np.linalg.norm(middles[:, :, None] - x[:, None, n:], axis=3)
        size = np.linalg.norm(x[:, 0] - x[:, 1], axis=1)[:, None, None]
        _, columns = linear_sum_assignment(((distance / size) ** 2).mean(axis=0))
        found = {place: n + int(column) for place, column in zip(places, columns)}
        for (a, b), mid in ((place, mid) for place, mid in found.items() if len(place) == 2):
            start, end, middle = (self.points[self.cells[:, k]] for k in (a, b, mid))
            bow = np.linalg.norm(middle - 0.5 * (start + end), axis=1) / np.linalg.norm(end - start, axis=1)
            if not (bow <= _BOW).all():
                row = self.cells[int(np.argmax(bow))]
                raise InvalidValue(f"cells: no node of cell {row.tolist()} is near the middle of its nodes {row[a]} and {row[b]}")
        return found

    def keys(self) -> list[Integers]:
        """Of each face the corners in ascending order, by which cells share it."""
        out = []
        for face in self.shape.faces:
            key = np.full((len(self.cells), 4), -1)
            key[:, : len(face)] = np.sort(self.cells[:, face], axis=1)
            out.append(key)
        return out

    def facets(self) -> list[tuple[Integers, int]]:
        """Of each face the nodes seen from outside, and how many of them are corners."""
        middle = self.points[self.cells[:, : self.shape.corners]].mean(axis=1)
        out = []
        for face in self.shape.faces:
            nodes, turned = self._nodes(face), self._nodes(face[::-1])
            x = self.points[self.cells[:, face]]
            outward = ((x.mean(axis=1) - middle) * _normal(x)).sum(axis=1) > 0
            out.append((np.where(outward[:, None], nodes, turned), len(face)))
        return out

    def _nodes(self, face: Sequence[int]) -> Integers:
        pairs = [tuple(sorted(pair)) for pair in zip(face, (*face[1:], face[0]))][: len(face) if len(face) > 2 else 1]
        places = [*pairs, tuple(sorted(face))] if len(face) == 4 else pairs
        return self.cells[:, [*face, *(self.mids[place] for place in places if place in self.mids)]]


def _normal(x: Reals) -> Reals:
    """The normal that the corners of each face go round, or to the right of each line."""
    if x.shape[2] == 2:
        along = x[:, 1] - x[:, 0]
        return np.stack([along[:, 1], -along[:, 0]], axis=1)
    return _cross(x[:, 0] - x[:, 2], x[:, 1] - x[:, -1])  # of a triangle the last one is the third


def _cross(a: Reals, b: Reals) -> Reals:
    """The cross product of vectors in space, or in the plane its one component."""
    if a.shape[-1] == 2:
        return a[..., :1] * b[..., 1:] - a[..., 1:] * b[..., :1]
    out: Reals = np.cross(a, b)
    return out
