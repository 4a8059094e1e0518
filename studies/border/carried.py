"""Ways to carry what points remember to the points of weights that are made anew at each commit, in the study's plane code:

- projection: onto the functions of each facet;  next: of the nearest old point;  both: the projection, with what is left of the nearest
  old point, as the library has it (docs/formulation 16.9).

carried.py [FACETS...]: shear in steps, its return and rest. Minutes."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "common"))
import folders  # noqa: E402  (puts the others on the path)

sys.path.append(str(folders.ROOT / "tests" / "stability"))
import numpy as np  # noqa: E402

import overlaps  # noqa: E402
from frozen import FrozenPoints  # noqa: E402
from laws import RULE, STABILISATION, Weights  # noqa: E402
from scenes import MU, PULL, Hertz, NoAnswer  # noqa: E402

WAYS = ("projection", "next", "both")
# Of a pull and of its return; steps in which nothing moves.
STEPS, REST = (10, 60), 400
# Singular values of a facet's matrix below this, over the largest, are rounding.
SMALLEST = 1e-10


class Carried(FrozenPoints):
    """Points that decide, with weights of the last commit, of lines that lie flat: nothing turns."""

    def __init__(self, pair, mu, way):
        super().__init__(pair, mu)
        self.pair, self.way, self.base = pair, way, 0.0

    def renew(self, x1, x2):
        """The matrices of weights at these positions."""
        one, two, flat = self.pair.one.facets, self.pair.two.facets, [1, 0]
        points = overlaps.of_lines(x1 * flat, one, x2 * flat, two, RULE)
        self.weights = w = Weights(points, one, two, x1 * flat, x2 * flat)
        self.weight, h = points.weight, self.pair.one.nodal_sizes
        self.own, self.other = self.spread(points.own, w.at_own, len(x1)), self.spread(points.other, w.at_other, len(x2))
        uncovered = w.area == 0
        dual = self.spread(w.psi, w.at_own, len(h)).T * self.weight
        self.difference = [dual @ f / (w.area + uncovered)[:, None] for f in (self.own, -self.other)]
        slope = self.spread(points.gradients[:, :, 0], w.at_own, len(h))
        size = self.weight * (self.own @ h) ** 2 * STABILISATION
        self.left = self.own.T @ (self.weight[:, None] * self.own) + slope.T @ (size[:, None] * slope)
        self.left += np.diag(uncovered * w.area.max())

    def relative(self, x1, x2, component):
        return super().relative(x1, x2, component) - (0.0 if component else self.base)

    def commit(self, x1, x2, lam):
        along = lam.reshape(len(x1), -1)[:, 0]
        before, weight, z = self.weights.points, self.weight, self.answer(x1, x2, lam)[0][0] - self.own @ along
        self.renew(x1, x2)
        self.base = super().relative(x1, x2, 0)
        points, self.stored = self.weights.points, self.own @ along  # what touches for the first time has no traction
        for f in np.intersect1d(points.facet, before.facet):
            old, new = before.facet == f, points.facet == f
            n, place, w = before.own[old], points.own[new], weight[old]
            theta = np.linalg.lstsq(n.T @ (w[:, None] * n), n.T @ (w * z[old]), rcond=SMALLEST)[0] * (self.way != "next")
            nearest = np.abs(place[:, :1] - n[None, :, 0]).argmin(axis=1)
            left = (z[old] - n @ theta)[nearest] * (self.way != "projection")
            self.stored[new] = -(place @ theta + left)


def walk(scene, laws, a, steps, rest):
    way = [(PULL * k / steps, 0.0) for k in range(steps + 1)] + [(PULL, PULL * k / steps) for k in range(1, steps + 1)]
    answer, answers = scene.scene.solve(laws[0], scene.prescribed(a)), []
    for pull, back in way + way[-1:] * rest:
        answer = scene.scene.solve(laws[1], scene.prescribed(a, pull, back), answer)
        scene.scene.commit(laws[1], answer)
        answers.append(answer)
    return answers


def main():
    print("facets, way, steps: error of the pull, after the return [%]; change of a force in the first step of rest, in the others")
    for n in map(int, sys.argv[1:] or ("5", "10")):
        scene = Hertz(n)
        for way, steps in ((way, steps) for way in WAYS for steps in STEPS):
            laws = [Carried(scene.scene.pair, mu, way) for mu in (0.0, MU)]
            try:
                answers = walk(scene, laws, scene.loads()[0], steps, REST)
            except NoAnswer as problem:
                print(n, way, steps, problem)
                continue
            most, end, first, last = (answers[k] for k in (steps, 2 * steps, 2 * steps + 1, -1))
            change = [np.abs((p.force - q.force)[:, 0]).max() / np.abs(q.force[:, 0]).max() for p, q in ((first, end), (last, first))]
            errors = f"{100 * scene.error_of_shear(most):.2f} {100 * scene.error_of_shear(end, most):.2f}"
            print(n, way, steps, errors, *(f"{c:.0e}" for c in change), flush=True)


if __name__ == "__main__":
    main()
