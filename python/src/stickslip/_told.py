"""What a :class:`stickslip.Contact` tells about a point: balance, states, pictures, reports."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from ._pair import Pair
from ._rigid_nodes import RigidNodes
from ._whole import Whole
from .results import States
from .skin import Integers, Reals

if TYPE_CHECKING:
    import scipy.sparse

#: Positions of both sides, or of the whole skin, and the multipliers.
Point = tuple[Reals, ...]
Part = Pair | Whole
# What contact equilibrium is measured to, over scales of its own: docs/host_convergence.md.
_BALANCE = 1e-10


class Told:
    """The part of a contact that changes nothing. What it needs of the rest:"""

    n_host: int
    condensed: bool
    _n_inner: int
    _map: scipy.sparse.csr_matrix | None
    _rigid: RigidNodes
    _parts: list[Part]
    _displacements: Callable[[Reals], Reals]
    _points: Callable[[Reals], list[tuple[Part, Point]]]
    _evaluated: Callable[[Reals], list[tuple[Part, Point]]]

    @property
    def _pairs(self) -> list[Pair]:
        """Those with two sides."""
        return [part for part in self._parts if isinstance(part, Pair)]

    @property
    def n_multipliers(self) -> int:
        """How many multipliers there are, condensed or not."""
        return sum(part.count for part in self._parts)

    @property
    def size(self) -> int:
        """How many entries a vector has."""
        return self.n_host + (0 if self.condensed else self.n_multipliers)

    def balanced(self, x: Reals, tolerance: float = _BALANCE) -> bool:
        """Whether every interface is in contact equilibrium. Whether forces balance is the host's to ask."""
        for part, point in self._points(x):
            e = part.face.equilibrium(*point, modulus=part.modulus, least_traction=part.largest)
            if not (e.gap <= tolerance * e.gap_scale and e.traction <= tolerance * e.traction_scale
                    and e.slip <= tolerance * e.slip_scale):
                return False
        return True

    def check(self, x: Reals) -> None:
        """Raises :class:`stickslip.StepRefused` where the step must not count, by :meth:`stickslip.Interface.check_step`."""
        for part, point in self._points(x):
            part.face.check_step(*point, modulus=part.modulus, least_traction=part.largest)

    def states(self, x: Reals) -> list[States]:
        """What :meth:`stickslip.Interface.states` says of each interface. Ask before the commit."""
        return [part.face.states(*point) for part, point in self._points(x)]

    def surface(self, x: Reals, states: States, interface: int = 0) -> Any:
        """The first side of an interface as x has it, a mesh of meshio with what ``states`` say of its nodes: ``.write("contact.vtu")``."""
        return self._parts[interface].mesh(self._displacements(x), states)

    def plot(self, x: Reals, states: States, what: str = "pressure", interface: int = 0, axes: Any = None) -> Any:
        """Draws the first side of an interface as x has it, by matplotlib, and gives the axes: ``contact.plot(...).figure.savefig(file)``.

        Parameters
        ----------
        states : of this interface, of :meth:`states` or :class:`stickslip.Step`
        what : "state", which colours nodes, or a number of :class:`stickslip.States` that colours facets; of vectors the length
        axes : where to draw, of projection "3d" in space; without it a new figure
        """
        from ._drawing import drawn

        return drawn(*self._parts[interface].drawn(self._displacements(x)), states, what, axes)

    def step_limit(self, x: Reals, step: Reals) -> float:
        """How much of a change of all unknowns may be taken before surfaces lie in each other, at most 1."""
        end = self._displacements(x + step)
        u, limits = self._displacements(x), [1.0]
        for part in self._parts:
            at, then = part.positions(u), part.positions(end)
            limits.append(part.face.step_limit(*at, *(b - a for a, b in zip(at, then))))
        return min(limits)

    def touching(self, x: Reals) -> list[tuple[int, int, bool]]:
        """Of what may touch an unknown of the host on either side, -1: none, and whether it does."""
        sides = [joint for part, states in zip(self._parts, self.states(x)) for joint in part.touching(states)]
        if self._map is None:
            column = self._rigid.owners(np.arange(self._n_inner), self.n_host)
        else:
            column = np.append(self._map.indices, -1)[np.where(np.diff(self._map.indptr) > 0, self._map.indptr[:-1], -1)]
        last = [[int(column[numbers[numbers >= 0]].max(initial=-1)) for numbers in joint[:2]] for joint in sides]
        return [(one, two, joint[2]) for (one, two), joint in zip(last, sides)]

    def first_side(self) -> Integers:
        """The host's unknowns of all nodes that have multipliers."""
        return np.concatenate([pair.bearing() for pair in self._pairs])

    def report(self, x: Reals | None = None) -> str:
        """Which nodes are covered in the first configuration, or at ``x``, and what looks wrong, in sentences. Of general contact who may
        touch whom in this step. At ``x`` of either who touches, and with what force."""
        told = [part.report(point, x is None) for part, point in self._evaluated(np.zeros(self.size) if x is None else x)]
        sides = [np.unique(part.nodes1) for part in self._parts if isinstance(part, Pair)]
        nodes, claims = np.unique(np.concatenate([*sides, []]), return_counts=True)
        if (claims > 1).any():
            told.append(f"Nodes {nodes[claims > 1].astype(int).tolist()} have multipliers in several interfaces: see docs/host_edges.md.")
        return "\n".join(told)
