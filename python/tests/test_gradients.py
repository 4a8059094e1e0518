"""Derivatives by positions of the last commit and by parameters, against differences: of residuals, and of whole runs."""

import sys
from pathlib import Path

import numpy as np
import pytest

import stickslip

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "examples"))
import gradients as example  # noqa: E402

#: Fourth-order differences with steps of 1e-5 to 1e-6 of numbers of size 1, over the largest.
DIFFERENCES = 1e-8
#: The same of whole runs, whose steps converge to 1e-15.
RUNS = 1e-7
#: Rounding of sums over an interface.
ROUNDING = 1e-12


def lines(n, lower, upper, is_lower, order):
    x = np.linspace(lower, upper, order * n + 1)
    nodes = np.column_stack([x, 0.02 * np.sin(2 * x)])
    ends = [(order * k, order * (k + 1), order * k + 1)[:order + 1] for k in range(n)]
    return nodes, np.array([(e[1], e[0], *e[2:]) for e in ends] if is_lower else ends)


def patch(n, lower, upper, is_lower, kind):
    """A wavy square of triangles or quadrilaterals, linear or quadratic, that looks up or down."""
    step = 1 if kind in ("tri3", "quad4") else 2
    side = np.linspace(lower, upper, step * n + 1)
    nodes = np.array([(x, y, 0.02 * np.sin(3 * x) + 0.003 * y * y) for y in side for x in side])
    at = lambda i, j: j * len(side) + i  # noqa: E731
    facets = []
    for i, j in ((step * a, step * b) for b in range(n) for a in range(n)):
        c = [at(i, j), at(i + step, j), at(i + step, j + step), at(i, j + step)]
        m = [at(i + 1, j), at(i + step, j + 1), at(i + 1, j + step), at(i, j + 1), at(i + 1, j + 1)]
        facets += {"quad4": [c], "tri3": [c[:3], [c[0], c[2], c[3]]], "quad8": [c + m[:4]], "quad9": [c + m],
                   "tri6": [[*c[:3], m[0], m[1], m[4]], [c[0], c[2], c[3], m[4], m[2], m[3]]]}[kind]
    if not is_lower:
        facets = [[*f[:k][::-1], *(f[k:2 * k][::-1][1:] + f[k:2 * k][::-1][:1]), *f[2 * k:]] if len(f) > k else f[::-1]
                  for f, k in ((f, 3 if kind[:3] == "tri" else 4) for f in facets)]
    used = np.unique(np.concatenate(facets))
    number = {old: new for new, old in enumerate(used)}
    return nodes[used], np.array([[number[k] for k in f] for f in facets])


class Case:
    """Two surfaces that partly overlap, at a point of a second step where nodes are open, stick and slip."""

    def __init__(self, kind, **options):
        if kind[:4] == "line":
            order = int(kind[4]) - 1
            # Beside the axis of axisymmetric models.
            sides, options = [lines(6, 0.3, 1.6, False, order), lines(5, 0.1, 1.3, True, order)], {"model": "plane", **options}
        else:
            sides = [patch(3, 0, 1.3, False, kind), patch(4, -0.2, 1.02, True, kind)]
        random = np.random.default_rng(3)
        (self.X1, f1), (self.X2, f2) = sides
        self.d, self.none = self.X1.shape[1], options.get("friction") == "none"
        ends = np.cumsum([0, self.X1.size, self.X2.size, len(self.X1) if self.none else self.X1.size])
        self.size, self.ends = ends[3], ends
        e1, e2 = np.arange(ends[1]).reshape(self.X1.shape), np.arange(ends[1], ends[2]).reshape(self.X2.shape)
        multipliers = np.arange(ends[2], ends[3]).reshape(-1, 1 if self.none else self.d)
        corners = len(f1[0]) // 2 if kind in ("tri6", "quad8") else {"quad9": 4, "line3": 2}.get(kind, len(f1[0]))
        has = np.zeros(len(self.X1), bool)
        has[np.unique(f1 if options.get("multiplier_space") == "sub" else f1[:, :corners])] = True
        multipliers[~has] = -1
        self.has = np.concatenate([np.ones(ends[2], bool), np.repeat(has, multipliers.shape[1])])
        one = stickslip.Surface(self.X1, f1, e1, multipliers[:, 0].copy() if self.none else multipliers)
        # r and the scale of rows follow the areas of t_n, and count where a row is not 0: they are held.
        law = {"mu": 0.4} if options.get("friction", "coulomb") in ("coulomb", "tresca") else {}
        self.face = stickslip.Interface(one, stickslip.Surface(self.X2, f2, e2), modulus=1000.0, row_scale="none",
                                        new_contact="keep", **law, **options)
        self.face.set_augmentation(np.full(len(self.X1), 500.0))
        noise = lambda x, by: x + by * random.standard_normal(x.shape)  # noqa: E731
        self.before = noise(self.X1, 3e-3 if kind[-1] in "34" else 1e-3), noise(self.X2, 3e-3 if kind[-1] in "34" else 1e-3)
        way = np.zeros(self.d)
        way[0], way[-1] = 0.02, -0.01
        self.now = noise(self.before[0] + way, 2e-3), noise(self.before[1], 2e-3)
        self.lam = np.zeros(self.X1.shape)
        self.lam[:, -1] = -8 * self.X1[:, 0] - 1
        self.lam = noise(self.lam, 1.0) * has[:, None]
        self.lam = self.lam[:, -1].copy() if self.none else self.lam
        self.random = random

    def residual(self, before):
        self.face.set_committed(*before)
        r = np.concatenate([part.ravel() for part in self.face.residual(*self.now, self.lam)])
        return np.where(self.has, r, 0.0)

    def direction(self):
        v = self.random.standard_normal(self.size) * self.has
        return v, v[:self.ends[1]].reshape(self.X1.shape), v[self.ends[1]:self.ends[2]].reshape(self.X2.shape)


def nearest(differences, exact):
    """The error of the best of some differences."""
    return min(np.abs(d - exact).max() / max(np.abs(d).max(), 1e-12) for d in differences)


CASES = [(kind, {"multiplier_basis": basis, "normals": normals, **friction, **({"quadrature": "degree_10"} if "quad" in kind else {})})
         for kind in ("tri3", "quad4", "line2", "line3", "tri6", "quad8", "quad9") for basis in ("standard", "dual")
         for normals in ("current", "committed") for friction in ({}, {"friction": "none"})]
MORE = [("tri3", {"slip": "increment"}), ("tri3", {"weights": "reference"}), ("line2", {"model": "axisymmetric"}),
        ("tri6", {"multiplier_space": "sub", "multiplier_basis": "standard"}), ("tri3", {"friction": "tied"})]


@pytest.mark.parametrize(("kind", "options"), CASES + MORE)
def test_previous_positions(kind, options):
    """The matrix, and products from either side, beside differences through what a host sets as committed."""
    case = Case(kind, **options)
    case.face.set_committed(*case.before)
    b = case.face.previous_tangent(*case.now, case.lam, case.size)
    states = set(case.face.states(*case.now, case.lam).state.ravel())
    assert len(states) > 1 or case.none or options.get("friction") == "tied"
    v, v1, v2 = case.direction()
    at = lambda s: case.residual((case.before[0] + s * v1, case.before[1] + s * v2))  # noqa: E731
    near = [(8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h) for h in (1e-5, 3e-6, 1e-6)]
    exact = b @ v
    if np.abs(exact).max() <= DIFFERENCES:
        assert np.abs(near).max() <= DIFFERENCES
        return
    # What a rule of degree 10 leaves on facets that are no parallelograms.
    bound = 1e-6 if kind in ("quad8", "quad9") else DIFFERENCES
    assert nearest(near, exact) <= bound

    case.face.set_committed(*case.before)
    change = np.concatenate([part.ravel() for part in case.face.sensitivity(*case.now, case.lam, previous1=v1, previous2=v2)])
    assert np.abs(change - exact).max() <= ROUNDING * np.abs(exact).max()
    a, a1, a2 = case.direction()
    rows = a[case.ends[2]:].reshape(case.lam.shape)
    left = case.face.adjoint(*case.now, case.lam, a1, a2, rows, ("previous1", "previous2", "now1", "now2"))
    expected = b.T @ a
    found = np.concatenate([left.previous1.ravel(), left.previous2.ravel()])
    assert np.abs(found - expected[:case.ends[2]]).max() <= ROUNDING * np.abs(expected).max()
    k = case.face.tangent(*case.now, case.lam, case.size)
    found, expected = np.concatenate([left.now1.ravel(), left.now2.ravel()]), k.T @ a
    assert np.abs(found - expected[:case.ends[2]]).max() <= ROUNDING * np.abs(expected).max()


@pytest.mark.parametrize("options", [{}, {"multiplier_basis": "standard"}, {"friction": "tresca", "shear_limit": 1.0}, {"friction": "none"}])
def test_parameters(options):
    """Friction, the limit and offsets, along one direction, beside differences of the residual."""
    case = Case("tri3", **options)
    n1, n2 = len(case.X1), len(case.X2)
    mu, offsets = np.full(n1, 0.4), (1e-4 * np.cos(np.arange(n1)), 1e-4 * np.sin(np.arange(n2)))
    case.face.set_committed(*case.before)
    case.face.set_offsets(*offsets)
    case.face.set_committed(*case.before)
    dmu, dh1, dh2 = (case.random.standard_normal(n) for n in (n1, n1, n2))

    def at(s):
        if not case.none:
            case.face.set_friction(mu + s * dmu)
        case.face.set_offsets(offsets[0] + s * 1e-3 * dh1, offsets[1] + s * 1e-3 * dh2)
        return case.residual(case.before)

    near = [(8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h) for h in (1e-3, 1e-4)]
    at(0.0)
    along = {"offsets1": 1e-3 * dh1, "offsets2": 1e-3 * dh2, **({} if case.none else {"friction": dmu})}
    exact = np.concatenate([part.ravel() for part in case.face.sensitivity(*case.now, case.lam, **along)])
    assert np.abs(exact).max() > 0 and nearest(near, exact) <= DIFFERENCES
    a, a1, a2 = case.direction()
    left = case.face.adjoint(*case.now, case.lam, a1, a2, a[case.ends[2]:].reshape(case.lam.shape), tuple(along))
    products = sum((getattr(left, name) * by).sum() for name, by in along.items())
    assert abs(products - a @ exact) <= ROUNDING * np.abs(a * exact).sum()


@pytest.mark.parametrize("options", [{}, {"multiplier_basis": "standard"}, {"normals": "committed"}, {"slip": "increment"}])
def test_runs(options):
    """20 steps that press, slide and return."""
    run, values = example.Run(**options), {"mu": 0.3, "modulus": 1.0, "press": 0.03, "offset": 0.001}
    exact = run.gradient(run.solve(**values), **values)
    for name, step in (("mu", 1e-4), ("modulus", 1e-4), ("press", 1e-6), ("offset", 1e-5)):
        # A kink, where a node changes its state, may lie within the larger step.
        near = (example.differences(run, name, values, h) for h in (step, step / 10))
        assert min(abs(exact[name] / d - 1) for d in near) <= RUNS, name


def test_calibration():
    """Friction and stiffness from a curve: found again by few runs, and near the truth from a noisy one."""
    import calibration

    truth = list(calibration.TRUTH.values())
    assert calibration.runs <= 30 and np.abs(calibration.exact / truth - 1).max() <= 1e-6
    assert np.abs(calibration.noisy / truth - 1).max() <= 3 * calibration.NOISE


def test_what_is_refused():
    case = Case("tri3", form="augmented")
    with pytest.raises(stickslip.errors.Error, match="derivatives by positions of t_n.*augmented"):
        case.face.previous_tangent(*case.now, case.lam, case.size)
    case = Case("tri3")
    with pytest.raises(TypeError, match="there are previous1"):
        case.face.sensitivity(*case.now, case.lam, velocity=case.X1)


VALUES = (0.3, 1.0, 0.03, 0.001)


def test_jax():
    jax = pytest.importorskip("jax")
    from stickslip.jax import function

    run = example.Run(steps=6)
    forces = function(run)
    with pytest.raises(stickslip.errors.InvalidValue, match="single precision"):
        forces(*VALUES)
    jax.config.update("jax_enable_x64", True)
    weights = np.cos(np.arange(6))

    def functional(*parameters):
        return jax.numpy.vdot(forces(*parameters), weights)

    outputs, ends = run.forward(*VALUES)
    np.testing.assert_array_equal(forces(*VALUES), outputs)
    exact = run.pull(VALUES, ends, weights)
    run.forward(0.2, 1.3, 0.02, 0.003)
    np.testing.assert_array_equal(run.pull(VALUES, ends, weights), exact, "after another run")
    for of in (jax.grad(functional, (0, 1, 2, 3)), jax.jit(jax.grad(functional, (0, 1, 2, 3)))):
        np.testing.assert_allclose(of(*VALUES), exact, rtol=ROUNDING)


def test_torch():
    torch = pytest.importorskip("torch")
    from stickslip.torch import function

    forces = function(example.Run(steps=6))
    parameters = [torch.tensor(v, dtype=torch.float64, requires_grad=True) for v in VALUES]
    # 2e-10 is found: what Newton's method leaves of forces of 1e-2, over the step of the differences.
    assert torch.autograd.gradcheck(forces, parameters, eps=1e-6, atol=1e-8, rtol=1e-6)


def test_a_run_of_another_shape_is_refused():
    from stickslip import differentiable

    run = example.Run(steps=6)
    run.outputs = (5,)
    with pytest.raises(stickslip.errors.InvalidSize, match=r"outputs of shape \(6,\); run.outputs says \(5,\)"):
        differentiable.forward(run, VALUES)
