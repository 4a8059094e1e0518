"""Systems without multipliers among the unknowns: dual basis alone."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ._arrays import Array, given, output, pointer
from ._library import ffi, value_of
from .interface import Interface

if TYPE_CHECKING:
    import scipy.sparse


class Condensed:
    """The condensed system of an interface with ``basis="dual"``.

    ``host1`` is the residual of the host's own forces at the non-mortar nodes, internal minus external, like ``x1`` [F].
    """

    def __init__(self, interface: Interface):
        self._interface = interface

    def multipliers(self, x1: ArrayLike, x2: ArrayLike, host1: ArrayLike, out: Array | None = None) -> Array:
        """The multipliers that follow from the displacements [F/L^2]. Call it first in an evaluation."""
        face = self._interface
        out = output("out", out, face._shape_multipliers)
        host = pointer(given("host1", host1, face._shape1))
        face._call("condensed_multipliers", *face._positions(x1, x2), host, pointer(out))
        return out

    def residual(self, x1: ArrayLike, x2: ArrayLike, lam: ArrayLike, host1: ArrayLike) -> tuple[Array, Array]:
        """``(rows1, force2)``: in place of the host's rows of the non-mortar nodes; to add to the mortar nodes' rows [F]."""
        face = self._interface
        rows1, force2 = np.empty(face._shape1), np.empty(face._shape2)
        point = face._point(x1, x2, lam, None)[:3]
        host = pointer(given("host1", host1, face._shape1))
        face._call("condensed_residual", *point, host, pointer(rows1), pointer(force2))
        return rows1, force2

    def piece(self, x1: ArrayLike, x2: ArrayLike, lam: ArrayLike, size: int, piece: str) -> scipy.sparse.csr_matrix:
        """One piece of the condensed matrix, ``(size, size)``: "forces", "elimination", "constraints" or "scales".

        With the host's own matrix K and J = K + forces the condensed one is J + elimination @ J + constraints. With scales
        added it is the exact derivative of :meth:`residual` with :meth:`multipliers`.
        """
        import scipy.sparse

        face = self._interface
        point = face._point(x1, x2, lam, None)[:3]
        number = value_of("piece", "CONDENSED", piece)
        count = ffi.new("int64_t *")
        face._call("condensed_coo", *point, number, 0, ffi.NULL, ffi.NULL, ffi.NULL, count)
        rows, columns = np.empty(count[0], np.int64), np.empty(count[0], np.int64)
        values = np.empty(count[0])
        addresses = pointer(rows), pointer(columns), pointer(values)
        face._call("condensed_coo", *point, number, len(rows), *addresses, count)
        n = count[0]
        return scipy.sparse.coo_matrix((values[:n], (rows[:n], columns[:n])), shape=(size, size)).tocsr()
