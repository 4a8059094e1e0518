"""Facets of the skin: each once, seen from outside, mid nodes between their corners, whatever the cells and their order."""

from types import SimpleNamespace

import numpy as np
import pytest
import stickslip
from numpy_blocks import box

# Sums of products of coordinates near 1.
ROUNDING = 1e-13
# Corners of one cell of each kind, in VTK's order.
SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]
CORNERS = {
    "tetra": [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)],
    "hexahedron": [(*xy, z) for z in (0, 1) for xy in SQUARE],
    "wedge": [(*xy, z) for z in (0, 1) for xy in ((0, 0), (1, 0), (0, 1))],
    "pyramid": [*((*xy, 0) for xy in SQUARE), (0.5, 0.5, 1)],
    "triangle": [(0, 0), (1, 0), (0, 1)],
    "quad": SQUARE,
}
VOLUME = {"tetra": 1 / 6, "hexahedron": 1, "wedge": 1 / 2, "pyramid": 1 / 3, "triangle": 1 / 2, "quad": 1}
EDGES = {
    "tetra": [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)],
    "hexahedron": [*((k, (k + 1) % 4) for k in range(4)), *((4 + k, 4 + (k + 1) % 4) for k in range(4)), *((k, k + 4) for k in range(4))],
    "wedge": [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)],
    "pyramid": [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4)],
    "triangle": [(0, 1), (1, 2), (2, 0)],
    "quad": [(0, 1), (1, 2), (2, 3), (3, 0)],
}
FACES = {
    "hexahedron": [(0, 3, 7, 4), (1, 2, 6, 5), (0, 1, 5, 4), (3, 2, 6, 7), (0, 1, 2, 3), (4, 5, 6, 7), range(8)],
    "wedge": [(0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)],
    "pyramid": [(0, 1, 2, 3)],
    "quad": [range(4)],
}
KINDS = [("tetra", 4), ("tetra", 10), ("hexahedron", 8), ("hexahedron", 20), ("hexahedron", 27), ("wedge", 6), ("wedge", 15), ("wedge", 18),
         ("pyramid", 5), ("pyramid", 13), ("pyramid", 14), ("triangle", 3), ("triangle", 6), ("quad", 4), ("quad", 8), ("quad", 9)]


def cell(kind, count):
    """Nodes of one cell in VTK's order."""
    corners = np.array(CORNERS[kind], dtype=float)
    middles = [corners[list(place)].mean(axis=0) for place in [*EDGES[kind], *FACES.get(kind, [])]]
    return np.vstack([corners, *middles])[:count]


def volume(facets, X):
    """The integral of x . n over flat facets, over the dimension: below 0 where they are seen from inside."""
    total = 0.0
    for facet in facets:
        if X.shape[1] == 2:
            a, b = X[facet[:2]]
            total += (a[0] * b[1] - a[1] * b[0]) / 2
        else:
            x = X[facet[: {3: 3, 6: 3}.get(len(facet), 4)]]
            total += sum(np.dot(x[0], np.cross(x[k], x[k + 1])) / 6 for k in range(1, len(x) - 1))
    return total


def check_mids(facets, X):
    for facet in facets:
        n = 2 if X.shape[1] == 2 else {3: 3, 6: 3}.get(len(facet), 4)
        for k, mid in enumerate(facet[n : 2 * n if n > 2 else 3]):
            np.testing.assert_allclose(X[mid], (X[facet[k]] + X[facet[(k + 1) % n]]) / 2, atol=ROUNDING)
        if len(facet) == 9:
            np.testing.assert_allclose(X[facet[8]], X[facet[:4]].mean(axis=0), atol=ROUNDING)


@pytest.mark.parametrize("kind, count", KINDS)
@pytest.mark.parametrize("mirrored", [False, True])
def test_the_skin_of_one_cell(kind, count, mirrored):
    X = cell(kind, count)
    if mirrored:  # cells whose corners go round the other way
        X[:, 0] *= -1
    facets = stickslip.skin(np.arange(count)[None], X)
    assert volume(facets, X) == pytest.approx(VOLUME[kind], abs=ROUNDING)
    check_mids(facets, X)
    on_facets = np.unique(np.concatenate([np.asarray(facet) for facet in facets]))
    inside = {("hexahedron", 27), ("quad", 9)}
    assert len(on_facets) == count - ((kind, count) in inside)
    stickslip.Surface(X, facets)  # of kinds that it knows


@pytest.mark.parametrize("kind, count", [kind for kind in KINDS if len(EDGES[kind[0]]) + len(CORNERS[kind[0]]) <= kind[1]])
def test_mid_nodes_are_found_by_their_place(kind, count):
    n, X = len(CORNERS[kind]), cell(kind, count)
    rest = np.random.default_rng(1).permutation(np.arange(n, count))
    row = np.concatenate([np.arange(n), rest])[None]
    facets = stickslip.skin(row, X)
    check_mids(facets, X)


def test_mid_nodes_of_thin_shells_that_bow_more_than_they_are_thick():
    X = cell("hexahedron", 20)
    angle, radius = X[:, 0] * 0.6, 1 + 0.01 * X[:, 1]  # the arc rises by 0.045, and the wall is 0.01
    bent = np.column_stack([radius * np.sin(angle), radius * np.cos(angle), X[:, 2]])
    facets = stickslip.skin(np.arange(20)[None], bent)
    check_mids(facets, X)


@pytest.mark.parametrize("order", [[0, 1, 3, 2, 4, 5, 7, 6], [0, 4, 3, 1, 7, 5, 2, 6]])
def test_corners_in_the_orders_of_fenicsx_and_scikit_fem(order):
    X, cells = box((0, 0, 0), (3, 2, 0.01), (3, 2, 4))
    facets = stickslip.skin(cells[:, order], X)
    assert facets.shape == (2 * (6 + 12 + 8), 4) and volume(facets, X) == pytest.approx(0.06, abs=ROUNDING)


def test_what_is_selected():
    X, cells = box((0, 0, 0), (1, 1, 1), (3, 3, 3))
    bottom = stickslip.skin(cells, X, lambda x: x[2] == 0)
    assert bottom.shape == (9, 4) and (X[bottom, 2] == 0).all()
    assert np.array_equal(bottom, stickslip.skin(cells, X, np.flatnonzero(X[:, 2] == 0)))
    assert len(stickslip.skin(cells, X)) == 54
    for select, words in ((lambda x: x[2] < 0, "no facet"), (lambda x: x[2], "boolean"), ([0.5], "function of coordinates or node numbers")):
        with pytest.raises(stickslip.Error, match=f"^select: .*{words}"):
            stickslip.skin(cells, X, select)


def test_two_cells_of_different_kinds_share_a_face():
    X = np.vstack([cell("hexahedron", 8), [(0.5, 0.5, 2)]])
    facets = stickslip.skin({"hexahedron": np.arange(8)[None], "pyramid": np.array([[4, 5, 6, 7, 8]]), "line": np.array([[0, 1]]),
                             "quad": np.array([[0, 1, 2, 3]])}, X)
    assert sorted(map(len, facets)) == [3] * 4 + [4] * 5
    assert volume(facets, X) == pytest.approx(4 / 3, abs=ROUNDING)


def test_meshes_of_other_libraries_are_taken_as_they_are():
    X, cells = box((0, 0, 0), (1, 1, 1), (2, 2, 2))
    whole = stickslip.skin(cells, X)
    for mesh in (SimpleNamespace(cells_dict={12: cells, 9: whole[:3]}, points=X),  # pyvista: VTK's numbers
                 SimpleNamespace(cells=cells, points=X),  # FElupe
                 SimpleNamespace(t=cells.T, p=X.T)):  # scikit-fem
        assert np.array_equal(stickslip.skin(mesh), whole)
    meshio = pytest.importorskip("meshio", reason="the mesh is meshio's, which is not installed")
    assert np.array_equal(stickslip.skin(meshio.Mesh(X, [("vertex", np.array([[0]])), ("hexahedron", cells)])), whole)
    flat = meshio.Mesh([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [("triangle", np.array([[0, 1, 2]]))])
    assert stickslip.skin(flat).shape == (3, 2)


@pytest.mark.parametrize("kind, degree, count", [("tetrahedron", 1, 3), ("tetrahedron", 2, 6), ("hexahedron", 1, 4), ("hexahedron", 2, 9)])
def test_cells_as_fenicsx_draws_them(kind, degree, count):
    plot = pytest.importorskip("dolfinx.plot", reason="the cells are those of dolfinx, which is not installed")
    from dolfinx import fem, mesh
    from mpi4py import MPI

    made = mesh.create_unit_cube(MPI.COMM_SELF, 2, 2, 2, getattr(mesh.CellType, kind))
    space = getattr(fem, "functionspace", fem.FunctionSpace)(made, ("Lagrange", degree))
    topology, types, X = (getattr(plot, "vtk_mesh", None) or plot.create_vtk_mesh)(space)
    facets = stickslip.skin(topology.reshape(len(types), -1)[:, 1:], X)
    assert facets.shape[1] == count and volume(facets, X) == pytest.approx(1, abs=ROUNDING)
    check_mids(facets, X)


@pytest.mark.parametrize("kind, count", [("Tet", 6), ("Hex", 9)])
def test_cells_of_order_2_of_scikit_fem(kind, count):
    skfem = pytest.importorskip("skfem", reason="the cells are those of scikit-fem, which is not installed")
    basis = skfem.Basis(getattr(skfem, f"Mesh{kind}")().refined(1), getattr(skfem, f"Element{kind}{'P' if kind == 'Tet' else ''}2")())
    facets = stickslip.skin(basis.element_dofs.T, basis.doflocs.T)
    assert facets.shape[1] == count and volume(facets, basis.doflocs.T) == pytest.approx(1, abs=ROUNDING)
    check_mids(facets, basis.doflocs.T)


def test_cells_that_are_none_are_refused_by_name():
    X, cells = box((0, 0, 0), (1, 1, 1), (2, 2, 2))
    for bad, points, words in ((cells, None, "X: .*is needed"), (cells, X[0], "X: shape"), (cells[:, :7], X, "cells: 7 nodes"),
                               (cells + 1, X, "cells: node 27"), (cells * 1.0, X, "cells: 2-D float64"),
                               (cells[:, [0, 2, 1, 3, 4, 6, 5, 7]], X, "cells: the corners of cells with 8 nodes"),
                               ({"line": cells[:, :2]}, X, "cells: none has an inside; there are line")):
        with pytest.raises(stickslip.Error, match=f"^{words}"):
            stickslip.skin(bad, points)
    stray = cell("tetra", 10)
    stray[4] += 0.6
    with pytest.raises(stickslip.Error, match="near the middle of its nodes 0 and 1"):
        stickslip.skin(np.arange(10)[None], stray)
