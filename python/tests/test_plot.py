"""Pictures of an interface: what is drawn is what the states say."""

import numpy as np
import pytest
import stickslip
from bodies import Blocks

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")
plt = pytest.importorskip("matplotlib.pyplot")
# A drawn picture; an empty one has a tenth of it.
PICTURE_BYTES = 10_000


@pytest.fixture(scope="module")
def solved():
    made = Blocks()
    contact = made.contact()
    x, _ = made.solve(contact, (2e-3, 8e-4, -5e-3))
    return contact, x, contact.states(x)[0]


def test_facets_have_the_mean_of_their_nodes(solved, tmp_path):
    contact, x, states = solved
    axes = contact.plot(x, states)
    drawn = axes.collections[0]
    facets = contact._pairs[0].facets1
    np.testing.assert_allclose(drawn.get_array(), [states.pressure[row].mean() for row in facets])
    file = tmp_path / "picture.png"
    axes.figure.savefig(file)
    assert file.stat().st_size > PICTURE_BYTES
    axes = contact.plot(x, states, "traction")
    np.testing.assert_allclose(axes.collections[0].get_array(), [np.linalg.norm(states.traction, axis=1)[row].mean() for row in facets])


def test_nodes_have_the_colour_of_their_state(solved):
    contact, x, states = solved
    axes = contact.plot(x, states, "state")
    told = [text.get_text() for text in axes.get_legend().get_texts()]
    assert told == [f"{state.name.lower()} ({states.count(state)})" for state in stickslip.State]
    assert states.count(stickslip.State.STICK) > 0 and states.count(stickslip.State.SLIP) > 0


def test_lines_and_axes_that_are_there():
    X = np.array([[0.0, 0.0], [0.5, 0.0], [1.0, 0.0], [-1.0, 0.0], [2.0, 0.0]])
    contact = stickslip.Contact(X).add([[0, 1], [1, 2]], [[4, 3]], modulus=1.0)
    x = contact.start()
    x[contact.n_host + 1 :: 2] = -1.0
    states = contact.states(x)[0]
    axes = plt.figure().add_subplot()
    assert contact.plot(x, states, axes=axes) is axes and len(axes.collections[0].get_segments()) == 2
    assert contact.plot(x, states, "state").get_legend() is not None


def test_other_numbers_are_refused_by_name(solved):
    contact, x, states = solved
    with pytest.raises(stickslip.errors.InvalidValue, match="^what: 'presure'; 'state', 'pressure'"):
        contact.plot(x, states, "presure")
