"""Shipped scenes with `contact: all` in place of their interfaces, against the pairs that they name."""

import numpy as np
import yaml
from scene import SCENES, write

# The same sums in another order.
SAME = 1e-10
# Of other roles, or other friction where two faces of a node touch: the mesh's error.
OTHER_ROLES = 0.01
# Iterations of all scenes together.
ITERATIONS = 1.1

# What general contact has not (docs/general_contact.md), by what a scene or one of its interfaces says.
OF_SCENES = ("dynamics", "unknowns")
OF_INTERFACES = ("decision", "offset", "adjust", "round", "cohesion", "critical_slip", "friction_across", "mortar_side")
# Keys that say how contact is computed, and stay.
METHOD = ("weights", "normals", "basis", "form", "augmentation", "augmentation_scale", "modulus", "weak_coverage", "new_contact", "slip",
          "turn_max", "slide_max", "lag_max", "lag_corrected", "quadrature", "integration", "points", "tangent", "multiplier_space")
# Another problem: a part of a face is named there, and all of it touches.
OTHERS = ("block_zone_mu05", "block_zone_mu05_facet", "block_zone_mu2", "block_zone_mu2_facet")
# Where the library gives the multipliers to the other side than the scene does.
OTHER_SIDES = ("ball_on_block", "mindlin", "ring_ball", "shaft_in_bore", "turned_shaft")


def general(scene):
    """The scene with `contact: all`, or why there is none."""
    named = scene.get("interfaces", [])
    if not named:
        return None, "it has no interface"
    for key in OF_SCENES:
        if key in scene:
            return None, f"it has `{key}`"
    of = {name: scene[name] for name in named}
    for name, map_ in of.items():
        for key in OF_INTERFACES:
            if key in map_:
                return None, f"{name} has `{key}`"
        sides = [map_[side].split(".")[0] for side in ("nonmortar", "mortar")]
        if any(scene.get(body, {}).get("type") == "analytic" for body in sides):
            return None, f"{name} has an analytic side"
        if map_.get("law") == "tied":
            return None, f"{name} is tied"
    rest = {key: value for key, value in scene.items() if key not in of and key != "interfaces"}
    rest["contact"] = "all"
    rest["friction"] = max(map_.get("friction", 0) for map_ in of.values())
    method = {key: value for map_ in of.values() for key, value in map_.items() if key in METHOD}
    if method:
        rest["all"] = method
    return rest, None


def of_surfaces(scene):
    """Where surfaces are named, meshes lie beside the scene: their paths become whole."""
    for value in scene.values():
        if isinstance(value, dict) and "file" in value:
            value["file"] = str((SCENES / value["file"]).resolve())
    return scene


def compare(driver, path):
    """(difference of displacements, of reactions, iterations of both), or why there is nothing to compare."""
    scene = of_surfaces(yaml.safe_load(path.read_text()))
    scene["output"] = {**scene.get("output", {}), "vtu": "last", "csv": "none"}
    other, why = general(scene)
    if other is None:
        return None, why
    folder = driver.output / "scenes"
    runs = [driver.run(write(one, folder / f"{path.stem}_{kind}.yaml"), "-output_quiet", label=f"{path.stem}_{kind}", expect=None)
            for one, kind in ((scene, "named"), (other, "all"))]
    if any(run.exit_code for run in runs):
        return None, f"exit codes {[run.exit_code for run in runs]}: {runs[-1].text.strip().splitlines()[-1] if runs[-1].text.strip() else ''}"
    fields = [run.mesh()[2] for run in runs]
    scale = np.abs(fields[0]).max()
    reactions = [np.array([step["reactions"][name] for step in run.steps[-1:] for name in sorted(step["reactions"])]) for run in runs]
    largest = max(np.abs(reactions[0]).max(initial=0), max(step["reference_force"] for step in runs[0].steps))
    return (np.abs(fields[1] - fields[0]).max() / scale, np.abs(reactions[1] - reactions[0]).max(initial=0) / largest if largest else 0.0,
            [run.newton_iterations for run in runs]), None


def general_scenes(verdicts, driver):
    iterations = np.zeros(2)
    for path in sorted(path for path in SCENES.glob("*.yaml") if path.stem not in OTHERS):
        found, why = compare(driver, path)
        if found is None:
            if why.startswith("exit"):
                verdicts.failed(f"{path.stem} as contact: all", why)
            continue
        bound, reason = (OTHER_ROLES, "other roles") if path.stem in OTHER_SIDES else (SAME, "the same roles")
        for quantity, error in zip(("displacements", "reactions"), found):
            verdicts.below(f"{path.stem} as contact: all: {quantity}, iterations {found[2][0]} and {found[2][1]}", error, bound, reason)
        iterations += found[2]
    verdicts.below("iterations of all scenes, over those of named pairs", iterations[1] / iterations[0], ITERATIONS, "the same problem")
