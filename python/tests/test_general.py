"""General contact: scenes against named pairs with the same sides, against halves on a rigid plane, and what must never happen."""

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
# The same where the meshes do not mirror each other at the fold: the error of the mesh.
HALVED = 0.01
# Of the largest displacement: what other sides are on such meshes (5.4e-4 is found), and what is left of them after facets have changed
# theirs: they stick where they were, so 6e-10 is found.
SIDES, EXCHANGED = 1e-3, 1e-8


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
          (crowds.stack, (), 0.3), (crowds.slide, (), 0.2), (crowds.strip, (), 0.3), (crowds.ring, (), 0.0),
          (crowds.ring, (24, 3, [*crowds.RING_TIMES[:15], 30.25]), 0.3),  # what follows needs the attempts of stickslip.steps
          (crowds.notch, (), 0.3), (crowds.slit_block, (), 0.2), (crowds.plates, (), 0.2)]
NAMES = [f"{make.__name__}{len(arguments) and arguments[0]}-{mu}" for make, arguments, mu in SCENES]


@pytest.mark.parametrize("make, arguments, mu", SCENES, ids=NAMES)
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


@pytest.mark.parametrize("cells, dimension, options", [(8, 2, {}), (9, 2, {}), (8, 2, {"basis": "standard"}), (4, 3, {})])
def test_a_notch_closes_from_its_root_as_its_half_on_a_rigid_plane(cells, dimension, options):
    whole = run(crowds.notch(cells, dimension), **options)
    scene, held, flank = crowds.half_notch(cells, dimension)
    s = scene.solids
    facets = s.skin()
    corners = [(0.0, -0.5), (0.0, 2.0)] if dimension == 2 else [(0.0, -0.5, -1.0), (0.0, 2.0, -1.0), (0.0, 2.0, 2.0), (0.0, -0.5, 2.0)]
    plane = stickslip.Surface(corners, [range(len(corners))])
    contact = stickslip.Contact(s.X).add(facets[np.isin(facets, flank).all(axis=1)], plane, held=s.dofs[held], modulus=1.0, **options)
    half = Run(s, contact, scene.prescribe).go(scene.times)
    # All is closed at the end, and flat; before, the projection along slanted normals is not that onto a plane.
    forces = [crowds.force(done, lambda x: x[0] == 1) for done in (whole, half)]
    assert whole.states[0].count(stickslip.State.SLIP) >= 4
    assert forces[0][0] == pytest.approx(forces[1][0], rel=MIRRORED)


@pytest.mark.parametrize("lines, thick", [(24, 3), (40, 4)])
def test_a_ring_closes_as_its_quarter_on_a_rigid_plane(lines, thick):
    whole = run(crowds.ring(lines, thick))
    scene, held = crowds.quarter(lines // 2, thick)
    s = scene.solids
    facets, bodies = s.skin(), s.bodies()
    radius = np.hypot(*s.X[facets].mean(axis=1).T)
    plane = stickslip.Surface([(2.0, 0.0), (-1.0, 0.0)], [[0, 1]])
    contact = stickslip.Contact(s.X).add(facets[(bodies == 0) & (radius > 1)], facets[bodies == 1], crease=0.7, modulus=1.0)
    contact.add(facets[(bodies == 0) & (radius < 1)], plane, held=s.dofs[held], crease=0.7, modulus=1.0)
    part = Run(s, contact, scene.prescribe).go(scene.times)
    forces = [crowds.force(done, lambda x: np.abs(np.hypot(x[0], np.abs(x[1]) - 1.7) - 0.18) < 1e-9, 1)[1] for done in (whole, part)]
    assert part.states[1].count(stickslip.State.SLIP) >= 2
    assert forces[0] == pytest.approx(forces[1], rel=HALVED)


@pytest.mark.parametrize("options", [{}, {"basis": "standard"}], ids=["dual", "standard"])
@pytest.mark.parametrize("dimension", [2, 3])
def test_patch_where_three_bodies_meet(dimension, options):
    scene, walls = crowds.patch(dimension)
    done = run(scene, **options)
    X, u = scene.solids.X, done.displacements()[-1].reshape(scene.solids.X.shape)
    for axis, ends in enumerate(walls):
        far = X[ends[1][0], axis]
        np.testing.assert_allclose(u[:, axis], -0.02 * (axis + 1) * X[:, axis] / far, rtol=0, atol=PATCH)
    states = done.states[0]
    for axis in (0, dimension - 1):
        pressure = states.pressure[(states.state != stickslip.State.GAP) & (np.abs(states.normal[:, axis]) > 0.9)]
        assert len(pressure) > 3 and np.ptp(pressure) < PATCH < pressure.min()


def test_how_far_it_looks_is_of_no_account():
    """Reach times 8: the same digits."""
    near, far = (run(crowds.slide(), mu=0.2, search_distance=reach) for reach in (0.05, 0.4))
    np.testing.assert_allclose(near.displacements(), far.displacements(), rtol=0, atol=SAME)


def test_facets_in_contact_that_change_their_side():
    """A slider nears a rigid body on the same plate, whose side there is the other one. Then the run is that with the other sides."""
    scene, after = crowds.exchange(), []

    def look(done):
        if skin_of(done).report().exchanged:
            after[:] = after or [named.Sides(skin_of(done))]
            after[0].look()

    general = run(scene, look, mu=0.2)
    facets = scene.solids.skin()
    plate = np.flatnonzero((scene.solids.bodies() == 0) & (scene.solids.X[facets][:, :, 1] == 0.4).all(axis=1))
    groups = [(own, plate) for own, _ in after[0].groups()]
    others = Run(scene.solids, named.contact(scene.solids, groups, mu=0.2), scene.prescribe).go(scene.times)
    assert skin_of(general).report().exchanged == 8 and len(after[0].seen) >= 4
    first = len(scene.times) - len(after[0].seen)
    apart = np.abs(general.displacements() - others.displacements()).max(axis=1) / np.abs(others.displacements()).max()
    assert (EXCHANGED < apart[:first]).all() and (apart[:first] < SIDES).all() and (apart[first:] < EXCHANGED).all()
