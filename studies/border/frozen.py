"""Laws that decide at points with the weights of flat surfaces, for good: small displacements. The last coordinate is across.

With friction along the first coordinate the trial traction is sum_A N_A (lambda_TA + r_A wh_A) - r s, cut to mu |t|: wh_A is the
slip in all, dual, and r s a number a point, the history. Symbols as in `laws`."""

import numpy as np

import overlaps
from laws import RULE, STABILISATION, STIFFNESS, Weights


class Frozen:
    """What both laws share: matrices from nodes to points, and systems from tractions at these."""

    def __init__(self, pair, mu, rule):
        one, two, self.mu = pair.one, pair.two, mu
        p = overlaps.between(one, two, rule)
        self.weights = w = Weights(p, one.facets, two.facets, one.x, two.x)
        self.weight, self.across = p.weight, pair.dimension - 1
        self.own = self.spread(p.own, w.at_own, len(one.x))
        self.other = self.spread(p.other, w.at_other, len(two.x))
        # Components of displacements that tractions act along.
        self.along = (0, self.across) if mu else (self.across,)
        self.stored = 0.0  # r s at the points

    def spread(self, values, nodes, count):
        """(points, count): values at the nodes of each point's facet."""
        matrix = np.zeros((len(values), count))
        np.add.at(matrix, (np.arange(len(values))[:, None], nodes), values)
        return matrix

    def answer(self, x1, x2, lam):
        """Tractions at the points, those along before those across, and their derivatives by each trial traction."""
        trials = self.trials(x1, x2, lam)
        closed = trials[-1] < 0
        t = np.where(closed, trials[-1], 0)
        if not self.mu:
            return [t], [[closed]]
        trial = trials[0] - self.stored
        slips, sign = np.abs(trial) > -self.mu * t, np.sign(trial)
        along = np.where(slips, -self.mu * sign * t, trial)
        return [along, t], [[~slips, -self.mu * sign * (slips & closed)], [np.zeros_like(closed), closed]]

    def commit(self, x1, x2, lam):
        """What slipped in the step is stored where it slipped: the trial of the same point is its traction then."""
        self.stored = self.trials(x1, x2, lam)[0] - self.answer(x1, x2, lam)[0][0]

    def relative(self, x1, x2, component):
        """Of both sides, by the law's own measure: `difference` of nodal values."""
        one, two = self.difference
        return one @ x1[:, component] + two @ x2[:, component]

    def forces(self, tractions, x1, x2):
        f1, f2 = np.zeros_like(x1), np.zeros_like(x2)
        for t, c in zip(tractions, self.along):
            f1[:, c], f2[:, c] = self.own.T @ (self.weight * t), -self.other.T @ (self.weight * t)
        return f1, f2

    def places(self, x1, x2, multipliers):
        """Numbers of the unknowns of each side and of the multipliers, and a matrix for all."""
        (n1, d), n2 = x1.shape, len(x2)
        sizes = d * n1, d * n2, multipliers * n1
        parts = np.split(np.arange(sum(sizes)), np.cumsum(sizes)[:2])
        return *(part.reshape(n, -1) for part, n in zip(parts, (n1, n2, n1))), np.zeros((sum(sizes),) * 2)


class FrozenPoints(Frozen):
    """(1) to (4) of `laws`. `factor`: r over rhat; `apart`: with K over rhat, and not over r; `stabilised`: with K at all."""

    def __init__(self, pair, mu=0.0, factor=1.0, apart=True, stabilised=True, lumped=False, rule=RULE):
        super().__init__(pair, mu, rule)
        self.components = len(self.along)
        w, h = self.weights, pair.one.nodal_sizes
        self.r = factor * STIFFNESS * pair.modulus / h
        dual = self.spread(w.psi, w.at_own, len(h)).T * self.weight
        # A node that nothing covers has no gap, and lambda = 0.
        uncovered = w.area == 0
        self.difference = [dual @ f / (w.area + uncovered)[:, None] for f in (self.own, -self.other)]
        size = self.weight * (self.own @ h) ** 2 * STABILISATION * stabilised * (factor if apart else 1)
        slopes = [self.spread(w.points.gradients[:, :, k], w.at_own, len(h)) for k in range(self.across)]
        full = self.own.T @ (self.weight[:, None] * self.own) + sum(s.T @ (size[:, None] * s) for s in slopes)
        self.left = (np.diag(w.area) if lumped else full) + np.diag(uncovered * w.area.max())

    def trials(self, x1, x2, lam):
        lam = lam.reshape(len(x1), -1)
        return [self.own @ (lam[:, k] + self.r * self.relative(x1, x2, c)) for k, c in enumerate(self.along)]

    def residual(self, x1, x2, lam):
        f1, f2 = self.forces(self.answer(x1, x2, lam)[0], x1, x2)
        rows = -(self.left @ lam.reshape(len(x1), -1) - f1[:, self.along]) / self.r[:, None]
        return np.concatenate([f1.ravel(), f2.ravel(), rows.ravel()])

    def tangent(self, x1, x2, lam):
        slopes = self.answer(x1, x2, lam)[1]
        one, two, multipliers, j = self.places(x1, x2, self.components)
        for k, c in enumerate(self.along):
            j[np.ix_(multipliers[:, k], multipliers[:, k])] -= self.left / self.r[:, None]
            for l, b in enumerate(self.along):
                by = self.own * (self.weight * slopes[k][l])[:, None]
                own, other = self.own.T @ by, -self.other.T @ by
                for rows, value in ((one[:, c], own), (two[:, c], other), (multipliers[:, k], own / self.r[:, None])):
                    j[np.ix_(rows, multipliers[:, l])] += value
                    for columns, difference in zip((one[:, b], two[:, b]), self.difference):
                        j[np.ix_(rows, columns)] += value @ (self.r[:, None] * difference)
        return j


class Penalty(Frozen):
    """Trial tractions stiffness times the relative place of the points themselves; no multipliers."""

    components = 0

    def __init__(self, pair, stiffness, mu=0.0, rule=RULE):
        super().__init__(pair, mu, rule)
        self.stiffness, self.difference = stiffness, [self.own, -self.other]

    def trials(self, x1, x2, lam):
        return [self.stiffness * self.relative(x1, x2, c) for c in self.along]

    def residual(self, x1, x2, lam):
        return np.concatenate([f.ravel() for f in self.forces(self.answer(x1, x2, lam)[0], x1, x2)])

    def tangent(self, x1, x2, lam):
        slopes = self.answer(x1, x2, lam)[1]
        one, two, _, j = self.places(x1, x2, 0)
        sides = (one, self.own), (two, -self.other)
        for k, c in enumerate(self.along):
            for l, b in enumerate(self.along):
                by = (self.stiffness * self.weight * slopes[k][l])[:, None]
                for rows, f in sides:
                    for columns, g in sides:
                        j[np.ix_(rows[:, c], columns[:, b])] += f.T @ (by * g)
        return j


class LastStep(FrozenPoints):
    """The same with slip since the last step, as the library's law at nodes has it: nothing is stored at points, and the
    multipliers alone carry tractions from step to step."""

    def commit(self, x1, x2, lam):
        self.stored = self.own @ (self.r * self.relative(x1, x2, 0))
