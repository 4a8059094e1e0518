"""A surface: nodes, facets, equations."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import _arrays
from ._arrays import Array, given, pointer
from ._library import ffi


class Surface:
    """One side of an interface.

    Parameters
    ----------
    coordinates : (n, 3) float64, of plane and axisymmetric models (n, 2)
        First configuration [L].
    facets : (m, k) integers, or a list of lists of mixed kinds
        Node numbers from 0. In space right-handed seen from outside the body; of lines the body is to the left.
        Corners first, then mid nodes, then the centre.
    equations : like ``coordinates``, int64, optional
        Displacement equations; -1 is prescribed. Without them all are -1.
    multiplier_equations : (n, dimension) or (n,) int64, optional
        Of the non-mortar side; (n,) where there is one multiplier a node.
    owned : (n,) int32, optional
        Of a non-mortar side on several processes: where a node's multiplier acts, ``constants["NODE_OWN"]``, ``"NODE_SHARED"``
        or ``"NODE_ELSEWHERE"``. Without it all are own.
    """

    def __init__(self, coordinates: ArrayLike, facets: Sequence[Any] | Array, equations: ArrayLike | None = None,
                 multiplier_equations: ArrayLike | None = None, owned: ArrayLike | None = None):
        self.coordinates = _arrays.coordinates(coordinates)
        self.n_nodes, self.dimension = self.coordinates.shape
        rows = [np.asarray(facet) for facet in facets]
        if any(row.ndim != 1 or row.dtype.kind not in "iu" for row in rows):
            raise TypeError("facets: a 2-D integer array or a list of lists of integers is needed")
        self.facet_offsets = np.cumsum([0, *(len(row) for row in rows)], dtype=np.int64)
        self.facet_nodes = np.concatenate(rows).astype(np.int64) if rows else np.empty(0, np.int64)
        shape = self.coordinates.shape
        equations = np.full(shape, -1, np.int64) if equations is None else equations
        self.equations = given("equations", equations, shape, np.int64)
        self.multiplier_equations = None
        if multiplier_equations is not None:
            size = np.size(multiplier_equations)
            wanted = (self.n_nodes,) if size == self.n_nodes else shape
            self.multiplier_equations = given("multiplier_equations", multiplier_equations, wanted, np.int64)
        self.owned = None if owned is None else given("owned", owned, (self.n_nodes,), np.int32)

    def __str__(self) -> str:
        facets = "lines" if self.dimension == 2 else "facets"
        return f"{len(self.facet_offsets) - 1} {facets} of {self.n_nodes} nodes"

    def rows(self) -> list[Array]:
        """The nodes of each facet."""
        return np.split(self.facet_nodes, self.facet_offsets[1:-1]) if len(self.facet_offsets) > 1 else []

    def __repr__(self) -> str:
        return f"<Surface: {self}>"

    def _struct(self) -> tuple[Any, dict[str, Any]]:
        """The C struct, and what has to live as long as it does."""
        out = ffi.new("struct stickslip_surface *")
        out.struct_size = ffi.sizeof("struct stickslip_surface")
        out.n_nodes = self.n_nodes
        out.n_facets = len(self.facet_offsets) - 1
        names = ["coordinates", "equations", "multiplier_equations", "owned"]
        if out.n_facets:
            names += ["facet_offsets", "facet_nodes"]
        kept = {name: pointer(getattr(self, name)) for name in names}
        for name, address in kept.items():
            setattr(out, name, address)
        return out, kept
