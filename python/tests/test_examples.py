"""Each example runs, draws its picture and finds what it must."""

import importlib.util
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import stickslip

EXAMPLES = Path(__file__).resolve().parent.parent / "examples"
# The driver's probes of plane_block.yaml.
TOPLEFT = 0.0484872344169568, -0.290357708449536
TOPRIGHT = 0.262339235862936, -0.40603752035701
DRIVER = 1e-12
# The driver's Newton iterations with -steps_predictor false -snes_linesearch_type basic.
ITERATIONS = [7, 1, 1, 1, 1, 1, 1, 1, 1, 1, 2, 1, 2, 1, 2, 2, 2, 1, 2, 2]


def run(name, folder, *needed):
    for package in (*needed, "matplotlib"):
        if importlib.util.find_spec(package) is None:
            pytest.skip(f"{name} needs {package}, which is not installed")
    picture = folder / "picture.png"
    path = os.pathsep.join([str(Path(stickslip.__file__).parents[1]), os.environ.get("PYTHONPATH", "")])
    done = subprocess.run([sys.executable, str(EXAMPLES / name), str(picture)], capture_output=True, text=True,
                          env={**os.environ, "PYTHONPATH": path}, timeout=300)
    assert done.returncode == 0, done.stderr
    assert picture.stat().st_size > 10_000
    return done.stdout


def test_block_is_the_drivers(tmp_path):
    printed = run("block.py", tmp_path)
    assert f"iterations {ITERATIONS} " in printed
    words = printed.split()
    topleft, topright = words.index("topleft"), words.index("topright")
    found = [float(word) for word in (*words[topleft + 1 : topleft + 3], *words[topright + 1 : topright + 3])]
    np.testing.assert_allclose(found, [*TOPLEFT, *TOPRIGHT], rtol=0, atol=DRIVER)


def test_the_first_program_of_the_readme_runs(tmp_path):
    text = (EXAMPLES.parent / "README.md").read_text()
    program = text.split("```python\n")[1].split("```")[0]
    exec(compile(program, "README.md", "exec"), space := {})
    np.testing.assert_allclose(-space["force1"].sum(axis=0), [0, 5 * 0.8], atol=1e-12)


def forces(printed):
    """Forces on the top by step, as the examples of two blocks print them."""
    return np.array([[float(word) for word in line.split("[")[1].rstrip("]").split(",")]
                     for line in printed.splitlines()])


# Steps of the path; the least shear over the limit that the last one must reach: far from where it would be without friction.
@pytest.mark.parametrize("name, package, steps, least", [
    ("scikit_fem_blocks.py", "skfem", 9, 0.95),
    ("felupe_blocks.py", "felupe", 10, 0.80),
])
def test_two_blocks_slide_below_the_limit_of_friction(name, package, steps, least, tmp_path):
    found = forces(run(name, tmp_path, package))
    assert len(found) == steps
    assert (found[:, 2] < 0).all()
    limit = 0.3 * -found[:, 2]
    # Six digits are printed. The surfaces tilt by less than a hundredth.
    assert (found[:, 0] <= 1.01 * limit).all()
    assert found[-1, 0] > least * limit[-1]
