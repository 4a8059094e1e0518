"""The parts of quadratic facets, drawn: parts.py [FILE], by default docs/figures/parts.svg. Node order and parts are those of
src/shape/parent.rs."""

import sys
from pathlib import Path

SIZE, GAP, MARGIN, LABEL = 170, 50, 26, 13

TRIANGLE = [(0, 0), (1, 0), (0, 1), (0.5, 0), (0.5, 0.5), (0, 0.5)]
SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1), (0.5, 0), (1, 0.5), (0.5, 1), (0, 0.5), (0.5, 0.5)]
KINDS = [
    ("6 nodes: tri6", TRIANGLE, 3, [(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)]),
    ("8 nodes: quad8", SQUARE[:8], 4, [(0, 4, 7), (4, 1, 5), (5, 2, 6), (6, 3, 7), (4, 5, 6, 7)]),
    ("9 nodes: quad9", SQUARE, 4, [(0, 4, 8, 7), (4, 1, 5, 8), (8, 5, 2, 6), (7, 8, 6, 3)]),
]


def facet(name, nodes, corners, parts, left):
    """A facet with its parts; corners, which have the multipliers, are full."""

    def at(k):
        x, y = nodes[k]
        return left + x * SIZE, MARGIN + (1 - y) * SIZE

    for part in parts:
        points = " ".join(f"{x:.1f},{y:.1f}" for x, y in map(at, part))
        yield f'<polygon points="{points}" fill="#e8eef7" stroke="#4a6fa5" stroke-width="1.2"/>'
    for k in range(len(nodes)):
        x, y = at(k)
        yield f'<circle cx="{x:.1f}" cy="{y:.1f}" r="5" fill="{"#c0392b" if k < corners else "white"}" stroke="#c0392b"/>'
        yield f'<text x="{x + 8:.1f}" y="{y - 7:.1f}">{k}</text>'
    yield f'<text x="{left:.1f}" y="{MARGIN + SIZE + 34}">{name}</text>'


def drawing():
    """All kinds in a row."""
    width = 2 * MARGIN + len(KINDS) * SIZE + (len(KINDS) - 1) * GAP
    height = MARGIN + SIZE + 64
    yield f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" font-size="{LABEL}">'
    yield f'<rect width="{width}" height="{height}" fill="white"/>'
    for place, kind in enumerate(KINDS):
        yield from facet(*kind, MARGIN + place * (SIZE + GAP))
    yield f'<text x="{MARGIN}" y="{MARGIN + SIZE + 56}">full: corners, which have the multipliers; hollow: mid nodes and centre</text>'
    yield "</svg>"


if __name__ == "__main__":
    default = Path(__file__).resolve().parents[2] / "docs/figures/parts.svg"
    Path(sys.argv[1] if len(sys.argv) > 1 else default).write_text("\n".join(drawing()) + "\n")
