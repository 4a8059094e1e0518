"""What to do with surfaces before they become interfaces: creases, and nodes that interfaces share."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ._arrays import Array, given, pointer
from ._library import call, ffi
from .results import Crosspoints
from .surface import Surface


def split_creases(coordinates: ArrayLike, facets: Sequence[Any] | Array, angle: float = 0.7) -> tuple[list[Array], Array]:
    """``(facets, originals)``: a non-mortar surface whose nodes on sharp edges are listed once a side.

    Parameters
    ----------
    coordinates, facets : as of :class:`Surface`
    angle : two facets around a node that differ by more have nodes of their own [rad]

    Returns
    -------
    facets : list of arrays of the new node numbers
    originals : of each new node the old one, int64. The new surface has ``coordinates[originals]`` and ``equations[originals]``;
        its multiplier equations are new ones for every copy. Copies that may be in contact together act without friction.
    """
    surface = Surface(coordinates, facets)
    struct, kept = surface._struct()
    count = ffi.new("int64_t *")

    def split(capacity: int, *outputs: Any) -> None:
        arguments = struct, angle, 0, capacity, *outputs, count
        if surface.dimension == 2:
            call("lines_split_creases", *arguments)
        else:
            call("surface_split_creases", *arguments)

    split(0, ffi.NULL, ffi.NULL)
    numbers, originals = np.empty_like(surface.facet_nodes), np.empty(count[0], np.int64)
    split(len(originals), pointer(numbers), pointer(originals))
    del kept
    return np.split(numbers, surface.facet_offsets[1:-1]), originals


def crosspoints(interfaces: Sequence[tuple[ArrayLike, ArrayLike]]) -> Crosspoints:
    """The nodes that several interfaces of a host share in a way that matters.

    Parameters
    ----------
    interfaces : list of (non-mortar nodes, mortar nodes), numbers of the host's, int64

    Returns
    -------
    nodes : ascending
    kinds : sums of ``constants["CROSSPOINT_CLAIMED"]``, ``"CROSSPOINT_CHAIN"``, ``"CROSSPOINT_BOTH_SIDES"``
    claims : in how many interfaces each is non-mortar
    """
    sides = []
    for name, side in (("non-mortar nodes", 0), ("mortar nodes", 1)):
        lists = [given(f"interfaces[{k}], {name}", pair[side], np.shape(pair[side]), np.int64)
                 for k, pair in enumerate(interfaces)]
        offsets = np.cumsum([0, *map(len, lists)], dtype=np.int64)
        # One entry at least: an empty array has no address.
        sides += [offsets, np.concatenate([*lists, np.zeros(1, np.int64)])]
    arguments = (len(sides[0]) - 1, *map(pointer, sides))
    count = ffi.new("int64_t *")
    call("crosspoints_find", *arguments, 0, ffi.NULL, ffi.NULL, ffi.NULL, count)
    n = count[0]
    nodes, kinds, claims = np.empty(n, np.int64), np.empty(n, np.int32), np.empty(n, np.int64)
    call("crosspoints_find", *arguments, n, pointer(nodes), pointer(kinds), pointer(claims), count)
    return Crosspoints(nodes=nodes, kinds=kinds, claims=claims)
