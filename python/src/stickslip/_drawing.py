"""Pictures of the first side of an interface, by matplotlib."""

from __future__ import annotations

from typing import Any

import numpy as np

from .errors import InvalidValue
from .results import State, States
from .skin import Integers, Reals

_COLOURS = {State.GAP: "0.75", State.STICK: "tab:blue", State.SLIP: "tab:orange"}
# Along the longest axis.
_TICKS = 6
_NUMBERS = ("pressure", "traction", "gap", "slip", "coverage", "area", "dissipation", "augmentation", "share", "worn", "damage")


def drawn(positions: Reals, facets: list[Integers], states: States, what: str, axes: Any) -> Any:
    """The facets with a colour, each node with its state: the axes."""
    import matplotlib.pyplot as plt

    if what != "state" and what not in _NUMBERS:
        raise InvalidValue(f"what: {what!r}; 'state', {', '.join(map(repr, _NUMBERS))} are possible")
    solid = positions.shape[1] == 3
    if axes is None:
        axes = plt.figure(layout="constrained").add_subplot(**({"projection": "3d"} if solid else {}))
    corners = [row[states.bearing[row]] for row in facets]
    faces = [positions[row] for row in corners]
    if what == "state":
        _add(axes, faces, solid, facecolors="0.95", colors="0.8")
        for state in State:
            nodes = positions[states.bearing & (states.state == state)]
            axes.scatter(*nodes.T, color=_COLOURS[state], label=f"{state.name.lower()} ({len(nodes)})", zorder=3,
                         **({"depthshade": False} if solid else {}))
        axes.legend()
    else:
        values = np.asarray(getattr(states, what), dtype=np.float64)
        values = np.linalg.norm(values, axis=1) if values.ndim == 2 else values
        collection = _add(axes, faces, solid, array=np.array([values[row].mean() for row in corners]))
        axes.figure.colorbar(collection, ax=axes, label=what)
    low, high = positions.min(axis=0), positions.max(axis=0)
    margin = 0.1 * (high - low).max()
    for name, a, b in zip("xyz", low - margin, high + margin):
        axes.set(**{f"{name}lim": (a, b), f"{name}label": name})
        axes.locator_params(axis=name, nbins=max(1, round(_TICKS * (b - a) / (high - low + 2 * margin).max())))
    if solid:
        axes.set_box_aspect(high - low + 2 * margin)
    else:
        axes.set_aspect("equal")
    return axes


def _add(axes: Any, faces: list[Reals], solid: bool, array: Reals | None = None, facecolors: str | None = None,
         colors: str | None = None) -> Any:
    """Polygons in space, lines in the plane."""
    from matplotlib.collections import LineCollection
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    paint: dict[str, Any] = {} if array is not None else {"facecolors": facecolors} if solid else {"colors": colors}
    if solid:
        return axes.add_collection3d(Poly3DCollection(faces, array=array, edgecolors="0.3", linewidths=0.3, **paint))
    return axes.add_collection(LineCollection(faces, array=array, linewidths=4, **paint))
