"""Bodies that a step begins with laying down, and turning: a pin in a lug and a fork, pulled obliquely, and a chain of two such joints. The linear material
becomes the law of St. Venant and Kirchhoff with what turns, and stays what it is where nothing does, or where small strain is meant."""

import numpy as np
from pin_joint import END, pin_chain, pin_joint
from scene import write

# The same law from the laid place on; Newton's tolerance.
SAME = 1e-7
BALANCE = 1e-9
PULL = (20.0, 2.0, 0.0)
# Of the pulled end of a chain, a fork's.
FORK_END = 8.8
# Of all steps.
ITERATIONS = 80


def balanced(verdicts, name, run, force):
    error = np.abs(np.array(run.steps[-1]["reactions"]["root"]) + force).max() / np.abs(force).max()
    verdicts.below(f"{name}: reaction", error, BALANCE, "the load")


def laid(verdicts, driver):
    driver.output.mkdir(parents=True, exist_ok=True)
    found = {}
    for law in ("linear", "st_venant_kirchhoff"):
        scene = pin_joint(PULL, 2)
        for name in ("lug", "pin"):
            scene[name]["material"] = law
        run = driver.run(write(scene, driver.output / f"{law}.yaml"), "-output_restart_every", 1, "-output_restart_keep", 0, label=law)
        found[law] = run
        verdicts.true(f"{law}: laid down", "laid_down" in run.summary, "lug and pin")
        balanced(verdicts, law, run, END * np.array(PULL))
    one, other = found.values()
    compared = {
        "stresses of the cells": [np.sort(np.linalg.norm(r.cell_stress(), axis=1))[-100:] for r in (one, other)],
        "tractions on the pin": [np.sort(r.interface("inner")["lambda_n"])[:10] for r in (one, other)],
    }
    for what, (a, b) in compared.items():
        verdicts.below(f"linear: {what}", np.abs(a - b).max() / np.abs(b).max(), SAME, "the law that knows turns")
    again = driver.run(driver.output / "linear.yaml", "-restart", one.directory / "restart_1.bin", label="restart")
    same = all((again.interface(name, 2)["lambda_n"] == one.interface(name, 2)["lambda_n"]).all() for name in ("inner", "outer"))
    verdicts.true("linear: restart after the step that was laid", same, "the same bits")
    turned = lambda run: {"fork", "lug", "pin"} - set(run.summary["linear_materials"])
    verdicts.true("linear: what turns", turned(one) == {"lug", "pin"}, "has no linear material any more")
    straight = driver.run(write(pin_joint((20.0, 0.0, 0.0), 1), driver.output / "straight.yaml"), label="straight")
    verdicts.true("pulled along: what does not turn", not turned(straight), "stays linear")
    chain(verdicts, driver)


def chain(verdicts, driver):
    for name, pull in (("along", (20.0, 0.0, 0.0)), ("obliquely", PULL)):
        run = driver.run(write(pin_chain(pull, 4), driver.output / f"chain_{name}.yaml"), label=f"chain_{name}")
        balanced(verdicts, f"chain pulled {name}", run, FORK_END * np.array(pull))
        verdicts.below(f"chain pulled {name}: iterations", sum(step["newton_iterations"] for step in run.steps), ITERATIONS, "of four steps")
        verdicts.true(f"chain pulled {name}: cut-backs", run.summary["cutbacks"] == 0, "none")
