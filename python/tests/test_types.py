"""Types: the package by mypy's strict rules, and what they tell a user."""

import importlib.util
import os
import subprocess
import sys
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[1]
USER = """import numpy as np
import stickslip

X = np.zeros((3, 3))
contact = stickslip.Contact(X).add(stickslip.skin(np.array([[0, 1, 2, 3]]), X), stickslip.Surface(X, [[0, 1, 2]]), modulus=1.0{option})
reveal_type(contact.states(contact.start())[0].pressure)
"""


def mypy(*arguments):
    if importlib.util.find_spec("mypy") is None:
        pytest.skip("the types are checked by mypy, which is not installed")
    done = subprocess.run([sys.executable, "-m", "mypy", "--cache-dir", os.devnull, *map(str, arguments)], cwd=PACKAGE,
                          capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


def test_the_package_is_clean():
    code, told = mypy()
    assert code == 0, told


@pytest.mark.parametrize("option, words", [("", "ndarray"), (", frictoin=0.3", 'Unexpected keyword argument "frictoin"'),
                                           (', basis="daul"', "Literal['auto', 'standard', 'dual']")])
def test_a_wrong_option_is_seen_before_the_program_runs(option, words, tmp_path):
    file = tmp_path / "user.py"
    file.write_text(USER.format(option=option))
    code, told = mypy("--follow-imports", "silent", file)
    assert words in told and code == bool(option), told
