"""The figures of `make study`: work-precision diagrams, shares against size, Newton's last iterations."""

import matplotlib

matplotlib.use("Agg")  # no display is needed

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import FormatStrFormatter, LogLocator, NullFormatter

from figures import BLUE, GREY, INK, RED, _save

MARKS = {
    "default": ("*", INK), "integration": ("o", BLUE), "tangent": ("v", RED), "tolerance": ("s", "#3a8f5c"),
    "weights": ("D", "#8a5fb0"), "form": ("P", "#b07a1f"), "mesh": ("^", "#d0862c"), "steps": ("<", "#2a9aa8"),
    "slip": ("X", "#a0407a"), "basis": ("h", "#5b3fd0"), "normals": ("p", "#c02f6d"), "paper": ("d", "#7d7d1c"),
}


def draw_precision(axis, problem, rows, front, small=False):
    rows = [r for r in rows if "error" in r]
    for knob, (mark, colour) in MARKS.items():
        some = [r for r in rows if r["knob"] == knob]
        if some:
            size = 120 if mark == "*" else 26
            axis.scatter([r["seconds"] for r in some], [r["error"] for r in some], size, marker=mark, color=colour,
                         label=knob, zorder=3, alpha=0.9, linewidths=0)
    best = front(rows)
    if best:
        axis.step([r["seconds"] for r in best], [r["error"] for r in best], where="post", color=GREY, zorder=1,
                  label="front")
    for row in rows:
        if row in best or row["knob"] == "default" or (not small and row["knob"] != "tolerance"):
            axis.annotate(row["label"], (row["seconds"], row["error"]), (4, 3), textcoords="offset points",
                          fontsize=6 if small else 7, color=INK if row in best else GREY)
    axis.set_xscale("log")
    axis.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axis.xaxis.set_major_formatter(FormatStrFormatter("%g"))
    axis.xaxis.set_minor_formatter(NullFormatter())
    axis.set_yscale("log")
    axis.set_xlabel("processor time [s]")
    axis.set_ylabel("error")
    axis.set_title(problem.title)
    axis.grid(True, which="major", color="#eeeeee", zorder=0)


def precision(problem, rows, front, folder):
    figure, axis = plt.subplots(figsize=(8.6, 5.2))
    draw_precision(axis, problem, rows, front)
    axis.set_ylabel(f"error: {problem.measure}")
    axis.legend(frameon=False, fontsize=7.5, loc="center left", bbox_to_anchor=(1.0, 0.5))
    return _save(figure, folder / f"study_{problem.name}.png")


def summary(problems, rows, front, path):
    """All diagrams in one picture, the fronts labelled."""
    columns = min(3, len(problems))
    lines = -(-len(problems) // columns)
    figure, axes = plt.subplots(lines, columns, figsize=(4.6 * columns, 3.7 * lines), squeeze=False)
    for axis, problem in zip(axes.flat, problems):
        draw_precision(axis, problem, [r for r in rows if r["problem"] == problem.name], front, small=True)
    for axis in axes.flat[len(problems):]:
        axis.axis("off")
    handles = {label: h for a in axes.flat for h, label in zip(*a.get_legend_handles_labels())}
    figure.tight_layout(rect=(0, 0.05, 1, 1))  # the legend below
    figure.legend(handles.values(), handles.keys(), frameon=False, loc="lower center", ncols=len(handles))
    return _save(figure, path)


def share(rows, folder):
    """Contact's part of a Newton iteration and of the bulk's assembly."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.6, 3.8))
    n = [r["unknowns"] for r in rows]
    parts = [("linear solve", "solve", GREY), ("bulk assembly", "bulk", BLUE),
             ("contact, with insertion", "whole", RED), ("contact, the library", "library", INK)]
    for label, key, colour in parts:
        left.loglog(n, [r[key] for r in rows], "o-", color=colour, label=label)
    left.set_xlabel("unknowns")
    left.set_ylabel("seconds an iteration")
    left.set_title("A Newton iteration")
    left.legend(frameon=False, fontsize=8)
    ratios = [("library / iteration", "library_share", INK), ("all of contact / iteration", "whole_share", RED),
              ("library / bulk assembly", "library_over_bulk", BLUE)]
    for label, key, colour in ratios:
        right.loglog(n, [100 * r[key] for r in rows], "o-", color=colour, label=label)
    right.axhline(1, color=INK, linewidth=0.7, linestyle=":")
    right.axhline(15, color=BLUE, linewidth=0.7, linestyle=":")
    right.set_xlabel("unknowns")
    right.set_ylabel("per cent")
    right.set_title("Contact's share (dotted: what was aimed at)")
    right.legend(frameon=False, fontsize=8)
    figure.tight_layout()
    return _save(figure, folder / "study_share.png")


def tails(rows, folder):
    figure, axis = plt.subplots(figsize=(6.4, 3.8))
    for row, colour in zip(rows, plt.get_cmap("viridis")(np.linspace(0, 0.85, len(rows)))):
        axis.semilogy(range(len(row["norms"])), row["norms"], "o-", color=colour, markersize=4,
                      label=f"{row['label']}: {1e3 * (row['integration'] + row['tangent']):.0f} ms")
    axis.set_xlabel("iteration of the last step")
    axis.set_ylabel("norm of the residual")
    axis.set_title("Newton on warped facets, rule by rule")
    axis.legend(frameon=False, fontsize=8, title="contact's time in the run")
    return _save(figure, folder / "study_tails.png")
