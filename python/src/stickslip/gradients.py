"""Gradients of a whole run through contact and friction, by one transposed solve a step, backwards (docs/gradients.md).

The run is stored as what each step ended with. All that an interface keeps of a step follows from the positions at its end, so that
nothing else is stored.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ._sensitivity import Gradient
from .interface import Interface

if TYPE_CHECKING:
    import scipy.sparse


@dataclass
class Contact:
    """An interface, and where the host's vector has its unknowns: those of both sides and of the multipliers, in the shapes of the
    residual; -1 where there is none."""

    interface: Interface
    equations1: np.ndarray
    equations2: np.ndarray
    multipliers: np.ndarray

    def gather(self, vector: np.ndarray) -> list[np.ndarray]:
        """What a vector of the host has at these places; 0 where there is no equation."""
        places = (self.equations1, self.equations2, self.multipliers)
        return [np.where(at >= 0, vector[np.maximum(at, 0)], 0.0) for at in places]

    def carry(self, gradient: Gradient, vector: np.ndarray) -> None:
        """Adds what a step has of the positions that the one before ended with."""
        for at, values in ((self.equations1, gradient.previous1), (self.equations2, gradient.previous2)):
            np.add.at(vector, at[at >= 0], values[at >= 0])


@dataclass
class State:
    """What a step ended with, for each interface in turn: x1, x2, lam. Of the first configuration lam is not read."""

    points: Sequence[tuple[np.ndarray, np.ndarray, np.ndarray]]


def lu(matrix: scipy.sparse.spmatrix, right: np.ndarray) -> np.ndarray:
    """A transposed solve with factors made anew."""
    import scipy.sparse.linalg

    return scipy.sparse.linalg.splu(matrix.T.tocsc()).solve(right)


def backward(contacts: Sequence[Contact], states: Sequence[State], matrix: Callable[[int], scipy.sparse.spmatrix],
             slopes: Callable[[int], np.ndarray], wanted: Sequence[str] = (),
             solve: Callable[[scipy.sparse.spmatrix, np.ndarray], np.ndarray] = lu,
             ) -> Iterator[tuple[int, np.ndarray, list[Gradient]]]:
    """The adjoints a_n of the steps, from the last to the first, each with the products that the contacts have with it.

    With the residual R_n = 0 of step n, its tangent K_n, a functional J = sum of j_n and what follows with B_n = dR_n / dx_{n-1},

        K_n^T a_n = - dj_n/d(unknowns) - B_{n+1}^T a_{n+1},    dJ/d(parameter) = sum of dj_n/d(parameter) + a_n . dR_n/d(parameter)

    Parameters
    ----------
    contacts
        Of which the unknowns are.
    states
        The first configuration, then what each step ended with, converged: an error of R is one of the gradient.
    matrix
        K_n of step n = 1, 2, ... where it ended, contact's part included; the interfaces are then at the start of that step.
    slopes
        dj_n/d(unknowns) of step n.
    wanted
        Members of :class:`Gradient` that the caller reads, beside previous1 and previous2.
    """
    members = tuple(dict.fromkeys(("previous1", "previous2", *wanted)))
    behind = None
    for n in range(len(states) - 1, 0, -1):
        for contact, (x1, x2, _) in zip(contacts, states[n - 1].points):
            contact.interface.set_committed(x1, x2, commits=n - 1)
        right = -np.asarray(slopes(n), float)
        if behind is not None:
            right -= behind
        adjoint = solve(matrix(n), right)
        behind, products = np.zeros(len(adjoint)), []
        for contact, point in zip(contacts, states[n].points):
            products.append(contact.interface.adjoint(*point, *contact.gather(adjoint), members))
            contact.carry(products[-1], behind)
        yield n, adjoint, products
