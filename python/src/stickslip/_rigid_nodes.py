"""Rigid bodies among the nodes of a :class:`stickslip.Contact`: nodes that move with six unknowns of the host, in the plane three."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from ._arrays import given
from .errors import InvalidValue
from .rigid import RigidBody, RigidPlan
from .skin import Integers, Reals

if TYPE_CHECKING:
    import scipy.sparse


class RigidNodes:
    """All rigid bodies of a host, whose nodes have numbers behind the host's unknowns that no vector has."""

    def __init__(self) -> None:
        self.bodies: list[RigidBody] = []
        self.nodes: list[Integers] = []
        self._plan: RigidPlan | None = None

    def add(self, X: Reals, numbers: Integers, nodes: ArrayLike, point: ArrayLike, unknowns: ArrayLike, sizes: tuple[int, int]) -> RigidBody:
        """A body of some nodes, whose numbers become those from the second size on; the first one is the host's."""
        n_host, n_inner = sizes
        where = np.unique(np.asarray(nodes, dtype=np.int64).ravel())
        equations = given("unknowns", unknowns, (6 if X.shape[1] == 3 else 3,), np.int64)
        if len(where) == 0 or where[0] < 0 or where[-1] >= len(X):
            raise InvalidValue(f"nodes: numbers from 0 to {len(X) - 1} are needed, one or more")
        if (numbers[where] >= 0).any():
            raise InvalidValue("nodes: dofs is not -1 for all of them, or another body has them")
        if len(np.unique(equations)) < len(equations) or equations.min() < 0 or equations.max() >= n_host:
            raise InvalidValue(f"unknowns: {len(equations)} numbers from 0 to {n_host - 1} are needed, each once")
        numbers[where] = n_inner + np.arange(len(where) * X.shape[1]).reshape(len(where), -1)
        self.bodies.append(RigidBody(X[where], numbers[where], point, equations))
        self.nodes.append(where)
        return self.bodies[-1]

    def place(self, x: Reals, X: Reals, u: Reals) -> None:
        """Moves the bodies to where the host's unknowns have them: displacements of their nodes in u."""
        for body, nodes in zip(self.bodies, self.nodes):
            body.unknowns = x[body.equations]
            u[nodes] = body.positions() - X[nodes]

    def resultants(self, inner: Reals, r: Reals) -> None:
        """Adds force and moment of the forces on the nodes to the rows of each body's unknowns."""
        for body in self.bodies:
            r[body.equations] += body.resultant(inner[body.node_equations])

    def reduced(self, nodal: scipy.sparse.csr_matrix, inner: Reals, n_host: int, n_inner: int) -> Any:
        """The matrix of the host's unknowns and the multipliers, out of that with rows and columns of nodes."""
        if self._plan is None:
            self._plan = RigidPlan(self.bodies, nodal.shape[0])
        matrix = self._plan.values(nodal, [inner[body.node_equations] for body in self.bodies])
        kept = np.r_[0:n_host, n_inner : nodal.shape[0]]
        return matrix[kept][:, kept]

    def owners(self, numbers: Integers, n_host: int) -> Integers:
        """Numbers of unknowns, in which those of a body's nodes have become its first one."""
        out = numbers.copy()
        for body in self.bodies:
            out[np.isin(numbers, body.node_equations) & (numbers >= n_host)] = body.equations[0]
        return out

    def links(self, n_host: int) -> scipy.sparse.csr_matrix:
        """What belongs together: entries between each body's first unknown and its others."""
        import scipy.sparse

        rows = np.concatenate([np.full(len(body.equations), body.equations[0]) for body in self.bodies] or [np.zeros(0, np.int64)])
        columns = np.concatenate([body.equations for body in self.bodies] or [np.zeros(0, np.int64)])
        return scipy.sparse.csr_matrix((np.ones(len(rows)), (rows, columns)), shape=(n_host, n_host))

    def stiffness(self, n_host: int, length: float) -> Reals:
        """Of each unknown, what a unit of stiffness at a node is for it: 1, of rotations the square of a length, of others 0."""
        out = np.zeros(n_host)
        for body in self.bodies:
            out[body.equations[: body.dimension]] = 1.0
            out[body.equations[body.dimension :]] = length**2
        return out
