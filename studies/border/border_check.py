"""What the study rests on, and its two findings, on its smallest meshes."""

import numpy as np

import overlaps
from frozen import FrozenPoints, Penalty
from laws import Nodal, Points, Weights
from scenes import MU, PULL, Corner, Hertz, Patch
from verdict import Verdicts

# Of weights and gaps, over the largest: rounding.
SAME = 1e-13
# Of forces, rows and their derivatives, over the largest: some dozen roundings, of lambda and r gh that nearly cancel.
SAME_POINTS = 1e-12
# Of the patch test's tractions: rounding of a solved system.
PATCH = 1e-11
# A tangent against central differences of STEP: their own error.
STEP, TANGENT = 1e-6, 1e-7
# Hertz' line, 5 facets over the half-width, mean over the border's positions.
LINE_BOUND = 0.016
# The shear of Cattaneo and Mindlin, likewise.
SHEAR_BOUND = 0.05
# Steps in which nothing moves, and what they may change: Newton's tolerance, over stiffness.
RESTS, CREEP = 10, 1e-8
# Positions of the border in the check; the study has ten.
POSITIONS = 4


def same_weights(library, v):
    kinds = {"lines": {}, "lines of 1 : 2": {"uneven": True}, "rectangles": {"dimension": 3},
             "triangles": {"dimension": 3, "triangles": True}}
    for name, kind in kinds.items():
        pair = Hertz(3, **kind).scene.pair
        points = overlaps.between(pair.one, pair.two, 3)
        v.below(f"weights of {name}", overlaps.worst_weight(library, pair.one, pair.two, points), SAME, "the library's own")


def same_gaps(library, v):
    """The library's dual gaps over D against gh, curved surfaces, weights of now."""
    scene = Hertz(5, radius=12.0).scene
    at, (one, two) = scene.start(), (scene.pair.one, scene.pair.two)
    at[0][:, 1] -= 0.01
    law = Nodal(library, scene.pair, *scene.start(), "dual", weights="current")
    states = law.interface.states(*at, np.zeros((len(one.x), 1)))
    w = Weights(overlaps.of_lines(at[0], one.facets, at[1], two.facets, 2), one.facets, two.facets, *at)
    gaps = w.gaps(overlaps.normals_of_lines(scene.start()[0], one.facets))
    v.below("dual gaps", np.abs(gaps * w.area - states["gap"]).max() / np.abs(states["gap"]).max(), SAME, "the library's own")


def same_points(library, v):
    """The library's own points against those of the study, on lines, whose rule is the same."""
    random = np.random.default_rng(2)
    for uneven, mu in ((False, 0.0), (True, 0.0), (False, MU), (True, MU)):
        scene = Hertz(6, uneven=uneven).scene
        pair, rest = scene.pair, scene.start()
        laws = FrozenPoints(pair, mu=mu), Nodal(library, pair, pair.one.x, pair.two.x, "dual", mu=mu, decision="points")
        x1, x2 = (x + 2e-3 * random.standard_normal(x.shape) for x in rest)
        x1[:, 1] -= 0.02
        at = x1, x2, 0.01 * random.standard_normal((len(x1), laws[0].components))
        if mu:  # and what points remember
            for law in laws:
                law.commit(*at)
            at = x1 + 1e-3 * random.standard_normal(x1.shape), x2, at[2] + 2e-3 * random.standard_normal(at[2].shape)
        for name, found in (("residual", [law.residual(*at) for law in laws]), ("tangent", [law.tangent(*at) for law in laws])):
            # As forces.
            scale = np.append(np.ones(x1.size + x2.size), np.repeat(laws[0].r, laws[0].components))
            own, other = (f * (scale[:, None] if f.ndim == 2 else scale) if law is laws[0] else f for f, law in zip(found, laws))
            error = np.abs(own - other).max() / np.abs(own).max()
            v.below(f"the library's points, {name}{', uneven' if uneven else ''}{', friction' if mu else ''}", error, SAME_POINTS, "the study's law")


def tangents(v):
    # As many facets as leave columns of several nodes to be made together.
    scene, random = Hertz(6, radius=12.0).scene, np.random.default_rng(1)
    rest = scene.start()
    laws = {"points": FrozenPoints(scene.pair), "points, friction": FrozenPoints(scene.pair, mu=MU),
            "points, weights of now": Points(scene.pair, *rest), "lumped": Points(scene.pair, *rest, lumped=True),
            "penalty, friction": Penalty(scene.pair, 3.0, mu=MU)}
    for name, law in laws.items():
        x1, x2 = (x + 2e-3 * random.standard_normal(x.shape) for x in rest)
        x1[:, 1] -= 0.02
        parts = [x1, x2, 0.01 * random.standard_normal((len(x1), law.components))]
        steps = [random.standard_normal(p.shape) for p in parts]
        ahead, behind = (law.residual(*(p + s * STEP * d for p, d in zip(parts, steps))) for s in (1, -1))
        differences = (ahead - behind) / (2 * STEP)
        exact = law.tangent(*parts) @ np.concatenate([d.ravel() for d in steps])
        v.below(f"tangent, {name}", np.abs(exact - differences).max() / np.abs(differences).max(), TANGENT, "differences")
        f = law.residual(*parts)[: x1.size + x2.size].reshape(-1, 2)
        v.below(f"sum of forces, {name}", np.abs(f.sum(axis=0)).max() / np.abs(f).max(), SAME, "momentum")


def patches(v):
    for uneven in (False, True):
        scene = Patch(uneven=uneven)
        pair, rest = scene.scene.pair, scene.scene.start()
        laws = {"points": FrozenPoints(pair), "lumped": FrozenPoints(pair, lumped=True), "weights of now": Points(pair, *rest)}
        for name, law in laws.items():
            answer = scene.scene.solve(law, scene.prescribed)
            v.below(f"patch test, {name}{', uneven' if uneven else ''}", scene.error(answer), PATCH, "exact")


def mean(scene, law):
    return np.mean([scene.error(scene.scene.solve(law, scene.prescribed(a))) for a in scene.loads(POSITIONS)])


def shear(scene, pressed, drawn, a):
    start = scene.scene.solve(pressed, scene.prescribed(a))
    return scene.error_of_shear(scene.scene.solve(drawn, scene.prescribed(a, PULL), start))


def findings(library, v):
    scene = Hertz(5)
    pair = scene.scene.pair
    by_library = mean(scene, Nodal(library, pair, pair.one.x, pair.two.x, "dual", decision="points"))
    v.below("the same by the library's own points", by_library, LINE_BOUND, "the study")
    points, nodes = mean(scene, FrozenPoints(pair)), mean(scene, Nodal(library, pair, pair.one.x, pair.two.x, "dual"))
    v.below("Hertz' line, 5 facets, points", points, LINE_BOUND, "the study")
    v.at_least("the same: dual nodes' error over it", nodes / points, 1.5, "the study")
    of_shear = [shear(scene, *(Nodal(library, pair, pair.one.x, pair.two.x, "dual", mu=mu, decision="points") for mu in (0.0, MU)), a)
                for a in scene.loads(POSITIONS)]
    v.below("shear of Cattaneo and Mindlin, 5 facets, by the library's own points", np.mean(of_shear), SHEAR_BOUND, "the study")
    scene = Hertz(5, uneven=True)
    full, lumped = (mean(scene, FrozenPoints(scene.scene.pair, lumped=lumped)) for lumped in (False, True))
    v.at_least("facets of 1 : 2: lumped error over the consistent one", lumped / full, 1.5, "the study")
    # A reference of fewer cells.
    shortened = type("Shortened", (Corner,), {"CELLS": 80, "HALVED": 6})
    scene = shortened(10, 0.3, wide=True)
    answer = scene.scene.solve(FrozenPoints(scene.scene.pair), scene.scene.prescribed)
    v.below("corner, partly covered facets", scene.error(answer, shortened.reference()), 0.03, "the study")


def rest(v):
    """Steps in which nothing moves change nothing, if slip is stored at points."""
    scene = Hertz(3)
    pair, a = scene.scene.pair, scene.loads()[0]
    law, answers = FrozenPoints(pair, mu=MU), [scene.scene.solve(FrozenPoints(pair), scene.prescribed(a))]
    for _ in range(RESTS):
        answers.append(scene.scene.solve(law, scene.prescribed(a, PULL), answers[-1]))
        scene.scene.commit(law, answers[-1])
    change = np.abs((answers[-1].force - answers[1].force)[:, 0]).max() / np.abs(answers[1].force[:, 0]).max()
    v.below(f"change in {RESTS} steps of rest", change, CREEP, "nothing moves")


def check(library):
    verdicts = Verdicts()
    same_weights(library, verdicts)
    same_gaps(library, verdicts)
    same_points(library, verdicts)
    tangents(verdicts)
    patches(verdicts)
    findings(library, verdicts)
    rest(verdicts)
    verdicts.print()
    return 0 if verdicts.passed else 1
