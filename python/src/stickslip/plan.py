"""A tangent whose entries are settled once and whose numbers are filled in place."""

import numpy as np

from ._arrays import pointer
from ._library import constants, ffi, value_of
from .errors import by_status


class Plan:
    """The tangent of an interface as a scipy CSR matrix of ``(size, size)``.

    ``matrix.data`` is refilled in place by :meth:`values`. Where the entries no longer do, the plan is made anew: then
    ``matrix`` is another object, and ``renewals`` has grown by one.

    Parameters
    ----------
    interface : Interface
    x1, x2 : positions that the entries are found at [L]
    size : the number of the host's equations
    pairs : "active", "active_sums" or "skin" (STICKSLIP_PLAN_...)
    """

    def __init__(self, interface, x1, x2, size: int, *, pairs: str = "active"):
        self._interface = interface
        self._size = size
        self._pairs = value_of("pairs", "PLAN", pairs)
        self.renewals = 0
        self._make(x1, x2)

    def _make(self, x1, x2) -> None:
        import scipy.sparse

        n_rows, count = ffi.new("int64_t *"), ffi.new("int64_t *")
        self._interface._call("plan", *self._interface._positions(x1, x2), self._pairs, n_rows, count)
        rows = np.empty(n_rows[0], np.int64)
        offsets = np.empty(n_rows[0] + 1, np.int64)
        columns = np.empty(count[0], np.int64)
        entries = value_of("entries", "ENTRIES", "tangent")
        addresses = pointer(rows), pointer(offsets), pointer(columns)
        self._interface._call("plan_csr", entries, len(columns), *addresses)
        lengths = np.zeros(self._size + 1, np.int64)
        lengths[rows + 1] = np.diff(offsets)
        arrays = np.zeros(len(columns)), columns, np.cumsum(lengths)
        self.matrix = scipy.sparse.csr_matrix(arrays, shape=(self._size, self._size), copy=False)

    def values(self, x1, x2, lam, *, sums=None):
        """Fills the matrix with the tangent at this point, and gives it."""
        try:
            self._fill(x1, x2, lam, sums)
        except by_status[constants["MISSING_ENTRY"]]:
            self._make(x1, x2)
            self.renewals += 1
            self._fill(x1, x2, lam, sums)
        return self.matrix

    def _fill(self, x1, x2, lam, sums) -> None:
        data = self.matrix.data
        point = self._interface._point(x1, x2, lam, sums)
        self._interface._call("plan_values", *point, len(data), pointer(data))
