"""Writes tests/data/slanted_pairs.json: pairs in general position whose edges cross at small angles, with the
derivatives of their weights from decimal arithmetic (oracle.py), in the form of the golden pairs.

    /usr/bin/python3 tests/stability/slanted_pairs.py
"""

import json
import sys
import textwrap
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import oracle  # noqa: E402
from cases.pairs import ABOUT, ANGLES, QUAD, TRIANGLE, rotation, turned  # noqa: E402

TARGET = HERE.parent / "data" / "slanted_pairs.json"


def rounded(array):
    """As lists; fifteen digits."""
    return [[[float(f"{v:.15g}") if abs(v) > 1e-16 else 0.0 for v in row] for row in rows] for rows in array]


def pairs():
    random = np.random.default_rng(20261122)
    facets, abouts = (("quad4", QUAD), ("tri3", TRIANGLE)), list(ABOUT.values())
    for k, angle in enumerate(ANGLES):
        (kind, x), (other, y) = facets[k % 2], facets[k % 2 if k % 4 < 2 else 1 - k % 2]
        q, gap = rotation(random), (0.0, 0.01)[k // 2 % 2]
        about = np.array(abouts[k % len(abouts)])
        x1, x2 = x @ q.T, (turned(y, float(angle), about) - [0, 0, gap])[::-1] @ q.T
        ab, ac = oracle.derivatives(x1, x2)
        name = f"{kind}_on_{other}_angle_{angle}_gap_{gap:g}"
        yield {
            "name": name,
            "affine": True,
            "x1": x1.tolist(),
            "x2": x2.tolist(),
            "dnAB": rounded(ab),
            "dnAC": rounded(ac),
        }


if __name__ == "__main__":
    text = json.dumps({"schema": "mortar-golden-pairs/1", "cases": list(pairs())})
    TARGET.write_text(textwrap.fill(text, 120, break_long_words=False, break_on_hyphens=False) + "\n")
