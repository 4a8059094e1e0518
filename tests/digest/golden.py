"""Digests of what a library gives for the golden pairs and interfaces (tests/data, or the whole set where it is)."""

import json
from pathlib import Path

import numpy as np

from histories import Handle, Loaded, digest

ROOT = Path(__file__).resolve().parents[2]
VARIANTS = {"objective": 0, "increment": 1, "seed": 2}


def data(name):
    whole = ROOT.parent / "shared" / "golden" / name
    return json.loads((whole if whole.is_file() else ROOT / "tests" / "data" / name).read_text())["cases"]


def digests(path):
    library = Loaded.of(path)
    found = {}
    for case in data("golden_pairs.json"):
        found[case["name"]] = digest(*library.pair(np.array(case["x1"]), np.array(case["x2"])))
    for case in data("golden_interfaces.json"):
        handle = Handle(library, case["x1_prev"], case["facets1"], case["x2_prev"], case["facets2"], 3, slip=VARIANTS[case["variant"]], mu=1.0, augmentation=1.0)
        handle.set("normals", case["nu"])
        handle.set("augmentation", case["r"])
        handle.set("friction", np.broadcast_to(np.asarray(case["mu"], float), len(case["x1"])))
        at = [np.array(case[name], float) for name in ("x1", "x2", "lambda")]
        found[case["name"]] = digest(*handle.evaluate(at))
        handle.close()
    return found
