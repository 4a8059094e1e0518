"""Plane problems as a layer of hexahedra, for programs that have contact in space: the mesh of a plane run, one cell deep, held in depth."""

import numpy as np

import peers

# Bounds of other programs are absolute: with moduli near 1 some of them would be met by what is no answer.
STIFFER = 1000.0
# Nodes on a line, in lengths near 1.
ON = 1e-9


def case_of(name, run, depth, young, poisson, held, sides, symmetric=False, whole=False, punch=None, **further):
    """`held`: (are nodes x?, component), which move as in `run`; `sides`: are nodes x on the sides in contact? The first body has the
    multipliers. `punch`: (plane points, quads, how they move) of a rigid
    second body that the run has no mesh of. `symmetric` about x = 0, where nodes are held along x but for those of the other side, or both halves if `whole`."""
    plane, kinds, displacement = run.mesh()
    plane, displacement = plane[:, :2], displacement[:, :2]
    quads, bodies = kinds["quad"], run.cell_bodies(kind="quad")
    bodies = bodies - bodies.min()
    if punch:
        more, corners, moved = punch
        quads, bodies = np.vstack([quads, corners + len(plane)]), np.append(bodies, np.ones(len(corners), int))
        plane, displacement = np.vstack([plane, more]), np.vstack([displacement, np.tile(moved, (len(more), 1))])
    if whole:
        plane, displacement, quads, bodies = mirrored(plane, displacement, quads, bodies)
    count, zero = len(plane), np.zeros(len(plane))
    points = np.vstack([np.column_stack([plane, zero]), np.column_stack([plane, zero + depth])])
    bodies_nodes = [np.isin(np.arange(count), quads[bodies == body]) for body in (0, 1)]
    if symmetric and not whole:
        held = [*held, (lambda x: (np.abs(x[:, 0]) < ON) & bodies_nodes[0], 0)]
    fixed = [(np.arange(2 * count), 2, 0.0)]
    for body, where, c in [(0, *each) for each in held] + [(1, lambda x: np.ones(len(x), bool), c) for c in (0, 1)]:
        fixed += [([n, n + count], c, displacement[n, c]) for n in np.flatnonzero(where(plane) & bodies_nodes[body])]
    cells = np.hstack([quads, quads + count])
    faces = [peers.faces_on(cells, points, bodies, body, np.tile(on(plane), 2)) for body, on in enumerate(sides)]
    return peers.Case(name, points, cells, bodies, STIFFER * young, poisson, fixed, np.zeros_like(points), *faces, **further)


def mirrored(plane, displacement, quads, bodies):
    """Both halves of what is symmetric about x = 0."""
    off = np.abs(plane[:, 0]) > ON
    other = np.arange(len(plane))
    other[off] = len(plane) + np.arange(off.sum())
    turned = other[quads][:, ::-1]
    return (np.vstack([plane, plane[off] * [-1, 1]]), np.vstack([displacement, displacement[off] * [-1, 1]]),
            np.vstack([quads, turned]), np.tile(bodies, 2))


def profile(case, displacement):
    """(x, nodal forces per depth along x and y) of the non-mortar side, as moduli are in the plane run."""
    nodes = np.unique([case.cells[cell][list(peers.FACES[face])] for cell, face in case.nonmortar])
    force = peers.internal_forces(case, displacement)[nodes]
    x, group = np.unique(np.round(case.points[nodes, 0], 9), return_inverse=True)
    depth = np.ptp(case.points[:, 2]) * STIFFER
    return x, *(np.bincount(group, weights=force[:, c]) / depth for c in (0, 1))
