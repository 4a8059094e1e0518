"""Two plates one above the other under one facet: only the nearer may be given its force.

Plates side by side, at several heights, are no layers: each has the force of what it covers.
"""

import numpy as np

from cell import ELEMENT, Outcome, series
from cases.assembled import OPTIONS, grid, pressed
from library import Interface, Refused, fade

GAPS = ("1", "0.2", "1e-2", "1e-4", "1e-6", "1e-8")
SIZES = ("3", "0.9", "0.5", "0.1", "1e-2", "1e-3")  # of the plates, over the facet's
SIDE_BY_SIDE = ("0", "1e-12", "1e-9", "1e-7", "1e-5", "1e-3")  # how far each reaches over the next, over its size
EXACT = 1e-12  # sums of a few products of numbers around 1


def together(*plates):
    nodes, facets, first = [], [], 0
    for x, f in plates:
        nodes.append(x)
        facets.append(f + first)
        first += len(x)
    return np.concatenate(nodes), np.concatenate(facets)


# A case of lines gives a `mesh` of its own, such as lines.grid, and the model among its options.
def vertical(plates, mesh=grid, **options):
    """What the plates are given of a unit pressure on the facet above them."""

    def run(context):
        outcome, library = Outcome(), context.library
        x1, f1 = mesh(1, down=True)
        x2, f2 = together(*plates)
        try:
            interface = Interface(library, x1, f1, x2, f2, **OPTIONS, **options)
        except Refused as refusal:
            outcome.refusal = str(refusal)
            return outcome
        force = interface.residual(x1, x2, pressed(x1, (0.0, 0.0, -1.0)))[1][:, -1]
        interface.close()
        ends = np.cumsum([len(x) for x, _ in plates])
        given = [abs(part.sum()) for part in np.split(force, ends[:-1])]
        return outcome, given

    return run


def stacked(size, gap, mesh=grid, **options):
    corner = (0.5 - 0.5 * size, 0.5 - 0.5 * size)
    plates = (mesh(2, corner, size), mesh(3, corner, size, z=-gap))

    def run(context):
        found = vertical(plates, mesh, **options)(context)
        if isinstance(found, Outcome):
            return found
        outcome, (near, far) = found
        covered = min(size, 1.0) ** (plates[0][0].shape[1] - 1)
        outcome.below("force of the farther plate over the nearer one's share", far / covered, EXACT, "it bears nothing")
        error = abs(near / covered - fade(covered))
        outcome.below("force of the nearer plate", error, EXACT, "the pressure on what it covers")
        return outcome

    return run


def beside(text):
    over, size = float(text), 0.25
    plates = [
        grid(1 + k % 3, (size * (k % 4), size * (k // 4)), size * (1 + over), z=-0.2 * (k % 3)) for k in range(16)
    ]

    def run(context):
        found = vertical(plates)(context)
        if isinstance(found, Outcome):
            return found
        outcome, given = found
        # What reaches over is given twice; the outermost reach over the facet's edge.
        error = max(abs(force / size**2 - 1) for force in given)
        outcome.below("force of each plate", error, 3 * over + EXACT, "the pressure on what it covers")
        return outcome

    return run


def cells():
    more = {"kind": ELEMENT}
    yield from series("layers, gap between them", GAPS, lambda t: stacked(0.5, float(t)), quick=("0.2", "1e-8"), **more)
    yield from series("layers, plates over facet", SIZES, lambda t: stacked(float(t), 0.2), quick=("3", "1e-3"), **more)
    near = lambda t: stacked(float(t), 0.2, search_distance=0.1)
    yield from series("layers with search distance, plates over facet", SIZES, near, kind=ELEMENT, quick=("0.1",))
    yield from series("plates side by side, overlap", SIDE_BY_SIDE, beside, kind=ELEMENT, quick=("0", "1e-9"))
