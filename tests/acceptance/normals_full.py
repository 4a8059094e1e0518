"""Normals of the current configuration, the longer lines: the group `normals_full`; over all scenes: `normals_iterations`."""

import numpy as np
from idle import SHORTER, SKIPPED, all_scenes, followed, idle_steps
from normals import QUIET
from normals_scenes import dragged_ball, ring
from scene import SCENES, write
from split import ironing

BOTH = ("current", "committed")

# The ball dragged along an arc with friction: so many steps, against FINEST with current normals.
STEPS, FINEST = (4, 8, 16, 32), 64
# An implicit Euler step of the law of friction is of first order: so is the force, whatever the normals. Slope of its error
# over the steps, the last one without, for it is half of FINEST.
ORDER = 0.8
# What lies between the pull and what friction dissipates, over the pull, on the second half of the arc. Mean of the steps.
LATER = 1.5
# Deep contact over facets that turn by 15 and 10 degrees, in parts of the radius. At 0.2 normals of t_n need cut-backs: in
# steps of 0.4 they turn by more than they may.
RINGS, DEPTHS, DRAGS, FRICTIONS = (24, 36), (0.09, 0.12, 0.2), (0.05, 0.1, 0.2, 0.4), (0, 0.3)
# Over all scenes that can have either, the longest on coarser meshes. Left out: minutes, and what is made for current normals.
MORE_ITERATIONS = 1.15
LEFT_OUT = {"torsion": SKIPPED["torsion"], "two_bars": "dynamics", "sliding_down": "dynamics", "shaft_in_bore": "normals of t_n are cut back 9 times"}


def normals_full(verdicts, driver):
    """Ten minutes."""
    ironing(verdicts, driver, (0.01,), (), "full", 0.02)
    friction_on_an_arc(verdicts, driver)
    deep(verdicts, driver)
    for scene, reason in SKIPPED.items():
        print(f"step without load: {scene} is left out ({reason})")
    idle_steps(verdicts, driver, all_scenes())


def friction_on_an_arc(verdicts, driver):
    """The end force and the work of friction against the step, with both normals: a table, and what must hold."""
    ends = {}
    for normals in BOTH:
        for n in (*STEPS, FINEST):
            scene = write(dragged_ball(n, 0.3, normals), driver.output / "scenes" / f"arc_{normals}_{n}.yaml")
            run = driver.run(scene, label=f"arc_{normals}_{n}")
            ends[normals, n] = run.resultant("contact"), run.steps[-1]["friction_work"], undissipated(run)
    force, work, _ = ends["current", FINEST]
    apart = lambda f: np.linalg.norm(f - force) / np.linalg.norm(force)
    wrong = {k: (apart(f), abs(w / work - 1), lost) for k, (f, w, lost) in ends.items()}
    print(f"{'normals':<10} {'steps':>5} {'force':>9} {'work':>9} {'pull that is not dissipated':>28}")
    for (normals, n), row in wrong.items():
        print(f"{normals:<10} {n:>5} {row[0]:>9.2e} {row[1]:>9.2e} {row[2]:>28.3f}")
    for n in STEPS:
        label = f"friction on an arc, {n} steps"
        ours, theirs = wrong["current", n], wrong["committed", n]
        verdicts.below(f"{label}: error of the end force", ours[0], theirs[0], "normals of t_n")
        verdicts.below(f"{label}: pull that is not dissipated", abs(ours[2]), abs(theirs[2]), "normals of t_n")
    for k, name in enumerate(("the end force", "the work of friction")):
        errors = [wrong["current", n][k] for n in STEPS]
        slope = -np.polyfit(np.log(STEPS[:3]), np.log(errors[:3]), 1)[0]
        verdicts.at_least(f"friction on an arc: order of {name}", slope, ORDER, "implicit Euler: first order")


def undissipated(run, arm=1.5, angle=1.0):
    """Part of the pull along the arc that friction does not dissipate."""
    pull = work = 0.0
    for before, step in zip(run.steps, run.steps[1:]):
        if step["t"] <= LATER + 1e-9:
            continue
        turned = angle * (step["t"] - 1)
        along = np.array([np.cos(turned), np.sin(turned), 0])
        pull += abs(np.array(step["interfaces"]["contact"]["force"]) @ along) * arm * angle * (step["t"] - before["t"])
        work += step["friction_work"] - before["friction_work"]
    return 1 - work / pull


def deep(verdicts, driver):
    total, cutbacks = dict.fromkeys(BOTH, 0), dict.fromkeys(BOTH, 0)
    for facets in RINGS:
        for depth in DEPTHS:
            for friction in FRICTIONS:
                for step in DRAGS:
                    label = f"ring_{facets}_{depth:g}_{friction:g}_{step:g}"
                    cut = {}
                    for normals in BOTH:
                        scene = ring(facets, depth, step, friction, normals)
                        path = write(scene, driver.output / "scenes" / f"{label}_{normals}.yaml")
                        run = driver.run(path, label=f"{label}_{normals}")
                        cut[normals] = run.summary["cutbacks"]
                        total[normals] += run.newton_iterations
                        cutbacks[normals] += cut[normals]
                    label = f"ring of {facets}, {depth:g} deep, mu {friction:g}, steps of {step:g}: cut-backs"
                    verdicts.below(label, cut["current"], cut["committed"], "normals of t_n")
    verdicts.below("rings: cut-backs in all", cutbacks["current"], 0, f"{cutbacks['committed']} with normals of t_n")
    verdicts.at_least("rings, normals of t_n: cut-backs in all", cutbacks["committed"], 1, "the lines above can fail")
    print(f"rings: {total['current']} iterations, {total['committed']} with normals of t_n")


def normals_iterations(verdicts, driver):
    """Some minutes."""
    total, cut = dict.fromkeys(BOTH, 0), dict.fromkeys(BOTH, 0)
    for scene in [path.stem for path in sorted(SCENES.glob("*.yaml"))]:
        names = followed(scene)
        if not names or scene in LEFT_OUT:
            continue
        row = {}
        for normals in BOTH:
            options = [word for name in names for word in (f"-{name}_normals", normals)]
            run = driver.run(scene, *SHORTER.get(scene, ()), *options, *QUIET, label=f"{scene}_{normals}")
            row[normals] = run.newton_iterations
            total[normals] += run.newton_iterations
            cut[normals] += run.summary["cutbacks"]
        print(f"{scene:<28} {row['current']:>5} iterations, {row['committed']:>5} with normals of t_n", flush=True)
    bound = MORE_ITERATIONS * total["committed"]
    verdicts.below("all scenes: iterations", total["current"], bound, f"{total['committed']} with normals of t_n")
    verdicts.below("all scenes: cut-backs", cut["current"], cut["committed"], "normals of t_n")
