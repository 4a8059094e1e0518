"""Rigid bodies in Contact: their derivative, statics, several interfaces, a gap that closes, turns, what is refused."""

import numpy as np
import pytest
import scipy.sparse
import stickslip
from numpy_blocks import block
from test_contact import check_derivative

YOUNG, HEIGHT, SIZE = 1000.0, 0.5, 0.2
# Of the load: where Newton's method stops, and the arms are as long as the bodies.
STATICS = 1e-9
# Of displacements, between a body that a load moves and one that is moved there.
SAME = 1e-9
# Beside the middle, so that the plate tilts.
LOAD, ARM = np.array([0.3, 0.1, -4.0]), np.array([0.1, -0.05, 0.0])


class Plate:
    """A rigid plate on an elastic block that stands on the ground; with ``above`` another block, fixed at its top, lies on the plate.

    Unknowns: displacements of the blocks, then six of the plate.
    """

    def __init__(self, plate_first=False, above=False, gap=0.0, **options):
        parts = [block((0, 0, 0), (1, 1, HEIGHT), (3, 3, 2), YOUNG, 0.3)]
        if above:
            parts.append(block((0, 0, HEIGHT + SIZE), (1, 1, 2 * HEIGHT + SIZE), (4, 4, 2), YOUNG, 0.3))
        corners = np.array([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)])
        plate = np.array([-0.1, -0.1, HEIGHT + gap]) + corners * [1.2, 1.2, SIZE]
        self.K = scipy.sparse.block_diag([*(internal(np.zeros(X.shape))[1] for X, _, internal in parts), scipy.sparse.csr_matrix((6, 6))], "csr")
        self.X = np.vstack([*(X for X, _, _ in parts), plate])
        first = len(self.X) - 8
        dofs = np.arange(self.X.size).reshape(self.X.shape)
        dofs[first:] = -1
        self.six = 3 * first + np.arange(6)
        self.contact = stickslip.Contact(self.X, dofs, 3 * first + 6)
        self.body = self.contact.rigid(first + np.arange(8), self.X[first:].mean(axis=0), self.six)
        top = stickslip.skin(parts[0][1], self.X, lambda x: x[2] == HEIGHT)
        under, over = (first + np.array([face]) for face in ((0, 2, 3, 1), (4, 5, 7, 6)))
        sides = (under, top) if plate_first else (top, under)
        self.options = {"mu": 0.3, "modulus": YOUNG, **options}
        self.contact.add(*sides, **self.options)
        self.fixed = dofs[:first][self.X[:first, 2] == 0].ravel()
        if above:
            lower = stickslip.skin(parts[1][1] + len(parts[0][0]), self.X, lambda x: np.isclose(x[2], HEIGHT + SIZE))
            self.contact.add(lower, over, **self.options)
            self.fixed = np.concatenate([self.fixed, dofs[:first][np.isclose(self.X[:first, 2], 2 * HEIGHT + SIZE)].ravel()])
        self.load = np.zeros(3 * first + 6)
        self.load[self.six] = [*LOAD, *np.cross(ARM, LOAD)]

    def solve(self, x=None, load=1.0, fixed=(), values=(), **how):
        x = self.contact.start() if x is None else x
        where = np.concatenate([self.fixed, np.asarray(fixed, dtype=np.int64)])
        prescribed = np.concatenate([np.zeros(len(self.fixed)), values])
        stickslip.newton(self.contact, lambda u: self.K @ u - load * self.load, lambda u: self.K, x, fixed=where, values=prescribed, **how)
        return x

    def contact_forces(self, x):
        r = np.zeros(self.contact.size)
        self.contact.add_residual(x, r)
        return r


@pytest.mark.parametrize("plate_first", [False, True])
@pytest.mark.parametrize("above", [False, True])
def test_the_tangent_is_the_derivative(plate_first, above):
    made = Plate(plate_first, above)
    random, x = np.random.default_rng(2), made.contact.start()
    x[: made.contact.n_host] += 1e-4 * random.standard_normal(made.contact.n_host)
    x[made.six] += [0.01, -0.02, -5e-3, 2e-3, -1e-3, 0.05]
    x[made.contact.n_host :] -= 1 + 0.1 * random.random(made.contact.n_multipliers)
    check_derivative(made.contact, x)


@pytest.mark.parametrize("plate_first", [False, True])
def test_a_loaded_plate_is_where_it_presses_with_its_load(plate_first):
    made = Plate(plate_first)
    x = made.solve()
    assert np.abs(x[made.six[3:]]).min() > 1e-4  # it tilts and turns
    forces = made.contact_forces(x)
    np.testing.assert_allclose(forces[made.six], made.load[made.six], rtol=0, atol=STATICS * np.linalg.norm(LOAD))
    other = Plate(plate_first)
    y = other.solve(load=0.0, fixed=other.six, values=x[made.six])
    np.testing.assert_allclose(y, x, rtol=0, atol=SAME * np.abs(x).max())
    # What the block has of it, with its moment about the plate's point, which has moved.
    n = made.six[0]
    on_block = forces[:n].reshape(-1, 3)
    np.testing.assert_allclose(on_block.sum(axis=0), -LOAD, rtol=0, atol=STATICS * np.linalg.norm(LOAD))
    arms = made.X[: n // 3] + x[:n].reshape(-1, 3) - made.body.point - x[made.six[:3]]
    np.testing.assert_allclose(np.cross(arms, on_block).sum(axis=0), -np.cross(ARM, LOAD), rtol=0, atol=STATICS * np.linalg.norm(LOAD))


def test_a_plate_between_two_blocks_hands_its_load_to_both():
    made = Plate(above=True)
    x = made.contact.start()
    for load in (0.5, 1.0):
        made.solve(x, load)
        states = made.contact.states(x)
        made.contact.commit(x)
    np.testing.assert_allclose(made.contact_forces(x)[made.six], made.load[made.six], rtol=0, atol=STATICS * np.linalg.norm(LOAD))
    assert len(states) == 2 and states[0].pressure.max() > 0


def test_a_plate_falls_onto_the_block():
    made = Plate(gap=0.01)
    done = list(stickslip.steps(made.contact, lambda u, t: made.K @ u - t * made.load, lambda u, t: made.K, [1.0, 2.0], fixed=made.fixed))
    assert done[-1].cuts == 0
    x = done[-1].x
    assert x[made.six[2]] < -0.01
    np.testing.assert_allclose(made.contact_forces(x)[made.six], 2 * made.load[made.six], rtol=0, atol=STATICS * np.linalg.norm(LOAD))


def test_turns_are_taken_into_the_body():
    made = Plate()
    x = made.solve()
    made.contact.commit(x)
    before = made.contact_forces(x)
    angle = x[made.six[3:]].copy()
    made.contact.turn(x)
    np.testing.assert_array_equal(x[made.six[3:]], 0)
    assert np.abs(made.body.turned - np.eye(3)).max() > 0.5 * np.abs(angle).max()
    np.testing.assert_allclose(made.contact_forces(x), before, rtol=0, atol=STATICS)


def test_a_rigid_body_in_the_plane():
    X = np.array([[0.0, 0.0], [1.0, 0.0], [0.25, 0.0], [0.75, 0.0]])
    dofs = np.array([[0, 1], [2, 3], [-1, -1], [-1, -1]])
    contact = stickslip.Contact(X, dofs, 7)
    contact.rigid([2, 3], [0.5, 0.1], [4, 5, 6])
    contact.add([[2, 3]], [[1, 0]], mu=0.3, modulus=YOUNG)
    x = contact.start()
    x[:7] = [0.0, 1e-3, 0.0, 0.0, 2e-3, -1e-3, 0.01]
    x[7:] = [0.0, -1.0, 0.0, -1.0]
    check_derivative(contact, x)


def test_what_is_wrong_is_refused_by_name():
    X, dofs = np.vstack([np.eye(3), np.ones(3)]), np.array([[0, 1, 2], [3, 4, 5], [-1] * 3, [-1] * 3])
    contact = stickslip.Contact(X, dofs, 12)
    for arguments, words in ((([2, 4], np.zeros(3), range(6, 12)), "^nodes: numbers from 0 to 3"),
                             (([1, 2], np.zeros(3), range(6, 12)), "^nodes: dofs is not -1"),
                             (([2, 3], np.zeros(3), range(7, 13)), "^unknowns: 6 numbers from 0 to 11"),
                             (([2, 3], np.zeros(3), [6] * 6), "^unknowns: 6 numbers")):
        with pytest.raises(stickslip.errors.InvalidValue, match=words):
            contact.rigid(*arguments)
    contact.rigid([2, 3], np.zeros(3), range(6, 12))
    with pytest.raises(stickslip.errors.InvalidValue, match="another body has them"):
        contact.rigid([3], np.zeros(3), range(6, 12))
    with pytest.raises(stickslip.errors.InvalidValue, match="^rigid: needs"):
        stickslip.Contact(X, dofs, 12, condensed=True).rigid([2, 3], np.zeros(3), range(6, 12))
