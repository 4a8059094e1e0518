"""What calling from Python adds to a call: the time of a method outside the C function, over the time in it.

A stopwatch stands around the C function while the method runs. So both times are of the same call, and what else the machine
does weighs on both. Each call has a new point, so that nothing is answered from what the handle keeps.
Usage: overhead.py [FACETS_ALONG_A_SIDE]
"""

import sys
import time
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent / "tests"), str(HERE.parent / "src")]
import scene
import stickslip
from stickslip import _library

REPEATS = 15
BOUND = 0.05


class Watched:
    """The library, with a stopwatch around its functions."""

    def __init__(self, lib):
        self._lib, self.seconds = lib, 0.0

    def __getattr__(self, name):
        function = getattr(self._lib, name)

        def timed(*arguments):
            start = time.perf_counter()
            status = function(*arguments)
            self.seconds += time.perf_counter() - start
            return status

        return timed


def main():
    n = int(sys.argv[1]) if len(sys.argv) > 1 else 100
    made = scene.Scene(scene.grid(n, 0.01, 1.0, 0.0, False), scene.grid(n + 1, 0.0, 1.02, 0.0, True))
    x1, x2, lam = made.x1 - 1e-5 * made.nu, made.x2, np.tile(-5.0 * made.nu, (len(made.x1), 1))
    plan = stickslip.Plan(made.interface, x1, x2, made.size)
    _library.lib = watch = Watched(_library.lib)
    above = False
    for name, method in (("residual", made.interface.residual), ("plan values", plan.values)):
        inside, outside = [], []
        for k in range(1, REPEATS + 1):
            point = x1 - 1e-9 * k * made.nu, x2, lam
            watch.seconds, start = 0.0, time.perf_counter()
            method(*point)
            total = time.perf_counter() - start
            inside.append(watch.seconds)
            outside.append(total - watch.seconds)
        c, python = np.median(inside), np.median(outside)
        above |= python > BOUND * c
        print(f"{name:12} {n * n} facets: in C {1e3 * c:.2f} ms, outside {1e3 * python:.3f} ms, {100 * python / c:.2f} %")
    _library.lib = watch._lib
    return int(above)


if __name__ == "__main__":
    sys.exit(main())
