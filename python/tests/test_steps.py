"""Load steps: predictor, attempts, cut-backs, what a host refuses, what is told."""

import sys

import numpy as np
import pytest
import stickslip
from bodies import Blocks

GRIP = np.array([2e-3, 8e-4, -5e-3])
TIMES = (0.25, 0.5, 0.75, 1.0)
# Two ways to the same step: the tolerance of Newton's method, over the displacements.
SAME = 1e-9
# Of sums of three numbers near 1; of forces, whose positions are turned.
ROUNDING, TURNED = 1e-15, 1e-12


@pytest.fixture(scope="module")
def blocks():
    return Blocks()


def run(blocks, contact, times=TIMES, grip=GRIP, residual=None, **how):
    return list(stickslip.steps(contact, residual or blocks.residual, blocks.tangent, times, fixed=blocks.fixed,
                                prescribed=lambda time: blocks.values(time * grip), **how))


def test_steps_are_committed_one_after_the_other(blocks):
    contact = blocks.contact()
    done = run(blocks, contact, predictor=False)
    assert [step.time for step in done] == list(TIMES) and not any(step.cuts for step in done)
    other = blocks.contact()
    x = other.start()
    for step in done:
        stickslip.newton(other, blocks.residual, blocks.tangent, x, fixed=blocks.fixed, values=blocks.values(step.time * GRIP))
        np.testing.assert_array_equal(x, step.x)
        other.commit(x)
    assert str(done[-1]) == f"time 1: {done[-1].iterations} iterations, {done[-1].states[0]}"


def test_a_predictor_saves_iterations_and_changes_nothing_else(blocks):
    plain, ahead = run(blocks, blocks.contact(), predictor=False), run(blocks, blocks.contact())
    assert sum(step.iterations for step in ahead) < sum(step.iterations for step in plain)
    np.testing.assert_allclose(ahead[-1].x, plain[-1].x, atol=SAME * np.abs(plain[-1].x).max())


def test_a_start_of_ones_own(blocks):
    upper = blocks.dofs[np.unique(blocks.cells[0])]
    seen = []

    def start(x, begin, end):
        seen.append((begin, end))
        x[upper] += (end - begin) * GRIP

    moved, plain = run(blocks, blocks.contact(), start=start), run(blocks, blocks.contact())
    assert seen == list(zip((0.0, *TIMES), TIMES))
    np.testing.assert_allclose(moved[-1].x, plain[-1].x, atol=SAME * np.abs(plain[-1].x).max())


def test_a_step_that_a_host_refuses_is_cut_back(blocks, capsys):
    longest = 0.3
    contact = blocks.contact()
    last = [0.0]

    def residual(u, time):
        if time - last[0] > longest:
            raise stickslip.StepRefused("the material wants shorter steps")
        return blocks.K @ u

    done = []
    for step in stickslip.steps(contact, residual, blocks.tangent, (1.0, 1.25), fixed=blocks.fixed, progress=True,
                                prescribed=lambda time: blocks.values(time * GRIP), accepted=lambda x, time: last.__setitem__(0, time)):
        done.append(step)
    assert [step.cuts for step in done] == [3, 0] and last == [1.25]
    told = capsys.readouterr().out.splitlines()
    assert told[0] == "time 0: cut back to 0.5: the material wants shorter steps"
    assert told[-1] == str(done[-1]) and len(told) == 5
    whole = run(blocks, blocks.contact(), times=(0.25, 0.5, 0.75, 1.0, 1.25))
    np.testing.assert_allclose(done[-1].x, whole[-1].x, atol=SAME * np.abs(whole[-1].x).max())


def test_no_step_is_short_enough(blocks):
    contact = blocks.contact()

    def residual(u, time):
        if time > 0.3:
            raise stickslip.StepRefused("no more than this")
        return blocks.K @ u

    x = contact.start()
    with pytest.raises(stickslip.StepRefused, match=r"^time 0.296875: no step is short enough. The last attempt: no more than this"):
        list(stickslip.steps(contact, residual, blocks.tangent, (1.0,), x, fixed=blocks.fixed,
                             prescribed=lambda time: blocks.values(time * GRIP)))
    assert x[blocks.top[0, 0]] == pytest.approx(0.296875 * GRIP[0])  # where it has come to
    assert contact.balanced(x)


def test_a_mistake_is_no_failed_step(blocks):
    with pytest.raises(stickslip.errors.InvalidSize, match="^residual: gives 3 entries"):
        run(blocks, blocks.contact(), residual=lambda u, time: u[:3])


def test_a_commit_that_is_refused_is_a_failed_step(blocks, monkeypatch):
    contact, refused = blocks.contact(), []
    commit = contact.commit

    def once(x):
        if not refused:
            refused.append(1)
            raise stickslip.errors.ContactLost("a closed node would lose a pair")
        commit(x)

    monkeypatch.setattr(contact, "commit", once)
    assert [step.cuts for step in run(blocks, contact, times=(1.0,))] == [1]


def test_a_step_that_must_not_count_is_cut_back(blocks, monkeypatch):
    contact, asked = blocks.contact(), []

    def check(x):
        asked.append(contact.balanced(x))
        if len(asked) == 1:
            raise stickslip.StepRefused("bodies overlap")

    monkeypatch.setattr(contact, "check", check)
    assert [step.cuts for step in run(blocks, contact, times=(1.0,))] == [1] and asked == [True] * 3


def test_attempts_follow_each_other(blocks, monkeypatch):
    """Predictor, full steps, line search, two phases, closing: each once where the one before has failed."""
    asked, normals, contact = [], ["current"], blocks.contact()
    solved, use_normals = sys.modules["stickslip.steps"].solved, contact.use_normals

    def failing(*arguments, search, closing, **how):
        asked.append(("search" if search else "closing" if closing else "full", normals[-1], arguments[3].copy()))
        if len(asked) in (2, 3, 4, 6):  # of the second step all but the last, of two phases the second
            raise stickslip.StepRefused("not yet")
        return solved(*arguments, search=search, closing=closing, **how)

    def watched(which):
        normals.append(which)
        return use_normals(which)

    monkeypatch.setattr(contact, "use_normals", watched)
    monkeypatch.setattr(sys.modules["stickslip.steps"], "solved", failing)
    begun = contact.start()
    first, second = run(blocks, contact, times=(0.5, 1.0))
    assert [(how, which) for how, which, _ in asked] == [
        ("full", "current"), ("full", "current"), ("full", "current"), ("search", "current"), ("full", "committed"), ("full", "current"),
        ("closing", "current")]
    np.testing.assert_allclose(asked[1][2], 2 * first.x - begun, atol=ROUNDING)
    for _, _, start in (*asked[2:5], asked[6]):
        np.testing.assert_array_equal(start, first.x)
    assert second.cuts == 0


def test_multipliers_turn_with_the_surfaces():
    """Both blocks turn by 40 degrees as a whole: with positions and multipliers turned, the forces of contact have turned."""
    blocks = Blocks(poisson=0.0, margin=0.0)
    contact = blocks.contact()
    x, _ = blocks.solve(contact, (0.0, 0.0, -5e-3))
    contact.commit(x)
    turn = np.array([[np.cos(0.7), 0, np.sin(0.7)], [0, 1, 0], [-np.sin(0.7), 0, np.cos(0.7)]])
    before, turned = np.zeros(contact.size), x.copy()
    contact.add_residual(x, before)
    n = blocks.X.size
    turned[:n] = ((blocks.X + x[:n].reshape(-1, 3)) @ turn.T - blocks.X).ravel()
    contact.turn_multipliers(turned)
    after = np.zeros(contact.size)
    contact.add_residual(turned, after)
    np.testing.assert_allclose(after[:n].reshape(-1, 3), before[:n].reshape(-1, 3) @ turn.T, atol=TURNED * np.abs(before).max())
    assert contact.balanced(turned)
