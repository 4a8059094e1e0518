"""Gradients of a whole run through contact and friction, by one transposed solve a step, backwards (docs/gradients.md).

The run is stored as what each step ended with. All that an interface keeps of a step follows from the positions at its end, so that
nothing else is stored.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .contact import Contact
from .newton import Solver
from .results import Gradient
from .skin import Reals


def lu(matrix: Any, right: Reals) -> Reals:
    """A solve with factors made anew."""
    import scipy.sparse.linalg

    solution: Reals = scipy.sparse.linalg.splu(matrix.tocsc()).solve(right)
    return solution


def backward(contact: Contact, ends: Sequence[Reals], tangent: Callable[[int], Any], slopes: Callable[[int], ArrayLike],
             wanted: Sequence[str] = (), *, fixed: ArrayLike = (), solve: Solver = lu) -> Iterator[tuple[int, Reals, list[Gradient]]]:
    """The adjoints a_n of the steps, from the last to the first, each with the products that the interfaces have with it.

    With the residual R_n = 0 of step n, its tangent K_n, a functional J = sum of j_n and B_n = dR_n / dx_{n-1}

        K_n^T a_n = - dj_n/d(unknowns) - B_{n+1}^T a_{n+1},    dJ/d(parameter) = sum of dj_n/d(parameter) + a_n . dR_n/d(parameter)

    Parameters
    ----------
    ends : all unknowns in the first configuration, then at the end of each step, converged: what Newton's method leaves is an error of the
        gradient, too
    tangent : ``tangent(n)`` is the host's share of K_n at the end of step n = 1, 2, ..., without contact
    slopes : ``slopes(n)`` are dj_n/d(unknowns)
    wanted : members of :class:`stickslip.Gradient` that the caller reads, beside previous1 and previous2
    fixed : which unknowns are prescribed; their rows and adjoints are left out
    solve : as of :func:`stickslip.newton`; it gets the transposed matrix
    """
    import scipy.sparse

    members = tuple(dict.fromkeys(("previous1", "previous2", *wanted)))
    free = np.ones(contact.size)
    free[np.asarray(fixed, dtype=np.int64)] = 0.0
    keep = scipy.sparse.diags(free)
    behind = np.zeros(contact.size)
    for n in range(len(ends) - 1, 0, -1):
        contact.set_committed(ends[n - 1], n - 1)
        matrix = keep @ contact.tangent(ends[n], tangent(n)) @ keep + scipy.sparse.diags(1.0 - free)
        adjoint = solve(matrix.T.tocsr(), -free * (np.asarray(slopes(n), dtype=float) + behind))
        products, behind = contact.adjoint(ends[n], adjoint, members)
        yield n, adjoint, products
