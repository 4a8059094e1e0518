"""General contact from step to step: refusals, rollback, restart; and what a user says and sees."""

import pickle

import crowds
import numpy as np
import pytest
import stickslip
from solids import Run, Solids, block

# Two ways to the same state: the tolerance of Newton's method, over displacements near 0.3.
SAME_STATE = 1e-10
# Forces of contact on both bodies, of sums of the same numbers.
BALANCE = 1e-15
# Of the largest displacement, blocks of cells of 0.2 with the other sides: the error of such meshes.
OTHER_SIDES = 0.03


def begun(scene, **options):
    return Run(scene.solids, scene.solids.contact(**{**scene.options, **options}), scene.prescribe)


def skin_of(done):
    return done.contact.interfaces[0]


def test_a_drop_over_six_times_the_reach_is_refused_and_then_right():
    scene = crowds.drop()
    done = begun(scene)
    start = done.x.copy()
    done.solve(1.0)
    assert done.contact.states(done.x)[0].count(stickslip.State.GAP) == done.contact.states(done.x)[0].bearing.sum()
    through = done.x.copy()
    with pytest.raises(stickslip.errors.ContactLost, match="facets 5 and 14 of the skin have met within the step"):
        done.contact.commit(done.x)
    np.testing.assert_array_equal(done.x, through)
    assert done.contact.missed == 1
    done.x[:] = start
    done.step(1.0)
    far = begun(scene, search_distance=0.4)
    far.step(1.0)
    assert done.states[0].count(stickslip.State.SLIP) == 5
    np.testing.assert_allclose(done.displacements(), far.displacements(), rtol=0, atol=SAME_STATE)


@pytest.mark.parametrize("reach", [{}, {"search_distance": 0.05}])
def test_steps_solves_such_a_step_again(reach):
    scene = crowds.drop()
    scene.options.pop("search_distance")
    done = begun(scene, **reach)
    fixed = done.held(1.0)[0]
    step, = stickslip.steps(done.contact, scene.solids.residual, scene.solids.tangent, [1.0], done.x, fixed=fixed,
                            prescribed=lambda time: done.held(time)[1])
    assert step.cuts == 0 and done.contact.missed == 1 and step.states[0].count(stickslip.State.SLIP) == 5


def evaluated(contact, x):
    """All that a skin answers to a point that is not in balance."""
    x = x + 1e-4 * np.sin(np.arange(len(x)))
    r = np.zeros(contact.size)
    contact.add_residual(x, r)
    states = contact.states(x)[0]
    return [r, contact.tangent(x).toarray(), states.gap, states.slip, states.traction]


@pytest.mark.parametrize("make, every, mu", [(crowds.slide, 3, 0.2), (crowds.strip, 1, 0.3), (crowds.exchange, 2, 0.2)])
def test_every_commit_can_be_undone_and_every_step_restarted(make, every, mu):
    scene = make()
    done, last = begun(scene, mu=mu), None
    for time in scene.times[::every]:
        done.solve(time)
        before, multipliers = evaluated(done.contact, done.x), done.x.copy()
        kept = pickle.dumps(skin_of(done).history())
        done.contact.commit(done.x)
        after, at = evaluated(done.contact, done.x), done.x.copy()
        done.contact.rollback()
        assert pickle.dumps(skin_of(done).history()) == kept
        done.x[:] = multipliers
        assert all(map(np.array_equal, evaluated(done.contact, done.x), before))
        done.contact.commit(done.x)
        assert np.array_equal(done.x, at) and all(map(np.array_equal, evaluated(done.contact, done.x), after))
        other = begun(scene, mu=mu)
        skin_of(other).restore(pickle.loads(pickle.dumps(skin_of(done).history())))
        assert all(map(np.array_equal, evaluated(other.contact, done.x), after))
        if last is not None:  # goes on as the one that was never stopped
            last.solve(time)
            last.contact.commit(last.x)
            assert np.array_equal(last.x, done.x)
        last, last.x[:] = other, done.x
    with pytest.raises(stickslip.errors.NothingToRollBack):
        other.contact.rollback()


def test_what_it_says_of_itself():
    scene = crowds.three_blocks(2)
    done = begun(scene, mu=0.3)
    skin, contact = skin_of(done), done.contact
    assert contact.report() == str(skin.report()) and skin.report().text.startswith("3 bodies; ")
    done.solve(1.0)
    told = contact.report(done.x)
    for words in ("Bodies 0 and 1: 4 facets within reach", "Bodies 0 and 2: 5 facets", "Bodies 1 and 2: 5 facets", " nodes in contact, ",
                  "The force of contact on body 0 is (", "The force of contact on body 2 is ("):
        assert words in told
    x = contact._parts[0].positions(contact._displacements(done.x))[0]
    force, _ = skin.residual(x, contact._parts[0].multipliers(done.x[contact.n_host :]))
    assert np.abs(force.sum(axis=0)).max() < BALANCE and np.abs(force).max() > 1e-3
    facets = skin.facets()
    assert set(facets.side[facets.piece >= 0]) == {stickslip.constants["SKIN_NONMORTAR"]}
    touching = np.flatnonzero(facets.partner >= 0)
    assert (facets.side[touching] != stickslip.constants["SKIN_NONE"]).all()
    assert (facets.side[touching] != facets.side[facets.partner[touching]]).all()
    assert facets.distance[touching].max() < 0.2 and set(facets.body) == {0, 1, 2}
    assert "24 lines" not in repr(skin) and "lines of" in repr(skin) and repr(skin) in repr(contact)


def test_bodies_that_do_not_see_each_other_and_friction_of_two():
    scene = crowds.three_blocks(2)
    apart = begun(scene, mu=0.3)
    skin_of(apart).set_pair(1, 2, None)
    apart.solve(1.0)
    assert "Bodies 1 and 2" not in apart.contact.report(apart.x)
    smooth, rough = begun(scene, mu=0.0), begun(scene, mu=0.3)
    for body in (1, 2):
        skin_of(smooth).set_pair(0, body, 0.3)
        skin_of(rough).set_pair(1, 2, 0.0)
    for done in (smooth, rough):
        done.solve(1.0)
    np.testing.assert_array_equal(smooth.x, rough.x)
    with pytest.raises(stickslip.Error, match="7"):
        skin_of(smooth).set_pair(0, 7, 0.3)


def test_bodies_that_hang_together_are_one_and_may_be_named_otherwise():
    s = Solids(block((0, 0), (1, 1), (2, 2)), block((0, 1.01), (1, 2), (2, 2)))
    facets = s.skin()
    by_itself = stickslip.Contact(s.X).add(facets, modulus=1.0).interfaces[0].facets()
    assert list(np.unique(by_itself.body)) == [0, 1]
    named = stickslip.Contact(s.X).add(facets, bodies=s.bodies() + 7, modulus=1.0).interfaces[0].facets()
    assert list(np.unique(named.body)) == [7, 8]
    np.testing.assert_array_equal(named.partner, by_itself.partner)


def test_copies_are_where_faces_meet():
    X, cells = block((0, 0), (1, 1), (2, 2))
    skin = stickslip.Contact(X).add(stickslip.skin(cells, X), modulus=1.0).interfaces[0]
    assert (skin.n_copies, skin.n_multipliers) == (12, 24)
    np.testing.assert_array_equal(skin.originals[:8], np.arange(8))
    assert sorted(skin.equations.ravel()) == list(range(18, 42))
    for nodes, copies in zip(skin.facet_nodes, skin.facet_copies):
        np.testing.assert_array_equal(skin.originals[copies], nodes)


def test_what_does_not_go_together_is_refused():
    X, cells = block((0, 0), (1, 1), (2, 2))
    facets = stickslip.skin(cells, X)
    for how, words in (({"crease": 0.7}, "^crease: "), ({"bodies": [1, 2]}, "^bodies: "), ({"friction": "tied"}, "tie surfaces"),
                       ({"decision": "points"}, "DECISION_NODES")):
        with pytest.raises(stickslip.Error, match=words):
            stickslip.Contact(X).add(facets, modulus=1.0, **how)
    with pytest.raises(stickslip.errors.InvalidValue, match="^condensed: "):
        stickslip.Contact(X, condensed=True).add(facets, modulus=1.0)
    with pytest.raises(stickslip.errors.InvalidValue, match="a whole skin already"):
        stickslip.Contact(X).add(facets, modulus=1.0).add(facets, modulus=1.0)
    with pytest.raises(stickslip.errors.InvalidValue, match="^bodies: two sides are named"):
        stickslip.Contact(X).add(facets[:2], facets[2:4], bodies=[0, 0], modulus=1.0)
    skin = stickslip.Skin(stickslip.Surface(X[np.unique(facets)], facets * 0 + np.searchsorted(np.unique(facets), facets)), modulus=1.0,
                          model="plane")
    with pytest.raises(stickslip.errors.InvalidValue, match="^report: needs x and lam"):
        skin.report(X[np.unique(facets)])
    skin.close()
    with pytest.raises(stickslip.errors.InvalidValue, match="the skin is closed"):
        skin.facets()
    assert "closed" in repr(skin)


def test_the_other_sides_where_no_step_is_short_enough(monkeypatch):
    scene = crowds.three_blocks(2)
    done = begun(scene, mu=0.3)
    done.step(0.25)
    sides, contact, asked = skin_of(done).facets().side, done.contact, []
    commit = contact.commit

    def only_with_others(x):
        asked.append(len(asked))
        if np.array_equal(skin_of(done).facets().side, sides):
            raise stickslip.StepRefused("not with these sides")
        commit(x)

    monkeypatch.setattr(contact, "commit", only_with_others)
    step, = stickslip.steps(contact, scene.solids.residual, scene.solids.tangent, [0.5], done.x, begin=0.25, fixed=done.held(0.5)[0],
                            prescribed=lambda time: done.held(time)[1])
    one, two = (stickslip.constants[f"SKIN_{name}"] for name in ("NONMORTAR", "MORTAR"))
    now = skin_of(done).facets().side
    assert step.cuts == 6 and len(asked) == 8 and (now[sides == one] == two).all() and (now[sides == two] == one).all()
    plain = begun(scene, mu=0.3).go([0.25, 0.5])
    u = plain.displacements()[-1]
    assert 0 < np.abs(step.x[: len(u)] - u).max() < OTHER_SIDES * np.abs(u).max()
