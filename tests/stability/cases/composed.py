"""Features that meet: normals of now over a tool whose frame has equations, shares of the mortar side under each rule of integration,
the reduced form with an ellipse of friction, symmetric systems of quadratic facets."""

import ctypes

import numpy as np

from cell import ELEMENT, Outcome, series
from cases.assembled import grid, pressed
from library import COMMITTED, DUAL, OF_COMMIT, OF_NOW, STANDARD, Interface, Law, Refused
from quadratic import grid as quadratic_grid
from scenes import EPS

ANALYTIC, FRICTIONLESS, ROUGH = 2, 1, 3  # STICKSLIP_..., in the header's words
WEAK_NONE, ORTHOTROPIC = -1.0, 3
SCHEMES = {"segments": 0, "elements": 1, "hybrid": 2}
FORCES, ELIMINATION, CONSTRAINTS, ROWS, COLUMNS, CONSTRAINED, DIAGONAL = 0, 1, 2, 4, 5, 6, 7
TILTS = (0.0, 1e-3, 1e-2, 0.03, 0.1, 0.3)
SPLITS = (0.9, 0.7, 0.45, 0.2, 0.05, 0.01)
RATIOS = ("1", "2", "5", "10", "100", "1e3")
OFF = (0.0, 0.01, 0.03, 0.05, 0.08, 0.1)  # of mid nodes, over the facet
STEP, DIFFERENCES = 1e-6, 1e-7  # of central differences; truncation and rounding over the largest entry
SHARES = 1e-12  # sums in another order
SAME_STEP = 1e-10  # of two factorisations: the condition times rounding
MODULUS, PRESSURE = 1000.0, 5.0


def framed(tilt):
    """Rows of a plane's frame by the nodes above it, against differences."""

    def run(context):
        outcome = Outcome()
        x1, f1 = grid(2, down=True)
        bent = x1 + np.outer(0.02 * (x1[:, 0] - 0.3) ** 2 + tilt * x1[:, 0] - 1e-3, (0, 0, 1))
        normal = np.array((-tilt, 0.0, 1.0)) / np.hypot(1.0, tilt)
        frame = np.array([(0, 0, 0), normal, (1.0, 0, tilt), (0, 1.0, 0)])
        for components, friction in ((1, FRICTIONLESS), (3, 0)):
            face = Interface(context.library, x1, f1, frame, None, components, frame=True, mortar_side=ANALYTIC, friction=friction,
                             mu=0.0 if friction else 0.3, modulus=MODULUS, basis=STANDARD, normals=OF_NOW)  # fmt: skip
            lam = np.full((len(x1), 1), -PRESSURE) if friction else pressed(x1, (0.1, 0.0, -PRESSURE))
            n = bent.size
            rows = slice(n, n + frame.size)
            found, expected = face.tangent(bent, frame, lam)[rows, :n], np.zeros((frame.size, n))
            for k in range(n):
                move = STEP * np.eye(1, n, k).reshape(bent.shape)
                ahead, behind = (face.residual(bent + s * move, frame, lam)[1] for s in (1, -1))
                expected[:, k] = (ahead - behind).ravel() / (2 * STEP)
            error = np.abs(found - expected).max() / np.abs(expected).max()
            outcome.below(f"forces on the frame by the nodes, {components} multipliers", error, DIFFERENCES, "differences")
            face.close()
        return outcome

    return run


def shared(split):
    """One facet over two plates that meet at `split`: one handle has both, or two have one each."""

    def run(context):
        outcome, library = Outcome(), context.library
        x1, f1 = grid(1, down=True)
        sheet = lambda a, b: np.array([(a, -0.2, 0), (b, -0.2, 0), (b, 1.2, 0), (a, 1.2, 0.0)])
        plates = [sheet(-0.2, split), sheet(split, 1.2)]
        bend = lambda x: x + np.outer(0.02 - 0.05 * np.abs(x[:, 0] - split), (0, 0, 1))
        quad, lam, now = np.arange(4)[None], pressed(x1, (0.1, 0.0, -PRESSURE)), x1 - (0, 0, 1e-2)
        for name, scheme in SCHEMES.items():
            options = {"modulus": MODULUS, "mu": 0.3, "integration": scheme, "basis": STANDARD, "normals": OF_COMMIT}
            both = Interface(library, x1, f1, np.vstack(plates), np.vstack((quad, quad + 4)), **options)
            expected = both.residual(now, np.vstack([bend(x) for x in plates]), lam)
            parts = [Interface(library, x1, f1, x, quad, **options) for x in plates]
            sums = sum(part.sums(now, bend(x)) for part, x in zip(parts, plates))
            try:
                found = [part.residual(now, bend(x), lam, sums=sums) for part, x in zip(parts, plates)]
            except Refused as refusal:
                known = name == "hybrid" and "STICKSLIP_INTEGRATION_HYBRID with sums" in str(refusal)
                outcome.true(f"{name}: refused by name", known, "its rule depends on all shares")
                continue
            force = np.abs(sum(f[0] for f in found) - expected[0]).max() / np.abs(expected[0]).max()
            outcome.below(f"{name}: forces of shares", force, SHARES, "those of one handle")
            row = np.abs(found[0][2] - expected[2]).max() / np.abs(expected[2]).max()
            outcome.below(f"{name}: rows of shares", row, SHARES, "those of one handle")
        return outcome

    return run


def ellipse(text):
    """What sticking nodes have in the reduced form, whatever the ratio of the ellipse's axes."""
    ratio = float(text)

    def run(context):
        outcome = Outcome()
        x1, f1 = grid(2, down=True)
        x2, f2 = grid(1, (-1.0, -1.0), 3.0)
        face = Interface(context.library, x1, f1, x2, f2, mu=0.5, modulus=MODULUS, basis=DUAL, weights=COMMITTED)
        law = Law(kind=ORTHOTROPIC, mu_across=0.5 / ratio, direction=(ctypes.c_double * 3)(2.0, -1.0, 0.0))
        context.library.call("interface_set_law", face.handle, ctypes.byref(law))
        at = x1 - (0, 0, 1e-3), x2, pressed(x1, (0.0, 0.0, -PRESSURE))
        piece = lambda k: face.piece(k, *at)
        one = np.eye(3 * (len(x1) + len(x2)))
        j = np.diag(np.linspace(100, 200, len(one))) + piece(FORCES)
        matrix = (one + piece(ROWS)) @ (j + piece(ELIMINATION) @ j + piece(CONSTRAINTS)) @ (one + piece(COLUMNS))
        diagonal = piece(DIAGONAL)
        error = np.abs(piece(CONSTRAINED) @ matrix - diagonal).max() / np.abs(diagonal).max()
        # The row is stretched by the ratio along one axis and by its reciprocal along the other.
        outcome.below("constraints of the reduced form", error, 10 * EPS * ratio**2, "their diagonal alone")
        outcome.true("some node sticks", (np.abs(np.diag(diagonal)[: x1.size]) > 0).all(), "it is closed")
        face.close()
        return outcome

    return run


def symmetric(off):
    """The step of a host that factors symmetric matrices alone (docs/host_symmetric.md) on quadratic facets."""

    def run(context):
        outcome = Outcome()
        for kind in (6, 8, 9):
            x1, f1 = quadratic_grid(1, kind, down=True)
            x2, f2 = grid(1, (-1.0, -1.0), 3.0)
            random = np.random.default_rng(kind)
            corners = np.isin(x1[:, :2], (0.0, 1.0)).all(axis=1)
            x1[~corners, :2] += off * random.uniform(-1, 1, (int((~corners).sum()), 2))
            face = Interface(context.library, x1, f1, x2, f2, friction=ROUGH, mu=0.0, modulus=MODULUS, basis=DUAL, weights=COMMITTED,
                             weak_coverage=WEAK_NONE)  # fmt: skip
            n, n1 = 3 * (len(x1) + len(x2)), x1.size
            b = random.standard_normal((n, n))
            k, host = 50 * np.eye(n) + b @ b.T / n, 0.1 * random.standard_normal(n)
            host[2:n1:3] += 0.5
            now = x1 - (0, 0, 1e-3)
            lam, rows, forces = face.condensed(now, x2, host[:n1].reshape(-1, 3))
            r = host.copy()
            r[:n1], r[n1:] = rows.ravel(), r[n1:] + forces.ravel()
            piece, one = lambda which: face.piece(which, now, x2, lam), np.eye(n)
            j = k + piece(FORCES)
            expected = np.linalg.solve(j + piece(ELIMINATION) @ j + piece(CONSTRAINTS), -r)
            left, right, q, d = one + piece(ROWS), one + piece(COLUMNS), piece(CONSTRAINED), piece(DIAGONAL)
            p, s, v = right @ (one - q), left @ r, np.zeros(n)
            for a in range(len(x1)):
                e = slice(3 * a, 3 * a + 3)
                if np.trace(q[e, e]) > 0.5:
                    v[e] = -q[e, e] @ s[e] * np.trace(q[e, e]) / np.trace(d[e, e])
            matrix = p.T @ k @ p + q
            outcome.true(f"{kind} nodes: positive definite", (np.linalg.eigvalsh(matrix) > 0).all(), "a Cholesky will do")
            step = p @ np.linalg.solve(matrix, -(one - q) @ s - p.T @ k @ right @ v) + right @ v
            error = np.abs(step - expected).max() / np.abs(expected).max()
            outcome.below(f"{kind} nodes: the step", error, SAME_STEP, "that of the condensed system")
            face.close()
        return outcome

    return run


def cells():
    kind = {"kind": ELEMENT}
    yield from series("frame of a plane, normals of now, tilted by", TILTS, framed, quick=(0.1,), **kind)
    yield from series("shares of the mortar side that meet at", SPLITS, shared, quick=(0.45,), **kind)
    yield from series("reduced form, ellipse of friction, axes", RATIOS, ellipse, quick=("10",), **kind)
    yield from series("symmetric system of quadratic facets, off by", OFF, symmetric, quick=(0.05,), **kind)
