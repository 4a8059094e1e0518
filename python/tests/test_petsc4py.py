"""The example of petsc4py gives what c_examples/petsc_block.c gives, on one process and on two."""

import importlib.util
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import stickslip

EXAMPLE = Path(__file__).resolve().parent.parent / "examples" / "petsc4py_block.py"
# So wide that on two processes neither part has the whole surface: each has its half and three rings of facets.
ARGUMENTS = ["-n", "10", "-steps", "4"]
# What petsc_block prints with these arguments: iterations, nodes in gap, stick and slip, shear forces of contact.
ITERATIONS = [6, 2, 6, 5]
STATES = [[0, 53, 68], [0, 53, 68], [11, 0, 110], [11, 0, 110]]
SHEAR = [0.0, 0.0, -11.9804585352, -11.9989923105]
# Newton's tolerance is 1e-11 of the forces, and the shear is printed with 12 digits.
FORCE = 1e-9 * 40
# Where root runs the tests, as in containers, Open MPI asks for the first two; with a single core for the third.
ENVIRONMENT = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
               "OMPI_MCA_rmaps_base_oversubscribe": "1"}




def run(ranks, *arguments):
    """What the example prints, a list of words a line."""
    if importlib.util.find_spec("petsc4py") is None:
        pytest.skip("petsc4py_block.py needs petsc4py, which is not installed (Debian: python3-petsc4py)")
    command = [sys.executable, str(EXAMPLE), *arguments]
    if ranks > 1:
        if shutil.which("mpiexec") is None:
            pytest.skip("two processes need mpiexec, which is not installed")
        command = ["mpiexec", "-n", str(ranks), *command]
    path = os.pathsep.join([str(Path(stickslip.__file__).parents[1]), os.environ.get("PYTHONPATH", "")])
    done = subprocess.run(command, capture_output=True, text=True, timeout=200,
                          env={**os.environ, **ENVIRONMENT, "PYTHONPATH": path})
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


def numbers(lines):
    """Of each step: step, iterations, gap, stick, slip, load, contact along z and x, reaction."""
    return np.array([[float(word) for word in re.findall(r"[-\d.][-+\d.e]*", line)] for line in lines if line.startswith("step")])


@pytest.mark.parametrize("ranks", [1, 2])
def test_block_is_the_c_programs(ranks):
    found = numbers(run(ranks, *ARGUMENTS))
    assert found[:, 1].tolist() == ITERATIONS
    assert found[:, 2:5].tolist() == STATES
    np.testing.assert_allclose(found[:, 6], found[:, 5], rtol=0, atol=FORCE)
    np.testing.assert_allclose(found[:, 7], SHEAR, rtol=0, atol=FORCE)
    np.testing.assert_allclose(found[:, 8], -found[:, 7], rtol=0, atol=FORCE)


@pytest.mark.parametrize("ranks", [1, 2])
@pytest.mark.parametrize("arguments", [("-n", "4", "-steps", "2", "-push", "3"), ("-n", "6", "-steps", "2", "-push", "3"),
                                       ("-n", "6", "-steps", "2", "-push", "1", "-friction", "5")])
def test_steps_that_are_too_long_are_cut_back(ranks, arguments):
    lines = run(ranks, *arguments)
    assert any(line.startswith("cut back") for line in lines)
    found = numbers(lines)
    assert len(found) == int(arguments[arguments.index("-steps") + 1])
    np.testing.assert_allclose(found[:, 6], found[:, 5], rtol=0, atol=FORCE)
    np.testing.assert_allclose(found[:, 8], -found[:, 7], rtol=0, atol=FORCE)
