"""Run one example scene and read what it wrote.

The contract with the driver: `stickslip -scene FILE -output_dir DIR [options]` leaves in DIR `summary.json`,
`interface_NAME_STEP.csv` (one row per non-mortar node) and `step_STEP.vtu` (of several ranks `step_STEP.pvtu`). Exit code 0: every step converged,
1: bad scene, 2: not converged, 3: refused by the library.

A missing file or an unexpected exit code raises SceneError: no check may pass because there was nothing to check.
"""

import json
import math
import re
import resource
import shutil
import subprocess
import time
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pieces
from mpi import environment

SCENES = Path(__file__).resolve().parents[2] / "c_examples" / "scenes"


class SceneError(Exception):
    """A scene did not run as expected, or did not write what it should."""


def write(scene, path):
    """A scene (a dict) as a YAML file, in flow style, which JSON is; returns its path. A file that says the same stays as it
    is, so that runs of it can be kept."""
    path.parent.mkdir(parents=True, exist_ok=True)
    text = "".join(f"{key}: {json.dumps(value)}\n" for key, value in scene.items())
    if not path.is_file() or path.read_text() != text:
        path.write_text(text)
    return path


def interfaces(scene):
    """The names of the interfaces of a scene, a file or the name of one in SCENES."""
    text = (scene if isinstance(scene, Path) else SCENES / f"{scene}.yaml").read_text()
    listed = re.search(r"^\"?interfaces\"?: \[(.*?)\]", text, re.MULTILINE | re.DOTALL)
    names = [name.strip(" \n\"") for name in listed[1].split(",")] if listed else []
    return names + ["all"] * bool(re.search(r"^\"?contact\"?: \"?all\b", text, re.MULTILINE))


def weights(scene, name):
    """The mortar weights of one of its interfaces: "current", "committed" or "reference"."""
    path = scene if isinstance(scene, Path) else SCENES / f"{scene}.yaml"
    about = re.search(rf"^\"?{re.escape(name)}\"?:(.*(?:\n[ \t].*)*)", path.read_text(), re.MULTILINE)
    given = about and re.search(r"\bweights\"?: *\"?(\w+)", about[1])
    return given[1] if given else "current"


def multiplier(table):
    """(n, 3) multiplier of each node from its normal and tangential parts."""
    normal = np.stack([table["nx"], table["ny"], table["nz"]], axis=1)
    tangential = np.stack([table["lambda_tx"], table["lambda_ty"], table["lambda_tz"]], axis=1)
    return table["lambda_n"][:, None] * normal + tangential


@dataclass
class Line:
    """An interface seen along x: sums over the nodes with the same x, per unit thickness, ordered by x."""

    x: np.ndarray
    force: np.ndarray  # (n, 3) nodal force of the mortar on the non-mortar side
    length: np.ndarray  # tributary length, undeformed: half the way to each neighbour
    state: np.ndarray  # 'gap', 'stick' or 'slip'; 'mixed' where the nodes of one x differ
    # (n, 3) what the multipliers say of the traction: minus each, times its covered area, summed over nodes of the same
    # x, over tributary length. With dual multipliers it is `traction`. None: whoever solved this has none.
    multiplier: np.ndarray | None = None

    @property
    def traction(self):
        """Nodal force over tributary length. Unlike the multiplier itself it does not oscillate next to a singularity.

        The length is the undeformed one, since the bulk is linear elastic: in the Hertz scene the material at the
        centre is 2.4 % shorter when deformed, which would show as so much more pressure.
        """
        return self.force / self.length[:, None]


@dataclass
class Run:
    """One finished run of the driver."""

    directory: Path
    exit_code: int
    text: str  # what it printed
    seconds: float
    cpu_seconds: float  # of all its processes
    summary: dict = field(default_factory=dict)  # empty where the scene was refused

    @property
    def steps(self):
        return self.summary["steps"]

    @property
    def newton_iterations(self):
        return sum(step["newton_iterations"] for step in self.steps)

    def resultant(self, interface, step=-1):
        return np.array(self.steps[step]["interfaces"][interface]["force"])

    def interface(self, name, step=None):
        """Table of an interface's nodes after a step (default: the last) as a structured array."""
        path = self._output(rf"interface_{re.escape(name)}_(\d+)\.csv", step)
        table = np.atleast_1d(np.genfromtxt(path, delimiter=",", names=True, dtype=None, encoding="ascii"))
        if len(table) == 0:
            raise SceneError(f"{path} has no rows")
        return table

    def mesh(self, step=None):
        """(points, cells by kind, displacement) of the undeformed meshes after a step."""
        mesh = self._bodies(step)
        displacement = next((v for k, v in mesh.point_data.items() if "displacement" in k), None)
        if displacement is None:
            raise SceneError(f"{self.directory}: no displacement in the .vtu, only {list(mesh.point_data)}")
        return mesh.points, mesh.cells_dict, displacement

    def point_field(self, name, step=None):
        """A field of the undeformed meshes' nodes, as `traction_NAME`; the CSV's `node` is the index."""
        fields = self._bodies(step).point_data
        if name not in fields:
            raise SceneError(f"{self.directory}: no {name} in the .vtu, only {list(fields)}")
        return fields[name]

    def cell_stress(self, step=None):
        """Cauchy's stress at the cells' centres: (cells, 6), xx yy zz xy yz xz."""
        mesh = self._bodies(step)
        return np.concatenate(mesh.cell_data["stress_xx_yy_zz_xy_yz_xz"])

    def cell_bodies(self, step=None, kind="hexahedron"):
        """Number of the body of each cell of a kind, in the order of mesh()."""
        mesh = self._bodies(step)
        return np.asarray(mesh.cell_data_dict["body"][kind]).ravel()

    def line(self, name, step=None):
        table = self.interface(name, step)
        x, first, group = np.unique(np.round(table["X"], 9), return_index=True, return_inverse=True)
        total = lambda column: np.bincount(group, weights=table[column]) / np.ptp(table["Y"])
        half = np.hypot(np.diff(x), np.diff(table["Z"][first])) / 2
        length = np.append(half, 0) + np.append(0, half)
        states = [set(table["state"][group == i]) for i in range(len(x))]
        weights = -multiplier(table) * table["area_covered"][:, None] / np.ptp(table["Y"])
        summed = np.stack([np.bincount(group, weights=weights[:, k]) for k in range(3)], axis=1)
        return Line(
            x=x,
            force=np.stack([total("fx"), total("fy"), total("fz")], axis=1),
            length=length,
            multiplier=summed / length[:, None],
            state=np.array([s.pop() if len(s) == 1 else "mixed" for s in states]),
        )

    def _bodies(self, step):
        """The bodies' meshes and fields after a step, in the order of one rank."""
        import meshio  # only here: the module is slow to load

        path = self._output(r"step_(\d+)\.p?vtu", step)
        return meshio.read(path) if path.suffix == ".vtu" else pieces.read(path)

    def _output(self, pattern, step):
        found = {}
        for path in self.directory.iterdir():
            match = re.fullmatch(pattern, path.name)
            if match:
                found[int(match.group(1))] = path
        if not found:
            raise SceneError(f"{self.directory}: nothing matches {pattern}")
        wanted = max(found) if step is None else step
        if wanted not in found:
            raise SceneError(f"{self.directory}: no step {wanted} of {pattern}; there are {sorted(found)}")
        return found[wanted]


def _cpu_of_children():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


class Driver:
    """The program in a build tree, `build`; outputs go to subdirectories of `output`. With `keep` a run whose outputs are
    newer than its inputs (program, scene, meshes) and that had the same options is read instead of made again; `report`
    is told of every run, with the number of seconds, or None if it was kept."""

    def __init__(self, build, output, keep=False, report=lambda label, run, seconds: None):
        self.build = Path(build).resolve()
        self.program = self.build / "program" / "stickslip"
        self.output = Path(output).resolve()
        self.keep, self.report = keep, report
        if not self.program.is_file():
            raise SceneError(f"{self.program} is not there: run `make build` first")

    def run(self, scene, *options, label=None, ranks=1, expect=0):
        """Run SCENES/scene.yaml (or a path) with extra options; raise unless the exit code is the expected one, if any."""
        path = scene if isinstance(scene, Path) else SCENES / f"{scene}.yaml"
        directory = self.output / (label or path.stem)
        command = [str(self.program), "-scene", str(path), "-output_dir", str(directory), "-options_left"]
        command += map(str, options)
        if ranks > 1:
            command = ["mpirun", "--oversubscribe", "-n", str(ranks), *command]
        if self.keep and expect in (0, None) and self._is_new(path, directory, command):
            result = self._finished(Run(directory, 0, (directory / "log.txt").read_text(), 0.0, math.nan))
            self.report(label or path.stem, result, None)
            return result

        if directory.exists():
            shutil.rmtree(directory)  # an old result must never be read as a new one
        directory.mkdir(parents=True)
        start, cpu = time.monotonic(), _cpu_of_children()
        done = subprocess.run(
            command,
            # Spares a program of one rank the start of a daemon, which takes a tenth of a second
            env=environment(OMPI_MCA_ess_singleton_isolated="1"),
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            errors="replace",
        )
        (directory / "log.txt").write_text(" ".join(command) + "\n" + done.stdout + done.stderr)
        seconds, cpu = time.monotonic() - start, _cpu_of_children() - cpu
        result = Run(directory, done.returncode, done.stdout + done.stderr, seconds, cpu)
        if expect not in (None, done.returncode):
            tail = "\n".join((done.stdout + done.stderr).strip().splitlines()[-8:])
            raise SceneError(
                f"{path.name}: exit code {done.returncode} instead of {expect} ({' '.join(command)})\n{tail}"
            )
        if (directory / "summary.json").is_file():
            result.summary = json.loads((directory / "summary.json").read_text())
        if done.returncode == 0:
            # MUMPS' own are the program's; where nothing had to be solved, nothing has read them
            unused = re.findall(r"Option left: name:(?!-mat_mumps_icntl)(\S+)", result.text)
            if unused:  # a misspelt option would silently leave the scene as it was
                raise SceneError(f"{path.name}: options nothing read: {', '.join(unused)}")
            self._finished(result)
        self.report(label or path.stem, result, result.seconds)
        return result

    @staticmethod
    def _finished(result):
        """The run, every step of which converged."""
        summary = result.directory / "summary.json"
        if not summary.is_file():
            raise SceneError(f"{result.directory}: no summary.json")
        result.summary = json.loads(summary.read_text())
        if not result.steps or not all(step["converged"] for step in result.steps):
            raise SceneError(f"{summary}: no steps, or one that did not converge")
        return result

    def _is_new(self, path, directory, command):
        """Is there a whole run of this command, newer than all that went into it? The log is written last."""
        log = directory / "log.txt"
        if not log.is_file() or log.read_text().partition("\n")[0] != " ".join(command):
            return False
        summary = directory / "summary.json"
        if not summary.is_file() or not all(s["converged"] for s in json.loads(summary.read_text())["steps"]):
            return False
        meshes = [path.parent / name for name in re.findall(r"file: *([^\s,}]+)", path.read_text())]
        return all(each.stat().st_mtime < summary.stat().st_mtime for each in (self.program, path, *meshes))
