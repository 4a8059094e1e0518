"""General contact: scenes against named pairs with the same sides, against halves on a rigid plane, and what must never happen."""

import copy
import pickle

import crowds
import named
import numpy as np
import pytest
import stickslip
from solids import Run

# General contact is its pieces: the same forces, summed in another order. Up to 3e-15 is found, of bodies of size 1.
SAME = 1e-12
# A homogeneous state: rounding of the solver, of displacements near 0.1.
PATCH = 1e-12
# Of a force, two meshes that mirror each other against one on a plane: the tolerance of Newton's method, 2e-11, and the condition.
MIRRORED = 1e-9


def run(scene, look=None, **options):
    """All steps of a scene by general contact."""
    done = Run(scene.solids, scene.solids.contact(**{**scene.options, **options}), scene.prescribe)
    for time in scene.times:
        if look is not None:
            look(done)
        done.step(time)
    return done


def skin_of(done):
    return done.contact.interfaces[0]


SCENES = [(crowds.three_blocks, (2,), 0.0), (crowds.three_blocks, (2,), 0.3), (crowds.three_blocks, (3,), 0.0), (crowds.three_blocks, (3,), 0.3),
          (crowds.stack, (), 0.3), (crowds.slide, (), 0.2), (crowds.strip, (), 0.3), (crowds.ring, (), 0.0), (crowds.ring, (), 0.3),
          (crowds.notch, (), 0.3), (crowds.slit_block, (), 0.2), (crowds.plates, (), 0.2)]


@pytest.mark.parametrize("make, arguments, mu", SCENES, ids=[f"{make.__name__}{arguments}-{mu}" for make, arguments, mu in SCENES])
def test_it_is_named_pairs_with_the_same_sides(make, arguments, mu):
    scene = make(*arguments)
    sides = []

    def look(done):
        sides[:] = sides or [named.Sides(skin_of(done))]
        sides[0].look()

    general = run(scene, look, mu=mu)
    others = Run(scene.solids, named.contact(scene.solids, sides[0].groups(), mu=mu, **scene.options), scene.prescribe).go(scene.times)
    assert general.iterations == others.iterations
    np.testing.assert_allclose(general.displacements(), others.displacements(), rtol=0, atol=SAME)
    report = skin_of(general).report()
    assert report.contradictions == report.exchanged == report.missed == 0
    assert general.states[0].count(stickslip.State.GAP) < general.states[0].bearing.sum()
