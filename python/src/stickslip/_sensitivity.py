"""Derivatives of a residual by positions of the last commit and by parameters: what gradients of a run are made of."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from ._arrays import Array, given, pointer
from ._library import ffi
from .results import Gradient

if TYPE_CHECKING:
    import scipy.sparse
    from numpy.typing import ArrayLike


class Sensitivities:
    """The part of an interface that is about derivatives by what is no unknown."""

    n1: int
    n2: int
    _shape1: tuple[int, ...]
    _shape2: tuple[int, ...]
    _shape_multipliers: tuple[int, ...]
    _call: Callable[..., None]
    _point: Callable[..., tuple[Any, ...]]

    def _argument_shapes(self) -> dict[str, tuple[int, ...]]:
        vectors = {name + side: shape for name in ("previous", "now") for side, shape in (("1", self._shape1), ("2", self._shape2))}
        return {**vectors, "friction": (self.n1,), "shear_limit": (1,), "offsets1": (self.n1,), "offsets2": (self.n2,)}

    def _shapes_of(self, names: Iterable[str]) -> dict[str, tuple[int, ...]]:
        known = self._argument_shapes()
        for name in names:
            if name not in known:
                raise TypeError(f"{name}: nothing that a residual depends on; there are {', '.join(known)}")
        return {name: known[name] for name in names}

    def previous_tangent(self, x1: ArrayLike, x2: ArrayLike, lam: ArrayLike, size: int) -> scipy.sparse.csr_matrix:
        """How the residual depends on the positions of the last commit: a scipy sparse matrix of ``(size, size)``, rows of the residual's
        equations, columns of the displacements'. For gradients of a run: docs/gradients.md."""
        import scipy.sparse

        *at, _ = self._point(x1, x2, lam, None)
        count = ffi.new("int64_t *")
        self._call("previous_tangent_coo", *at, 0, ffi.NULL, ffi.NULL, ffi.NULL, count)
        n = count[0]
        rows, columns, values = np.empty(n, np.int64), np.empty(n, np.int64), np.empty(n)
        self._call("previous_tangent_coo", *at, n, pointer(rows), pointer(columns), pointer(values), count)
        return scipy.sparse.coo_matrix((values, (rows, columns)), shape=(size, size)).tocsr()

    def adjoint(self, x1: ArrayLike, x2: ArrayLike, lam: ArrayLike, a1: ArrayLike, a2: ArrayLike, a_rows: ArrayLike,
                wanted: tuple[str, ...] = ("previous1", "previous2", "friction", "offsets1", "offsets2")) -> Gradient:
        """``a^T d residual / d`` each of ``wanted`` (members of :class:`Gradient`), in one pass. a1, a2 and a_rows have the shapes of the
        residual, 0 where there is no equation."""
        *at, _ = self._point(x1, x2, lam, None)
        out = Gradient(**{name: np.empty(shape) for name, shape in self._shapes_of(wanted).items()})
        to = ffi.new("struct stickslip_gradient *", {"struct_size": ffi.sizeof("struct stickslip_gradient")})
        for name in wanted:
            setattr(to, name, pointer(getattr(out, name)))
        a = (("a1", a1, self._shape1), ("a2", a2, self._shape2), ("a_rows", a_rows, self._shape_multipliers))
        self._call("adjoint", *at, *(pointer(given(*array)) for array in a), to)
        return out

    def sensitivity(self, x1: ArrayLike, x2: ArrayLike, lam: ArrayLike, **along: ArrayLike) -> tuple[Array, Array, Array]:
        """``(force1, force2, rows)``: the change of the residual along a direction, given by members of :class:`Gradient`."""
        *at, _ = self._point(x1, x2, lam, None)
        arrays = {name: given(name, along[name], shape) for name, shape in self._shapes_of(along).items()}
        direction = ffi.new("struct stickslip_direction *", {"struct_size": ffi.sizeof("struct stickslip_direction")})
        for name, array in arrays.items():
            setattr(direction, name, pointer(array))
        force1, force2, rows = (np.empty(shape) for shape in (self._shape1, self._shape2, self._shape_multipliers))
        self._call("sensitivity", *at, direction, pointer(force1), pointer(force2), pointer(rows))
        return force1, force2, rows
