"""Restart files: a run that goes on from any step of another one ends with the same bits; on other ranks with the same answers. Files
that do not belong to the scene, or are damaged, are refused."""

import numpy as np
from ranks import CONDENSED, GROUPS, apart
from ranks_moving import SLIDING
from scene import interfaces, write

# Two ways to one answer, each to Newton's tolerance of 1e-11: what ranks add is added in another order.
ANSWERS = 1e-9
# What a run takes and holds, not what it finds.
COSTS = ("seconds", "interfaces", "mesh", "ranks", "scene")
KEEP = ("-output_restart_every", 1, "-output_restart_keep", 0)
BITS = ("-output_csv", "all", "-output_vtu", "none")

BOX = {"type": "box", "young": 1000, "poisson": 0.3}


def pad(**more):
    """A pad pressed on a base and pushed to and fro, four steps; `more` replaces maps, or what is in them."""
    scene = {
        "schema": 1,
        "bodies": ["upper", "lower"],
        "upper": {**BOX, "lower": [0.1, 0.1, 0], "upper": [1.1, 0.9, 0.5], "cells": [3, 2, 1]},
        "lower": {**BOX, "lower": [-0.5, 0, -0.5], "upper": [2, 1, 0], "cells": [7, 3, 1]},
        "supports": ["ground", "grip"],
        "ground": {"surface": "lower.zmin", "components": ["x", "y", "z"]},
        "grip": {"surface": "upper.zmax", "components": ["x", "y", "z"], "value": [0.2, 0.03, -0.02], "curve": [0, 0, 1, 1, 2, 0.4]},
        "interfaces": ["contact"],
        "contact": {"nonmortar": "upper.zmin", "mortar": "lower.zmax", "friction": 0.3},
        "steps": {"times": [0.5, 1, 1.5, 2]},
    }
    for key, value in more.items():
        scene[key] = {**scene[key], **value} if isinstance(value, dict) and key in scene else value
    return scene


def dropped():
    """A block that its weight closes over a gap, on a follower pressure from then on."""
    scene = pad(
        upper={"density": 1, "lower": [0.1, 0.1, 0.05], "material": "neo_hooke"},
        supports=["ground", "guide"],
        guide={"surface": "upper.zmax", "components": ["x", "y"]},
        loads=["weight", "press"],
        weight={"body": "upper", "gravity": [0, 0, -9.81], "curve": [0, 1, 1, 1]},
        press={"surface": "upper.zmax", "pressure": 3, "follower": True, "curve": [0.5, 0, 2, 1]},
    )
    del scene["grip"]
    return scene


def turned():
    """A block of finite strain that turns on the base with normals of now."""
    twist = {"value": [0, 0, -0.01], "rotate": [0, 0, 0.3], "origin": [0.6, 0.5, 0], "curve": [0, 0, 0.5, 1], "rotate_curve": [0.5, 0, 2, 1]}
    return pad(upper={"material": "neo_hooke"}, grip=twist, contact={"normals": "current"})


def rigid():
    """A rigid block under force and moment."""
    scene = pad(
        upper={"type": "rigid", "from": "box", "reference": [0.6, 0.5, 0.25], "mass": 1},
        supports=["ground", "guide"],
        guide={"body": "upper", "components": ["x", "y"], "value": [0.1, 0.02, 0], "curve": [0.5, 0, 2, 1]},
        loads=["press"],
        press={"body": "upper", "force": [0, 0, -20], "moment": [0.5, 0, 0.2], "curve": [0, 0, 0.5, 1]},
    )
    del scene["grip"], scene["upper"]["young"], scene["upper"]["poisson"]
    return scene


def rigid_thrown():
    """The same, free and thrown onto the base."""
    scene = rigid()
    scene["upper"].update(inertia=[0.1, 0.1, 0.15], velocity=[0.3, 0.1, -0.3], spin=[0.5, -0.3, 1], about=scene["upper"]["reference"])
    scene["lower"]["density"] = 1
    scene.update(dynamics={"rho_inf": 1, "mass_damping": 0.1}, supports=["ground"], steps={"times": [0.05, 0.1, 0.15, 0.2]})
    del scene["guide"]
    return scene


def plane():
    corners = {"upper": {"lower": [0, 0], "upper": [1, 0.5], "cells": [5, 2]}, "lower": {"lower": [-0.5, -0.5], "upper": [2, 0], "cells": [11, 2]}}
    return pad(
        model="plane_strain",
        **{name: {**BOX, **box} for name, box in corners.items()},
        ground={"surface": "lower.ymin", "components": ["x", "y"]},
        grip={"surface": "upper.ymax", "components": ["x", "y"], "value": [0.2, -0.02]},
        contact={"nonmortar": "upper.ymin", "mortar": "lower.ymax"},
    )


def thrown(rho, **more):
    """A block that flies onto the base while its upper face is turned and the base shaken, with damping."""
    shake = {"surface": "lower.zmin", "components": ["x", "y", "z"], "value": [0.02, 0, 0], "curve": [0, 0.5, 1, 1, 2, 0]}
    scene = pad(upper={"density": 2, "velocity": [0.3, 0.1, -0.1], "spin": [0, 0.1, 0.2], "lower": [0.1, 0.1, 0.01]}, lower={"density": 1}, ground=shake,
                supports=["ground"], loads=["press"], press={"surface": "upper.zmax", "pressure": 2, "curve": [0, 1, 2, 0]},
                dynamics={"rho_inf": rho, "mass_damping": 0.1}, steps={"times": [0.05, 0.1, 0.15, 0.2]}, **more)
    del scene["grip"]
    return scene


def warm(**heat):
    """A warm pad that rubs; it expands and lets heat through as it is pressed."""
    return pad(
        upper={"conductivity": 3, "heat_capacity": 2},
        lower={"conductivity": 7, "heat_capacity": 1},
        heat={"initial": 20, **heat},
        temperatures=["hot", "cold"],
        hot={"surface": "upper.zmax", "value": 60, "curve": [0, 0, 2, 1]},
        cold={"surface": "lower.zmin", "value": 20},
        flows=["burner"],
        burner={"surface": "upper.xmax", "flow": 5, "curve": [0, 1, 2, 0]},
        contact={"conductance": 2, "conductance_pressure": 4, "friction_heat": 0.5},
    )


def expanding():
    scene = warm(coupling="two_way")
    scene["upper"]["expansion"] = 1e-3
    return scene


def spread():
    """A thrown block of finite strain, without masses at the contact."""
    scene = thrown(1)
    scene["upper"].update(material="neo_hooke", cells=[2, 2, 3], spin=[0, 1, 2])
    scene["dynamics"]["contact_mass"] = "spread"
    return scene


WEAKENING = {"law": "weakening", "friction_after": 0.1, "critical_slip": 0.2}
LAYERS = {**WEAKENING, "overclosure": [0, 1e-3, 3e-3], "overclosure_pressure": [0, 1, 9], "wear": 1e-4, "bond_stiffness": 100,
          "bond_strength": 1, "bond_toughness": 0.05}
# Name, scene, options.
SCENES = (
    ("pad", pad(), ()),
    ("dual", pad(contact={"basis": "dual"}), ()),
    ("condensed", pad(contact={"basis": "dual"}), CONDENSED),
    ("augmented", pad(contact={"form": "augmented"}), ()),
    ("committed weights", pad(contact={"weights": "committed"}), ()),
    ("tied", pad(contact={"law": "tied", "friction": 0}, grip={"value": [0.01, 0.003, 0.002]}), ()),
    ("weakening", pad(contact=WEAKENING), ()),
    ("layers", pad(contact=LAYERS), ()),
    ("points", pad(contact={"basis": "dual", "decision": "points", "weights": "reference"}, grip={"value": [0.01, 0.003, -0.01]}), ()),
    ("committed points", pad(contact={"basis": "dual", "decision": "points", "weights": "committed"}, grip={"value": [0.01, 0.003, -0.01]}), ()),
    ("offset", pad(contact={"offset": 0.01, "offset_curve": [0, 0, 2, 1]}), ()),
    ("automatic", pad(steps={"automatic": True, "initial": 0.2, "largest": 0.5}), ()),
    ("cut back", pad(upper={"material": "neo_hooke"}, grip={"value": [0.2, 0.03, -0.2]}), ("-snes_max_it", 6)),
    ("dropped", dropped(), ()),
    ("turned", turned(), ()),
    ("rigid", rigid(), ()),
    ("rigid, thrown", rigid_thrown(), ()),
    ("plane", plane(), ()),
    ("dynamics", thrown(0.7), ("-dynamics_stiffness_damping", 0.01)),
    ("dynamics, finite strain", spread(), ("-dynamics_stiffness_damping", 0.01)),
    ("heat", expanding(), ()),
    ("heat, finite strain", expanding(), ("-upper_material", "neo_hooke")),
    ("quadratic", pad(upper={"cell": "tet10"}, lower={"cell": "tet10"}, contact={"basis": "dual"}), ()),
    ("two interfaces", pad(bodies=["upper", "lower", "other"], other={**BOX, "lower": [1.3, 0.1, 0.02], "upper": [1.9, 0.9, 0.5], "cells": [2, 2, 1]},
                           grip={"surface": ["upper.zmax", "other.zmax"]}, interfaces=["contact", "second"],
                           second={"nonmortar": "other.zmin", "mortar": "lower.zmax", "law": "none"}), ()),
)


def restart(verdicts, driver):
    driver.output.mkdir(parents=True, exist_ok=True)
    for name, scene, options in SCENES:
        same_bits(verdicts, driver, name, scene, options, lambda n: [n // 2])
    unnamed(verdicts, driver)
    files(verdicts, driver)
    more_steps(verdicts, driver)
    iterative(verdicts, driver)
    ranks(verdicts, driver)
    refused(verdicts, driver)


def restart_steps(verdicts, driver):
    """From every step but the last, to the end."""
    driver.output.mkdir(parents=True, exist_ok=True)
    for name, scene, options in SCENES:
        same_bits(verdicts, driver, name, scene, options, lambda n: range(1, n))


def same_bits(verdicts, driver, name, scene, options, of):
    """From some of the n steps, `of(n)`, to the end."""
    label = name.replace(" ", "_")
    path = write(scene, driver.output / f"{label}.yaml")
    whole = driver.run(path, *BITS, *KEEP, *options, label=label)
    n = len(whole.steps)
    steps, differ, compared = list(of(n)), [], 0
    for step in steps:
        run = driver.run(path, *BITS, *options, "-restart", whole.directory / f"restart_{step}.bin", label=f"{label}_again")
        differ += [f"{step}: {key}" for key in whole.summary if key not in COSTS and whole.summary[key] != run.summary.get(key)]
        if (whole.directory / "energy.csv").exists():
            differ += [f"{step}: energy.csv"] * ((run.directory / "energy.csv").read_text() != (whole.directory / "energy.csv").read_text())
        tables = sorted(run.directory.glob("interface_*.csv"))
        differ += [f"{step}: {table.name}" for table in tables if table.read_bytes() != (whole.directory / table.name).read_bytes()]
        compared += len(tables) == (n - step) * len(interfaces(path))
    verdicts.true(f"{name}: {len(steps)} restarts, all tables written", compared == len(steps) and n >= 4, "those of the steps that follow")
    verdicts.true(f"{name}: bits of tables and summary", not differ, "; ".join(differ[:4]) or "those of the run that goes through")


def unnamed(verdicts, driver):
    """Writing the files changes nothing."""
    path = driver.output / "pad.yaml"
    plain, kept = (driver.run(path, *BITS, *more, label=label) for more, label in (((), "plain"), (KEEP, "pad")))
    verdicts.true("files are written: bits", plain.steps == kept.steps, "those of the run that writes none")
    names = {p.name for p in plain.directory.iterdir() if "restart" in p.name}
    verdicts.true("nothing is named: no file", not names, f"{len(names)} there")


def files(verdicts, driver):
    """How many are kept, of which steps, and nothing else."""
    path = driver.output / "pad.yaml"
    for options, expected in ((("-output_restart_every", 1), {4}), (("-output_restart_every", 3), {4}),
                              (("-output_restart_every", 3, "-output_restart_keep", 2), {3, 4})):
        run = driver.run(path, *BITS, *options, label="kept")
        there = {p.name for p in run.directory.iterdir() if "restart" in p.name}
        verdicts.true(f"{options}: files", there == {f"restart_{k}.bin" for k in expected}, f"{sorted(there)}")


def more_steps(verdicts, driver):
    """Steps may change: a run that ends at 1 goes on to 2, in steps of its own."""
    path = driver.output / "pad.yaml"
    first = driver.run(path, *BITS, "-steps_times", "0.5,1", *KEEP, label="first")
    rest = driver.run(path, *BITS, "-steps_times", "1.5,2", "-restart", first.directory / "restart_2.bin", label="rest")
    whole = driver.run(path, *BITS, label="plain")
    tables = [[run.interface("contact", 4) for run in (whole, rest)]]
    verdicts.below("steps of two runs: answers", max(apart(tables, group) for group in GROUPS), ANSWERS, "those of one run")
    verdicts.near("steps of two runs: friction work", rest.steps[-1]["friction_work"], whole.steps[-1]["friction_work"], ANSWERS, "counts on")


def iterative(verdicts, driver):
    """Multigrid of an earlier matrix is not in the file: answers, not bits."""
    path, options = write(pad(contact={"basis": "dual"}), driver.output / "iterative.yaml"), (*BITS, *CONDENSED, "-solver", "iterative")
    whole = driver.run(path, *options, *KEEP, label="iterative")
    run = driver.run(path, *options, "-restart", whole.directory / "restart_2.bin", label="iterative_again")
    tables = [[r.interface("contact", k) for r in (whole, run)] for k in (3, 4)]
    verdicts.below("iterative: answers", max(apart(tables, group) for group in GROUPS), ANSWERS, "those of the run that goes through")


def ranks(verdicts, driver):
    """A block that slides over parts' borders, on as many ranks, on more and on fewer."""
    contact = {**SLIDING["contact"], **WEAKENING}
    path = write({**SLIDING, "contact": contact, "steps": {"count": 4}}, driver.output / "sliding.yaml")
    whole = {n: driver.run(path, *BITS, *KEEP, ranks=n, label=f"sliding_{n}") for n in (1, 2)}
    for before, after in ((2, 2), (2, 1), (1, 2), (2, 3)):
        file = whole[before].directory / "restart_2.bin"
        run = driver.run(path, *BITS, "-restart", file, ranks=after, label=f"sliding_{before}_{after}")
        tables = [[whole[1].interface("contact", k), run.interface("contact", k)] for k in (3, 4)]
        worst = max(apart(tables, group) for group in GROUPS)
        verdicts.below(f"from {before} to {after} ranks: answers", worst, ANSWERS, "those of one rank")
        work = [r.steps[-1]["friction_work"] for r in (whole[1], run)]
        verdicts.near(f"from {before} to {after} ranks: friction work", work[1], work[0], ANSWERS, "those of one rank")


    for name, scene, of in (("thrown", thrown(0.7), lambda step: step["energy"]), ("warm", warm(), lambda step: step["heat"]["supplied"])):
        path = write(scene, driver.output / f"{name}.yaml")
        whole = {n: driver.run(path, *BITS, *KEEP, ranks=n, label=f"{name}_{n}") for n in (1, 2)}
        for before, after in ((2, 1), (1, 2)):
            run = driver.run(path, *BITS, "-restart", whole[before].directory / "restart_2.bin", ranks=after, label=f"{name}_{before}_{after}")
            found, right = (np.array([[*of(step).values()] for step in r.steps]) for r in (run, whole[1]))
            verdicts.below(f"{name}, from {before} to {after} ranks: answers", np.abs(found - right).max() / np.abs(right).max(), ANSWERS, "those of one rank")


def refused(verdicts, driver):
    path = driver.output / "pad.yaml"
    good = driver.output / "pad" / "restart_2.bin"
    content = good.read_bytes()

    def refuses(what, says, file, *options, ranks=1, scene=path):
        run = driver.run(scene, *BITS, "-restart", file, *options, label="refused", expect=1, ranks=ranks)
        verdicts.true(f"{what}: refused", "restart:" in run.text and says in run.text, f"says: {says}")
        verdicts.true(f"{what}: a sentence, no traceback", "PETSC ERROR" not in run.text, "nor a crash")

    def spoilt(name, text):
        file = driver.output / f"{name}.bin"
        file.write_bytes(text)
        return file

    refuses("another modulus", "its upper.young is 1000, here it is 1001", good, "-upper_young", 1001)
    refuses("a key more", "it has no contact.weak_coverage", good, "-contact_weak_coverage", 0.5)
    refuses("another mesh", "upper.cells", good, "-upper_cells", "4,2,1")
    ramp = pad()
    del ramp["grip"]["curve"]  # up to the end of the steps
    ramp = write(ramp, driver.output / "ramp.yaml")
    driver.run(ramp, *BITS, *KEEP, label="ramp")
    refuses("another end, and a ramp", "curves", driver.output / "ramp" / "restart_2.bin", "-steps_times", "0.5,1,1.5,3", scene=ramp)
    ramp = warm()
    del ramp["hot"]["curve"]
    ramp = write(ramp, driver.output / "warm_ramp.yaml")
    driver.run(ramp, *BITS, *KEEP, label="warm_ramp")
    refuses("another end, and a ramp of heat", "curves of heat", driver.output / "warm_ramp" / "restart_2.bin", "-steps_times", "0.5,1,1.5,3", scene=ramp)
    refuses("at its end", "the steps end at 1", good, "-steps_times", "0.5,1")
    refuses("no file", "No such file", driver.output / "nowhere.bin")
    refuses("no restart file", "no restart file", path)
    refuses("an empty one", "no restart file", spoilt("empty", b""))
    rng = np.random.default_rng(7)
    for k in range(6):  # one bit, anywhere
        at, bit = int(rng.integers(32, len(content))), int(rng.integers(8))
        changed = content[:at] + bytes([content[at] ^ (1 << bit)]) + content[at + 1:]
        refuses(f"bit {bit} of byte {at} changed", "damaged", spoilt("bit", changed), ranks=1 + k % 2)
    for part in (0.02, 0.5, 0.999):
        refuses(f"cut to {part}", "cannot be used", spoilt("cut", content[: int(part * len(content))]))
    refuses("something behind it", "follows its end", spoilt("long", content + b"0"))
