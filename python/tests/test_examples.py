"""Each example runs, draws its picture and finds what it must."""

import importlib.util
import os
import re
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
import stickslip
from bodies import Blocks

EXAMPLES = Path(__file__).resolve().parent.parent / "examples"
# The driver's probes of plane_block.yaml.
TOPLEFT = 0.04851349276175426, -0.29031535607113274
TOPRIGHT = 0.262352934489316, -0.4060503680352719
DRIVER = 1e-12
# Rounding of two linear solvers, of the largest multiplier.
SOLVERS = 1e-11
# Of mu times the pressure, where all nodes slip: the block bulges, so that some of it is across. 0.994 is found.
SLIPPING = 0.99
# The driver's Newton iterations with -steps_predictor false -snes_linesearch_type basic.
ITERATIONS = [4, 1, 1, 1, 1, 1, 1, 1, 1, 1, 2, 1, 1, 2, 1, 2, 2, 2, 2, 2]


def run(name, folder, *needed, before=()):
    for package in (*needed, "matplotlib"):
        if importlib.util.find_spec(package) is None:
            pytest.skip(f"{name} needs {package}, which is not installed")
    picture = folder / "picture.png"
    printed = call(name, *before, str(picture))
    assert picture.stat().st_size > 10_000
    return printed


def call(name, *arguments):
    path = os.pathsep.join([str(Path(stickslip.__file__).parents[1]), os.environ.get("PYTHONPATH", "")])
    done = subprocess.run([sys.executable, str(EXAMPLES / name), *arguments], capture_output=True, text=True,
                          env={**os.environ, "PYTHONPATH": path}, timeout=300)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_block_is_the_drivers(tmp_path):
    printed = run("block.py", tmp_path)
    assert f"iterations {ITERATIONS} " in printed
    words = printed.split()
    topleft, topright = words.index("topleft"), words.index("topright")
    found = [float(word) for word in (*words[topleft + 1 : topleft + 3], *words[topright + 1 : topright + 3])]
    np.testing.assert_allclose(found, [*TOPLEFT, *TOPRIGHT], rtol=0, atol=DRIVER)


def test_general_contact_of_several_bodies_and_of_one_with_itself(tmp_path):
    printed = run("general_contact.py", tmp_path)
    assert printed.count("iterations") == 24 and "cut back" not in printed
    for pair in ("Bodies 0 and 1", "Body 1 and itself", "Bodies 1 and 2"):
        assert f"{pair}: " in printed
    assert int(re.search(r"time 2: .* (\d+) gap", printed).group(1)) < 200  # of 206 copies, so that more than one place is closed
    assert "refused" not in printed and "not be put" not in printed


def test_press_and_pull_is_in_the_readme_and_slides():
    if importlib.util.find_spec("skfem") is None:
        pytest.skip("press_and_pull.py needs skfem, which is not installed")
    ratios = [float(line.split("pull / press ")[1].split()[0]) for line in call("press_and_pull.py").splitlines()]
    # It slides at mu 0.3, along a surface that is bent a little; while it sticks it is pulled by less.
    assert len(ratios) == 10 and ratios[5] < 0.26 and np.abs(np.array(ratios[7:]) / 0.3 - 1).max() < 0.005
    quoted = (EXAMPLES.parents[1] / "README.md").read_text().split("```python\n")[1].split("```")[0]
    assert quoted in (EXAMPLES / "press_and_pull.py").read_text()


def programs():
    return [part.split("```")[0] for part in (EXAMPLES.parent / "README.md").read_text().split("```python\n")[1:]]


def test_the_first_program_of_the_readme_runs(monkeypatch, capsys):
    assert len(programs()[0].splitlines()) <= 15
    installed = ModuleType("stickslip.examples")  # as a wheel has them
    installed.__path__ = [str(EXAMPLES)]
    monkeypatch.setitem(sys.modules, "stickslip.examples", installed)
    exec(compile(programs()[0], "README.md", "exec"), space := {})
    told = capsys.readouterr().out.splitlines()
    assert [line.split(":")[0] for line in told] == ["time 0.5", "time 1", "time 1.5", "time 2"]
    assert " 0 gap " in told[-1] and " 0 stick " in told[-1]  # drawn, all slip
    u = space["step"].x[: space["contact"].n_host]
    shear, pressure = (space["K"] @ u)[space["top"]].sum(axis=0)[[0, 2]]
    assert SLIPPING < shear / (-0.3 * pressure) < 1


def test_the_solver_of_the_readme_solves():
    if importlib.util.find_spec("petsc4py") is None:
        pytest.skip("the solver of the README needs petsc4py, which is not installed (Debian: python3-petsc4py)")
    exec(compile(programs()[1], "README.md", "exec"), space := {})
    made = Blocks()
    (x, iterations), (y, others) = (made.solve(made.contact(), (2e-3, 8e-4, -5e-3), solve=solve) for solve in (None, space["mumps"]))
    assert iterations == others
    np.testing.assert_allclose(x, y, atol=SOLVERS * np.abs(x).max())


def test_the_program_by_hand_of_the_readme_runs():
    exec(compile(programs()[2], "README.md", "exec"), space := {})
    np.testing.assert_allclose(-space["force1"].sum(axis=0), [0, 5 * 0.8], atol=1e-12)


# Of Lame's pressure, by cells of 0.15: 0.9965 to 0.9977 are found. An overlap of 0.003 makes 0.001 of it, the facets the rest.
LAME = 0.004


@pytest.mark.parametrize("name, package", [("scikit_fem_shaft.py", "skfem"), ("ngsolve_shaft.py", "ngsolve")])
def test_a_shaft_has_the_pressure_of_lames_formula(name, package, tmp_path):
    least, largest = map(float, run(name, tmp_path, package, before=("0.15",)).split()[-2:])
    assert 1 - LAME < least <= largest < 1


# Iterations, nodes that stick and nodes that slip in each step, of the driver on the same meshes. hosts/check.py asks the driver
# itself, and compares the displacements.
SMALL_STRAIN = [(5, 18, 7), (3, 18, 7), (3, 18, 7), (3, 18, 7)]
LARGE_STRAIN = [(8, 18, 7), (5, 18, 7), (4, 18, 7), (4, 18, 7)]
# Blocks of moduli 1000 and 2000, 0.8 high, 0.005 shorter together; at finite strain some thousandths more.
PRESSURE, LARGE_STRAIN_PRESSURE = 0.005 / (0.8 / 1000 + 0.8 / 2000), 4.173925662893


@pytest.mark.parametrize("name, package, steps, pressure", [
    ("numpy_blocks.py", "numpy", SMALL_STRAIN, PRESSURE),
    ("scikit_fem_blocks.py", "skfem", SMALL_STRAIN, PRESSURE),
    ("fenicsx_blocks.py", "dolfinx", SMALL_STRAIN, PRESSURE),
    ("sfepy_blocks.py", "sfepy", SMALL_STRAIN, PRESSURE),
    ("felupe_blocks.py", "felupe", LARGE_STRAIN, LARGE_STRAIN_PRESSURE),
])
def test_two_blocks_are_the_drivers(name, package, steps, pressure, tmp_path):
    printed = run(name, tmp_path, package)
    found = re.findall(r"(\d+) iterations, 0 gap (\d+) stick (\d+) slip", printed)
    assert [tuple(map(int, step)) for step in found] == steps
    patch = call(name, "patch", "1", str(tmp_path / "nodes"))
    np.testing.assert_allclose([float(word) for word in patch.split()[-2:]], -pressure, rtol=1e-11)


# Of beam theory's force where the crack grows. 0.0073 is found.
BEAM = 0.02
# Of the toughness: sums of what each node has lost, and rounding.
LOST = 1e-6
# Of the work of the ends, which trapezes over 60 steps measure. 0.0001 is found, and a third of it in four times as many steps.
BALANCE = 2e-4


def test_a_peeled_beam_has_the_force_of_beam_theory_and_loses_the_toughness(tmp_path):
    off, lost, work, stored, gone = (float(word) for word in re.findall(r"[\d.]+(?:e-?\d+)?(?=%|, stored|, lost|\n)", run("peeled_beam.py", tmp_path)))
    assert off / 100 <= BEAM
    assert lost <= LOST
    assert abs(work / (stored + gone) - 1) <= BALANCE


# Sums over a hundred steps of a dozen nodes.
WEAR_ROUNDING = 1e-12
# Of depth and volume, between jumps of 20 cycles and of 10. 0.003 and 0.004 are found.
JUMPS = 0.01


def test_a_fretting_pad_is_worn_by_the_work_of_its_friction_and_jumps_of_cycles_converge(tmp_path):
    printed = run("fretting.py", tmp_path)
    assert "monotone: True" in printed
    assert float(re.search(r"mu - 1: (\S+)", printed).group(1)) <= WEAR_ROUNDING
    depths, volumes = re.search(r"depth (\S+ \S+), volume (\S+ \S+)", printed).groups()
    for coarse, fine in (map(float, pair.split()) for pair in (depths, volumes)):
        assert abs(coarse / fine - 1) <= JUMPS
