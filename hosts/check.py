#!/usr/bin/env python3
"""Builds the hosts that are installed against an installed stickslip, runs them, and compares them with the driver.

    check.py --build BUILD [--cmake cmake]

A host that is not installed is left out with a sentence. The exit code is 77 if none is there.
"""

import argparse
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import meshio
import numpy as np

HERE = Path(__file__).resolve().parent
SCENE = HERE.parent / "c_examples" / "scenes" / "two_blocks.yaml"
NONE_IS_THERE = 77
STEPS = 4
# What the hosts have: a coarse mesh, and a way along which some nodes stick and others slip. The driver's Newton method is made theirs.
SAME_PROBLEM = ["-upper_cells", "4,4,4", "-lower_cells", "5,5,4", "-grip_value", "0.002,0.0008,-0.005",
                "-steps_count", str(STEPS), "-steps_predictor", "false", "-snes_linesearch_type", "basic",
                "-output_vtu", "all"]
# Over the largest displacement. 5e-14 is measured: the rounding of two linear solvers.
DISPLACEMENTS = 1e-12
# The patch test's pressure: 0.005 = p (0.8 / 1000 + 0.8 / 2000). 2e-14 of it is measured.
PRESSURE, PATCH = 0.005 / (0.8 / 1000 + 0.8 / 2000), 1e-11
# Decimals that tell nodes apart, for both meshes' nodes in one order.
DECIMALS = 6
failed = []


def run(*command, may_fail=False):
    done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
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


def drivers_answer(build, folder):
    """Places and displacements of all nodes in the last step, iterations and numbers of nodes by state in each."""
    printed = run(build / "c_examples/snes_contact", "-scene", SCENE, "-output_dir", folder, *SAME_PROBLEM).stdout
    mesh = meshio.read(folder / f"step_{STEPS}.vtu")
    counts = [[int(word) for word in found] for found in
              re.findall(r"newton +(\d+).*contact +(\d+) gap +(\d+) stick +(\d+) slip", printed)]
    return *sorted_by_place(mesh.points, mesh.point_data["displacement"]), counts


def compare(name, program, answer, folder):
    places, displacements, counts = answer
    patch = run(program, "patch", 1, folder / "patch").stdout
    multipliers = np.array([float(word) for word in patch.split()[-2:]])
    judge(f"{name}: multipliers of the patch test", np.abs(multipliers / -PRESSURE - 1).max(), PATCH)
    printed = run(program, "friction", STEPS, folder / "friction").stdout
    rows = np.loadtxt(folder / "friction")
    own_places, own = sorted_by_place(rows[:, :3], rows[:, 3:])
    judge(f"{name}: places of nodes", np.abs(own_places - places).max(), 10.0**-DECIMALS)
    judge(f"{name}: displacements", np.abs(own - displacements).max() / np.abs(displacements).max(), DISPLACEMENTS)
    found = [[int(word) for word in line] for line in
             re.findall(r"iterations (\d+) gap (\d+) stick (\d+) slip (\d+)", printed)]
    print(f"        iterations, gap, stick, slip: {found}")
    judge(f"{name}: steps with other iterations or states", float(sum(a != b for a, b in zip(found, counts))
                                                              + abs(len(found) - STEPS)), 0)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", required=True, type=Path)
    parser.add_argument("--cmake", default="cmake")
    arguments = parser.parse_args()
    build = arguments.build.resolve()
    prefix = build / "hosts/installed"
    run(arguments.cmake, "--install", build, "--prefix", prefix)
    # The wheel of MFEM, where `make hosts` puts it.
    prefixes = [str(prefix), *map(str, (build / "hosts/python").glob("lib/python*/site-packages/mfem/external/ser"))]
    there = 0
    with tempfile.TemporaryDirectory(prefix="stickslip-") as folder:
        folder = Path(folder)
        answer = drivers_answer(build, folder / "driver")
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
            compare(name, own / "two_blocks", answer, folder)
    sys.exit(1 if failed else 0 if there else NONE_IS_THERE)


if __name__ == "__main__":
    main()
