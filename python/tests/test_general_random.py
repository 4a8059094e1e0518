"""Random round bodies pushed and rolled into each other: no body passes through another one, forces balance, and steps converge or are
refused. By itself, with PYTHONPATH=python/src:python/examples: test_general_random.py SCENES STEPS tells it of many."""

import sys
import warnings

import numpy as np
import pytest
import stickslip
from solids import Run, Solids, block

SEEDS, STEPS = (0, 2, 4, 5, 7), 10
# A corner of one body may be in a facet of another one, for gaps are means over facets: so far, over a facet's length. 0.19 is found.
DEEPEST = 0.25
# Forces of contact on all bodies, of sums of the same numbers, over the largest.
BALANCE = 1e-13


def body(random, centre, cells):
    """A convex body between an ellipse and a rectangle, turned."""
    size, power, angle = 0.48 * random.uniform(0.6, 1.0, 2), 1 + random.uniform(1, 4), random.uniform(0, np.pi)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])

    def shape(X):
        out, way = np.abs(X).max(axis=1)[:, None], np.arctan2(X[:, 1], X[:, 0])
        radius = (np.abs(np.cos(way)) ** power + np.abs(np.sin(way)) ** power) ** (-1 / power)
        outline = size * out * np.column_stack([radius * np.cos(way), radius * np.sin(way)])
        return (out * outline + (1 - out) * 0.7 * size * X) @ turn.T + centre

    return block((-1, -1), (1, 1), (cells, cells), shape)


class Pile:
    """Two to four of them, whose cores move to the middle and turn."""

    def __init__(self, seed):
        random = np.random.default_rng(seed)
        places = random.permutation([(i, j) for i in range(2) for j in range(2)])[: random.integers(2, 5)]
        self.centres = places * 1.05 + random.uniform(-0.02, 0.02, places.shape)
        self.solids = Solids(*(body(random, centre, int(random.integers(4, 9))) for centre in self.centres),
                             young=random.uniform(0.5, 3, len(places)))
        self.mu, self.part, self.spin = random.choice([0.0, 0.2, 0.5]), random.uniform(0.25, 0.4), random.uniform(-0.8, 0.8, len(places))
        self.cores = [nodes[np.linalg.norm(self.solids.X[nodes] - centre, axis=1) < 0.2]
                      for nodes, centre in zip(self.solids.nodes, self.centres)]

    def prescribe(self, time):
        out = []
        for core, centre, spin in zip(self.cores, self.centres, self.spin):
            arm, c, s = self.solids.X[core] - centre, np.cos(spin * time), np.sin(spin * time)
            out.append((core, self.part * time * (self.centres.mean(axis=0) - centre) + arm @ np.array([[c, s], [-s, c]]) - arm))
        return out


def deepest(solids, u):
    """How far any node is inside another body, over the length of the facets there."""
    path = pytest.importorskip("matplotlib.path")
    x, facets, bodies, found = solids.X + u, solids.skin(), solids.bodies(), 0.0
    for number in range(len(solids.nodes)):
        after = dict(facets[bodies == number].tolist())
        ring = [next(iter(after))]
        while after[ring[-1]] != ring[0]:
            ring.append(after[ring[-1]])
        a, b = x[ring], np.roll(x[ring], -1, axis=0)
        others = np.unique(facets[bodies != number])
        for point in x[others[path.Path(np.vstack([a, a[:1]]), closed=True).contains_points(x[others])]]:
            part = np.clip(((point - a) * (b - a)).sum(axis=1) / ((b - a) ** 2).sum(axis=1), 0, 1)[:, None]
            found = max(found, np.linalg.norm(a + part * (b - a) - point, axis=1).min() / np.linalg.norm(b - a, axis=1).mean())
    return found


@pytest.mark.parametrize("seed", SEEDS)
def test_no_body_passes_through_another_one(seed):
    pile = Pile(seed)
    s = pile.solids
    done = Run(s, s.contact(mu=pile.mu), pile.prescribe)
    contact, skin = done.contact, done.contact.interfaces[0]
    forces = []

    def tangent(u, time):
        return s.tangent(u)

    def accepted(x, time):
        assert deepest(s, x[: s.X.size].reshape(s.X.shape)) < DEEPEST

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", stickslip.StepWarning)  # corners of coarse meshes that lie in each other a little
        for step in stickslip.steps(contact, s.residual, tangent, np.arange(1, STEPS + 1) / STEPS, done.x, fixed=done.held(0.0)[0],
                                    prescribed=lambda time: done.held(time)[1], accepted=accepted):
            force, _ = skin.residual(s.X[np.unique(s.skin())] + step.x[: s.X.size].reshape(s.X.shape)[np.unique(s.skin())],
                                     contact._parts[0].multipliers(step.x[s.X.size :]))
            assert np.abs(force.sum(axis=0)).max() <= BALANCE * max(np.abs(force).max(), 1.0)
            forces.append(np.abs(force).max())
    assert max(forces) > 1e-3 and step.states[0].count(stickslip.State.GAP) < step.states[0].bearing.sum()


def told(seed, steps):
    """How a scene ends, and how deep any node has been in another body."""
    pile, worst = Pile(seed), 0.0
    s = pile.solids
    done = Run(s, s.contact(mu=pile.mu), pile.prescribe)
    try:
        for step in stickslip.steps(done.contact, s.residual, lambda u, time: s.tangent(u), np.arange(1, steps + 1) / steps, done.x,
                                    fixed=done.held(0.0)[0], prescribed=lambda time: done.held(time)[1]):
            worst = max(worst, deepest(s, step.x[: s.X.size].reshape(s.X.shape)))
    except stickslip.StepRefused as refusal:
        return worst, f"stopped: {refusal}"
    return worst, ""


if __name__ == "__main__":
    warnings.simplefilter("ignore", stickslip.StepWarning)
    scenes = [told(seed, int(sys.argv[2])) for seed in range(int(sys.argv[1]))]
    for seed, (worst, end) in enumerate(scenes):
        if end:
            print(f"seed {seed}: {end}")
    depths = [worst for worst, _ in scenes]
    print(f"{len(scenes)} scenes, {sum(end == '' for _, end in scenes)} to the end; deepest node {max(depths):.2f} of a facet, "
          f"above {DEEPEST} in {sum(depth > DEEPEST for depth in depths)}")
