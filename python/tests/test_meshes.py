"""Creases, shared nodes, carriers, and the plan of a condensed matrix."""

import numpy as np
import pytest
import scene
import stickslip

# Sums of the same products in another order.
ROUNDING = 1e-12


def test_a_right_angle_is_split_and_a_flat_surface_is_not():
    # A floor of 1 x 1 and a wall on its edge x = 1: the nodes 1 and 2 are on the crease.
    x = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (1, 0, 1), (1, 1, 1)], dtype=float)
    facets = [[0, 1, 2, 3], [1, 4, 5, 2]]
    split, originals = stickslip.split_creases(x, facets)
    assert originals[:6].tolist() == list(range(6)) and sorted(originals[6:]) == [1, 2]
    assert [originals[facet].tolist() for facet in split] == facets
    assert not set(split[0]) & set(split[1])
    same, unchanged = stickslip.split_creases(x, facets, angle=1.6)
    assert [facet.tolist() for facet in same] == facets and len(unchanged) == 6
    with pytest.raises(stickslip.errors.InvalidValue, match="angle"):
        stickslip.split_creases(x, facets, angle=4.0)


def test_nodes_that_interfaces_share():
    claimed, chain, both = (stickslip.constants["CROSSPOINT_" + name] for name in ("CLAIMED", "CHAIN", "BOTH_SIDES"))
    found = stickslip.crosspoints([([1, 2, 3], [7, 8]), ([3, 4], [9, 2]), ([20, 21], [21])])
    assert found.nodes.tolist() == [2, 3, 21]
    assert found.kinds.tolist() == [chain, claimed, both]
    assert found.claims.tolist() == [1, 2, 1]
    with pytest.raises(stickslip.errors.InvalidSize):
        stickslip.crosspoints([])
    with pytest.raises(TypeError, match=r"interfaces\[0\], mortar nodes"):
        stickslip.crosspoints([([1], np.array([2.0]))])


def test_carriers_of_nodes_that_overhang():
    # The last node of the upper line overhangs all but a sliver.
    x1 = np.column_stack([np.linspace(0.1, 1.0, 4), np.zeros(4)])
    x2 = np.array([(0.0, 0.0), (0.72, 0.0)])
    numbers = np.arange(8, dtype=np.int64).reshape(4, 2)
    upper = stickslip.Surface(x1, [[0, 1], [1, 2], [2, 3]], numbers, numbers + 8)
    lower = stickslip.Surface(x2, [[1, 0]])
    with stickslip.Interface(upper, lower, modulus=1.0, model="plane", weak_coverage=0.5) as face:
        nodes, carriers, weights = face.carriers()
        assert nodes.tolist() == [3] and carriers.tolist() == [2] and weights.tolist() == [1.0]
    with stickslip.Interface(upper, lower, modulus=1.0, model="plane", weak_coverage="none") as face:
        assert [len(part) for part in face.carriers()] == [0, 0, 0]


@pytest.mark.parametrize("kind", [scene.Solid, scene.Plane])
def test_condensed_plan_has_the_pieces_in_place(kind):
    with kind(basis="dual") as made:
        face, condensed, n = made.interface, stickslip.Condensed(made.interface), made.x1.size + made.x2.size
        plan = stickslip.CondensedPlan(face, made.x1, made.x2, n, pairs="skin")
        for seed in (1, 2):
            x1, x2, lam = made.pressed(seed=seed)
            kept = plan.forces.data, plan.constraints.data
            forces, constraints = plan.values(x1, x2, lam)
            assert plan.renewals or (forces.data is kept[0] and constraints.data is kept[1])
            for name, matrix in (("forces", forces), ("constraints", constraints)):
                piece = condensed.piece(x1, x2, lam, n, name)
                assert abs(matrix - piece).max() <= ROUNDING * abs(piece).max()
                assert abs(piece).max() > 0


def test_standard_multipliers_have_no_condensed_plan():
    with scene.Plane(basis="standard") as lines, pytest.raises(stickslip.errors.Unsupported):
        stickslip.CondensedPlan(lines.interface, lines.x1, lines.x2, lines.size)


def test_condensed_plan_is_renewed():
    with scene.Plane(basis="dual") as made:
        n = made.x1.size + made.x2.size
        plan = stickslip.CondensedPlan(made.interface, made.x1, made.x2, n)
        x1, x2, lam = made.pressed()
        x1[:, 0] += 0.35
        plan.values(x1, x2, lam)
        assert plan.renewals == 1
