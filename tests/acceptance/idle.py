"""Steps without load: every example scene, with one step more in which loads and supports stay as they are.

A committed state solves that step, if its normals are those of now: nothing is iterated and nothing moves. Normals of
t_n turn once more at each commit.
"""

import re

import numpy as np
from ironing import COARSE, COARSE_3D
from scene import SCENES, interfaces, weights

# Positions, over the largest: where nothing is solved nothing changes, not in the last bit. With normals of t_n they move by
# more than this in the scenes below: 1.1e-3 to 7e-3 is measured.
SAME, MOVES = 0, 1e-4
# Of these the time would be minutes: options for a coarser mesh, or fewer steps, in their place. Curves that end where
# the steps then end.
SHORTER = {
    "shallow_ironing": (*COARSE, "-steps_stages", "1,10,1.2,100"),
    "ironing_3d": (*COARSE_3D[:4], "-steps_stages", "1,14,1.5,20"),
    "turned_shaft": ("-steps_end", 1.5, "-steps_count", 75),
}
# Where the normals of t_n need iterations in a step without load: surfaces that slide and are curved.
CURVED = ("press_fit", "shallow_ironing", "ironing_3d")
SKIPPED = {"torsion": "minutes; torsion_disc and ball_on_plane_friction are like it", "two_bars": "it moves on", "sliding_down": "it moves on"}


def followed(scene):
    """The interfaces of a scene that allow normals of now and have any: no frozen weights, not tied, no lines."""
    if re.search(r"^model: *(plane|axi)", text_of(scene), re.MULTILINE):
        return []
    return [name for name in interfaces(scene) if weights(scene, name) == "current" and "law: tied" not in about(scene, name)]


def about(scene, name):
    """The text of a map of a scene."""
    found = re.search(rf"^{re.escape(name)}:(.*(?:\n[ \t].*)*)", text_of(scene), re.MULTILINE)
    return found[1] if found else ""


def text_of(scene):
    return (SCENES / f"{scene}.yaml").read_text()


def numbers(text, key):
    found = re.search(rf"\b{key}: *\[([^\]]*)\]", text)
    return [float(word) for word in found[1].split(",")] if found else []


def times(scene, options):
    """The scene's steps with one step more, as options, and where its own end."""
    steps, given = about(scene, "steps"), dict(zip(options[::2], options[1::2]))
    listed, staged = (numbers(steps, key) for key in ("times", "stages"))
    staged = [float(word) for word in given.get("-steps_stages", "").split(",") if word] or staged
    if listed:
        return listed[-1], ("-steps_times", text([*listed, 2 * listed[-1] - listed[-2]]))
    if staged:
        return staged[-2], ("-steps_stages", text([*staged, staged[-2] + 0.1, 1]))
    end, count = (float((re.search(rf"\b{key}: *([\d.]+)", steps) or [0, 1])[1]) for key in ("end", "count"))
    end, count = float(given.get("-steps_end", end)), float(given.get("-steps_count", count))
    return end, ("-steps_end", f"{end * (count + 1) / count:.17g}", "-steps_count", f"{count + 1:.0f}")


def text(values):
    return ",".join(f"{value:.17g}" for value in values)


def ended(scene, end):
    """Options that end every curve of loads and supports there, at its value there."""
    for kind in ("supports", "loads"):
        listed = re.search(rf"^{kind}: \[(.*?)\]", text_of(scene), re.MULTILINE | re.DOTALL)
        for name in re.split(r",\s*", listed[1]) if listed else ():
            keys = about(scene, name)
            if kind == "supports" and not re.search(r"\b(value|gradient|rotate):", keys):
                continue
            yield f"-{name}_curve", text(cut(numbers(keys, "(?<!_)curve"), end))
            if "rotate_curve:" in keys:
                yield f"-{name}_rotate_curve", text(cut(numbers(keys, "rotate_curve"), end))


def cut(curve, end):
    """As it is until there, and constant from there on. No curve is one from 0 to 1 at the end."""
    t, v = (curve or [0, 0, end, 1])[::2], (curve or [0, 0, end, 1])[1::2]
    before = [(a, b) for a, b in zip(t, v) if a < end]
    return [number for pair in [*before, (end, np.interp(end, t, v))] for number in pair]


def idle(driver, scene, normals):
    """(run, iterations of the idle step, largest change of a position over the largest position)"""
    given = SHORTER.get(scene, ())
    end, steps = times(scene, given)
    followers = followed(scene)
    # Whatever normals of t_n lag by, no step is solved again.
    keys = (("normals", normals), *([("lag_max", 1)] if normals == "committed" else []))
    # What is given first gives way to what is given last.
    options = (*given, *steps, *(word for pair in ended(scene, end) for word in pair),
               *(word for name in followers for key, value in keys for word in (f"-{name}_{key}", value)))
    run = driver.run(scene, *options, "-output_vtu", "none", "-output_csv", "all", label=f"idle_{scene}_{normals}")
    change = max(moved(run, name) for name in followers)
    iterations = run.steps[-1]["newton_iterations"]
    for path in run.directory.glob("interface_*.csv"):
        path.unlink()
    return run, iterations, change


def moved(run, name):
    before, after = (positions(run.interface(name, len(run.steps) - back)) for back in (1, 0))
    return np.abs(after - before).max() / np.abs(after).max()


def positions(table):
    return np.stack([table[axis] + table[f"u{axis.lower()}"] for axis in "XYZ"], axis=1)


def all_scenes():
    return [path.stem for path in sorted(SCENES.glob("*.yaml")) if path.stem not in SKIPPED and followed(path.stem)]


def idle_steps(verdicts, driver, scenes):
    for scene in scenes:
        _, iterations, change = idle(driver, scene, "auto")
        verdicts.below(f"{scene}, step without load: iterations", iterations, 0, "its start solves it")
        verdicts.below(f"{scene}, step without load: change of position", change, SAME, "nothing is solved")
        if scene in CURVED:
            _, iterations, change = idle(driver, scene, "committed")
            label = f"{scene}, step without load, normals of t_n"
            verdicts.at_least(f"{label}: iterations", iterations, 1, "they turn once more: the line above can fail")
            verdicts.at_least(f"{label}: change of position", change, MOVES, "and the surfaces move")
