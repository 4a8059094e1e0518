"""One interface of a :class:`stickslip.Contact`: its nodes, its numbers among the unknowns, its plan."""

from __future__ import annotations

from graphlib import CycleError, TopologicalSorter
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _chords
from ._touching import force, pressing
from .condensed import Condensed
from .errors import InvalidSize, InvalidValue
from .interface import Interface
from .meshes import split_creases
from .plan import CondensedPlan, Plan
from .results import Gradient, State, States
from .skin import Facets, Integers, Reals
from .surface import Surface

if TYPE_CHECKING:
    import scipy.sparse

# Corners of a facet by the number of its nodes, in the plane and in space.
_CORNERS = {2: {2: 2, 3: 2}, 3: {3: 3, 4: 4, 6: 3, 8: 4, 9: 4}}

_MESHIO = {(2, 2): "line", (2, 3): "line3", (3, 3): "triangle", (3, 4): "quad", (3, 6): "triangle6", (3, 8): "quad8", (3, 9): "quad9"}


def checked_rows(name: str, facets: Facets, dimension: int) -> list[Integers]:
    rows = [np.asarray(row) for row in facets]
    if not rows or any(row.ndim != 1 or row.dtype.kind not in "iu" for row in rows):
        raise InvalidSize(f"{name}: rows of node numbers are needed, one or more, as stickslip.skin gives them")
    for row in rows:
        if len(row) not in _CORNERS[dimension]:
            raise InvalidSize(f"{name}: a facet of {len(row)} nodes; in this model {sorted(_CORNERS[dimension])} are possible")
    return rows


def add_forces(vector: Reals, equations: Integers, force: Reals) -> None:
    """Adds forces to the rows of their equations."""
    np.add.at(vector, equations[equations >= 0], force[equations >= 0])


def in_space(vectors: Reals) -> Reals:
    """Vectors of three components."""
    return np.pad(vectors, ((0, 0), (0, 3 - vectors.shape[1])))


def mesh_of(x: Reals, facets: list[Integers], states: States, of_facets: dict[str, Any]) -> Any:
    """A surface in space with what is known of its nodes and facets, of meshio's."""
    import meshio

    dimension = 2 if states.normal.shape[1] == 2 else 3
    cells = [(_MESHIO[dimension, len(row)], row[None]) for row in facets]
    flat = {name: np.asarray(getattr(states, name)) for name in ("state", "pressure", "coverage", "share")}
    vectors = {name: in_space(getattr(states, name)) for name in ("normal", "traction", "slip")}
    blocks = {name: [values[k : k + 1] for k in range(len(cells))] for name, values in of_facets.items()}
    return meshio.Mesh(x, cells, point_data={**flat, **vectors}, cell_data=blocks)


class Pair:
    """Two surfaces of the nodes X, whose displacements are the equations ``numbers``; multipliers are numbered from ``first`` on."""

    def __init__(self, X: Reals, numbers: Integers, first: int, sides: tuple[Facets, Facets | Surface], *, held: Integers,
                 crease: float | None, condensed: bool, options: dict[str, Any]):
        dimension = X.shape[1]
        rows = checked_rows("facets1", sides[0], dimension)
        self.nodes1 = np.unique(np.concatenate(rows))
        local = [np.searchsorted(self.nodes1, row) for row in rows]
        if crease is not None:
            local, originals = split_creases(X[self.nodes1], local, crease)
            self.nodes1 = self.nodes1[originals]
        self.facets1 = local
        self.X1, self.equations1 = X[self.nodes1], numbers[self.nodes1]
        if isinstance(sides[1], Surface):
            self.mortar, self.nodes2 = sides[1], None
            if (self.mortar.equations >= 0).any():
                raise InvalidValue("facets2: a Surface with unknowns; give the node numbers of its facets in its place")
            self.equations2 = self.mortar.equations
        else:
            rows = checked_rows("facets2", sides[1], dimension)
            self.nodes2 = np.unique(np.concatenate(rows))
            self.equations2 = numbers[self.nodes2]
            self.mortar = Surface(X[self.nodes2], [np.searchsorted(self.nodes2, row) for row in rows], self.equations2)
        # What is prescribed on both sides has no multiplier.
        self.held = np.isin(self.equations1, held) | (self.equations1 < 0) & (self.equations2 < 0).all(axis=0)
        self.mask = self._mask(local, options)
        self.count = int(self.mask.sum())
        multipliers = np.full(self.mask.shape, -1, np.int64)
        multipliers[self.mask] = first + np.arange(self.count)
        if dimension == 2:
            options = {"model": "plane", **options}
        self.face = Interface(Surface(self.X1, local, self.equations1, multipliers), self.mortar, **options)
        if self.mask.ndim == 1 and self.held.any():  # the one multiplier of a node stays, its normal keeps to what is free
            nodes, axes = np.nonzero(self.held)
            self.face.set_constraints(nodes, np.eye(dimension)[axes])
        self._turns = True
        self.use_normals("current")
        self.tied = options.get("friction") == "tied"
        self.modulus = float(options.get("modulus", 0.0))
        #: The largest traction of the steps before.
        self.largest = 0.0
        self._plan: Plan | CondensedPlan | None = None
        if condensed:
            self.system = Condensed(self.face)
            self.lam = np.zeros(self.mask.shape)
            self.scaled = False

    def _mask(self, facets: list[Integers], options: dict[str, Any]) -> NDArray[np.bool_]:
        """Which multipliers there are, (n1, d) or (n1,): of corners, unless mid nodes have their own, and of what is not held."""
        bearing = np.zeros(len(self.nodes1), dtype=bool)
        every, corners = options.get("multiplier_space") == "sub", _CORNERS[self.X1.shape[1]]
        for row in facets:
            bearing[row if every else row[: corners[len(row)]]] = True
        return bearing if options.get("friction") == "none" else bearing[:, None] & ~self.held

    def positions(self, u: Reals) -> tuple[Reals, Reals]:
        """Of both sides, with the displacements of all nodes."""
        x1 = self.X1 + u[self.nodes1]
        return x1, self.mortar.coordinates + (0.0 if self.nodes2 is None else u[self.nodes2])

    def bearing(self) -> Integers:
        """The equations of nodes that have multipliers."""
        numbers: Integers = np.unique(self.equations1[self.mask.reshape(len(self.mask), -1).any(axis=1)])
        return numbers[numbers >= 0]

    def drawn(self, u: Reals) -> tuple[Reals, list[Integers]]:
        """Where the nodes of the first side are, and its facets."""
        return self.positions(u)[0], self.facets1

    def mesh(self, u: Reals, states: States) -> Any:
        """The first side of meshio's."""
        return mesh_of(in_space(self.positions(u)[0]), self.facets1, states, {})

    def multipliers(self, values: Reals) -> Reals:
        """The array of the library from the values of those that there are."""
        lam = np.zeros(self.mask.shape)
        lam[self.mask] = values
        return lam

    def add_forces(self, vector: Reals, force1: Reals, force2: Reals) -> None:
        """Adds forces to the rows of the equations; creases have nodes twice."""
        add_forces(vector, self.equations1, force1)
        add_forces(vector, self.equations2, force2)

    def gather(self, vector: Reals) -> tuple[Reals, Reals]:
        """What a vector has at the nodes of both sides; 0 where there is no equation."""
        side1, side2 = (np.where(at < 0, 0.0, vector[at]) for at in (self.equations1, self.equations2))
        return side1, side2

    def tangent(self, point: tuple[Reals, ...], size: int) -> scipy.sparse.csr_matrix:
        """The share of the matrix, by a plan that is made when it is first asked for."""
        x1, x2, lam = point
        if self._plan is None:
            self._plan = Plan(self.face, x1, x2, size, pairs="skin")
        return self._plan.values(x1, x2, lam)

    def use_normals(self, normals: str) -> bool:
        """Whether its normals follow the surface within a step; then those of the step that follows are chosen."""
        if self._turns:
            try:
                self.face.use_normals(normals)
            except InvalidValue:
                self._turns = False
        return self._turns

    def commit_check(self, point: tuple[Reals, ...]) -> None:
        """Raises what the commit would raise."""
        self.face.commit_check(*point)

    def commit(self, point: tuple[Reals, ...]) -> Reals:
        """Accepts a step; its multipliers stay as they are."""
        self.face.commit(*point)
        return point[-1]

    def exchange(self, lam: Reals) -> bool:
        """Its sides are named."""
        return False

    def touching(self, states: States) -> list[tuple[Integers, Integers, bool]]:
        """The equations of both sides, and whether a node is in contact."""
        return [(self.equations1, self.equations2, states.count(State.GAP) < states.bearing.sum())]

    def report(self, point: tuple[Reals, ...], is_first: bool) -> str:
        """What is covered, in sentences; at the start what chords take, later what presses, and the forces on both sides."""
        lines, states = [self.face.report(*point[:2]).text], self.face.states(*point)
        if is_first:
            if not (self.tied or self.face.has_offsets):
                lines += _chords.told(states, (self.X1, self.facets1), (self.mortar.coordinates, self.mortar.rows()))
            return "\n".join(lines)
        nodes = pressing(states, np.flatnonzero(states.bearing))
        lines.append(nodes[0].upper() + nodes[1:])
        forces = self.face.residual(*point)[:2]
        lines += [force(f"the {name} side", -side.sum(axis=0)) for name, side in zip(("first", "second"), forces)]
        return "\n".join(lines)

    #: What an interface has as pairs does not change.
    missed = 0

    def adjoint(self, point: tuple[Reals, ...], inner: Reals, multipliers: Reals, wanted: tuple[str, ...]) -> Gradient:
        """Products of a vector with derivatives of the residual."""
        x1, x2, lam = point
        return self.face.adjoint(x1, x2, lam, *self.gather(inner), self.multipliers(multipliers), wanted)

    def set_committed(self, u: Reals, commits: int) -> None:
        """What displacements ended becomes the step before."""
        self.face.set_committed(*self.positions(u), commits=commits)

    def pieces(self, point: tuple[Reals, ...], size: int) -> tuple[Any, Any, Any]:
        """Forces, elimination and constraints of the condensed matrix."""
        x1, x2, lam = point
        if self._plan is None:
            self._plan = CondensedPlan(self.face, x1, x2, size, pairs="skin")
        forces, constraints = self._plan.values(x1, x2, lam)
        elimination = self.system.piece(x1, x2, lam, size, "elimination")
        if self.scaled:
            constraints = constraints + self.system.piece(x1, x2, lam, size, "scales")
        return forces, elimination, constraints


def elimination_order(pairs: list[Pair]) -> list[int]:
    """In which order interfaces are condensed: one whose forces act on a node comes before the one that eliminates its multiplier."""
    owned = [pair.bearing() for pair in pairs]
    touched = [np.setdiff1d(np.concatenate([pair.equations1.ravel(), pair.equations2.ravel()]), own) for pair, own in zip(pairs, owned)]
    for j, later in enumerate(pairs):
        for i in range(j):
            shared = np.intersect1d(owned[i], owned[j])
            if len(shared):
                nodes = np.unique(later.nodes1[np.isin(later.equations1, shared).any(axis=1)])
                raise InvalidValue(f"start: nodes {nodes.tolist()} have multipliers in the interfaces {i} and {j}; condensed, each would take the"
                                   " constraint of the other one for a force: let the other body's facets have them in one of the two, or give"
                                   " up condensed")
    before = {j: {i for i in range(len(pairs)) if i != j and len(np.intersect1d(touched[i], owned[j]))} for j in range(len(pairs))}
    try:
        return list(TopologicalSorter(before).static_order())
    except CycleError as error:
        names = sorted(set(error.args[1]))
        raise InvalidValue(f"start: the interfaces {names} act on each other's nodes with multipliers all round, so that none of them can"
                           " be condensed first: swap the sides of one, or give up condensed") from error
