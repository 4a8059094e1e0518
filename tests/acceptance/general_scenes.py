"""Shipped scenes with `contact: all` in place of their interfaces, against the pairs that they name, or these with their sides exchanged."""

import numpy as np
import yaml
from scene import SCENES, write

# The same sums in another order.
SAME = 1e-10
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


def exchanged(scene):
    """The scene with the sides of its interfaces exchanged."""
    sides = lambda map_: {**map_, "nonmortar": map_["mortar"], "mortar": map_["nonmortar"]}
    return scene | {name: sides(scene[name]) for name in scene["interfaces"]}


def compare(driver, path):
    """(difference of displacements, of reactions, iterations of both, difference of displacements from the scene as it is), or why there is
    nothing to compare."""
    scene = of_surfaces(yaml.safe_load(path.read_text()))
    scene["output"] = {**scene.get("output", {}), "vtu": "last", "csv": "none"}
    other, why = general(scene)
    if other is None:
        return None, why
    folder, scenes = driver.output / "scenes", {"named": scene, "all": other}
    if path.stem in OTHER_SIDES:
        scenes["exchanged"] = exchanged(scene)
    runs = {kind: driver.run(write(one, folder / f"{path.stem}_{kind}.yaml"), "-output_quiet", label=f"{path.stem}_{kind}", expect=None)
            for kind, one in scenes.items()}
    if any(run.exit_code for run in runs.values()):
        last = runs["all"].text.strip().splitlines()
        return None, f"exit codes {[run.exit_code for run in runs.values()]}: {last[-1] if last else ''}"
    fields = {kind: run.mesh()[2] for kind, run in runs.items()}
    scale = np.abs(fields["named"]).max()
    apart = lambda kind: np.abs(fields["all"] - fields[kind]).max() / scale
    same = "exchanged" if "exchanged" in runs else "named"
    reactions = [np.array([runs[kind].steps[-1]["reactions"][name] for name in sorted(runs[kind].steps[-1]["reactions"])]) for kind in (same, "all")]
    largest = max(np.abs(reactions[0]).max(initial=0), max(step["reference_force"] for step in runs[same].steps))
    of_reactions = np.abs(reactions[1] - reactions[0]).max(initial=0) / largest if largest else 0.0
    return (apart(same), of_reactions, [runs[kind].newton_iterations for kind in ("named", "all")], apart("named")), None


def general_scenes(verdicts, driver):
    iterations = np.zeros(2)
    for path in sorted(path for path in SCENES.glob("*.yaml") if path.stem not in OTHERS):
        found, why = compare(driver, path)
        if found is None:
            if why.startswith("exit"):
                verdicts.failed(f"{path.stem} as contact: all", why)
            continue
        reason = f"the same pair with its sides exchanged; {found[3]:.2e} from the scene's" if path.stem in OTHER_SIDES else "the same roles"
        for quantity, error in zip(("displacements", "reactions"), found):
            verdicts.below(f"{path.stem} as contact: all: {quantity}, iterations {found[2][0]} and {found[2][1]}", error, SAME, reason)
        iterations += found[2]
    verdicts.below("iterations of all scenes, over those of named pairs", iterations[1] / iterations[0], ITERATIONS, "the same problem")
