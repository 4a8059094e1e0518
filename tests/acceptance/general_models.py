"""Scenes of general contact whose meshes are written here."""

import numpy as np
from plane_mesh import PlaneMesh
from scene import SCENES, write

import yaml

BOX = {"type": "box", "young": 1000, "poisson": 0.3}
NONE = {"vtu": "none", "csv": "none"}


def shipped(name, **more):
    """A scene of the folder as a dict; `more` replaces keys."""
    return {**yaml.safe_load((SCENES / f"{name}.yaml").read_text()), **more}


# A strip that is folded by a half turn: length of its arms, thickness, half the gap between them.
ARM, THICK, GAP = 2.0, 0.2, 0.1
ALONG, AROUND, ACROSS = 24, 12, 3


def strip(folder, contact, steps=12):
    """A folded strip, one arm of which is pressed on the other one and drawn along it by some facets, with friction. `contact`: keys."""
    radius = GAP + THICK / 2
    turn = np.pi * radius
    along = [*np.linspace(0, ARM, ALONG + 1), *(ARM + turn * np.arange(1, AROUND + 1) / AROUND), *(ARM + turn + np.linspace(0, ARM, ALONG + 1)[1:])]
    across = np.linspace(-THICK / 2, THICK / 2, ACROSS + 1)

    def bend(p):
        s, depth = p
        if s <= ARM:
            return [s, -radius - depth]
        if s >= ARM + turn:
            return [2 * ARM + turn - s, radius + depth]
        angle = (s - ARM) / radius - np.pi / 2
        return [ARM + (radius + depth) * np.cos(angle), (radius + depth) * np.sin(angle)]

    mesh = PlaneMesh("quad", along, across, True, bend).write(folder / "strip.msh")
    scene = {
        "schema": 1,
        "model": "plane_strain",
        "bodies": ["strip"],
        "strip": {"type": "gmsh", "file": str(mesh), "young": 1000, "poisson": 0.3, "material": "neo_hooke"},
        "surfaces": ["low", "high", "under", "over"],
        "low": {"of": "strip.ymin", "within": [-1, -1, ARM - 0.01, 0]},
        "high": {"of": "strip.ymin", "within": [-1, 0, ARM - 0.01, 1]},
        "under": {"of": "strip.ymax", "within": [-1, -1, ARM - 0.1, 0]},
        "over": {"of": "strip.ymax", "within": [-1, 0, ARM / 2, 1]},
        "supports": ["ground", "press"],
        "ground": {"surface": "under", "components": ["x", "y"]},
        "press": {"surface": "over", "components": ["x", "y"], "value": [0.3, -3 * GAP], "curve": [0, 0, 1, 1]},
        "steps": {"count": steps},
        "output": NONE,
        **contact,
    }
    return write(scene, folder / f"strip_{'all' if 'contact' in contact and contact['contact'] == 'all' else 'named'}.yaml")
