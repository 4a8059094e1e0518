"""Heat across an interface."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ._arrays import Array, given, pointer
from ._library import ffi, value_of

if TYPE_CHECKING:
    import scipy.sparse
    from numpy.typing import ArrayLike


@dataclass
class Heat:
    """Heat that leaves the nodes, and what passes through the non-mortar ones, (n1,) each."""

    #: What leaves the non-mortar and the mortar nodes, (n1,) and (n2,) [F L/T]: to add to the internal heat flow.
    heat1: Array
    heat2: Array
    #: h [F/(L T K)], h times the mean jump of temperature [F/(L T)], that jump [K], the heat of friction [F L/T], the covered area [L^2].
    conductance: Array
    flux: Array
    jump: Array
    friction: Array
    area: Array


class Heats:
    """The part of an interface that is about heat. ``numbers`` are members of ``stickslip_heat``."""

    n1: int
    n2: int
    _call: Callable[..., None]
    _point: Callable[..., tuple[Any, ...]]

    def _heat_point(self, point: tuple[Any, ...], temperatures: tuple[Any, Any], numbers: dict[str, float]) -> tuple[Any, ...]:
        law = ffi.new("struct stickslip_heat *", {"struct_size": ffi.sizeof("struct stickslip_heat")})
        known = [name for name, _ in ffi.typeof("struct stickslip_heat").fields if name != "struct_size"]
        for name, value in numbers.items():
            if name not in known:
                raise TypeError(f"{name}: no number of heat; there are {', '.join(known)}")
            setattr(law, name, float(value))
        *at, _ = self._point(*point, None)
        t1, t2 = temperatures
        return (*at, law, pointer(given("t1", t1, (self.n1,))), pointer(given("t2", t2, (self.n2,))))

    def heat(self, x1: ArrayLike, x2: ArrayLike, lam: ArrayLike, t1: ArrayLike, t2: ArrayLike, **numbers: float) -> Heat:
        """Heat across the interface at temperatures t1, (n1,), and t2, (n2,)."""
        arguments = self._heat_point((x1, x2, lam), (t1, t2), numbers)
        nodes = ffi.new("struct stickslip_heat_nodes *", {"struct_size": ffi.sizeof("struct stickslip_heat_nodes")})
        out = Heat(np.empty(self.n1), np.empty(self.n2), *(np.empty(self.n1) for _ in range(5)))
        for name in ("conductance", "flux", "jump", "friction", "area"):
            setattr(nodes, name, pointer(getattr(out, name)))
        self._call("heat", *arguments, pointer(out.heat1), pointer(out.heat2), nodes)
        return out

    def heat_tangent(self, x1: ArrayLike, x2: ArrayLike, lam: ArrayLike, t1: ArrayLike, t2: ArrayLike, equations1: ArrayLike,
                     equations2: ArrayLike, size: int, which: str = "all", **numbers: float) -> scipy.sparse.spmatrix:
        """Its derivative, a scipy sparse matrix of ``(size, size)``: rows ``equations1``, (n1,) int64, and ``equations2``, (n2,).

        ``which``: "temperatures", or "all" with columns of displacements and multipliers.
        """
        import scipy.sparse

        arguments = self._heat_point((x1, x2, lam), (t1, t2), numbers)
        rows_of = (pointer(given("equations1", equations1, (self.n1,), np.int64)),
                   pointer(given("equations2", equations2, (self.n2,), np.int64)))
        number, count = value_of("which", "HEAT", which), ffi.new("int64_t *")
        self._call("heat_tangent_coo", *arguments, *rows_of, number, 0, ffi.NULL, ffi.NULL, ffi.NULL, count)
        n = count[0]
        rows, columns, values = np.empty(n, np.int64), np.empty(n, np.int64), np.empty(n)
        self._call("heat_tangent_coo", *arguments, *rows_of, number, n, pointer(rows), pointer(columns), pointer(values), count)
        return scipy.sparse.coo_matrix((values, (rows, columns)), shape=(size, size)).tocsr()
