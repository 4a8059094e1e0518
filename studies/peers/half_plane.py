"""Hertz' line contact of `tests/acceptance/quadratic_line.py` on hexahedra of 20 nodes, for programs that have them and tell
the forces of supports: a rigid parabola on a half-plane, the force on it against the analytic one."""

import numpy as np

import peers
import quadratic_line

TITLE = "Hertz, half-plane, 3.5 facets of hex20 over the half-width: force"
# Over the size of a facet.
HALF_WIDTH, PARTS = 3.5, 1
KIND = "hexahedron20"
SPACES = ("corner", "sub")
# Nodes on a face, over facets of size 1.
ON = 1e-9


def force_error(half):
    """Half of the parabola is there."""
    return abs(2 * abs(half) / quadratic_line.force(HALF_WIDTH) - 1)


def runs(driver):
    """(name, run) of the driver, with each space of multipliers"""
    path = quadratic_line.scene(driver, "hex20", HALF_WIDTH, PARTS)
    for space in SPACES:
        options = ("-contact_multiplier_space", space, "-output_vtu", "last", "-output_quiet", "true")
        yield f"stickslip, small displacements, {space}", driver.run(path, *options, label=f"compare_half_plane_{space}")


def case_of(run):
    """(Case, nodes of the parabola)"""
    points, kinds, _ = run.mesh()
    cells, bodies = kinds[KIND], run.cell_bodies(kind=KIND)
    bodies = bodies - bodies.min()
    block, parabola = (np.unique(cells[bodies == k]) for k in (0, 1))
    x, end = points[block], quadratic_line.ACROSS[-1]
    outer = block[(np.abs(x[:, 0] - end) < ON) | (np.abs(x[:, 2] + end) < ON)]
    field = quadratic_line.hertz_field(points[outer], HALF_WIDTH)
    fixed = [([n], c, u[c]) for n, u in zip(outer, field) for c in (0, 2)]
    fixed += [(block, 1, 0.0), (block[np.abs(x[:, 0]) < ON], 0, 0.0)]
    fixed += [(parabola, c, 0.0) for c in range(3)]
    foot = (np.abs(points[:, 2]) < ON) & (points[:, 0] < quadratic_line.WIDTH)
    under = np.abs(points[:, 2] - points[:, 0] ** 2 / (2 * quadratic_line.RADIUS)) < ON
    faces = [peers.faces_on(cells, points, bodies, body, on) for body, on in ((0, foot), (1, under))]
    young, poisson = quadratic_line.YOUNG, quadratic_line.POISSON
    return peers.Case("half_plane", points, cells, bodies, young, poisson, fixed, np.zeros_like(points), *faces), parabola
