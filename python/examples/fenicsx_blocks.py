"""Two elastic blocks in contact with friction, small strain: bodies by FEniCSx (dolfinx). Arguments: two_blocks.py.

It is tested with 0.5, Debian's. Where names have changed since, the newer ones are taken if they are there.
"""

import dolfinx.fem.petsc
import dolfinx.plot
import numpy as np
import scipy.sparse
import two_blocks
import ufl
from dolfinx import fem, mesh
from mpi4py import MPI


def block(lower, upper, cells, young, poisson):
    """A box of hexahedra: nodes, cells, forces and stiffness, unknowns node by node as dolfinx has them."""
    box = mesh.create_box(MPI.COMM_SELF, [lower, upper], cells, mesh.CellType.hexahedron)
    space = getattr(fem, "functionspace", fem.FunctionSpace)  # as it was called before 0.8
    V = space(box, ufl.VectorElement("Lagrange", box.ufl_cell(), 1) if hasattr(ufl, "VectorElement") else ("Lagrange", 1, (3,)))
    shear, lame = young / (2 * (1 + poisson)), young * poisson / ((1 + poisson) * (1 - 2 * poisson))
    u, v = ufl.TrialFunction(V), ufl.TestFunction(V)
    stress = 2 * shear * ufl.sym(ufl.grad(u)) + lame * ufl.div(u) * ufl.Identity(3)
    A = fem.petsc.assemble_matrix(fem.form(ufl.inner(stress, ufl.sym(ufl.grad(v))) * ufl.dx(metadata={"quadrature_degree": 3})))
    A.assemble()
    K = scipy.sparse.csr_matrix(A.getValuesCSR()[::-1], A.size)
    plot = getattr(dolfinx.plot, "vtk_mesh", None) or dolfinx.plot.create_vtk_mesh  # before 0.7
    topology, types, X = plot(V)
    return X, topology.reshape(len(types), -1)[:, 1:], lambda u: ((K @ u.ravel()).reshape(u.shape), K)


two_blocks.main("FEniCSx", block)
