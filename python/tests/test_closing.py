"""A body that nothing but its load moves towards a table."""

import numpy as np
import pytest
import stickslip
from bodies import YOUNG
from numpy_blocks import block

GAP, PRESSURE = 0.01, 5.0
# Rounding of a linear solver, of a pressure.
PATCH = 1e-11


def falling(upwards=False, **how):
    X, cells, internal = block((0, 0, GAP), (1, 1, 1 + GAP), (3, 3, 2), YOUNG, 0.0)
    K = internal(np.zeros(X.shape))[1]
    bottom = stickslip.skin(cells, X, lambda x: x[2] == GAP)
    table = stickslip.Surface([(-1, -1, 0), (2, -1, 0), (2, 2, 0), (-1, 2, 0)], [[0, 1, 2, 3]])
    top = X[:, 2] == X[:, 2].max()
    edges = np.isclose(X[:, :2], 0) | np.isclose(X[:, :2], 1)
    load = np.zeros(X.shape)
    load[top, 2] = (PRESSURE if upwards else -PRESSURE) * (np.where(edges, 0.5, 1.0) / 3).prod(axis=1)[top]
    contact = stickslip.Contact(X, **how).add(bottom, table, mu=0.3, modulus=YOUNG)
    return stickslip.steps(contact, lambda u, time: K @ u - time * load.ravel(), lambda u, time: K, [1.0, 2.0, 3.0])


@pytest.mark.parametrize("condensed", [False, True])
def test_a_block_falls_onto_a_table_and_rests_on_it(condensed):
    for step in falling(condensed=condensed):
        np.testing.assert_allclose(step.states[0].pressure, PRESSURE * step.time, rtol=PATCH)
        assert step.cuts == 0 and step.iterations <= 5
        assert np.abs(step.x[:2]).max() < PATCH  # it has not drifted along the table


def test_a_block_that_is_drawn_away_is_told():
    with pytest.raises(stickslip.StepRefused, match="its load moves it away"):
        list(falling(upwards=True))
