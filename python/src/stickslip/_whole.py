"""General contact of a :class:`stickslip.Contact`: the whole skin in place of an interface, with the same verbs as :class:`Pair`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ._pair import add_forces, checked_rows, in_space, mesh_of
from .errors import InvalidValue, Unsupported
from .general import Skin
from .plan import SkinPlan
from .results import Gradient, State, States
from .skin import Facets, Integers, Reals
from .surface import Surface

if TYPE_CHECKING:
    import scipy.sparse


class Whole:
    """The skin of the nodes X, whose displacements are the equations ``numbers``; multipliers are numbered from ``first`` on."""

    def __init__(self, X: Reals, numbers: Integers, first: int, facets: Facets, *, bodies: Any, held: Integers, options: dict[str, Any]):
        rows = checked_rows("facets1", facets, X.shape[1])
        self.nodes = np.unique(np.concatenate(rows))
        self.X, self.equations = X[self.nodes], numbers[self.nodes]
        if X.shape[1] == 2:
            options = {"model": "plane", **options}
        surface = Surface(self.X, [np.searchsorted(self.nodes, row) for row in rows], self.equations)
        self.face = Skin(surface, bodies, first_multiplier=first, **options)
        self.count, self.mask = self.face.n_multipliers, self.face.equations >= 0
        nodes, axes = np.nonzero(np.isin(self.equations, held))
        if len(nodes):
            self.face.set_constraints(nodes, np.eye(X.shape[1])[axes])
        self.modulus = float(options.get("modulus", 0.0))
        #: The largest traction of the steps before.
        self.largest = 0.0
        self._plan: SkinPlan | None = None

    def positions(self, u: Reals) -> tuple[Reals]:
        """Of the skin, with the displacements of all nodes."""
        return (self.X + u[self.nodes],)

    def multipliers(self, values: Reals) -> Reals:
        """The array of the library from the values of those that there are."""
        lam = np.zeros(self.mask.shape)
        lam[self.mask] = values
        return lam

    def add_forces(self, vector: Reals, *forces: Reals) -> None:
        """Adds forces to the rows of the equations."""
        for force in forces:
            add_forces(vector, self.equations, force)

    def tangent(self, point: tuple[Reals, ...], size: int) -> scipy.sparse.csr_matrix:
        """The share of the matrix, by a plan that is made when it is first asked for."""
        if self._plan is None:
            self._plan = SkinPlan(self.face, point[0], size, pairs="skin")
        return self._plan.values(*point)

    def commit_check(self, point: tuple[Reals, ...]) -> None:
        """Nothing: the only skin is committed first, so that it may refuse then."""

    def commit(self, point: tuple[Reals, ...]) -> Reals:
        """Accepts a step, and gives the multipliers that the next one starts with."""
        x, lam = point
        lam = lam.copy()
        self.face.commit(x, lam)
        return lam

    def exchange(self, lam: Reals) -> bool:
        """The other sides; whether there are any."""
        self.face.exchange(lam)
        return self.face.report().pieces > 0

    def use_normals(self, normals: str) -> bool:
        """Whether normals follow the surface; then those of the step that follows are chosen."""
        try:
            self.face.use_normals(normals)
        except InvalidValue:
            return False
        return True

    def touching(self, states: States) -> list[tuple[Integers, Integers, bool]]:
        """The equations of each body; and of two bodies that may touch, with whether a node of theirs is in contact."""
        facets, copies = self.face.facets(), self.face.facet_copies
        equations = [self.equations[nodes].ravel() for nodes in self.face.facet_nodes]
        ground = np.array([-1])
        out = [(equations[f], ground, False) for f in np.unique(facets.body, return_index=True)[1]]
        for f in np.flatnonzero((facets.piece >= 0) & (facets.partner >= 0)):
            touches = bool((states.state[copies[f]] != State.GAP).any())
            out.append((equations[f], equations[facets.partner[f]], touches))
        return out

    def drawn(self, u: Reals) -> tuple[Reals, list[Integers]]:
        """Where the copies are, and the facets."""
        return self.positions(u)[0][self.face.originals], self.face.facet_copies

    def mesh(self, u: Reals, states: States) -> Any:
        """The skin as a mesh of meshio, with nodes a face at creases."""
        facets = self.face.facets()
        data = {"side": facets.side, "piece": facets.piece, "body": facets.body, "distance": facets.distance}
        x, rows = self.drawn(u)
        return mesh_of(in_space(x), rows, states, data)

    def report(self, point: tuple[Reals, ...], is_first: bool) -> str:
        """Who may touch whom, and at a point that is not the first one who does, in sentences."""
        return self.face.report(*([] if is_first else point)).text

    @property
    def missed(self) -> int:
        """How many steps were refused since facets met that were out of reach: what is looked for has changed then."""
        return self.face.report().missed

    def adjoint(self, *_: Any) -> Gradient:
        raise Unsupported("adjoint: of general contact there is none; name pairs")

    def set_committed(self, *_: Any) -> None:
        raise Unsupported("set_committed: of general contact there is none; name pairs")
