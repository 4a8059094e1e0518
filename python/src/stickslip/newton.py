"""Newton's method for a host and its contact: docs/host_convergence.md."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from ._closing import Closing
from .contact import Contact
from .errors import Error, InvalidSize, InvalidValue, StepRefused
from .skin import Integers, Reals

if TYPE_CHECKING:
    import scipy.sparse

Solver = Callable[["scipy.sparse.csr_matrix", Reals], Reals]
# The forces on a body balance to this part of reactions and contact forces on it, or to the rounding of its own: so many units in the
# last place of |K| |u|.
_FORCES, _ROUNDING = 2e-11, 16 * np.finfo(float).eps
# What is prescribed is reached up to the rounding of a sum.
_REACHED = 4 * np.finfo(float).eps
# A line search halves a step so many times, and asks of a part s of a step a residual smaller by 1e-4 s.
_HALVINGS, _DECREASE = 10, 1e-4


def newton(contact: Contact, residual: Callable[[Reals], ArrayLike], tangent: Callable[[Reals], Any], x: Reals, *,
           fixed: ArrayLike = (), values: ArrayLike = 0.0, search: bool = False, closing: bool = False, most: int = 25,
           solve: Solver | None = None) -> int:
    """Solves one step in place, and gives the number of iterations.

    Raises :class:`stickslip.Error` where that fails: :class:`stickslip.StepRefused`, or what the library has refused. Then x is as it was.

    Parameters
    ----------
    residual, tangent : of the host's unknowns: its internal minus external forces, (n_host,), and their derivative, a sparse matrix
    x : all unknowns, as :meth:`Contact.start` gives them
    fixed, values : which of the host's unknowns are prescribed, and what they become. They move along with the first iterate.
    search : False: full steps, which find the states of nodes fastest. True: each is halved until the residual decreases.
    closing : True: steps are cut where surfaces meet, as they are anyhow where a body that nothing holds touches nothing yet
    most : how many iterations it may take; twice as many where steps are cut
    solve : ``solve(A, b)`` of a csr_matrix A that is not symmetric and has zeros on its diagonal; without it SuperLU of scipy
    """
    return solved(contact, residual, tangent, x, fixed=fixed, values=values, search=search, closing=closing, most=most, solve=solve)[0]


def solved(contact: Contact, residual: Callable[[Reals], ArrayLike], tangent: Callable[[Reals], Any], x: Reals, *, fixed: ArrayLike,
           values: ArrayLike, search: bool, closing: bool, most: int, solve: Solver | None) -> tuple[int, bool]:
    """The same, and whether steps were cut where surfaces met: nothing to extrapolate from."""
    run = _Run(contact, residual, tangent, np.asarray(fixed, dtype=np.int64).ravel(), solve or _superlu)
    before = x.copy()
    try:
        iterations = run.solve(x, np.asarray(values, dtype=np.float64).ravel(), search, closing, most)
    except Error:
        x[:] = before
        raise
    return iterations, run.closing.cut


def _superlu(A: scipy.sparse.csr_matrix, b: Reals) -> Reals:
    from scipy.sparse.linalg import splu

    try:
        out: Reals = splu(A.tocsc()).solve(b)
    except RuntimeError as error:
        raise StepRefused("Newton's matrix is singular") from error
    return out


class _Run:
    """One solution: what stays from iterate to iterate."""

    def __init__(self, contact: Contact, residual: Callable[[Reals], ArrayLike], tangent: Callable[[Reals], Any], fixed: Integers,
                 solver: Solver):
        self.contact, self.n = contact, contact.n_host
        self.host_residual, self.host_tangent, self.solver = residual, tangent, solver
        self.free = np.ones(contact.size, dtype=bool)
        self.free[fixed] = False
        self.fixed = fixed
        held = contact.first_side() if contact.condensed else fixed[:0]
        held = held[~self.free[held]]
        if len(held):
            raise InvalidValue(f"fixed: unknown {held[0]} is one of a node of the first side that has multipliers, whose rows a condensed contact"
                               " needs: give it dofs -1 and, on a plane of symmetry, name it as held")
        self.largest: Reals | float = 0.0

    def evaluate(self, x: Reals) -> tuple[Reals, Reals]:
        """The residual of all unknowns, and the host's own part of it."""
        own = np.asarray(self.host_residual(x[: self.n]), dtype=np.float64).ravel()
        if own.shape != (self.n,):
            raise InvalidSize(f"residual: gives {own.size} entries, {self.n} are needed")
        r = np.zeros(self.contact.size)
        r[: self.n] = own
        self.contact.add_residual(x, r)
        if not np.isfinite(r).all():
            raise StepRefused("the residual is NaN or infinite")
        return r, own

    def forces_balance(self, x: Reals, r: Reals, own: Reals, K: Any) -> bool:
        """Whether the forces on every body balance, beside its reactions and contact forces. Bodies are what the host's matrix joins."""
        free, bodies = self.free[: self.n], self.bodies

        def norms(vector: Reals) -> Reals:
            out: Reals = np.sqrt(np.bincount(bodies, vector**2))
            return out

        total = r[: self.n]
        reference = norms(np.where(free, 0.0, total)) + norms(total - own)
        self.largest = np.maximum(self.largest, reference)
        rounding = norms(abs(K) @ np.abs(x[: self.n]))
        return bool((norms(np.where(free, total, 0.0)) <= np.maximum(_FORCES * self.largest, _ROUNDING * rounding)).all())

    def solve(self, x: Reals, values: Reals, search: bool, closing: bool, most: int) -> int:
        """Iterates x."""
        import scipy.sparse
        from scipy.sparse.csgraph import connected_components

        r, own = self.evaluate(x)
        K = scipy.sparse.csr_matrix(self.host_tangent(x[: self.n]))
        self.bodies: Integers = connected_components(K + self.contact._rigid.links(self.n), directed=False)[1]
        self.closing = Closing(self.contact, self.bodies, self.fixed)
        self.closing.begin(x, closing)
        for iteration in range((2 if self.closing.active else 1) * most + 1):
            step = np.zeros(self.contact.size)
            way = values - x[self.fixed]
            step[self.fixed] = np.where(np.abs(way) <= _REACHED * np.abs(values), 0.0, way)
            if not step.any() and self.closing.settled and self.forces_balance(x, r, own, K) and self.contact.balanced(x):
                return iteration
            if iteration:  # not before: where forces balance, the matrix of the last iterate says how they are rounded
                K = scipy.sparse.csr_matrix(self.host_tangent(x[: self.n]))
            A = self.closing.shifted(self.contact.tangent(x, K), x, float(np.linalg.norm(r[self.free])))
            rows = A[self.free]
            step[self.free] = -self.solver(rows[:, self.free], r[self.free] + rows @ step)
            if not np.isfinite(step).all():
                raise StepRefused("the solution of Newton's matrix is NaN or infinite")
            step = self.closing.shortened(x, step)
            r, own = self.shortened(x, step, r) if search and not step[self.fixed].any() else self.moved(x, step, 1.0)
        raise StepRefused(f"Newton's method has not converged in {iteration} iterations")

    def moved(self, x: Reals, step: Reals, part: float) -> tuple[Reals, Reals]:
        """Takes a part of a step."""
        x += part * step
        return self.evaluate(x)

    def shortened(self, x: Reals, step: Reals, r: Reals) -> tuple[Reals, Reals]:
        """Takes the first of the whole step, half of it, ... at which the residual decreases and nothing is refused."""
        start, norm = x.copy(), np.linalg.norm(r[self.free])
        for k in range(_HALVINGS + 1):
            x[:] = start
            try:
                new, own = self.moved(x, step, 0.5**k)
            except Error:
                continue
            if np.linalg.norm(new[self.free]) <= (1 - _DECREASE * 0.5**k) * norm:
                return new, own
        raise StepRefused("the line search finds no smaller residual")
