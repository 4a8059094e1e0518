"""Rigid bodies: a plate in six unknowns against statics, its matrix against differences, motions."""

import numpy as np
import pytest
import scene
import scipy.optimize
import scipy.sparse
import scipy.sparse.linalg
import stickslip
from scipy.spatial.transform import Rotation

# Central differences with this step: truncation and rounding both are below 1e-6 of the largest entry.
STEP = 1e-6
DIFFERENCES = 1e-6
# Of Newton's residual, over the load: rounding of a hundred unknowns is a hundredth of it.
CONVERGED = 1e-12
# Of displacements and rotations, from two solvers whose residuals are below 1e-12 of the load, over a stiffness ten times as large.
STATICS = 1e-12
ROUNDING = 1e-13


class Plate:
    """A rigid plate on springs under the nodes of a square. A force at a point above it presses it and draws it aside.

    Unknowns: six of the plate, displacements of the springs' ends, multipliers. Nodes of the plate have the numbers beyond.
    """

    FORCE, POINT, STIFFNESS = np.array([3.0, -1.2, -20.0]), (0.5, 0.5, 0.3), 200.0

    def __init__(self):
        self.x1, facets1 = scene.grid(3, 0.0, 1.0, 0.0, True)
        x2, facets2 = scene.grid(4, -0.5, 1.5, 0.0, False)
        n = self.x1.size
        self.size = 6 + 2 * n
        self.plate, self.ends, self.lam = slice(0, 6), slice(6, 6 + n), slice(6 + n, self.size)
        ends, lam = (np.arange(s.start, s.stop).reshape(-1, 3) for s in (self.ends, self.lam))
        nodes = self.size + np.arange(x2.size).reshape(-1, 3)
        self.face = stickslip.Interface(stickslip.Surface(self.x1, facets1, ends, lam), stickslip.Surface(x2, facets2, nodes),
                                        mu=0.9, modulus=self.STIFFNESS)
        self.body = stickslip.RigidBody(x2, nodes, self.POINT, np.arange(6))
        self.whole = self.size + x2.size
        self.spring = self.STIFFNESS * np.repeat(self.face.states(self.x1, x2, np.zeros(self.x1.shape)).area, 3)

    def unpack(self, u):
        self.body.unknowns = u[self.plate]
        return self.x1 + u[self.ends].reshape(-1, 3), self.body.positions(), u[self.lam].reshape(-1, 3)

    def residual(self, u, load):
        force1, force2, rows = self.face.residual(*self.unpack(u))
        plate = self.body.resultant(force2)
        plate[:3] -= load * self.FORCE
        return np.concatenate([plate, force1.ravel() + self.spring * u[self.ends], rows.ravel()]), force2

    def step(self, plan, u, load):
        host = scipy.sparse.diags(np.concatenate([np.zeros(6), self.spring, np.zeros(self.x1.size)]))
        for iterations in range(20):
            residual, force2 = self.residual(u, load)
            if np.abs(residual).max() < CONVERGED * np.linalg.norm(self.FORCE):
                self.states = set(self.face.states(*self.unpack(u)).state)
                self.face.commit(*self.unpack(u))
                return iterations
            nodal = self.face.tangent(*self.unpack(u), self.whole)
            u -= scipy.sparse.linalg.spsolve((plan.values(nodal, [force2]) + host).tocsc(), residual)
        raise AssertionError("Newton's method does not converge")


def statics(plate, load):
    """Displacement and rotation of the plate where each spring's end keeps its place on it: six equations of its own."""
    arms = plate.x1 - plate.POINT

    def balance(motion):
        turned = Rotation.from_rotvec(motion[3:]).apply(arms)
        forces = plate.spring.reshape(-1, 3) * (motion[:3] + turned - arms)
        return np.concatenate([forces.sum(axis=0) - load * plate.FORCE, np.cross(turned, forces).sum(axis=0)])

    found = scipy.optimize.root(balance, np.zeros(6), tol=1e-14)
    assert np.abs(balance(found.x)).max() < CONVERGED * np.linalg.norm(plate.FORCE)
    return found.x


def test_a_plate_on_springs_is_where_statics_puts_it():
    plate = Plate()
    plan = stickslip.RigidPlan([plate.body], plate.size)
    u = np.zeros(plate.size)
    u[plate.lam] = plate.face.initial_multipliers().ravel()
    for load in (0.5, 1.0):
        # Quadratic convergence: with a tangent that is not exact it takes dozens.
        assert plate.step(plan, u, load) <= 8
        assert plate.states == {stickslip.constants["STATE_STICK"]}
    expected = statics(plate, 1.0)
    assert np.abs(expected[3:]).max() > 0.05  # no small rotation
    np.testing.assert_allclose(plate.body.unknowns, expected, rtol=0, atol=STATICS)
    # The springs bear the load, and it has no moment about the point where it acts.
    forces = (plate.spring * u[plate.ends]).reshape(-1, 3)
    np.testing.assert_allclose(forces.sum(axis=0), plate.FORCE, rtol=0, atol=Plate.STIFFNESS * STATICS)
    arms = plate.x1 + u[plate.ends].reshape(-1, 3) - plate.POINT - u[:3]
    np.testing.assert_allclose(np.cross(arms, forces).sum(axis=0), 0, rtol=0, atol=Plate.STIFFNESS * STATICS)


@pytest.mark.parametrize("arms", ["end", "middle"])
@pytest.mark.parametrize("kind", [scene.Solid, scene.Plane])
def test_its_matrix_is_the_derivative_of_the_residual(kind, arms):
    with kind() as made:
        n1, d = made.x1.size, made.x1.shape[1]
        m = 6 if d == 3 else 3
        x1, x2, lam = made.pressed()
        # The mortar side, given as it was before a turn that brings it back to x2, about a point outside it.
        point, first = np.array([0.3, -0.2, 0.8])[:d], np.array([0.4, 0.1, -0.2, 0.7, 0.2, -0.3])
        motion = first if d == 3 else np.array([0.4, 0.1, 0.7])
        rotation = Rotation.from_rotvec(motion[3:] if d == 3 else [0, 0, motion[2]]).as_matrix()[:d, :d]
        coordinates = point + (x2 - point - motion[:d]) @ rotation
        numbers = made.slices[1].start + np.arange(x2.size)
        # Unknowns: non-mortar nodes, the body's in place of the mortar nodes', multipliers.
        equations = numbers[:m]
        node_equations = made.size + np.arange(x2.size).reshape(x2.shape)
        surface = stickslip.Surface(made.x2, made.arguments[1].facet_nodes.reshape(-1, 4 if d == 3 else 2), node_equations)
        with stickslip.Interface(made.arguments[0], surface, **made.options) as face:
            body = stickslip.RigidBody(coordinates, node_equations, point, equations)
            body.unknowns = motion
            body.arms = arms
            np.testing.assert_allclose(body.positions(), x2, rtol=0, atol=ROUNDING)
            plan = stickslip.RigidPlan([body], made.size)
            order = [*range(n1), *equations, *range(made.slices[2].start, made.size)]

            def residual(u):
                body.unknowns = u[n1 : n1 + m]
                point = u[:n1].reshape(x1.shape), body.positions(), u[n1 + m :].reshape(x1.shape)
                force1, force2, rows = face.residual(*point)
                return np.concatenate([force1.ravel(), body.resultant(force2), rows.ravel()]), point, force2

            u = np.concatenate([x1.ravel(), motion, lam.ravel()])
            _, at, force2 = residual(u)
            for form in ("coo", "csr", "csc"):
                nodal = face.tangent(*at, made.size + x2.size, form=form)
                matrix = plan.values(nodal, [force2])
                same = plan.values(nodal, [force2])
                assert same is matrix and plan.renewals == (form == "csc")  # the library sorts by rows
                dense = matrix.toarray()[np.ix_(order, order)]
                differences = np.column_stack([(residual(u + STEP * e)[0] - residual(u - STEP * e)[0]) / (2 * STEP)
                                               for e in np.eye(len(u))])
                residual(u)
                assert np.abs(dense - differences).max() < DIFFERENCES * np.abs(dense).max()


def test_turns_add_up_and_can_be_restored():
    x, numbers = np.array([[1.0, 2.0, -0.5]]), np.array([[6, 7, 8]])
    body, once = (stickslip.RigidBody(x, numbers, [0, 0, 0], np.arange(6)) for _ in range(2))
    np.testing.assert_array_equal(body.turned, np.eye(3))
    axis = np.array([2.0, -3.0, 6.0]) / 7
    for _ in range(100):
        body.unknowns += [0, 0, 0, *(0.03 * axis)]
        there = body.positions()
        body.turn()
        np.testing.assert_array_equal(body.unknowns, 0)
        np.testing.assert_allclose(body.positions(), there, rtol=0, atol=ROUNDING)
    once.unknowns = [0, 0, 0, *(3.0 * axis)]
    np.testing.assert_allclose(body.positions(), once.positions(), rtol=0, atol=100 * ROUNDING)
    once.unknowns, once.turned = np.zeros(6), body.turned
    np.testing.assert_array_equal(body.positions(), once.positions())


def test_a_lever_in_the_plane():
    lever = stickslip.RigidBody([[3.0, 1.0]], [[10, 11]], [1.0, 1.0], [0, 1, 2])
    lever.unknowns = [0.5, 0.25, np.pi / 2]
    np.testing.assert_allclose(lever.positions(), [[1.5, 3.25]], rtol=0, atol=ROUNDING)
    np.testing.assert_allclose(lever.resultant([[5.0, 7.0]]), [5, 7, -10], rtol=0, atol=10 * ROUNDING)


def test_what_is_wrong_is_refused_by_name():
    body = stickslip.RigidBody([[1.0, 2.0, 3.0]], [[10, 11, 12]], [0, 0, 0], range(6))
    with pytest.raises(stickslip.errors.InvalidValue, match="at most pi"):
        body.unknowns = [0, 0, 0, 4, 0, 0]
        body.positions()
    body.unknowns = np.zeros(6)
    with pytest.raises(ValueError, match="^unknowns: shape"):
        body.unknowns = [0, 0, 0]
    with pytest.raises(TypeError, match="^equations: float64, integers"):
        stickslip.RigidBody([[1.0, 2.0, 3.0]], [[10, 11, 12]], [0, 0, 0], [0.5] * 6)
    with pytest.raises(ValueError, match=r"^coordinates: shape \(3,\)"):
        stickslip.RigidBody([1.0, 2.0, 3.0], [10, 11, 12], [0, 0, 0], range(6))
    plan, nodal = stickslip.RigidPlan([body], 6), scipy.sparse.coo_matrix(([1.0], ([10], [11])), shape=(13, 13))
    with pytest.raises(ValueError, match="^forces: 0 arrays"):
        plan.values(nodal, [])
    with pytest.raises(ValueError, match=r"^forces\[0\]: shape"):
        plan.values(nodal, [np.zeros((2, 3))])
    with pytest.raises(TypeError, match="^nodal: ndarray"):
        plan.values(np.eye(13), [np.zeros((1, 3))])
    with pytest.raises(TypeError, match="^nodal: dtype float32"):
        plan.values(nodal.astype(np.float32), [np.zeros((1, 3))])
    with pytest.raises(ValueError, match="^size: 5, and there is an equation 5"):
        stickslip.RigidPlan([body], 5).values(nodal, [np.zeros((1, 3))])
    # Two bodies that share a number; a matrix without entries, which no interface has.
    with pytest.raises(stickslip.errors.InvalidValue, match="10 is that of two components"):
        stickslip.RigidPlan([body, body], 6).values(nodal, [np.zeros((1, 3))] * 2)
    # A refusal leaves the plan as it was.
    first = plan.values(nodal, [np.zeros((1, 3))])
    beyond = scipy.sparse.coo_matrix(([1.0] * 50, ([9] * 50, range(50))), shape=(99, 99))
    with pytest.raises(ValueError, match="^size: 6, and there is an equation 49"):
        plan.values(beyond, [np.zeros((1, 3))])
    assert plan.values(nodal, [np.zeros((1, 3))]) is first and plan.renewals == 0
    # What nothing follows has no entries, and forces on it turn with it all the same.
    assert plan.values(scipy.sparse.csr_matrix((13, 13)), [np.zeros((1, 3))]).nnz == 36
