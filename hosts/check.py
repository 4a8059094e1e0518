#!/usr/bin/env python3
"""Builds the hosts that are installed against an installed stickslip, runs them, and compares them with the driver.

    check.py --build BUILD [--cmake cmake] [--calculix]

A host that is not installed is left out with a sentence. The exit code is 77 if none is there. --calculix: gets and compiles CalculiX,
two minutes; without it CalculiX takes part where that was done before.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import meshio
import numpy as np

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
EXAMPLES = ROOT / "python" / "examples"
SCENE = ROOT / "c_examples" / "scenes" / "two_blocks.yaml"
NONE_IS_THERE = 77
STEPS = 4
# The driver's Newton method made that of the hosts: full steps, no predictor.
SAME_METHOD = ["-steps_predictor", "false", "-snes_linesearch_type", "basic", "-output_vtu", "all"]
# What the hosts have: a coarse mesh, and a way along which some nodes stick and others slip.
SAME_PROBLEM = ["-upper_cells", "4,4,4", "-lower_cells", "5,5,4", "-grip_value", "0.002,0.0008,-0.005",
                "-steps_count", str(STEPS), *SAME_METHOD]
LARGE_STRAIN = ["-upper_material", "neo_hooke", "-lower_material", "neo_hooke"]
# The problem of python/examples/petsc4py_block.py: a block on a rigid base, pressed, then drawn.
CELLS = 10
PETSC_SCENE = f"""schema: 1
bodies: [block, base]
block: {{type: box, lower: [0, 0, 0], upper: [2, 2, 1], cells: [{CELLS}, {CELLS}, {(CELLS + 1) // 2}], young: 1000,
  poisson: 0.3, small_strain: true}}
base: {{type: box, lower: [-1, -1, -1], upper: [3, 3, 0], cells: [1, 1, 1], young: 1000, poisson: 0.3}}
supports: [top, rigid]
top: {{surface: block.zmax, components: [x, y], value: [0.1, 0, 0], curve: [0.5, 0, 1, 1]}}
rigid: {{body: base, components: [x, y, z]}}
loads: [press]
press: {{surface: block.zmax, traction: [0, 0, -10], curve: [0, 0, 0.5, 1]}}
interfaces: [contact]
contact: {{nonmortar: block.zmin, mortar: base.zmax, friction: 0.3}}
steps: {{end: 1, count: {STEPS}}}
"""
# Over the largest displacement. 6e-14 is measured: the rounding of two linear solvers. 1e-8 is asked for.
DISPLACEMENTS = 1e-12
# Of the patch test's pressure. 5e-13 is measured; 1e-10 is asked for.
PATCH = 1e-11
# Decimals that tell nodes apart, for both meshes' nodes in one order.
DECIMALS = 6
# Where root runs this, as in containers, Open MPI asks for the first two; with a single core for the third.
OPEN_MPI = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1"}
failed = []


def linear_pressure():
    """p of the patch test: two columns of height 0.8, of moduli 1000 and 2000, together 0.005 shorter."""
    return 0.005 / (0.8 / 1000 + 0.8 / 2000)


def neo_hookean_pressure():
    """The same where a stretch s needs the force E (s - 1/s) / 2 on its area, which stays; both columns bear one force."""
    def shortening(p):
        return sum(0.8 * (1 + p / young - np.sqrt((p / young) ** 2 + 1)) for young in (1000.0, 2000.0))

    low, high = 0.0, 2 * linear_pressure()
    for _ in range(100):
        middle = (low + high) / 2
        low, high = (middle, high) if shortening(middle) < 0.005 else (low, middle)
    return middle


def run(*command, may_fail=False, env=None):
    done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          env={**os.environ, **OPEN_MPI, **(env or {})})
    if done.returncode != 0 and not may_fail:
        raise SystemExit(f"FAILED  {' '.join(map(str, command))}\n{done.stdout}")
    return done


def judge(what, value, bound):
    print(f"{'ok    ' if value <= bound else 'FAILED'}  {what}: {value:.1e}, at most {bound:.0e}")
    if not value <= bound:
        failed.append(what)


def sorted_by_place(places, displacements):
    order = np.lexsort(np.round(places, DECIMALS).T)
    return places[order], displacements[order]


class Driver:
    """The driver's answers, each computed when it is asked for the first time."""

    def __init__(self, program, folder):
        self.program, self.folder, self.known = program, folder, {}

    def answer(self, name, scene, *options, above=None):
        """Places and displacements of all nodes in the last step, iterations and numbers of nodes by state in each.

        above: cells whose centre is lower are left out.
        """
        if name not in self.known:
            out = self.folder / f"driver_{name}"
            printed = run(self.program, "-scene", scene, "-output_dir", out, *options).stdout
            mesh = meshio.read(out / f"step_{STEPS}.vtu")
            cells = np.concatenate([block.data for block in mesh.cells if block.type == "hexahedron"])
            if above is not None:
                cells = cells[mesh.points[cells][:, :, 2].mean(axis=1) > above]
            nodes = np.unique(cells)
            counts = [[int(word) for word in found] for found in
                      re.findall(r"newton +(\d+).*contact +(\d+) gap +(\d+) stick +(\d+) slip", printed)]
            places = sorted_by_place(mesh.points[nodes], mesh.point_data["displacement"][nodes])
            self.known[name] = (*places, counts)
        return self.known[name]


def compare(name, answer, pressure, patch, friction):
    """patch and friction: words that a host has printed, and for the latter the file that it has written."""
    multipliers = np.array([float(word) for word in patch.split()[-2:]])
    judge(f"{name}: multipliers of the patch test", np.abs(multipliers / -pressure - 1).max(), PATCH)
    places, displacements, counts = answer
    printed, file = friction
    rows = np.loadtxt(file)
    own_places, own = sorted_by_place(rows[:, :3], rows[:, 3:])
    judge(f"{name}: places of nodes", np.abs(own_places - places).max(), 10.0**-DECIMALS)
    judge(f"{name}: displacements", np.abs(own - displacements).max() / np.abs(displacements).max(),
          DISPLACEMENTS)
    found = [[int(word) for word in re.findall(r"\d+", line)[:4]] for line in
             re.findall(r"step \d+:? (iterations \d+ gap \d+ stick \d+ slip \d+|\d+ iterations, \d+ gap \d+ stick \d+ slip)",
                        printed)]
    print(f"        iterations, gap, stick, slip: {found}; of the driver {counts}")
    judge(f"{name}: steps with other states", float(sum(a[1:] != b[1:] for a, b in zip(found, counts))
                                                    + abs(len(found) - len(counts))), 0)
    judge(f"{name}: steps with other iterations", float(sum(a[0] != b[0] for a, b in zip(found, counts))), 0)


def two_blocks(name, command, driver, folder, large_strain=False, env=None):
    """A program with the arguments friction|patch STEPS FILE."""
    options, pressure = (LARGE_STRAIN, neo_hookean_pressure()) if large_strain else ([], linear_pressure())
    answer = driver.answer("large_strain" if large_strain else "small_strain", SCENE, *SAME_PROBLEM, *options)
    patch = run(*command, "patch", 1, folder / "patch", env=env).stdout
    file = folder / "friction"
    printed = run(*command, "friction", STEPS, file, env=env).stdout
    compare(name, answer, pressure, patch, (printed, file))


def petsc4py_block(command, driver, folder, env):
    scene = folder / "petsc4py.yaml"
    scene.write_text(PETSC_SCENE)
    answer = driver.answer("petsc4py", scene, *SAME_METHOD, above=0)
    for ranks in (1, 2):
        if ranks > 1 and shutil.which("mpiexec") is None:
            print("left out  petsc4py on two processes: mpiexec is not installed")
            continue
        words = [*(["mpiexec", "-n", ranks] if ranks > 1 else []), *command, "-n", CELLS]
        patch = run(*words, "-steps", 1, "-poisson", 0, "-push", 0, env=env).stdout
        file = folder / f"petsc4py_{ranks}"
        printed = run(*words, "-steps", STEPS, "-output", file, env=env).stdout
        compare(f"petsc4py, {ranks} processes", answer, 10.0, patch, (printed, file))


def python_with(module, build):
    """An interpreter that has a module and what the package needs: that of `make hosts`, or the one that runs this."""
    for python in (*(build / "hosts/python").glob("bin/python"), sys.executable):
        if run(python, "-c", f"import cffi, numpy, scipy, {module}", may_fail=True).returncode == 0:
            return python
    return None


def calculix(build, prefix, fetch):
    """Compiles CalculiX with the library and compares it; whether it is there."""
    folder, here = build / "hosts/calculix", HERE / "calculix"
    if not fetch and not (folder / "ccx_stickslip").exists():
        print("left out  CalculiX is not compiled: `make hosts` does it")
        return False
    made = run(sys.executable, here / "build.py", "--prefix", prefix, "--out", folder, may_fail=True)
    print(made.stdout.strip(), flush=True)
    if made.returncode == NONE_IS_THERE:
        return False
    if made.returncode != 0:
        failed.append("CalculiX")
    elif subprocess.run([sys.executable, here / "check.py", "--program", folder / "ccx_stickslip", "--driver",
                         build / "program/stickslip", "--out", folder / "runs"]).returncode != 0:
        failed.append("CalculiX")
    return True


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", required=True, type=Path)
    parser.add_argument("--cmake", default="cmake")
    parser.add_argument("--calculix", action="store_true")
    arguments = parser.parse_args()
    build = arguments.build.resolve()
    prefix = build / "hosts/installed"
    run(arguments.cmake, "--install", build, "--prefix", prefix)
    # The wheel of MFEM, where `make hosts` puts it.
    prefixes = [str(prefix), *map(str, (build / "hosts/python").glob("lib/python*/site-packages/mfem/external/ser"))]
    env = {"STICKSLIP_LIBRARY": str(prefix / "lib/libstickslip.so"), "PYTHONPATH": str(ROOT / "python/src")}
    there = int(calculix(build, prefix, arguments.calculix))
    with tempfile.TemporaryDirectory(prefix="stickslip-") as folder:
        folder = Path(folder)
        driver = Driver(build / "program/stickslip", folder)
        for source in sorted(HERE.glob("*/CMakeLists.txt")):
            name = source.parent.name
            own = build / "hosts" / name
            configured = run(arguments.cmake, "-S", source.parent, "-B", own, f"-DCMAKE_PREFIX_PATH={';'.join(prefixes)}",
                             may_fail=True)
            if configured.returncode != 0:
                if f'provided by "{name}"' not in configured.stdout:
                    raise SystemExit(f"FAILED  {name} does not configure\n{configured.stdout}")
                print(f"left out  {name} is not installed: `make hosts` installs it")
                continue
            there += 1
            run(arguments.cmake, "--build", own)
            two_blocks(name, [own / "two_blocks"], driver, folder)
        for name, module, example in (("numpy", "numpy", "numpy_blocks.py"), ("FEniCSx", "dolfinx", "fenicsx_blocks.py"),
                                      ("scikit-fem", "skfem", "scikit_fem_blocks.py"), ("SfePy", "sfepy", "sfepy_blocks.py"),
                                      ("FElupe", "felupe", "felupe_blocks.py"),
                                      ("petsc4py", "petsc4py", "petsc4py_block.py")):
            python = python_with(module, build)
            if python is None:
                print(f"left out  {name} is not installed: `make hosts` installs it")
                continue
            there += 1
            if name == "petsc4py":
                petsc4py_block([python, EXAMPLES / example], driver, folder, env)
            else:
                two_blocks(name, [python, EXAMPLES / example], driver, folder, large_strain=name == "FElupe", env=env)
    sys.exit(1 if failed else 0 if there else NONE_IS_THERE)


if __name__ == "__main__":
    main()
