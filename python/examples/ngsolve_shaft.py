"""A shaft that is too thick for its hub, by curved triangles of order 2 of NGSolve. Arguments: shaft_in_hub.py.

NGSolve's unknowns of order 2 are no displacements of mid nodes: S makes those of vertices and middles of edges from them.
"""

import netgen.occ as occ
import numpy as np
import scipy.sparse
import shaft_in_hub
from ngsolve import H1, VOL, BilinearForm, Grad, InnerProduct, IntegrationRule, Mesh, VectorH1, div, dx
from shaft_in_hub import POISSON, YOUNG

VERTICES = np.array([(1.0, 0.0), (0.0, 1.0), (0.0, 0.0)])  # of the reference triangle


def nodes_of(mesh):
    """Nodes (n, 2), triangles with six nodes, and the values at the nodes from the unknowns of H1 of order 2, a matrix."""
    space, n = H1(mesh, order=2), mesh.nv + mesh.nedge
    X, S, cells = np.zeros((n, 2)), scipy.sparse.lil_matrix((n, space.ndof)), []
    for element in mesh.Elements(VOL):
        corners = [vertex.nr for vertex in element.vertices]
        ends = [[corners.index(vertex.nr) for vertex in mesh[edge].vertices] for edge in element.edges]
        cells.append(corners + [mesh.nv + edge.nr for edge in element.edges])
        places = np.vstack([VERTICES, [VERTICES[pair].mean(axis=0) for pair in ends]])
        trafo, rule = mesh.GetTrafo(element), IntegrationRule([*map(tuple, places)], [0.0] * 6)
        for node, place, point in zip(cells[-1], places, rule):
            mapped = trafo(point)  # by a name: its point is gone with it
            X[node] = mapped.point
            S[node, list(space.GetDofNrs(element))] = space.GetFE(element).CalcShape(*place).NumPy()[None]
    return X, np.array(cells), S


def ring(inner, outer, size):
    """What shaft_in_hub.py asks for."""
    shape = (occ.WorkPlane().Circle(outer).Face() - occ.WorkPlane().Circle(inner).Face()) * occ.WorkPlane().Rectangle(3, 3).Face()
    shape.edges.Min(occ.X).name, shape.edges.Min(occ.Y).name = "left", "bottom"
    mesh = Mesh(occ.OCCGeometry(shape, dim=2).GenerateMesh(maxh=size)).Curve(2)
    V = VectorH1(mesh, order=2, dirichletx="left", dirichlety="bottom")
    u, v = V.TnT()
    strain, test = (0.5 * (Grad(w) + Grad(w).trans) for w in (u, v))
    shear, lame = YOUNG / (2 * (1 + POISSON)), YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
    form = BilinearForm((2 * shear * InnerProduct(strain, test) + lame * div(u) * div(v)) * dx).Assemble()
    K = scipy.sparse.csr_matrix(tuple(np.array(part) for part in form.mat.CSR()))
    X, cells, S = nodes_of(mesh)
    order = np.arange(V.ndof).reshape(-1, 2).T.ravel()  # the unknowns along x come before those along y
    return X, cells, K, np.flatnonzero(~np.array(V.FreeDofs())), scipy.sparse.kron(S, np.eye(2)).tocsc()[:, order]


shaft_in_hub.main("NGSolve", ring)
