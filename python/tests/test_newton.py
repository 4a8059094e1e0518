"""Newton's method of a step: the right answer, failures that leave everything as it was, a line search."""

import numpy as np
import pytest
import scipy.sparse.linalg
import stickslip
from bodies import YOUNG, Blocks

# Of the pressure of a patch test: rounding of a linear solver.
PATCH = 1e-11
# Of the displacements, with another matrix beside: the rounding of a linear solver.
SAME = 1e-11
# Of the largest reaction, the sum of all: forces on each body balance to 2e-11.
BALANCE = 1e-10
GRIP = (2e-3, 8e-4, -5e-3)
# So far, two facets of the lower block, that full steps fold facets.
SHOVE = (0.5, 0.2, -0.08)


@pytest.fixture(scope="module")
def blocks():
    return Blocks()


@pytest.mark.parametrize("condensed", [False, True])
def test_a_constant_pressure_is_exact(condensed):
    patch = Blocks(poisson=0.0, margin=0.0)
    contact = patch.contact(condensed=condensed)
    x, iterations = patch.solve(contact, (0.0, 0.0, -0.005))
    pressure = 0.005 / (0.5 / YOUNG + 0.5 / (2 * YOUNG))
    assert iterations == 1
    states = contact.states(x)[0]
    np.testing.assert_allclose(states.pressure, pressure, rtol=PATCH)
    np.testing.assert_allclose(states.traction[:, :2], 0, atol=PATCH * pressure)
    np.testing.assert_allclose(x[patch.fixed.ravel()], patch.values((0.0, 0.0, -0.005)).ravel())


def test_a_solution_is_in_balance_and_stays(blocks):
    contact = blocks.contact()
    x, iterations = blocks.solve(contact, GRIP)
    assert 2 <= iterations <= 8 and contact.balanced(x)
    again = x.copy()
    assert stickslip.newton(contact, blocks.residual, blocks.tangent, again, fixed=blocks.fixed, values=blocks.values(GRIP)) == 0
    np.testing.assert_array_equal(x, again)
    r = np.zeros(contact.size)
    r[: contact.n_host] = blocks.residual(x[: contact.n_host])
    contact.add_residual(x, r)
    assert np.abs(r[blocks.top].sum(axis=0) + r[blocks.bottom].sum(axis=0)).max() < BALANCE * np.abs(r[blocks.top].sum(axis=0)).max()


def test_what_is_prescribed_is_reached_in_one_iterate():
    # 0.03 + (0.29 - 0.03) is not 0.29, and no iteration is spent on the difference.
    patch = Blocks(poisson=0.0, margin=0.0)
    contact = patch.contact()
    x, below = contact.start(), np.tile([0.03, 0.0, 0.0], (len(patch.X), 1))
    x[: patch.X.size] = below.ravel()
    values = patch.values((0.0, 0.0, -0.005)) + [0.29, 0.0, 0.0]
    assert 0.03 + (0.29 - 0.03) != 0.29
    assert stickslip.newton(contact, patch.residual, patch.tangent, x, fixed=patch.fixed, values=values) == 1


def test_bodies_are_judged_one_by_one(blocks):
    # A third body of two unknowns, with forces of 1e13: beside them all that is wrong with the others would be nothing.
    n = blocks.X.size
    K = scipy.sparse.block_diag([blocks.K, [[1e15, -1e15], [-1e15, 1e15]]], "csr")
    plain, heavy = blocks.contact(), blocks.contact(size=n + 2)
    x, iterations = blocks.solve(plain, GRIP)
    fixed, values = np.append(blocks.fixed.ravel(), [n, n + 1]), np.append(blocks.values(GRIP).ravel(), [0.01, 0.0])

    def solve(y):
        return stickslip.newton(heavy, lambda u: K @ u, lambda u: K, y, fixed=fixed, values=values)

    y = heavy.start()
    assert solve(y) == iterations
    np.testing.assert_allclose(y[:n], x[:n], atol=SAME * np.abs(x[:n]).max())
    inside = np.setdiff1d(np.arange(n), np.concatenate([fixed, *(blocks.dofs[facets].ravel() for facets in blocks.facets)]))
    y[inside[0]] += 1e-6  # contact does not know of it
    assert heavy.balanced(y) and solve(y) == 1


def test_a_line_search_solves_what_full_steps_do_not(blocks):
    contact = blocks.contact()
    with pytest.raises(stickslip.errors.ProjectionNotConvex):
        blocks.solve(contact, SHOVE)
    x, iterations = blocks.solve(contact, SHOVE, search=True)
    assert contact.balanced(x) and iterations > 5


def test_a_failure_leaves_the_unknowns_as_they_were(blocks):
    contact = blocks.contact()
    calls = []

    def failing(u):
        calls.append(1)
        if len(calls) > 1:
            raise stickslip.StepRefused("the material is beyond its law")
        return blocks.K @ u

    for residual, tangent, words in ((failing, blocks.tangent, "beyond its law"),
                                     (lambda u: blocks.K @ u + np.where(u.any(), np.nan, 0.0), blocks.tangent, "NaN or infinite"),
                                     (blocks.residual, lambda u: 0 * blocks.K, "singular"),
                                     (blocks.residual, lambda u: 1e3 * blocks.K, "has not converged in 3")):
        x = contact.start()
        before = x.copy()
        with pytest.raises(stickslip.StepRefused, match=words):
            stickslip.newton(contact, residual, tangent, x, fixed=blocks.fixed, values=blocks.values(GRIP), most=3)
        np.testing.assert_array_equal(x, before)


def test_a_solver_of_ones_own(blocks):
    sizes = []

    def solve(A, b):
        sizes.append(A.shape)
        return scipy.sparse.linalg.spsolve(A.tocsc(), b)

    contact = blocks.contact()
    _, iterations = blocks.solve(contact, GRIP, solve=solve)
    assert sizes == [(contact.size - blocks.fixed.size,) * 2] * iterations


def test_what_is_wrong_is_told(blocks):
    contact = blocks.contact(condensed=True)
    with pytest.raises(stickslip.Error, match="^fixed: .* of the first side"):
        stickslip.newton(contact, blocks.residual, blocks.tangent, contact.start(), fixed=blocks.dofs[blocks.facets[0]])
    with pytest.raises(stickslip.Error, match="^residual: gives 3 entries"):
        stickslip.newton(contact, lambda u: u[:3], blocks.tangent, contact.start())
