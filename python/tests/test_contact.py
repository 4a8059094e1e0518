"""Contact on the host's vectors: what it adds, its derivative, several interfaces, mid nodes, condensed, maps, commits."""

import re

import numpy as np
import pytest
import scipy.sparse
import stickslip
from bodies import HEIGHT, YOUNG, Blocks
from numpy_blocks import block, box

# Central differences with this step: truncation and rounding both are below 1e-6 of the largest entry.
STEP = 1e-6
DIFFERENCES = 1e-6
# Condensed multipliers change fast with displacements, and truncation with the square of the step.
CONDENSED_STEP = 1e-7
# Sums of the same products in another order.
ROUNDING = 1e-12
# Two linear solvers' rounding, over the displacements.
SAME = 1e-11
# Rounding of a linear solver, of a constant pressure.
PATCH = 1e-11
GRIP = (2e-3, 8e-4, -5e-3)


@pytest.fixture(scope="module")
def blocks():
    return Blocks()


def pressed(contact, X, seed=1):
    """A point in contact that is not at an edge of any law."""
    random, x = np.random.default_rng(seed), contact.start()
    x[: X.size] += 1e-4 * random.standard_normal(X.size)
    x[: X.size].reshape(X.shape)[X[:, 2] > HEIGHT, 2] -= 1e-3
    x[X.size :] -= 1 + 0.1 * random.random(len(x) - X.size)
    return x


def quad8(X, facets):
    """Facets with mid nodes, and all nodes."""
    pairs = np.sort(np.stack([facets, np.roll(facets, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    edges, which = np.unique(pairs, axis=0, return_inverse=True)
    return np.hstack([facets, len(X) + which.reshape(facets.shape)]), np.vstack([X, X[edges].mean(axis=1)])


def check_derivative(contact, x):
    def residual(x):
        r = np.zeros(contact.size)
        contact.add_residual(x, r)
        return r

    tangent = contact.tangent(x)
    for direction in np.random.default_rng(3).standard_normal((3, len(x))):
        difference = (residual(x + STEP * direction) - residual(x - STEP * direction)) / (2 * STEP)
        assert np.abs(tangent @ direction - difference).max() < DIFFERENCES * np.abs(tangent @ direction).max()


def test_the_tangent_is_the_derivative(blocks):
    contact = blocks.contact()
    x = pressed(contact, blocks.X)
    check_derivative(contact, x)
    whole = contact.tangent(x, blocks.K)
    assert abs(whole[: blocks.X.size, : blocks.X.size] - contact.tangent(x)[: blocks.X.size, : blocks.X.size] - blocks.K).max() == 0


def test_mid_nodes_have_no_multipliers_and_share_the_pressure(blocks):
    facets1, X = quad8(blocks.X, blocks.facets[0])
    facets2, X = quad8(X, blocks.facets[1])
    contact = stickslip.Contact(X).add(facets1, facets2, **blocks.options)
    assert contact.n_multipliers == 3 * 16 < facets1.size
    x, r = contact.start(), np.zeros(contact.size)
    x[X.size + 2 :: 3] = -5.0
    x[X.size :: 3] = x[X.size + 1 :: 3] = 0.0
    contact.add_residual(x, r)
    force = -r[: X.size].reshape(X.shape)  # on the bodies
    edge = 0.8 / 3
    # The element's own nodal forces of a constant pressure: -1/12 of a facet's at a corner, 1/3 at a mid node.
    corner = np.isclose(X[:, 0], 0.1) & np.isclose(X[:, 1], 0.1) & np.isclose(X[:, 2], HEIGHT)
    np.testing.assert_allclose(force[corner], [[0, 0, -5 * edge**2 / 12]], atol=ROUNDING)
    on_edge = np.isclose(X[:, 0], 0.1 + edge / 2) & np.isclose(X[:, 1], 0.1) & np.isclose(X[:, 2], HEIGHT)
    np.testing.assert_allclose(force[on_edge], [[0, 0, 5 * edge**2 / 3]], atol=ROUNDING)
    check_derivative(contact, pressed(contact, X))
    states = contact.states(x)[0]
    assert str(states) == "0 gap 16 stick 0 slip" and repr(states) == "<States of 16 nodes: 0 gap 16 stick 0 slip>"
    assert np.isin(np.unique(facets1)[states.bearing], facets1[:, :4]).all()


def test_with_sub_multipliers_mid_nodes_have_them(blocks):
    facets1, X = quad8(blocks.X, blocks.facets[0])
    contact = stickslip.Contact(X).add(facets1, blocks.facets[1], multiplier_space="sub", **blocks.options)
    assert contact.n_multipliers == 3 * len(np.unique(facets1))


def test_condensed_is_the_same_answer_with_the_same_iterations(blocks):
    whole, few = blocks.contact(), blocks.contact(condensed=True)
    assert (whole.size, few.size) == (blocks.X.size + 48, blocks.X.size)
    (x, iterations), (y, fewer) = blocks.solve(whole, GRIP), blocks.solve(few, GRIP)
    assert iterations == fewer
    np.testing.assert_allclose(y, x[: few.size], atol=SAME * np.abs(y).max())
    for one, other in zip(whole.states(x), few.states(y)):
        assert np.array_equal(one.state, other.state)
        np.testing.assert_allclose(one.traction, other.traction, atol=SAME * YOUNG * np.abs(y).max())
    whole.commit(x)
    few.commit(y)
    with pytest.raises(stickslip.Error, match="^x: condensed multipliers follow"):
        few.balanced(y + 1.0)
    with pytest.raises(stickslip.Error, match="^K: the host's matrix"):
        few.tangent(y)


def test_the_condensed_tangent_is_the_derivative(blocks):
    contact = blocks.contact(condensed=True)
    contact.start()
    x = pressed(contact, blocks.X)

    def residual(x):
        r = blocks.K @ x
        contact.add_residual(x, r)
        return r

    residual(x)
    tangent = contact.tangent(x, blocks.K)
    for direction in np.random.default_rng(3).standard_normal((3, len(x))):
        difference = (residual(x + CONDENSED_STEP * direction) - residual(x - CONDENSED_STEP * direction)) / (2 * CONDENSED_STEP)
        assert np.abs(tangent @ direction - difference).max() < DIFFERENCES * np.abs(tangent @ direction).max()


def test_a_matrix_of_dofs_is_a_change_of_unknowns(blocks):
    # As of hierarchical elements: displacements are sums of unknowns.
    n = blocks.X.size
    S = scipy.sparse.identity(n) + scipy.sparse.diags([0.3], [5], shape=(n, n))
    plain, mapped = blocks.contact(), blocks.contact(dofs=S)
    x = pressed(plain, blocks.X)
    y = x.copy()
    y[:n] = scipy.sparse.linalg.spsolve(S.tocsc(), x[:n])
    r, s = np.zeros(plain.size), np.zeros(plain.size)
    plain.add_residual(x, r)
    mapped.add_residual(y, s)
    np.testing.assert_allclose(s[:n], S.T @ r[:n], atol=ROUNDING)
    np.testing.assert_allclose(s[n:], r[n:], atol=ROUNDING)
    check_derivative(mapped, y)
    with pytest.raises(stickslip.Error, match="^dofs: 3 rows"):
        stickslip.Contact(blocks.X, S.tocsr()[:3])


def test_unknowns_of_the_host_are_where_it_says(blocks):
    order = np.random.default_rng(2).permutation(blocks.X.size + 7)[: blocks.X.size].reshape(blocks.X.shape)
    plain, other = blocks.contact(), blocks.contact(dofs=order.astype(np.int32), size=blocks.X.size + 7)
    x = pressed(plain, blocks.X)
    y = np.zeros(other.size)
    y[order.ravel()], y[other.n_host :] = x[: blocks.X.size], x[blocks.X.size :]
    r, s = np.zeros(plain.size), np.zeros(other.size)
    plain.add_residual(x, r)
    other.add_residual(y, s)
    np.testing.assert_array_equal(s[order.ravel()], r[: blocks.X.size])
    with pytest.raises(stickslip.Error, match="^size: 5, and dofs has"):
        blocks.contact(size=5)


def test_what_is_prescribed_on_both_sides_has_no_multiplier(blocks):
    dofs = blocks.dofs.copy()
    plane = np.isclose(blocks.X[:, 1], 0.1) & np.isclose(blocks.X[:, 2], HEIGHT)  # nodes of the first side alone
    held = blocks.contact().n_multipliers - stickslip.Contact(blocks.X).add(
        *blocks.facets, held=dofs[plane, 1], **blocks.options).n_multipliers
    assert held == plane.sum() == 4
    dofs[plane, 1] = -1  # the other side can move
    assert stickslip.Contact(blocks.X, dofs).add(*blocks.facets, **blocks.options).n_multipliers == 48
    table = stickslip.Surface([(-1, -1, HEIGHT), (2, -1, HEIGHT), (2, 2, HEIGHT), (-1, 2, HEIGHT)], [[0, 1, 2, 3]])
    assert stickslip.Contact(blocks.X, dofs).add(blocks.facets[0], table, **blocks.options).n_multipliers == 44
    # One multiplier a node without friction: it stays, and the normal does not turn that way.
    contact = stickslip.Contact(blocks.X).add(*blocks.facets, friction="none", held=blocks.dofs[plane, 1], modulus=YOUNG)
    assert contact.n_multipliers == 16
    check_derivative(contact, pressed(contact, blocks.X))


def test_a_rigid_table_moves_by_its_coordinates(blocks):
    table = stickslip.Surface([(-1, -1, HEIGHT), (2, -1, HEIGHT), (2, 2, HEIGHT), (-1, 2, HEIGHT)], [[0, 1, 2, 3]])
    contact = stickslip.Contact(blocks.X).add(blocks.facets[0], table, **blocks.options)
    x = contact.start()
    assert contact.states(x)[0].count(stickslip.State.GAP) == 0
    table.coordinates[:, 2] -= 0.01
    assert contact.states(x)[0].count(stickslip.State.GAP) == 16
    moving = stickslip.Surface(table.coordinates, [[0, 1, 2, 3]], np.arange(12).reshape(4, 3))
    with pytest.raises(stickslip.Error, match="^facets2: a Surface with unknowns"):
        stickslip.Contact(blocks.X).add(blocks.facets[0], moving, **blocks.options)


def test_an_analytic_plane_is_the_same_table(blocks):
    frame = stickslip.Surface([(0.5, 0.5, HEIGHT), (0.5, 0.5, HEIGHT + 1), (1.5, 0.5, HEIGHT), (0.5, 1.5, HEIGHT)], [])
    table = stickslip.Surface([(-1, -1, HEIGHT), (2, -1, HEIGHT), (2, 2, HEIGHT), (-1, 2, HEIGHT)], [[0, 1, 2, 3]])
    of_plane = stickslip.Contact(blocks.X).add(blocks.facets[0], frame, mortar_side="analytic", shape="plane", **blocks.options)
    of_facets = stickslip.Contact(blocks.X).add(blocks.facets[0], table, **blocks.options)
    x = of_facets.start()
    x[2 : blocks.X.size : 3] -= 1e-3  # flat: on a facet that leans the two project in different ways
    x[blocks.X.size :] -= 1 + np.arange(48) / 48
    residuals = []
    for contact in (of_plane, of_facets):
        residuals.append(np.zeros(contact.size))
        contact.add_residual(x, residuals[-1])
    np.testing.assert_allclose(*residuals, atol=ROUNDING)


def test_a_crease_has_multipliers_a_face():
    X, cells = box((0, 0, 0), (1, 1, 1), (2, 2, 2))
    both = stickslip.skin(cells, X, lambda x: (x[2] == 0) | (x[0] == 0))
    both = both[((X[both, 2] == 0).all(axis=1)) | ((X[both, 0] == 0).all(axis=1))]
    channel = stickslip.Surface([(-1, -1, 0), (2, -1, 0), (2, 2, 0), (-1, 2, 0), (0, -1, -1), (0, 2, -1), (0, 2, 2), (0, -1, 2)],
                                [[0, 1, 2, 3], [4, 5, 6, 7]])
    options = {"modulus": YOUNG, "mu": 0.3}
    contact = stickslip.Contact(X).add(both, channel, crease=0.7, **options)
    assert contact.n_multipliers == 3 * 18
    x, r = contact.start(), np.zeros(contact.size)
    contact.add_residual(x, r)
    assert np.isfinite(r).all() and contact.states(x)[0].count(stickslip.State.GAP) == 0


def test_all_interfaces_accept_a_step_or_none():
    first, second = Blocks(normals="committed"), Blocks(normals="committed")
    X = np.vstack([first.X, second.X + [5, 0, 0]])
    contact = stickslip.Contact(X)
    for facets in (first.facets, [facets + len(first.X) for facets in second.facets]):
        contact.add(*facets, **first.options)
    x = contact.start()
    assert contact.n_multipliers == 96 and len(contact.interfaces) == len(contact.states(x)) == 2
    turned = x.copy()  # the second pair as a whole, by more than a commit with normals of t_n takes
    away = X[len(first.X) :] - X[len(first.X)]
    turn = np.array([[0.6, 0, 0.8], [0, 1, 0], [-0.8, 0, 0.6]])
    turned[first.X.size : X.size] = (away @ turn.T - away).ravel()
    before = [face.history()["reals"] for face in contact.interfaces]
    with pytest.raises(stickslip.errors.TurnedTooFar):
        contact.commit(turned)
    assert all(np.array_equal(face.history()["reals"], reals) for face, reals in zip(contact.interfaces, before))
    moved = x.copy()
    moved[2 : X.size : 3] += 1e-3
    contact.commit(moved)
    assert not any(np.array_equal(face.history()["reals"], reals) for face, reals in zip(contact.interfaces, before))
    contact.rollback()
    assert all(np.array_equal(face.history()["reals"], reals) for face, reals in zip(contact.interfaces, before))


@pytest.mark.parametrize("condensed", [False, True])
def test_three_bodies_and_two_interfaces(condensed):
    """A stack under a constant pressure: the middle one has multipliers below, and the upper one's above."""
    parts = [block((0.0, 0.0, z), (1.0, 1.0, z + 0.5), cells, YOUNG, 0.0) for z, cells in ((1.0, (2, 2, 1)), (0.5, (3, 3, 1)), (0.0, (4, 4, 1)))]
    firsts = np.cumsum([0, *(len(X) for X, _, _ in parts)])
    X = np.vstack([X for X, _, _ in parts])
    K = scipy.sparse.block_diag([internal(np.zeros(own.shape))[1] for own, _, internal in parts], "csr")
    faces = {(body, z): stickslip.skin(parts[body][1] + firsts[body], X, lambda x, z=z: np.isclose(x[2], z))
             for body, z in ((0, 1.0), (1, 1.0), (1, 0.5), (2, 0.5))}
    contact = stickslip.Contact(X, condensed=condensed)
    contact.add(faces[0, 1.0], faces[1, 1.0], mu=0.3, modulus=YOUNG).add(faces[1, 0.5], faces[2, 0.5], mu=0.3, modulus=YOUNG)
    dofs = np.arange(X.size).reshape(X.shape)
    fixed = dofs[(X[:, 2] == 0) | (X[:, 2] == 1.5)]
    values = np.where(X[(X[:, 2] == 0) | (X[:, 2] == 1.5), 2:] == 1.5, [0, 0, -0.01], 0.0)
    x = contact.start()
    assert stickslip.newton(contact, lambda u: K @ u, lambda u: K, x, fixed=fixed, values=values) == 1
    for states, count in zip(contact.states(x), (9, 16)):
        np.testing.assert_allclose(states.pressure, YOUNG * 0.01 / 1.5, rtol=PATCH)
        assert str(states) == f"0 gap {count} stick 0 slip"
    contact.commit(x)


class Bodies:
    """Elastic boxes, each between its first two corners in so many cells."""

    def __init__(self, *boxes):
        parts = [block(*box, YOUNG, 0.3) for box in boxes]
        firsts = np.cumsum([0, *(len(X) for X, _, _ in parts)])
        self.X = np.vstack([X for X, _, _ in parts])
        self.K = scipy.sparse.block_diag([internal(np.zeros(own.shape))[1] for own, _, internal in parts], "csr")
        self.cells = [cells + first for (_, cells, _), first in zip(parts, firsts)]
        self.dofs = np.arange(self.X.size).reshape(self.X.shape)

    def face(self, body, axis, at):
        return stickslip.skin(self.cells[body], self.X, lambda x: np.isclose(x[axis], at))

    def solved(self, pairs, fixed, values, condensed):
        contact = stickslip.Contact(self.X, condensed=condensed)
        for pair in pairs:
            contact.add(*pair, mu=0.3, modulus=YOUNG)
        x = contact.start()
        for part in (0.5, 1.0):
            stickslip.newton(contact, lambda u: self.K @ u, lambda u: self.K, x, fixed=fixed, values=part * values)
            contact.commit(x)
        closed = [(states.state > 0).sum() for states in contact.states(x)] if not condensed else []
        return x[: self.X.size], closed


def in_a_corner():
    """A block is pushed into a corner: its bottom is the second side of the floor, its flank the first side of the wall."""
    bodies = Bodies(((0.0, 0.0, 0.0), (1.0, 1.0, 1.0), (3, 3, 3)), ((-0.5, -0.2, -0.5), (1.0, 1.2, 0.0), (5, 4, 1)),
                    ((1.0, -0.2, -0.5), (1.5, 1.2, 1.2), (1, 4, 6)))
    pairs = [(bodies.face(0, 0, 1.0), bodies.face(2, 0, 1.0)), (bodies.face(1, 2, 0.0), bodies.face(0, 2, 0.0))]
    top, rest = bodies.dofs[bodies.X[:, 2] == 1.0], bodies.dofs[(bodies.X[:, 2] == -0.5) | (bodies.X[:, 0] == 1.5)]
    top = top[np.isin(top[:, 0], bodies.dofs[: 64, 0]) & (bodies.X[top[:, 0] // 3, 0] < 0.9)]
    return bodies, pairs, np.concatenate([top, rest]), np.vstack([np.tile([0.004, 0.001, -0.01], (len(top), 1)), np.zeros(rest.shape)])


def three_blocks():
    """Two blocks side by side, and one that lies on both."""
    bodies = Bodies(((0.0, 0.0, 0.0), (1.0, 1.0, 1.0), (3, 3, 3)), ((1.0, 0.0, 0.0), (2.0, 1.0, 1.0), (4, 4, 4)),
                    ((0.3, 0.1, 1.0), (1.7, 0.9, 1.5), (5, 3, 1)))
    both = np.vstack([bodies.face(0, 2, 1.0), bodies.face(1, 2, 1.0)])
    pairs = [(bodies.face(0, 0, 1.0), bodies.face(1, 0, 1.0)), (bodies.face(2, 2, 1.0), both)]
    x = bodies.X
    moved = [((x[:, 2] == 1.5), [0.003, 0.0, -0.01]), ((x[:, 0] == 0.0), [0.004, 0.0, 0.0]), ((x[:, 0] == 2.0), [0.0, 0.0, 0.0])]
    return bodies, pairs, np.concatenate([bodies.dofs[at] for at, _ in moved]), np.concatenate([np.tile(u, (at.sum(), 1)) for at, u in moved])


@pytest.mark.parametrize("scene", [in_a_corner, three_blocks])
def test_chains_of_condensed_interfaces_are_eliminated_in_their_order(scene):
    """Nodes of an edge are on the second side of one interface and on the first of another one."""
    bodies, pairs, fixed, values = scene()
    expected, closed = bodies.solved(pairs, fixed, values, False)
    assert min(closed) > 3
    on_both = np.intersect1d(np.concatenate([np.ravel(first) for first, _ in pairs]), np.concatenate([np.ravel(second) for _, second in pairs]))
    assert len(on_both) > 2
    for order in (pairs, pairs[::-1]):
        found, _ = bodies.solved(order, fixed, values, True)
        np.testing.assert_allclose(found, expected, atol=SAME * np.abs(expected).max())


def test_what_has_no_order_is_refused():
    bodies, ((flank, wall), (floor, bottom)), fixed, values = in_a_corner()
    with pytest.raises(stickslip.Error, match=r"^start: nodes \[.*\] have multipliers in the interfaces 0 and 1; condensed"):
        bodies.solved([(flank, wall), (bottom, floor)], fixed, values, True)
    bodies.solved([(flank, wall), (bottom, floor)], fixed, values, False)
    bodies, ((right, left), (below, both)), fixed, values = three_blocks()
    with pytest.raises(stickslip.Error, match=r"^start: the interfaces \[0, 1\] act on each other's nodes"):
        bodies.solved([(right, np.vstack([left, bodies.face(2, 2, 1.5)])), (bodies.face(2, 2, 1.5), np.vstack([right]))], fixed, values, True)


@pytest.mark.parametrize("mids", [False, True])
def test_the_surface_is_drawn(blocks, mids, tmp_path):
    meshio = pytest.importorskip("meshio", reason="the surface is a mesh of meshio, which is not installed")
    facets, X = quad8(blocks.X, blocks.facets[0]) if mids else (blocks.facets[0], blocks.X)
    contact = stickslip.Contact(X).add(facets, blocks.facets[1], **blocks.options)
    x = contact.start()
    x[2 : X.size : 3] += 1e-3
    (states,) = contact.states(x)
    contact.surface(x, states).write(tmp_path / "contact.vtu")
    mesh = meshio.read(tmp_path / "contact.vtu")
    np.testing.assert_allclose(mesh.points, X[np.unique(facets)] + [0, 0, 1e-3])
    assert sum(len(block.data) for block in mesh.cells) == 9 and mesh.cells[0].type == ("quad8" if mids else "quad")
    np.testing.assert_array_equal(mesh.point_data["traction"], states.traction)
    np.testing.assert_array_equal(mesh.point_data["state"], states.state)


def test_what_is_wrong_is_told(blocks):
    contact = blocks.contact()
    x = contact.start()
    with pytest.raises(stickslip.errors.Unsupported, match="standard multipliers"):
        stickslip.Contact(blocks.X, condensed=True).add(*blocks.facets, method="paper", **blocks.options).start()
    with pytest.raises(stickslip.Error, match="^start: there is no interface"):
        stickslip.Contact(blocks.X).start()
    with pytest.raises(stickslip.Error, match=r"^r: shape"):
        contact.add_residual(x, np.zeros(blocks.X.size))
    assert "16 are covered in full" in contact.report()
    pressed, _ = blocks.solve(contact, GRIP)
    told, state = contact.report(pressed), contact.states(pressed)[0]
    forces = [np.array(words.split(", "), float) for words in re.findall(r"The force of contact on the \w+ side is \((.*)\)", told)]
    force1, force2, _ = contact.interfaces[0].residual(*contact._points(pressed)[0][1])
    np.testing.assert_allclose(forces, [-force1.sum(axis=0), -force2.sum(axis=0)], rtol=1e-3, atol=1e-12)  # four digits are told
    assert f"16 nodes in contact, {state.count(stickslip.State.STICK)} stick and {state.count(stickslip.State.SLIP)} slip, " in told
    assert f"{blocks.X.size} unknowns of the host, 48 multipliers behind them; [<Interface: 9 facets of 16 nodes on 16 facets" in repr(contact)
    twice = blocks.contact().add(*blocks.facets, **blocks.options)
    assert f"Nodes {np.unique(blocks.facets[0]).tolist()} have multipliers in several interfaces" in twice.report()
    with pytest.raises(stickslip.Error, match=r"^x: shape \(3,\)"):
        contact.balanced(np.zeros(3))
    with pytest.raises(stickslip.Error, match="^add: all interfaces"):
        contact.add(*blocks.facets, **blocks.options)
    with pytest.raises(stickslip.Error, match="^K: shape"):
        contact.tangent(x, blocks.K[:5, :5])
    with pytest.raises(stickslip.Error, match="^facets1: a facet of 5 nodes"):
        blocks.contact().add(np.arange(5)[None], blocks.facets[1], modulus=1.0)
    with pytest.raises(stickslip.Error, match="^facets2: rows of node numbers"):
        blocks.contact().add(blocks.facets[0], [], modulus=1.0)
    with pytest.raises(stickslip.Error, match="^x: entry 3 is NaN"):
        contact.add_residual(np.where(np.arange(contact.size) == 3, np.nan, x), np.zeros(contact.size))
