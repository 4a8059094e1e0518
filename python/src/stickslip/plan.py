"""Matrices whose entries are settled once and whose numbers are filled in place."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ._arrays import Array, pointer
from ._library import constants, ffi, value_of
from .errors import exception_of
from .general import Skin
from .interface import Interface

if TYPE_CHECKING:
    import scipy.sparse


def empty_csr(rows: Array, row_lengths: Array, columns: Array, size: int) -> scipy.sparse.csr_matrix:
    """A scipy CSR matrix of zeros with these entries: ascending rows, how many entries each has, the columns of all of them."""
    import scipy.sparse

    largest = max(rows.max(initial=-1), columns.max(initial=-1))
    if largest >= size:
        raise ValueError(f"size: {size}, and there is an equation {largest}; at least {largest + 1} is needed")
    offsets = np.zeros(size + 1, np.int64)
    offsets[rows + 1] = row_lengths
    arrays = np.zeros(len(columns)), columns, np.cumsum(offsets)
    return scipy.sparse.csr_matrix(arrays, shape=(size, size), copy=False)


def _matrix(interface: Interface, entries: str, n_rows: int, count: int, size: int) -> scipy.sparse.csr_matrix:
    """The same with the entries of a plan that was made."""
    rows, offsets = np.empty(n_rows, np.int64), np.empty(n_rows + 1, np.int64)
    columns = np.empty(count, np.int64)
    addresses = pointer(rows), pointer(offsets), pointer(columns)
    interface._call("plan_csr", value_of("entries", "ENTRIES", entries), count, *addresses)
    return empty_csr(rows, np.diff(offsets), columns, size)


class _Planned:
    """What plans share: they are made anew where their entries no longer do. What each has of its own:"""

    _make: Callable[..., None]
    _fill: Callable[..., None]

    def __init__(self, interface: Interface, x1: ArrayLike, x2: ArrayLike, size: int, *, pairs: str = "active"):
        self._interface = interface
        self._size = size
        self._pairs = value_of("pairs", "PLAN", pairs)
        self.renewals = 0
        self._make(x1, x2)

    def _renewed(self, x1: ArrayLike, x2: ArrayLike, *rest: ArrayLike | None) -> None:
        try:
            self._fill(x1, x2, *rest)
        except exception_of(constants["MISSING_ENTRY"]):
            self._make(x1, x2)
            self.renewals += 1
            self._fill(x1, x2, *rest)


class Plan(_Planned):
    """The tangent of an interface as a scipy CSR matrix of ``(size, size)``.

    ``matrix.data`` is refilled in place by :meth:`values`. Where the entries no longer do, the plan is made anew: then
    ``matrix`` is another object, and ``renewals`` has grown by one.

    Parameters
    ----------
    interface : Interface
    x1, x2 : positions that the entries are found at [L]
    size : the number of the host's equations
    pairs : "active", "active_sums" or "skin" (``STICKSLIP_PLAN_...``)
    """

    def _make(self, x1: ArrayLike, x2: ArrayLike) -> None:
        face = self._interface
        n_rows, count = ffi.new("int64_t *"), ffi.new("int64_t *")
        face._call("plan", *face._positions(x1, x2), self._pairs, n_rows, count)
        self.matrix = _matrix(face, "tangent", n_rows[0], count[0], self._size)

    def values(self, x1: ArrayLike, x2: ArrayLike, lam: ArrayLike, *, sums: ArrayLike | None = None) -> scipy.sparse.csr_matrix:
        """Fills the matrix with the tangent at this point, and gives it."""
        self._renewed(x1, x2, lam, sums)
        return self.matrix

    def _fill(self, x1: ArrayLike, x2: ArrayLike, lam: ArrayLike, sums: ArrayLike | None) -> None:
        data = self.matrix.data
        self._interface._call("plan_values", *self._interface._point(x1, x2, lam, sums), len(data), pointer(data))


class CondensedPlan(_Planned):
    """The pieces "forces" and "constraints" of a condensed matrix, which change in each iteration, as two scipy CSR matrices.

    They are ``forces`` and ``constraints``, refilled in place by :meth:`values`. Renewals and parameters are those of
    :class:`Plan`; the interface has ``basis="dual"``. The other pieces: :meth:`Condensed.piece`.
    """

    def _make(self, x1: ArrayLike, x2: ArrayLike) -> None:
        face = self._interface
        n_rows, counts = ffi.new("int64_t[2]"), ffi.new("int64_t[2]")
        # If a matrix is refused, no shorter one is left for the new plan to fill.
        vars(self).pop("forces", None), vars(self).pop("constraints", None)
        face._call("condensed_plan", *face._positions(x1, x2), self._pairs, n_rows, counts)
        self.forces = _matrix(face, "forces", n_rows[0], counts[0], self._size)
        self.constraints = _matrix(face, "constraints", n_rows[1], counts[1], self._size)

    def values(self, x1: ArrayLike, x2: ArrayLike, lam: ArrayLike) -> tuple[scipy.sparse.csr_matrix, scipy.sparse.csr_matrix]:
        """Fills both matrices at this point, and gives ``(forces, constraints)``."""
        self._renewed(x1, x2, lam)
        return self.forces, self.constraints

    def _fill(self, x1: ArrayLike, x2: ArrayLike, lam: ArrayLike) -> None:
        face = self._interface
        data = pointer(self.forces.data), pointer(self.constraints.data)
        face._call("condensed_values", *face._point(x1, x2, lam, None)[:3], *data)


class SkinPlan:
    """The tangent of a :class:`stickslip.Skin` as a scipy CSR matrix of ``(size, size)``.

    ``matrix.data`` is refilled in place by :meth:`values`. Where what may touch has changed the plan is made anew: then ``matrix`` is
    another object, and ``renewals`` has grown by one.

    Parameters
    ----------
    skin : Skin
    x : positions that the entries are found at [L]
    size : the number of the host's equations, multipliers among them
    pairs : "active" or "skin" (``STICKSLIP_PLAN_...``)
    """

    def __init__(self, skin: Skin, x: ArrayLike, size: int, *, pairs: str = "active"):
        self._skin, self._size, self._pairs = skin, size, pairs
        self.renewals = 0
        self._make(x)

    def _make(self, x: ArrayLike) -> None:
        count = self._skin.plan(x, self._pairs)
        rows, columns = self._skin.plan_coo(count)
        # Interfaces that meet at a node have entries in common, which add up.
        wide = int(columns.max(initial=0)) + 1
        entries, self._places = np.unique(rows * wide + columns, return_inverse=True)
        ascending, lengths = np.unique(entries // wide, return_counts=True)
        self.matrix = empty_csr(ascending, lengths, entries % wide, self._size)
        self._values = np.empty(count)

    def values(self, x: ArrayLike, lam: ArrayLike) -> scipy.sparse.csr_matrix:
        """Fills the matrix with the tangent at this point, and gives it."""
        try:
            self._skin.plan_values(x, lam, self._values)
        except exception_of(constants["MISSING_ENTRY"]):
            self._make(x)
            self.renewals += 1
            self._skin.plan_values(x, lam, self._values)
        self.matrix.data[:] = np.bincount(self._places, self._values, len(self.matrix.data))
        return self.matrix
