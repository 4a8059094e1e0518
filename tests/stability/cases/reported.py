"""Small scenes that users reported as converged and wrong, or as refused though they should work (tests/data/reports): as they are, with both bases, both
normals, roles exchanged, finer cells. The answer is right, or the run is refused by a sentence that names the cause, or it says that its facets are too coarse."""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import yaml

import host
from cell import series

REPORTS = Path(__file__).resolve().parents[2] / "data" / "reports"
# Of what is right on the scene's meshes: statics, or the same with eight times as many steps. Where a mesh is too coarse for the contact: on fine ones.
RIGHT = 0.02
# Facets that are too coarse for the contact: the driver says so, and no more is asked of them.
COARSE = "smaller than its facets|although they are .* apart|bodies of \\w+ overlap"
# Offsets and wear that slant the surface against its mesh: so does the driver.
SLOPES = "slopes against the mesh"
AS_IT_IS = "as it is"
VARIANTS = (AS_IT_IS, "dual", "standard", "normals of now", "normals of t_n", "exchanged", "finer")


@dataclass
class Report:
    measure: object  # function of a Run: what is compared
    right: float
    finer: float | None = None  # what is right on finer cells, where that is not the same
    scale: float | None = None  # of the error, where `right` is 0
    refused: str | None = None  # what a refusal says
    told: str | None = None  # what a run says that is not right
    variants: tuple = VARIANTS


def reaction(support, component):
    return lambda run: run.steps[-1]["reactions"][support][component]


def torque(support):
    return lambda run: run.steps[-1]["moments"][support][2]


def turned(support, degrees):
    """The shear over the pressure of bodies that have turned so far."""

    def measure(run):
        x, y = run.steps[-1]["reactions"][support][:2]
        c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
        return (x * c + y * s) / (y * c - x * s)

    return measure


def ratio(support, along, other, across):
    return lambda run: abs(reaction(support, along)(run) / reaction(other, across)(run))


def deepest(probe):
    """The farthest that it came from the origin."""
    return lambda run: max(np.hypot(0.69282 + step["probes"][probe][0], -0.4 + step["probes"][probe][1]) for step in run.steps)


ONE_SIDE = tuple(name for name in VARIANTS if name != "exchanged")
SCENES = {
    "share_worst": Report(reaction("ground", 1), 10.989),
    "clamped_pair_default": Report(reaction("clamp", 1), 0.1),
    "skin": Report(reaction("ground", 1), 28.08, variants=ONE_SIDE),
    "skin_min": Report(reaction("ground", 1), 10.989),
    "bounce_skin": Report(lambda run: run.steps[-1]["momentum"][0], 1.0, variants=ONE_SIDE),
    "sled_in_bowl": Report(deepest("c"), 0.8, variants=ONE_SIDE),
    "floor_nonmortar_2_facets": Report(ratio("b", 0, "b", 1), 0.3),
    "shaft_10deg": Report(torque("turn"), 755.0, finer=832.0),
    "points_fit": Report(torque("turn"), 755.0, finer=825.0, variants=(AS_IT_IS, "finer")),
    "stack_10deg": Report(turned("b", 40), 0.0, scale=1.0),
    "cam_15deg": Report(ratio("g", 0, "cc", 1), 0.0, scale=1.0),
    "edge": Report(reaction("ground", 1), 4.0),
    "edge_fric": Report(reaction("ground", 1), 4.0),
    "tee_min": Report(reaction("ground", 1), 20.0),
    "ring_min": Report(lambda run: abs(run.steps[-1]["interfaces"]["side"]["force"][0]), 0.4955),
    "leaves2": Report(reaction("clamp", 1), 0.2),
    "coins": Report(reaction("ground", 2), 2.56),
    "analytic_pstress": Report(reaction("press", 1), -5.98, told=COARSE, variants=ONE_SIDE),
    "apart_search": Report(reaction("press", 1), -5.731),
    "rz_gap": Report(reaction("press", 1), -5.87, refused=COARSE, told=COARSE),
    "plane_wrongway": Report(lambda run: np.inf, 0.0, scale=1.0, refused="look the same way", variants=ONE_SIDE),
    "tie_far": Report(lambda run: np.inf, 0.0, scale=1.0, told="are tied although"),
    "pin": Report(reaction("drive", 1), -1.51, told=COARSE, variants=ONE_SIDE),
    "worn_block": Report(reaction("d", 0), 0.5, told=SLOPES),
    "shim": Report(ratio("d", 0, "g", 1), 0.0, scale=1.0, told=SLOPES, variants=VARIANTS[:5]),
    "wedge": Report(reaction("d", 0), -5.1667, told=COARSE, variants=(AS_IT_IS, "finer")),
    "roller1": Report(reaction("fix", 1), 247.5, refused=COARSE, told=COARSE),
}


def options(text, variant):
    """What makes the variant of a scene."""
    scene = yaml.safe_load(text)
    of_all = lambda key, value: [word for name in scene["interfaces"] for word in (f"-{name}_{key}", value)]
    match variant:
        case "dual" | "standard":
            return of_all("basis", variant)
        case "normals of now":
            return of_all("normals", "current")
        case "normals of t_n":
            return of_all("normals", "committed")
        case "exchanged":
            exchanged = {"nonmortar": "mortar", "mortar": "nonmortar"}
            as_text = lambda value: ",".join(value) if isinstance(value, list) else value
            return [word for name in scene["interfaces"] for to, of in exchanged.items() for word in (f"-{name}_{to}", as_text(scene[name][of]))]
        case "finer":
            boxes = [name for name in scene["bodies"] if "cells" in scene[name]]
            return [word for name in boxes for word in (f"-{name}_cells", ",".join(str(2 * n) for n in scene[name]["cells"]))]
    return []


def reported(name, report, variant):
    def run(context):
        path = REPORTS / f"{name}.yaml"
        solved = context.solve(path, *options(path.read_text(), variant))
        result = host.outcome(solved)
        if result.refusal is None:
            right = report.finer if report.finer and variant == "finer" else report.right
            error = abs(report.measure(solved) - right) / (report.scale or abs(right))
            if report.told and error > RIGHT and re.search(report.told, solved.text):
                result.warnings.append(f"{100 * error:.0f} % off, and the run says why")
                error = 0.0
            result.below(name, error, RIGHT, f"{right:g} is right")
        return result

    return run


def cells():
    for name, report in SCENES.items():
        quick = (AS_IT_IS,) if name in ("share_worst", "stack_10deg", "roller1") else ()
        yield from series(f"reported: {name}", report.variants, lambda v, n=name, r=report: reported(n, r, v), may_refuse=report.refused, quick=quick)
