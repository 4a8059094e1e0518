"""Two hyperelastic blocks in contact with friction, finite strain: bodies by FElupe. Usage: felupe_blocks.py [PICTURE]"""

import sys

import felupe
import numpy as np
import scipy.sparse
import two_blocks

SHEAR, BULK = 1.0, 5.0


def block(lower, upper, n):
    """A box of Neo-Hookean hexahedra."""
    mesh = felupe.Cube(a=lower, b=upper, n=n)
    field = felupe.FieldContainer([felupe.Field(felupe.RegionHexahedron(mesh), dim=3)])
    return mesh, field, felupe.SolidBody(felupe.NeoHooke(mu=SHEAR, bulk=BULK), field)


def facets_at(mesh, height):
    """The faces of cells whose four nodes are at this height."""
    at = np.isclose(mesh.points[mesh.cells][:, :, 2], height)
    return mesh.cells[at.sum(axis=1) == 4][at[at.sum(axis=1) == 4]].reshape(-1, 4)


bodies = [block((0.15, 0.1, 0.5), (0.95, 0.9, 1.0), (6, 6, 4)), block((0, 0, 0), (1.2, 1, 0.5), (8, 7, 4))]
(above, *_), (below, *_) = bodies
X = np.vstack([above.points, below.points])
count = len(above.points)


def internal(u):
    """Forces and stiffness of both bodies at these displacements."""
    forces, stiffness = [], []
    for (_, field, solid), part in zip(bodies, (u[:count], u[count:])):
        field[0].values[:] = part
        forces.append(solid.assemble.vector(field).toarray().ravel())
        stiffness.append(solid.assemble.matrix(field))
    return np.concatenate(forces), scipy.sparse.block_diag(stiffness, "csr")


upper = two_blocks.surface_facets(X, facets_at(above, 0.5), up=False)
lower = two_blocks.surface_facets(X, count + facets_at(below, 0.5), up=True)
top = np.flatnonzero(np.isclose(X[:, 2], 1.0))
bottom = np.flatnonzero(np.isclose(X[:, 2], 0.0))

path = [(0.0, -0.03 * k) for k in range(1, 5)] + [(0.03 * k, -0.12) for k in range(1, 7)]
result = two_blocks.solve(X, upper, lower, internal, 3 * SHEAR, top, bottom, path)
if len(sys.argv) > 1:
    two_blocks.draw(sys.argv[1], "FElupe", X, *result)
