"""Residual, tangent, states and history of the handle, against what they must be."""

import pickle

import numpy as np
import pytest
import scene
import stickslip

# Central differences with this step: truncation and rounding both are below 1e-6 of the largest entry.
STEP = 1e-6
DIFFERENCES = 1e-6
# Sums of the same products in another order.
ROUNDING = 1e-12


@pytest.mark.parametrize("kind", [scene.Solid, scene.Plane])
@pytest.mark.parametrize("basis", ["standard", "dual"])
def test_tangent_is_the_derivative_of_the_residual(kind, basis):
    with kind(basis=basis) as made:
        point = made.pressed()
        u = np.concatenate([part.ravel() for part in point])
        tangent = made.interface.tangent(*point, made.size).toarray()
        for column, unit in enumerate(np.eye(made.size)):
            difference = (made.residual(u + STEP * unit) - made.residual(u - STEP * unit)) / (2 * STEP)
            assert np.abs(tangent[:, column] - difference).max() < DIFFERENCES * np.abs(tangent).max()


@pytest.mark.parametrize("kind", [scene.Solid, scene.Plane])
def test_patch_constant_pressure_is_in_balance(kind):
    with kind() as made:
        pressure = 5.0
        lam = np.tile(-pressure * made.nu, (len(made.x1), 1))
        force1, force2, _ = made.interface.residual(made.x1, made.x2, lam)
        states = made.interface.states(made.x1, made.x2, lam)
        # The force ON the upper body is -force1: upwards, pressure times area.
        assert -force1.sum(axis=0) == pytest.approx(pressure * states.area.sum() * made.nu, abs=ROUNDING * 10)
        assert (force1.sum(axis=0) + force2.sum(axis=0)) == pytest.approx(0, abs=ROUNDING * 10)
        assert states.traction == pytest.approx(lam, abs=ROUNDING * 10)
        assert states.coverage == pytest.approx(states.area, rel=1e-10)
        assert states.normal == pytest.approx(np.tile(made.nu, (len(made.x1), 1)), abs=ROUNDING)


@pytest.mark.parametrize("kind", [scene.Solid, scene.Plane])
def test_plan_gives_the_tangent_in_place(kind):
    with kind() as made:
        plan = stickslip.Plan(made.interface, made.x1, made.x2, made.size)
        for seed in (1, 2):
            point = made.pressed(seed=seed)
            data = plan.matrix.data
            matrix = plan.values(*point)
            assert plan.renewals or matrix.data is data
            tangent = made.interface.tangent(*point, made.size)
            assert abs(matrix - tangent).max() <= ROUNDING * abs(tangent).max()
            assert abs(tangent).max() > 1


def test_plan_is_renewed_when_surfaces_have_moved_apart_from_it(lines):
    plan = stickslip.Plan(lines.interface, lines.x1, lines.x2, lines.size)
    x1, x2, lam = lines.pressed()
    x1[:, 0] += 0.35
    matrix = plan.values(x1, x2, lam)
    assert plan.renewals == 1
    assert abs(matrix - lines.interface.tangent(x1, x2, lam, lines.size)).max() <= ROUNDING * abs(matrix).max()


def test_commit_and_rollback_move_the_history(blocks):
    face, point = blocks.interface, blocks.pressed()
    before = face.history()["reals"]
    face.commit(*point)
    assert not np.array_equal(face.history()["reals"], before)
    face.rollback()
    np.testing.assert_array_equal(face.history()["reals"], before)
    with pytest.raises(stickslip.errors.NothingToRollBack):
        face.rollback()


def test_history_goes_through_pickle(blocks):
    first, point, later = blocks.interface, blocks.pressed(), blocks.pressed(seed=2)
    first.commit(*point)
    kept = pickle.loads(pickle.dumps(first.history()))
    with stickslip.Interface(*blocks.arguments, **blocks.options) as second:
        fresh = second.residual(*later)
        second.restore(kept)
        for ours, theirs in zip(second.residual(*later), first.residual(*later)):
            np.testing.assert_array_equal(ours, theirs)
        assert not np.array_equal(fresh[2], second.residual(*later)[2])


@pytest.mark.parametrize("kind", [scene.Solid, scene.Plane])
def test_condensed_multipliers_hold_the_host_forces(kind):
    with kind(basis="dual", weights="reference") as made:
        face, condensed = made.interface, stickslip.Condensed(made.interface)
        # Pressed down by 0.2 at each node: internal minus external force points up, and contact takes all of it.
        host1 = np.tile(0.2 * made.nu, (len(made.x1), 1))
        lam = condensed.multipliers(made.x1, made.x2, host1)
        force1, force2, rows = face.residual(made.x1, made.x2, lam)
        np.testing.assert_allclose(force1, -host1, atol=ROUNDING)
        np.testing.assert_allclose(rows, 0, atol=ROUNDING)
        rows1, condensed2 = condensed.residual(made.x1, made.x2, lam, host1)
        np.testing.assert_allclose(condensed2, force2, atol=ROUNDING)
        np.testing.assert_allclose(rows1, 0, atol=ROUNDING)


def test_condensed_matrix_is_the_derivative_of_the_condensed_residual():
    with scene.Plane(basis="dual") as made:
        face, condensed = made.interface, stickslip.Condensed(made.interface)
        x1, x2, _ = made.pressed()
        n1, n = made.x1.size, made.x1.size + made.x2.size
        host = 50.0 * np.eye(n) + np.random.default_rng(3).standard_normal((n, n))
        base, start = np.tile(0.2 * made.nu, (len(x1), 1)).ravel(), np.concatenate([x1.ravel(), x2.ravel()])

        def residual(u):
            y1, y2 = u[:n1].reshape(x1.shape), u[n1:].reshape(x2.shape)
            own = host @ (u - start)
            host1 = (base + own[:n1]).reshape(x1.shape)
            lam = condensed.multipliers(y1, y2, host1)
            rows1, force2 = condensed.residual(y1, y2, lam, host1)
            return np.concatenate([rows1.ravel(), own[n1:] + force2.ravel()]), lam

        lam = residual(start)[1]
        piece = {name: condensed.piece(x1, x2, lam, n, name).toarray()
                 for name in ("forces", "elimination", "constraints", "scales")}
        inner = host + piece["forces"]
        matrix = inner + piece["elimination"] @ inner + piece["constraints"] + piece["scales"]
        differences = np.column_stack([(residual(start + STEP * e)[0] - residual(start - STEP * e)[0]) / (2 * STEP)
                                       for e in np.eye(n)])
        assert np.abs(matrix - differences).max() < DIFFERENCES * np.abs(matrix).max()


def test_the_face_tells_about_itself(blocks):
    face, point = blocks.interface, blocks.pressed()
    face.residual(*point)
    assert face.counters().multipliers == blocks.x1.size
    assert "friction" in face.effects().lower()
    assert face.report(*point[:2]).nodes_full == len(blocks.x1)
    assert face.equilibrium(*point).gap_scale > 0
    assert face.diagnose(*point).text
    assert face.initial_multipliers() @ blocks.nu == pytest.approx(face.initial_multipliers()[:, 2])
    assert 0 < face.step_limit(*point[:2], np.zeros_like(point[0]), np.zeros_like(point[1])) <= 1


def test_a_larger_friction_is_taken(lines):
    point = lines.pressed()
    before = lines.interface.states(*point).traction
    lines.interface.set_friction(np.zeros(len(lines.x1)))
    assert not np.array_equal(lines.interface.states(*point).traction, before)


def test_offsets_and_adjusted_nodes():
    with scene.Solid() as solid:
        interface, gap = solid.interface, 0.01
        x1, lam = solid.x1 + gap * solid.nu, np.tile(-5.0 * solid.nu, (len(solid.x1), 1))
        closed, gaping = (interface.residual(x, solid.x2, lam)[2] for x in (solid.x1, x1))
        interface.set_offsets(np.full(len(x1), -gap))
        np.testing.assert_allclose(interface.residual(x1, solid.x2, lam)[2], closed, atol=1e-12)
        interface.set_offsets()
        np.testing.assert_array_equal(interface.residual(x1, solid.x2, lam)[2], gaping)
        assert np.abs(gaping - closed).max() > 1e-6
    apart = scene.grid(2, 0.13, 1.0, 1e-3, False)
    with scene.Scene(apart, scene.grid(3, 0.0, 1.2, 0.0, True)) as solid:
        coordinates, gaps, moved = solid.interface.adjust(0.01)
        np.testing.assert_allclose(coordinates[:, 2], 0.0, atol=1e-15)
        np.testing.assert_allclose(gaps, 1e-3, rtol=1e-12)
        assert (moved == 2).all()
        with pytest.raises(stickslip.errors.InvalidValue, match="tolerance"):
            solid.interface.adjust(-1.0)


def test_offsets_of_a_shape():
    # The top of a ball of radius 10 from three chords a side: facets lie inside it, by less than h^2 / (4 R).
    (x1, f1), top = scene.grid(3, -0.6, 0.6, 0.0, False), scene.grid(3, -0.6, 0.6, 0.0, True)
    x2 = 10 * (top[0] + [0, 0, 10]) / np.linalg.norm(top[0] + [0, 0, 10], axis=1, keepdims=True)
    with scene.Scene((x1 + [0, 0, 10], f1), (x2, top[1])) as ball:
        offsets = ball.interface.shape_offsets("mortar", "sphere", 10.0, (0, 0, 0))
        assert ((offsets < 0) & (offsets > -2 * 0.4**2 / 40)).all()


def test_a_law_of_ones_own_that_is_coulombs(blocks):
    face, point = blocks.interface, blocks.pressed()
    plain = face.residual(*point)
    seen = []

    def coulomb(at):
        assert at.normal <= 0 and at.slip.shape == (3,)
        seen.append(at.node)
        at.states[0] += np.linalg.norm(at.slip)
        return -at.mu * at.normal, -at.mu

    face.set_threshold(coulomb, n_states=1)
    for ours, theirs in zip(face.residual(*point), plain):
        np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-13 * np.abs(theirs).max())
    assert 0 < len(seen) <= face.n1 and np.array_equal(face.law_states(), np.zeros((face.n1, 1)))
    face.commit(*point)
    assert face.law_states().max() > 0
    face.set_law_states(np.ones((face.n1, 1)))
    assert face.law_states().min() == 1
    face.set_law("cohesion", cohesion=0.0)
    assert face.law_states().shape == (face.n1, 0)


def test_a_law_that_fails_refuses_the_call_and_is_its_cause(blocks):
    point = blocks.pressed()
    blocks.interface.set_threshold(lambda at: 1 / 0)
    with pytest.raises(stickslip.errors.InvalidValue, match="node") as caught:
        blocks.interface.residual(*point)
    assert isinstance(caught.value.__cause__, ZeroDivisionError)
    blocks.interface.set_threshold(lambda at: (float("nan"), 0.0))
    with pytest.raises(stickslip.errors.NotFinite, match="node"):
        blocks.interface.residual(*point)
    with pytest.raises(TypeError, match="mu_across"):
        blocks.interface.set_law("orthotropic", across=0.1)


def test_a_layer_yields_wears_and_holds(blocks):
    point, face = blocks.pressed(), blocks.interface
    hard = face.residual(*point)[2]
    face.set_layer(overclosure=[[0, 0], [1e-3, 1e3]])
    assert np.abs(face.residual(*point)[2] - hard).max() > 0 and face.law_states().shape == (face.n1, 0)
    face.set_layer(wear=1e-3, bond_stiffness=1e3, bond_strength=1.0, bond_toughness=0.1, bond_shear=1.0)
    states = face.states(*point)
    assert (states.worn >= 0).all() and ((states.damage >= 0) & (states.damage <= 1)).all()
    assert face.law_states().shape == (face.n1, 6)
    face.set_layer()
    np.testing.assert_array_equal(face.residual(*point)[2], hard)
    with pytest.raises(stickslip.errors.InvalidValue, match=r"layer.pressure\[1\]"):
        face.set_layer(overclosure=[[0, 0], [1, 0]])
    with pytest.raises(TypeError, match="bond_shear"):
        face.set_layer(glue=1.0)


def test_heat_passes_and_is_what_its_tangent_says():
    with scene.Solid() as solid:
        face, n = solid.interface, len(solid.x1) + len(solid.x2)
        point = solid.x1, solid.x2, np.tile(-5.0 * solid.nu, (len(solid.x1), 1))
        t1, t2 = np.linspace(20.0, 30.0, len(solid.x1)), np.linspace(25.0, 15.0, len(solid.x2))
        law = dict(contact=2.0, pressure=5.0, exponent=0.95, constant=0.3, reach=1.0)
        heat = face.heat(*point, t1, t2, **law)
        assert abs(heat.heat1.sum() + heat.heat2.sum()) <= 1e-13 * np.abs(heat.heat1).sum() and heat.flux.any()
        np.testing.assert_allclose(heat.flux, heat.conductance * heat.jump, rtol=1e-14)
        np.testing.assert_allclose(heat.conductance[heat.area > 0], 2.3, rtol=1e-12)
        equations = np.arange(n, dtype=np.int64)
        matrix = face.heat_tangent(*point, t1, t2, equations[:len(t1)], equations[len(t1):], n, "temperatures", **law)
        np.testing.assert_allclose(matrix @ np.concatenate([t1, t2]), np.concatenate([heat.heat1, heat.heat2]), atol=1e-12)
        with pytest.raises(TypeError, match="no number of heat"):
            face.heat(*point, t1, t2, warmth=1.0)
        with pytest.raises(stickslip.Error, match="reach"):
            face.heat(*point, t1, t2, constant=1.0)


def test_shapes_that_fit_are_each_named_once():
    (x1, f1), (x2, f2) = scene.grid(2, 0.13, 1.0, 0.0, False), scene.grid(3, 0.0, 1.2, 0.0, True)
    numbers = np.arange(x1.size + x2.size + len(x1), dtype=np.int64)
    of1, of2, of_lam = np.split(numbers, np.cumsum([x1.size, x2.size]))
    first, second = stickslip.Surface(x1, f1, of1.reshape(x1.shape), of_lam), stickslip.Surface(x2, f2, of2.reshape(x2.shape))
    with stickslip.Interface(first, second, friction="none", modulus=1000.0) as face:
        with pytest.raises(ValueError, match=r"^lam: shape \(9, 1\), \(9,\) is needed$"):
            face.residual(x1, x2, np.zeros((9, 1)))
        with pytest.raises(ValueError, match=r"^x1: shape \(3,\), \(9, 3\) or \(27,\) is needed$"):
            face.residual(np.zeros(3), x2, np.zeros(9))


def test_a_step_is_asked_whether_it_may_count():
    with scene.Solid(mu=0.0, method="paper") as solid:  # normals of now do not lag
        face, lam, modulus = solid.interface, np.tile(-5.0 * solid.nu, (len(solid.x1), 1)), 1000.0
        e = face.check_step(solid.x1, solid.x2, lam, modulus=modulus)  # touches, and no word
        assert e.penetration == e.lag == e.apart == 0
        with pytest.raises(stickslip.StepRefused, match="not in equilibrium"):
            face.check_step(solid.x1 - 0.01 * solid.nu, solid.x2, lam, modulus=modulus)
        for angle, outcome in ((0.015, pytest.warns(stickslip.StepWarning, match="lag")), (0.15, pytest.raises(stickslip.StepRefused, match="lag"))):
            turn = np.array([[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]])
            with outcome:
                face.check_step(solid.x1 @ turn.T, solid.x2 @ turn.T, lam, modulus=modulus)


def test_a_commit_is_checked_and_nothing_changes():
    with scene.Solid(normals="committed") as blocks:  # normals of now may turn by any angle
        check_commits(blocks.interface, blocks.pressed())


def check_commits(face, point):
    before = face.residual(*point)
    face.commit_check(*point)
    for one, other in zip(before, face.residual(*point)):
        np.testing.assert_array_equal(one, other)
    with pytest.raises(stickslip.Error):
        face.rollback()  # none was made
    x1 = point[0] @ np.array([[0, 0, 1.0], [0, 1, 0], [-1, 0, 0]]).T
    for refuses in (face.commit_check, face.commit):
        with pytest.raises(stickslip.errors.TurnedTooFar):
            refuses(x1, point[1], point[2])
    face.commit(*point)
