"""Two hyperelastic blocks in contact with friction, finite strain: bodies by FElupe. Arguments: two_blocks.py."""

import felupe
import two_blocks


def block(lower, upper, cells, young, poisson):
    """A box of Neo-Hookean hexahedra: nodes, cells, forces and stiffness."""
    mesh = felupe.Cube(a=lower, b=upper, n=tuple(count + 1 for count in cells))
    field = felupe.FieldContainer([felupe.Field(felupe.RegionHexahedron(mesh), dim=3)])
    shear, lame = young / (2 * (1 + poisson)), young * poisson / ((1 + poisson) * (1 - 2 * poisson))
    solid = felupe.SolidBody(felupe.NeoHookeCompressible(mu=shear, lmbda=lame), field)

    def internal(u):
        field[0].values[:] = u
        forces = solid.assemble.vector(field).toarray().reshape(u.shape)
        return forces, solid.assemble.matrix(field)

    return mesh.points, mesh.cells, internal


two_blocks.main("FElupe", block, moves_along=True)
