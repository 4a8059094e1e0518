"""What calling from Python adds to a call: the time outside the C function over the time in it.

The C function is timed by the same interpreter with its arguments made beforehand, the package's method as a user calls
it. A new point each time, so that nothing is answered from the cache. Usage: overhead.py [FACETS_ALONG_A_SIDE]
"""

import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))
import scene
import stickslip
from stickslip._arrays import pointer
from stickslip._library import ffi, lib

REPEATS = 15
BOUND = 0.05


class Large(scene.Scene):
    def __init__(self, n):
        super().__init__(scene.grid(n, 0.01, 1.0, 0.0, False), scene.grid(n + 1, 0.0, 1.02, 0.0, True))


def median(function, points):
    times = []
    for point in points:
        start = time.perf_counter()
        function(*point)
        times.append(time.perf_counter() - start)
    return float(np.median(times))


def main():
    n = int(sys.argv[1]) if len(sys.argv) > 1 else 100
    made = Large(n)
    face = made.interface
    x1, x2, lam = made.x1 - 1e-5 * made.nu, made.x2, np.tile(-5.0 * made.nu, (len(made.x1), 1))
    plan = stickslip.Plan(face, x1, x2, made.size)
    out = tuple(np.empty(shape) for shape in (x1.shape, x2.shape, lam.shape))
    results = tuple(map(pointer, out))
    data = plan.matrix.data

    def c_residual(*point):
        assert lib.stickslip_interface_residual(face._handle, *point, ffi.NULL, *results) == 0

    def c_values(*point):
        assert lib.stickslip_interface_plan_values(face._handle, *point, ffi.NULL, len(data), pointer(data)) == 0

    # Points of both ways take turns in the same order, so that the machine's mood is shared.
    for name, c_way, python_way in (
        ("residual", c_residual, lambda *p: face.residual(*p, out=out)),
        ("plan values", c_values, plan.values),
    ):
        in_c, in_python = [], []
        for k in range(1, REPEATS + 1):  # 0 is the point of the plan, which the handle knows
            moved = [(x1 - 1e-9 * (2 * k + j) * made.nu, x2, lam) for j in range(2)]
            in_c.append(median(c_way, [tuple(map(pointer, moved[0]))]))
            in_python.append(median(python_way, [moved[1]]))
        c, python = np.median(in_c), np.median(in_python)
        # The least of many is the time without what else the machine does.
        least = min(in_python) / min(in_c) - 1
        print(f"{name:12} {n * n} facets  C {1e3 * c:8.2f} ms  Python {1e3 * python:8.2f} ms  "
              f"overhead {100 * (python / c - 1):+.2f} % of the medians, {100 * least:+.2f} % of the least"
              f"  {'within' if least < BOUND else 'ABOVE'} {100 * BOUND:g} %")


if __name__ == "__main__":
    main()
