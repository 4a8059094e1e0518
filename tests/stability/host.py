"""Runs the driver on a scene that is made here, and reads what the matrix wants to know."""

import json
import os
import re
import sys
from dataclasses import dataclass
from pathlib import Path

import condition
from cell import Outcome
from library import BASIS, NORMALS, Library

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "studies" / "common"))
import folders  # noqa: E402, F401  (needs the path; puts the others on it)
from scene import SCENES, Driver, SceneError, interfaces, weights, write  # noqa: E402  (needs the path)

# The variable of the environment that says on how many ranks the driver runs.
RANKS = "STABILITY_RANKS"

CONVERGED, BAD_SCENE, NOT_CONVERGED, REFUSED = range(4)  # exit codes of the driver


def matrix_folder():
    """Of the matrix with these multipliers and normals, on so many ranks."""
    return "_".join(["stability", *(os.environ[name] for name in (BASIS, NORMALS, RANKS) if name in os.environ)])


def in_question(path, options):
    """The options that say so of the interfaces of a scene. Frozen weights, there or in its options, go with committed
    normals only."""
    names = interfaces(path)
    if BASIS in os.environ:
        yield from (word for name in names for word in (f"-{name}_basis", os.environ[BASIS]))
    if NORMALS in os.environ:
        free = [name for name in names if weights(path, name) == "current" and f"-{name}_weights" not in options]
        yield from (word for name in free for word in (f"-{name}_normals", os.environ[NORMALS]))


@dataclass
class Context:
    """Where a cell runs."""

    build: Path
    label: str

    @property
    def folder(self):
        return self.build / matrix_folder() / "runs" / self.label

    @property
    def library(self):
        return Library(self.build / "lib" / "libstickslip.so")

    def write(self, scene, name="scene"):
        """A scene as a file in the cell's folder."""
        return write(scene, self.folder / f"{name}.yaml")

    def adapted(self, name, steps):
        """A scene of c_examples/scenes with other steps, as a file in the cell's folder."""
        text = (SCENES / f"{name}.yaml").read_text()
        text, found = re.subn(r"^steps:.*$", f"steps: {json.dumps(steps)}", text, flags=re.MULTILINE)
        if found != 1:
            raise SceneError(f"{name}.yaml: no steps in a line of their own")
        self.folder.mkdir(parents=True, exist_ok=True)
        path = self.folder / f"{name}.yaml"
        path.write_text(re.sub(r"file: *(?=[^/\s])", f"file: {SCENES}/", text))
        return path

    def solve(self, scene, *options, name="run", kappa=False):
        """The finished Run of a scene (a dict, a file, or the name of one in c_examples/scenes); any exit code."""
        path = self.write(scene, name) if isinstance(scene, dict) else scene
        options = (*in_question(path, options), *options)
        matrix = self.folder / f"{name}_matrix.bin"
        if kappa:
            self.folder.mkdir(parents=True, exist_ok=True)
            matrix.unlink(missing_ok=True)
            options += ("-ksp_view_mat", f"binary:{matrix}")
        run = Driver(self.build, self.folder).run(path, *options, label=name, expect=None, ranks=int(os.environ.get(RANKS, 1)))
        run.kappa = None
        if kappa and matrix.is_file():
            run.kappa = condition.of(condition.read(matrix))
            matrix.unlink()
            matrix.with_name(matrix.name + ".info").unlink(missing_ok=True)
        return run


def message(run):
    """The sentence with which the driver gave up, and what the library found at its last iterate."""
    lines = [line.strip() for line in run.text.splitlines() if line.strip()]
    told = [line for line in lines if re.match(r"(\[0\])?(stickslip: |\S+\.yaml: )(?!\d+ unknowns)", line)]
    found = [line for line in lines if re.match(r"\w+: \d+ nodes in gap", line)]
    return " ".join([(told or lines or [""])[-1], *found])


def outcome(run):
    """What every run of the driver has: iterations, what it complained of, or its refusal. Errors are the cell's to
    add."""
    result = Outcome(kappa=run.kappa)
    if run.exit_code not in (CONVERGED, BAD_SCENE, NOT_CONVERGED, REFUSED):
        raise SceneError(f"the driver ended with {run.exit_code}, which is none of its exit codes: {message(run)}")
    if run.exit_code != CONVERGED:
        result.refusal = message(run)
        return result
    result.iterations = run.newton_iterations
    if run.summary["cutbacks"]:
        result.warnings.append(f"{run.summary['cutbacks']} cut-backs")
    cycles = sum(len(step.get("cycles", ())) for step in run.steps)
    if cycles:
        result.warnings.append(f"{cycles} cycles found and ended")
    for name, motions in run.summary.get("held_by_nothing", {}).get("bodies", {}).items():
        result.warnings.append(f"{name} is free to {motions}")
    for name, found in run.summary.get("several_states", {}).items():
        result.warnings.append(f"{name}: friction beyond {found['critical_friction']:.3g}, a node's limit for one state")
    result.figures["seconds"] = run.seconds
    return result
