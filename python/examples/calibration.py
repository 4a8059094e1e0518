"""Friction and stiffness from a measured curve of the pulling force: L-BFGS with exact gradients, and how far noise is to be trusted.

Usage: calibration.py [PICTURE]
"""

import sys

import numpy as np
from gradients import Run
from scipy.optimize import minimize

TRUTH, START = {"mu": 0.3, "modulus": 1.0}, (0.12, 0.6)
PRESS, NOISE = 0.03, 0.01


def fit(run, start=START):
    """mu and modulus whose curve is nearest to the target, and how many runs that took."""
    scale = np.mean(np.square(run.target))

    def misfit(logarithms):
        parameters = np.exp(logarithms)  # both are positive, and the first step is of their own size
        values = dict(zip(TRUTH, parameters), press=PRESS)
        ends = run.solve(**values)
        slopes = run.gradient(ends, **values)
        return run.functional(ends, values["modulus"]) / scale, parameters * [slopes[name] for name in TRUTH] / scale

    found = minimize(misfit, np.log(start), jac=True, method="L-BFGS-B", options={"ftol": 0, "gtol": 1e-13})
    return np.exp(found.x), found.nfev


run = Run()
measured = run.forces(run.solve(**TRUTH, press=PRESS)[1:], TRUTH["modulus"])
run.target = measured
exact, runs = fit(run)
noise = np.random.default_rng(1).standard_normal(run.steps) * NOISE * np.abs(measured).max()
run.target = measured + noise
noisy, _ = fit(run)

if __name__ == "__main__":
    print(f"from mu {START[0]}, modulus {START[1]}: mu {exact[0]:.9f}, modulus {exact[1]:.9f} in {runs} runs")
    print(f"with {NOISE:.0%} of noise: mu {noisy[0]:.4f}, modulus {noisy[1]:.4f}")
    if len(sys.argv) > 1:
        import matplotlib

        matplotlib.use("Agg")
        import matplotlib.pyplot as plt

        figure, axes = plt.subplots(figsize=(6, 4))
        way = 0.04 * np.sin(1.6 * np.pi * np.arange(1, run.steps + 1) / run.steps)
        for values, style, label in ((START, ":", "first guess"), (noisy, "-", "fitted")):
            axes.plot(way, run.forces(run.solve(*values, press=PRESS)[1:], values[1]), style, label=label)
        axes.plot(way, run.target, "o", label="measured, with noise")
        axes.set(xlabel="way of the top", ylabel="pulling force", title=f"mu {noisy[0]:.3f}, modulus {noisy[1]:.3f}")
        axes.legend()
        figure.savefig(sys.argv[1], dpi=120)
