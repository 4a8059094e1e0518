"""Linear facets are chords of the curved surface that is meant: what they take of a fit, in words. program/contact/chords.c has the same."""

from __future__ import annotations

import numpy as np

from .results import Reals, States
from .skin import Integers

# Facets that meet under more than twice this angle are two sides of an edge, and no chords of one surface [rad].
_SMOOTH = 0.52
# Facets that match are apart by less than this part of what the surfaces rise over them: what meshes are written with.
_TOUCHING = 1e-2
# A part of a fit's overlap that chords may take or give and nobody is told.
_FIT = 0.05
_REMEDY = "Cells of order 2 follow the shape; `shape_offsets` gives linear facets theirs back in the mean: see docs/host_offsets.md."


def told(states: States, *sides: tuple[Reals, list[Integers]]) -> list[str]:
    """What is told before the first step. ``sides``: nodes and facets of each; an analytic one has no facets."""
    covered = states.bearing & (states.coverage > 0)
    if not covered.any():
        return []
    gaps = states.gap[covered] / states.coverage[covered]
    rises = [_rises(*side) for side in sides]
    both = sum(max(rise) for rise in rises)
    taken = sum(rise - dip for rise, dip in rises) * 2 / 3  # of a shaft two thirds of their rise, in the mean; a bore's add as much
    least, largest = gaps.min(), gaps.max()
    if largest > _TOUCHING * both and np.abs(gaps).max() <= both:
        return [f"The facets start with gaps from {least:.3g} to {largest:.3g}, and the curved surfaces that are meant rise over them by up to "
                f"{both:.3g}: where these touch the facets may not, so that a fit presses too little, or not at all. {_REMEDY}"]
    if largest < 0 and abs(taken) > _FIT * -least:
        return [f"The facets start with overlaps from {-largest:.3g} to {-least:.3g}, and the curved surfaces that are meant overlap by about "
                f"{abs(taken):.2g} {'more' if taken > 0 else 'less'}: facets are their chords, so that the fit presses too "
                f"{'little' if taken > 0 else 'much'}. {_REMEDY}"]
    return []


def _rises(X: Reals, facets: list[Integers]) -> tuple[float, float]:
    """How far a surface rises over its facets and dips below them at most: a circle over a chord of length h by h theta / 8, theta the angle
    between the normals at its ends. Facets with mid nodes follow the surface."""
    linear = (2,) if X.shape[1] == 2 else (3, 4)
    kinds = [np.array([row for row in facets if len(row) == n], dtype=int).reshape(-1, n) for n in linear]
    sums, bends = np.zeros(X.shape), [0.0]
    for rows in kinds:
        np.add.at(sums, rows, _areas(X[rows])[:, None])
    at_nodes = _unit(sums)
    for rows in kinds:
        normals = _unit(_areas(X[rows]))
        for k in range(rows.shape[1]):
            one, two = rows[:, k], rows[:, (k + 1) % rows.shape[1]]
            smooth = np.minimum(*((normals * at_nodes[end]).sum(axis=1) for end in (one, two))) > np.cos(_SMOOTH)
            bends += ((at_nodes[two] - at_nodes[one]) * (X[two] - X[one])).sum(axis=1)[smooth].tolist()
    return max(bends) / 8, -min(bends) / 8


def _areas(corners: Reals) -> Reals:
    """Area vectors of facets by their corners, of lines their lengths across them."""
    if corners.shape[2] == 2:
        along = corners[:, 1] - corners[:, 0]
        return np.stack([along[:, 1], -along[:, 0]], axis=1)
    first = corners[:, 2] - corners[:, 0] if corners.shape[1] == 4 else corners[:, 1] - corners[:, 0]
    return np.cross(first, corners[:, -1] - corners[:, -3])


def _unit(vectors: Reals) -> Reals:
    """Of length 1; what is 0 stays."""
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    unit: Reals = vectors / np.where(length > 0, length, 1.0)
    return unit
