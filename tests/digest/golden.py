"""Digests of what a library gives for the golden pairs and interfaces (tests/data, or the whole set where it is)."""

import json
from pathlib import Path

import numpy as np

from histories import digest, evaluate, loaded
from library import OF_COMMIT, STANDARD, Interface, Refused

ROOT = Path(__file__).resolve().parents[2]
VARIANTS = {"objective": 0, "increment": 1, "seed": 2}


def data(name):
    whole = ROOT.parent / "shared" / "golden" / name
    return json.loads((whole if whole.is_file() else ROOT / "tests" / "data" / name).read_text())["cases"]


def pair(library, case):
    """Weights and their derivatives, or the status."""
    try:
        return library.weights(case["x1"], case["x2"], derivatives=True)
    except Refused as refusal:
        return [np.array(refusal.status)]


def interface(library, case):
    """Residual, tangent and states, of the paper's element."""
    options = {"slip": VARIANTS[case["variant"]], "mu": 1.0, "augmentation": 1.0, "basis": STANDARD, "normals": OF_COMMIT}
    made = Interface(library, case["x1_prev"], case["facets1"], case["x2_prev"], case["facets2"], **options)
    made.set("normals", case["nu"])
    made.set("augmentation", case["r"])
    made.set("friction", np.broadcast_to(np.asarray(case["mu"], float), len(case["x1"])))
    at = [case[name] for name in ("x1", "x2", "lambda")]
    found = [array for name in ("residual", "tangent", "states") for array in evaluate(made, name, at)]
    made.close()
    return found


def digests(path):
    library, found = loaded(path), {}
    for file, arrays in (("golden_pairs.json", pair), ("golden_interfaces.json", interface)):
        found |= {case["name"]: digest(*arrays(library, case)) for case in data(file)}
    return found
