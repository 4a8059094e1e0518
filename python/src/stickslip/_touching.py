"""Who touches whom, in words."""

from __future__ import annotations

from typing import Any

import numpy as np

from .results import Reals, SkinFacets, State, States
from .skin import Integers


def told(found: dict[str, Any], facets: SkinFacets, point: tuple[States, Reals] | None, rows: tuple[list[Integers], list[Integers]]) -> str:
    """Sentences about a skin. ``point``: the states of copies and the forces on nodes; ``rows``: nodes and copies of each facet."""
    lines = [f"{_many(found['bodies'], 'body', 'bodies')}; {_many(found['pairs'], 'pair')} of facets may touch in this step, in "
             f"{_many(found['pieces'], 'piece')}."]
    own, other = facets.body, np.where(facets.partner < 0, -1, facets.body[facets.partner])
    bears = facets.side == 1
    both = {(min(a, b), max(a, b)) for a, b in zip(own[bears].tolist(), other[bears].tolist())}
    for a, b in sorted(both):
        which = np.flatnonzero(bears & (np.minimum(own, other) == a) & (np.maximum(own, other) == b))
        who = f"Body {a} and itself" if a == b else f"Bodies {a} and {b}"
        line = f"{who}: {_many(len(which), 'facet')} within reach, the nearest {facets.distance[which].min():.3g} away"
        lines.append(line + ("." if point is None else f"; {pressing(point[0], np.unique(np.concatenate([rows[1][f] for f in which])))}"))
    lonely = sorted(set(own.tolist()) - set(own[facets.partner >= 0].tolist()))
    if lonely:
        lines.append(f"Nothing is within reach of {_listed(lonely)}.")
    if point is not None:
        lines += _forces(own, point[1], rows[0])
    if found["contradictions"]:
        lines.append(f"{_many(found['contradictions'], 'pair')} of facets could not be put on different sides, and cannot touch.")
    if found["exchanged"]:
        lines.append(f"Facets in contact have exchanged their sides {_many(found['exchanged'], 'time')}.")
    if found["missed"]:
        lines.append(f"Facets have met out of reach, and the step was refused, {_many(found['missed'], 'time')}.")
    return "\n".join(lines)


def pressing(states: States, copies: Integers) -> str:
    """What some nodes do."""
    state, pressure = states.state[copies], states.pressure[copies]
    closed = state != State.GAP
    if not closed.any():
        return "no node is in contact."
    return (f"{_many(int(closed.sum()), 'node')} in contact, {(state == State.STICK).sum()} stick and {(state == State.SLIP).sum()} slip, "
            f"the largest pressure is {pressure[closed].max():.3g}.")


def force(on: str, vector: Reals) -> str:
    """A force on a body or a side; -0 is 0."""
    return f"The force of contact on {on} is ({', '.join(f'{value + 0.0:.4g}' for value in vector)})."


def _forces(body: Integers, forces: Reals, nodes: list[Integers]) -> list[str]:
    """The sum of each body's forces; a node of several bodies counts for the first."""
    of_node = np.full(len(forces), -1)
    for f in range(len(nodes) - 1, -1, -1):
        of_node[nodes[f]] = body[f]
    told = []
    for number in np.unique(body):
        total = forces[of_node == number].sum(axis=0)
        if total.any():
            told.append(force(f"body {number}", total))
    return told


def _many(count: int, one: str, more: str | None = None) -> str:
    return f"{count} {one if count == 1 else more or one + 's'}"


def _listed(numbers: list[int]) -> str:
    most = 10
    text = ", ".join(map(str, numbers[:most])) + (f" and {len(numbers) - most} others" if len(numbers) > most else "")
    return f"body {text}" if len(numbers) == 1 else f"bodies {text}"
