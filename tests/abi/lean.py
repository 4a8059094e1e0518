#!/usr/bin/env python3
"""A library without any of the features that can be left out: smaller, with all symbols; what needs one is refused by its name,
and everything else has the bits of the whole library.

    lean.py --library libstickslip.so --build DIR    the whole library; builds the lean one in DIR
    lean.py --probe                                  what STICKSLIP_LIBRARY says: bits of results, and refusals
"""

import argparse
import hashlib
import json
import os
import subprocess
import sys
from pathlib import Path

import features

PYTHON = features.ROOT / "python"
# What all features together add at the least; more than a fifth of the library is what they did.
SAVED = 0.2


def refusals(stickslip, scene, np):
    """The messages of each feature's calls, with None where one is taken."""
    from stickslip import _library as library

    quadratic = np.array([(0, 0, 0), (0, 1, 0), (1, 0, 0), (0, 0.5, 0), (0.5, 0.5, 0), (0.5, 0, 0)], float), np.array([range(6)])
    centre = np.array([0.5, 0.5, -1.5])
    frame = centre + np.vstack([np.zeros(3), np.eye(3)])
    below = scene.grid(3, 0.0, 1.2, 0.0, True)

    def analytic(solid):
        # Beside what the package offers: a ball below the facets.
        made, _method = stickslip.options.make(solid.options)
        made.mortar_side, made.shape, made.radius = (stickslip.constants[name] for name in ("MORTAR_ANALYTIC", "SHAPE_SPHERE", "SHAPE_SPHERE"))
        one, two = solid.arguments[0]._struct(), stickslip.Surface(frame, [])._struct()
        slot = library.ffi.new("struct stickslip_interface **")
        library.call("interface_create", one[0], two[0], made, slot)
        library.call("interface_destroy", slot)

    def heat(solid):
        x1, x2, lam = solid.pressed()
        solid.interface.heat(x1, x2, lam, np.zeros(len(x1)), np.ones(len(x2)), contact=1.0, pressure=1.0, exponent=1.0)

    def condensed(solid):
        stickslip.Condensed(solid.interface).multipliers(solid.x1, solid.x2, np.zeros(solid.x1.shape))

    def condensed_plan(solid):
        x1, x2 = (library.ffi.from_buffer("double[]", np.ascontiguousarray(x)) for x in (solid.x1, solid.x2))
        rows, counts = library.ffi.new("int64_t[2]"), library.ffi.new("int64_t[2]")
        solid.interface._call("condensed_plan", x1, x2, stickslip.constants["PLAN_ACTIVE"], rows, counts)

    def rigid(solid):
        x1 = solid.x1
        body = stickslip.RigidBody(x1, np.arange(x1.size).reshape(x1.shape), [0, 0, 0], np.arange(6) + 9999)
        body.positions()

    def skin(_solid):
        # Both sides as the skin of two bodies; the package has no such handle.
        (x1, f1), (x2, f2) = scene.grid(2, 0.13, 1.0, 0.0, False), scene.grid(3, 0.0, 1.2, 0.0, True)
        x = np.vstack([x1, x2])
        surface = stickslip.Surface(x, np.vstack([f1, f2 + len(x1)]), np.arange(x.size).reshape(x.shape))._struct()
        made, _method = stickslip.options.make({"modulus": 1000.0})
        slot = library.ffi.new("struct stickslip_skin **")
        library.call("skin_create", surface[0], library.ffi.NULL, x.size, made, slot)
        library.call("skin_destroy", slot)

    line = np.array([(0.0, 0.0), (1.0, 0.0)])
    lines = [(line, np.array([order])) for order in ((0, 1), (1, 0))]

    def law(kind, **numbers):
        return lambda solid: solid.interface.set_law(kind, **numbers)

    calls = {
        "analytic": [analytic],
        "condensed": [condensed, condensed_plan],
        "heat": [heat],
        "laws": [law("cohesion", cohesion=1.0), law("weakening", mu_after=0.1, critical_slip=1.0),
                 law("orthotropic", mu_across=0.2, direction=(1, 0, 0)), lambda solid: solid.interface.set_threshold(lambda _: (1, 0)),
                 lambda solid: solid.interface.set_layer(wear=1.0)],
        "lines": [lambda _, model=model: scene.Scene(*lines, model=model) for model in ("plane", "axisymmetric")],
        "offsets": [lambda solid: solid.interface.set_offsets(np.full(len(solid.x1), 1e-4))],
        "points": [lambda _: scene.Solid(basis="dual", weights="reference", decision="points")],
        "quadratic": [lambda _: scene.Scene(quadratic, below, multiplier_space="sub")],
        "rigid": [rigid],
        "sensitivity": [lambda solid: solid.interface.previous_tangent(*solid.pressed(), solid.size),
                        lambda solid: solid.interface.adjoint(*solid.pressed(), *solid.pressed()),
                        lambda solid: solid.interface.sensitivity(*solid.pressed(), friction=np.ones(len(solid.x1)))],
        "skin": [skin],
    }
    said = {}
    for name, call in ((name, call) for name, of_feature in calls.items() for call in of_feature):
        with scene.Solid(basis="dual") as solid:
            try:
                call(solid)
                answer = None
            except stickslip.Error as refusal:
                answer = f"{type(refusal).__name__}: {refusal}"
        said.setdefault(name, []).append(answer)
    return said


def probe():
    sys.path[:0] = [str(PYTHON / "tests"), str(PYTHON / "src")]
    import numpy as np
    import scene
    import stickslip

    bits = hashlib.sha256()
    for basis in ("standard", "dual"):
        with scene.Solid(basis=basis) as made:
            at = made.pressed()
            for array in (*made.interface.residual(*at), made.interface.tangent(*at, made.size).toarray()):
                bits.update(np.ascontiguousarray(array).tobytes())
            made.interface.commit(*at)
    built = dict(word.split("=") for word in stickslip.__build__.split())["features"]
    print(json.dumps({"bits": bits.hexdigest(), "features": built, "refusals": refusals(stickslip, scene, np)}))


def probed(library):
    environment = {**os.environ, "STICKSLIP_LIBRARY": str(library)}
    done = subprocess.run([sys.executable, __file__, "--probe"], capture_output=True, text=True, env=environment)
    if done.returncode:
        sys.exit(f"{library}: {done.stdout}{done.stderr}")
    return json.loads(done.stdout)


def symbols(library):
    done = subprocess.run(["nm", "-D", "--defined-only", str(library)], capture_output=True, text=True, check=True)
    return {line.split()[-1] for line in done.stdout.splitlines()}


def checks(library, less, kept):
    """What a library that has only the features in `kept` must be, beside the whole one: each with True, or with what was found."""
    whole, lean = probed(library), probed(less)
    said = [(name, words) for name, answers in lean["refusals"].items() for words in answers]
    refused = lambda name, words: words is not None and words.startswith("Unsupported") and f"built without {name}:" in words
    wrong = [f"{name}: {words}" for name, words in said if not (words is None if name in kept else refused(name, words))]
    taken = [f"{name}: {words}" for name, answers in whole["refusals"].items() for words in answers if words is not None]
    return {
        "the whole library takes what each feature is for": not taken or taken,
        "the lean one refuses by name what it lacks, and takes the rest": not wrong or wrong,
        "every feature is asked": sorted(lean["refusals"]) == sorted(features.FEATURES),
        "stickslip_build says so": (whole["features"], lean["features"]) == (",".join(features.FEATURES), ",".join(kept) or "none"),
        "all else has the same bits": whole["bits"] == lean["bits"],
        "the same symbols": symbols(library) == symbols(less),
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--library", type=Path, help="the whole library")
    parser.add_argument("--build", type=Path, help="where to build the lean one")
    parser.add_argument("--probe", action="store_true")
    arguments = parser.parse_args()
    if arguments.probe:
        return probe()
    whole, lean = arguments.library.resolve(), features.library(arguments.build.resolve(), [])
    bytes_of = [features.stripped(path) for path in (whole, lean)]
    found = checks(whole, lean, [])
    found["smaller"] = bytes_of[1] < (1 - SAVED) * bytes_of[0] or bytes_of
    for what, holds in found.items():
        print(f"{'ok     ' if holds is True else 'FAILED '} {what}{'' if holds is True else f': {holds}'}")
    print(f"        {bytes_of[0]} and {bytes_of[1]} bytes stripped")
    return 0 if all(holds is True for holds in found.values()) else 1


if __name__ == "__main__":
    sys.exit(main())
