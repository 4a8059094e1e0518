"""Iterations, states and forces per step of every scene, as numbers: they are compared with room for rounding."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[2] / "studies" / "common"))
from scene import SCENES, Driver  # noqa: E402  (needs the path)

# Of some minutes each; `jacobian_states` and `keys` are no problems of their own.
LEFT_OUT = {"ironing_3d", "cattaneo_line", "torsion", "mindlin", "press_fit_3d", "shallow_ironing", "keys"}
# Up to so many steps a scene must take the same iterations; in longer ones, where the last bit decides now and then,
# their sum may differ by this part.
SHORT, PART = 50, 0.01
# Forces over the largest of the scene: a step ends at 2e-11 of them, with whatever the last iteration left.
SAME_FORCE = 1e-9


def paths():
    return sorted(path for path in SCENES.glob("*.yaml") if path.stem not in LEFT_OUT)


def digest(task):
    build, folder, path = task
    quiet = ("-output_vtu", "none", "-output_csv", "none")
    run = Driver(build, folder).run(path, *quiet, expect=None)
    kept = ("t", "newton_iterations", "interfaces", "reactions")
    steps = [{key: step[key] for key in kept if key in step} for step in run.summary.get("steps", [])]
    return path.stem, {"exit": run.exit_code, "cutbacks": run.summary.get("cutbacks"), "steps": steps}


def iterations(scene):
    return [step["newton_iterations"] for step in scene["steps"]]


def told(scene):
    return f"exit {scene['exit']}, {len(scene['steps'])} steps, {sum(iterations(scene))} iterations"


def counts(step):
    return {name: [i[s] for s in ("gap", "stick", "slip")] for name, i in step.get("interfaces", {}).items()}


def numbers(step):
    return [value for name in sorted(step.get("reactions", {})) for value in step["reactions"][name]]


def difference(before, after):
    """What differs, in words; empty: nothing."""
    for key in ("exit", "cutbacks"):
        if before[key] != after[key]:
            return f"{key} {before[key]} -> {after[key]}"
    a, b = before["steps"], after["steps"]
    if [step["t"] for step in a] != [step["t"] for step in b]:
        return "other steps"
    one, two = iterations(before), iterations(after)
    if len(a) <= SHORT and one != two:
        return f"iterations {one} -> {two}"
    if abs(sum(one) - sum(two)) > PART * sum(one):
        return f"iterations {sum(one)} -> {sum(two)}"
    for x, y in zip(a, b):
        if counts(x) != counts(y):
            return f"states at t = {x['t']}: {counts(x)} -> {counts(y)}"
    largest = max((abs(v) for step in a for v in numbers(step)), default=0.0)
    off = max((abs(v - w) for x, y in zip(a, b) for v, w in zip(numbers(x), numbers(y))), default=0.0)
    noise = sys.float_info.min
    # Where every resultant is 0 but for rounding there is no largest to compare with: forces within a body are larger.
    return f"forces by {off:.1e} of {largest:.1e}" if off > SAME_FORCE * max(largest, 1.0) + noise else ""
