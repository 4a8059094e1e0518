"""What the report says of linear facets that are chords of round surfaces."""

import re

import numpy as np
import pytest

import stickslip
from bodies import Blocks

RADIUS, FIT = 1.0, 0.005


def circle(n, radius, hole, layers=0):
    """Nodes and facets around the axis: lines, or with layers quadrilaterals along z."""
    angles = 2 * np.pi * np.arange(n) / n
    ring, lines = radius * np.stack([np.cos(angles), np.sin(angles)], axis=1), np.stack([np.arange(n), (np.arange(n) + 1) % n], axis=1)
    if not layers:
        return ring, lines[:, ::-1] if hole else lines
    X = np.concatenate([np.column_stack([ring, np.full(n, z)]) for z in np.linspace(0, 0.5, layers + 1)])
    quads = np.concatenate([np.column_stack([lines + n * k, lines[:, ::-1] + n * (k + 1)]) for k in range(layers)])
    return X, quads[:, ::-1] if hole else quads


def fitted(shaft, bore, layers=0, fit=FIT, friction="none"):
    """A shaft of some facets in a bore of some."""
    (x1, facets1), (x2, facets2) = circle(shaft, RADIUS + fit, False, layers), circle(bore, RADIUS, True, layers)
    return stickslip.Contact(np.concatenate([x1, x2])).add(facets1, facets2 + len(x1), modulus=1.0, friction=friction)


@pytest.mark.parametrize("layers", [0, 2])
def test_what_chords_take_of_a_fit_is_told(layers):
    # In the mean a shaft of n facets is too thin by h^2 / (12 R), a bore too narrow by as much of its own.
    contact = fitted(24, 31, layers)
    told = re.search(r"meant overlap by about (\S+) more: facets are their chords, so that the fit presses too little", contact.report())
    wanted = sum(sign * (2 * RADIUS * np.sin(np.pi / n)) ** 2 / (12 * RADIUS) for n, sign in ((24, 1), (31, -1)))
    assert abs(float(told[1]) / wanted - 1) < 0.05  # two digits are told
    states = contact.states(np.zeros(contact.size))[0]
    mean = -states.gap.sum() / states.coverage.sum()
    assert abs((FIT - mean) / wanted - 1) < 0.1  # and so it is, but for what goes with the fourth power of a facet's angle
    assert "presses too much" in fitted(31, 24, layers).report()


@pytest.mark.parametrize("layers", [0, 2])
def test_gaps_within_what_the_surfaces_rise_are_told(layers):
    assert "start with gaps from " in fitted(24, 31, layers, 0.0).report()
    assert "facets" not in fitted(24, 24, layers, 0.0).report()  # facets that match touch as the circles do


def test_nothing_is_told_where_nothing_is_lost():
    assert "chords" not in fitted(24, 24).report() and "facets" not in fitted(24, 31, fit=-0.1).report()
    assert "facets" not in Blocks().contact().report()
    assert "facets" not in fitted(24, 31, friction="tied").report()
    contact = fitted(24, 31)
    face = contact.interfaces[0]
    offsets = [face.shape_offsets(side, "cylinder", radius, (0, 0)) for side, radius in (("nonmortar", RADIUS + FIT), ("mortar", -RADIUS))]
    face.set_offsets(*offsets)
    assert "facets" not in contact.report()
    with pytest.raises(stickslip.Error, match="^point: shape"):
        face.shape_offsets("mortar", "cylinder", -RADIUS, (0,))
