"""The tests run from the source tree, against STICKSLIP_LIBRARY or a library that is built there."""

import sys
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "examples")]
try:
    import stickslip
except ImportError:
    sys.path.insert(0, str(HERE.parent / "src"))
    import stickslip  # noqa: F401

import scene


@pytest.fixture
def blocks():
    """Two flat surfaces in space that do not match, with friction."""
    with scene.Solid() as made:
        yield made


@pytest.fixture
def lines():
    """Two lines of a plane model."""
    with scene.Plane() as made:
        yield made
