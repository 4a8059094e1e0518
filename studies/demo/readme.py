"""The README's picture: errors of several programs on equal meshes (the table of docs/other_programs.md), a block that is pulled until it slides,
and Newton's residuals on the way (python/examples/press_and_pull.py).

Usage: readme.py [--to PICTURE]; by default docs/figures/readme.png. Needs scikit-fem.
"""

import argparse
import re
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "python/src"), str(ROOT / "python/examples")]
# Rows of the table, the label of each, and how it is drawn.
PROGRAMS = {
    "stickslip, points": ("stickslip, points", "o-", "C3"),
    "stickslip, defaults": ("stickslip", "o-", "C0"),
    "CalculiX, surface to surface (penalty), 2.20": ("CalculiX, penalty", "s--", "C1"),
    "CalculiX, mortar, 2.20": ("CalculiX, mortar", "s--", "C4"),
    "GetFEM, nodes against faces, augmented Lagrangian, 5.4": ("GetFEM", "^--", "C2"),
    "Kratos, mortar, augmented Lagrangian, 10.4.4": ("Kratos", "v--", "C5"),
}
# What is drawn of displacements.
MAGNIFIED = 4.0


def errors():
    """By program: facets over the half-width, and the mean error in per cent against contact of the deformed bodies."""
    found = {name: [] for name in PROGRAMS}
    for line in (ROOT / "docs/other_programs.md").read_text().splitlines():
        words = [word.strip() for word in line.strip("| ").split(" | ")]
        if len(words) >= 6 and words[0].isdigit():
            name, error = re.sub(r", \d+ loads$", "", words[1]), re.match(r"[\d.]+", words[5])
            if name in found and error:
                found[name].append((int(words[0]), float(error.group())))
    return found


def draw_errors(axes):
    for name, rows in errors().items():
        label, style, colour = PROGRAMS[name]
        axes.loglog(*zip(*rows), style, color=colour, label=label)
    axes.set(xlabel="facets over the half-width", ylabel="error of the pressure, %", title="Hertz' line on equal meshes")
    axes.set_xticks([5, 10, 20], ["5", "10", "20"])
    axes.set_xticks([], minor=True)
    axes.set_yticks([0.5, 1, 2, 4], ["0.5", "1", "2", "4"])
    axes.set_yticks([], minor=True)
    axes.legend(fontsize=7)


def draw_run(bodies, newton):
    """The block while it slides, and the residuals of all steps."""
    import press_and_pull as example
    import scipy.sparse.linalg

    residuals = []

    def solve(matrix, right):
        residuals.append(np.linalg.norm(right))
        return scipy.sparse.linalg.spsolve(matrix.tocsc(), right)

    for step, _, _ in example.run(solve):
        norms = np.array(residuals)
        newton.semilogy(np.arange(len(norms)), norms / norms[0], "o-", ms=3, lw=1, color=plt.cm.viridis(step.time), label=f"t = {step.time:.1f}")
        residuals.clear()
    u = step.x[: example.X.size].reshape(-1, 2)
    at = example.X + MAGNIFIED * u
    drawn = PolyCollection(at[example.cells], array=np.linalg.norm(u, axis=1)[example.cells].mean(axis=1), edgecolor="0.3", lw=0.3)
    bodies.add_collection(drawn)
    bodies.autoscale()
    bodies.set(aspect="equal", title=f"pressed, then pulled: it slides (motion x {MAGNIFIED:g})")
    bodies.axis("off")
    newton.set_xticks(range(5))
    newton.set(xlabel="Newton iteration", ylabel="residual over the first", title="exact tangents, with friction")
    newton.legend(fontsize=6, ncol=2)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--to", default=str(ROOT / "docs/figures/readme.png"))
    to = parser.parse_args().to
    figure, axes = plt.subplots(1, 3, figsize=(13, 3.6), layout="constrained")
    draw_errors(axes[0])
    draw_run(axes[1], axes[2])
    figure.savefig(to, dpi=90)
    print(f"written  {to}")


if __name__ == "__main__":
    main()
