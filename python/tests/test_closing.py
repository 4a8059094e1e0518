"""A body that nothing but its load moves towards a table."""

import numpy as np
import pytest
import stickslip
from bodies import YOUNG
from numpy_blocks import block

GAP, PRESSURE = 0.01, 5.0
# Rounding of a linear solver, of a pressure.
PATCH = 1e-11


def falling(upwards=False, seen=None, **how):
    """The steps. seen: receives the time and the displacements of each evaluation."""
    X, cells, internal = block((0, 0, GAP), (1, 1, 1 + GAP), (3, 3, 2), YOUNG, 0.0)
    K = internal(np.zeros(X.shape))[1]
    bottom = stickslip.skin(cells, X, lambda x: x[2] == GAP)
    table = stickslip.Surface([(-1, -1, 0), (2, -1, 0), (2, 2, 0), (-1, 2, 0)], [[0, 1, 2, 3]])
    top = X[:, 2] == X[:, 2].max()
    edges = np.isclose(X[:, :2], 0) | np.isclose(X[:, :2], 1)
    load = np.zeros(X.shape)
    load[top, 2] = (PRESSURE if upwards else -PRESSURE) * (np.where(edges, 0.5, 1.0) / 3).prod(axis=1)[top]
    contact = stickslip.Contact(X, **how).add(bottom, table, mu=0.3, modulus=YOUNG)

    def residual(u, time):
        if seen is not None:
            seen.append((time, u.copy()))
        return K @ u - time * load.ravel()

    return stickslip.steps(contact, residual, lambda u, time: K, [1.0, 2.0, 3.0])


@pytest.mark.parametrize("condensed", [False, True])
def test_a_block_falls_onto_a_table_and_rests_on_it(condensed):
    seen, ends = [], {}
    for step in falling(seen=seen, condensed=condensed):
        ends[step.time] = step.x
        np.testing.assert_allclose(step.states[0].pressure, PRESSURE * step.time, rtol=PATCH)
        assert step.cuts == 0 and step.iterations <= 5
        assert np.abs(step.x[:2]).max() < PATCH  # it has not drifted along the table
    # No iterate is deeper in the table than a tenth of an edge. The second step does not go on as the gap closed, the third one does.
    assert min(u[2::3].min() for _, u in seen) > -GAP - 0.1 / 3 - PRESSURE * 3 / YOUNG
    first = {time: next(u for at, u in seen if at == time) for time in ends}
    n = first[1.0].size
    np.testing.assert_array_equal(first[2.0], ends[1.0][:n])
    np.testing.assert_allclose(first[3.0], (2 * ends[2.0] - ends[1.0])[:n])


def test_a_block_that_is_drawn_away_is_told():
    with pytest.raises(stickslip.StepRefused, match="its load moves it away"):
        list(falling(upwards=True))


def test_a_block_that_is_laid_down_by_its_top_from_rest():
    """No force acts at all before what is prescribed moves, so that there is nothing to measure what is left by."""
    X, cells, internal = block((0, 0, GAP), (1, 1, 1 + GAP), (3, 3, 2), YOUNG, 0.0)
    K = internal(np.zeros(X.shape))[1]
    table = stickslip.Surface([(-1, -1, 0), (2, -1, 0), (2, 2, 0), (-1, 2, 0)], [[0, 1, 2, 3]])
    contact = stickslip.Contact(X).add(stickslip.skin(cells, X, lambda x: x[2] == GAP), table, mu=0.3, modulus=YOUNG)
    x, top = contact.start(), contact.dofs[X[:, 2] == X[:, 2].max()]
    stickslip.newton(contact, lambda u: K @ u, lambda u: K, x, fixed=top, values=np.tile([0, 0, -2 * GAP], len(top)), closing=True)
    np.testing.assert_allclose(contact.states(x)[0].pressure, YOUNG * GAP, rtol=PATCH)
