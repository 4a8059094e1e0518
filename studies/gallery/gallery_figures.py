"""Figures of any scene: history of reactions, contact forces on the deformed surface, strips of frames and animations.

A *section* is a scene of one layer of cells seen along y, a *plane* one a plane or axisymmetric model. A *map* is a contact
surface seen along its normal z.
"""

import io
from dataclasses import dataclass

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection
from PIL import Image

from figures import BLUE, GREY, INK, RED, SAND, front_quads

STATE_COLOURS = {"gap": GREY, "stick": BLUE, "slip": RED}
BODY_COLOURS = (SAND, "#dfe6ee", "#e5eddc")


AXES = {"section": [0, 2], "plane": [0, 1], "map": [0, 1]}
CORNERS = {"quad": 4, "quad8": 4, "quad9": 4, "triangle": 3, "triangle6": 3}


@dataclass
class View:
    """What of a run is drawn: the interface, the window, and how long an arrow of the largest traction is."""

    interface: str
    window: tuple  # left, right, bottom, top
    arrow: float
    size: tuple = (7.2, 4.0)
    kind: str = "section"
    magnify: float = 1.0  # of displacements
    normal_only: bool = False


def save(figure, path):
    figure.savefig(path)
    plt.close(figure)
    return path


def nodal_tractions(run, view, step):
    """(positions, tractions on the non-mortar side, states) of the nodes to draw; without area: no traction."""
    table = run.interface(view.interface, step)
    if view.kind == "section":
        table = table[table["Y"] < table["Y"].min() + 1e-9 * max(np.ptp(table["Y"]), 1e-30)]
    vectors = lambda *names: np.stack([table[name] for name in names], axis=1)
    area = np.where(table["area_covered"] > 0, table["area_covered"], table["area_full"])
    traction = vectors("fx", "fy", "fz") / np.where(area > 0, area, 1.0)[:, None]
    if view.normal_only:
        normal = vectors("nx", "ny", "nz")
        traction = normal * (traction * normal).sum(axis=1)[:, None]
    position = vectors("X", "Y", "Z") + view.magnify * vectors("ux", "uy", "uz")
    return position, traction, table["state"]


def body_polygons(run, view, step):
    """(number of the body, corners of its cells as they are seen), kind by kind."""
    points, cells, _ = run.mesh(step)
    for kind in ["hexahedron"] if view.kind == "section" else [kind for kind in cells if kind in CORNERS]:
        body = run.cell_bodies(step, kind)
        for number in np.unique(body):
            of_body = cells[kind][body == number]
            if view.kind == "plane" and len(of_body) == 1:  # the frame of an analytic body
                continue
            yield number, front_quads(points, of_body) if view.kind == "section" else of_body[:, : CORNERS[kind]]


def frame(axis, run, view, step, largest):
    """One picture of a step; `largest` traction has the view's arrow length."""
    left, right, bottom, top = view.window
    axes = AXES[view.kind]
    position, traction, state = nodal_tractions(run, view, step)
    touching = state != "gap"
    if view.kind != "map":
        points, _, displacement = run.mesh(step)
        deformed = (points + view.magnify * displacement)[:, axes]
        for number, polygons in body_polygons(run, view, step):
            colour = BODY_COLOURS[int(number) % len(BODY_COLOURS)]
            style = {"facecolors": colour, "edgecolors": GREY, "linewidths": 0.25}
            axis.add_collection(PolyCollection(deformed[polygons], **style))
    else:
        colours = [STATE_COLOURS.get(name, GREY) for name in state]
        axis.scatter(position[:, 0], position[:, 1], s=3, c=colours, linewidths=0)
    arrows = traction[:, axes] * view.arrow / largest
    tail = position[:, axes] - (arrows if view.kind != "map" else 0)  # pushing from outside; on a map from the node
    for name in ("stick", "slip"):
        chosen = touching & (state == name)
        if chosen.any():
            style = {"angles": "xy", "scale_units": "xy", "scale": 1, "width": 0.0028, "headwidth": 3.5}
            axis.quiver(*tail[chosen].T, *arrows[chosen].T, color=STATE_COLOURS[name], zorder=5, **style)
    axis.set(xlim=(left, right), ylim=(bottom, top), aspect="equal")
    axis.axis("off")


def largest_traction(run, view, steps):
    """Of the nodes that touch, in the plane that is seen; singular corners aside."""
    axes = AXES[view.kind]
    sizes = []
    for step in steps:
        _, traction, state = nodal_tractions(run, view, step)
        sizes.append(np.linalg.norm(traction[state != "gap"][:, axes], axis=1))
    sizes = np.concatenate(sizes)
    return np.percentile(sizes, 98) if len(sizes) and sizes.max() > 0 else 1.0


def legend(axis):
    marks = [plt.Line2D([], [], color=STATE_COLOURS[n], label=n, marker=">", linestyle="-") for n in ("stick", "slip")]
    axis.legend(handles=marks, loc="upper center", bbox_to_anchor=(0.5, 0.0), ncol=2, frameon=False)


def surface(run, view, path, step=None, title=""):
    """Contact tractions on the deformed surface after one step."""
    step = len(run.steps) if step is None else step
    figure, axis = plt.subplots(figsize=view.size)
    frame(axis, run, view, step, largest_traction(run, view, [step]))
    axis.set_title(title)
    legend(axis)
    return save(figure, path)


def strip(run, view, path, steps, caption):
    """Some steps under one another, or side by side if the window is higher than wide."""
    left, right, bottom, top = view.window
    wide = (right - left) > 1.5 * (top - bottom)
    rows, columns = (len(steps), 1) if wide else (1, len(steps))
    width = view.size[0] if wide else 2.6 * columns
    height = width * (top - bottom) / (right - left) / columns + 0.25
    figure, axes = plt.subplots(rows, columns, figsize=(width, height * rows + 0.3), squeeze=False)
    largest = largest_traction(run, view, steps)
    for axis, step in zip(axes.flat, steps):
        frame(axis, run, view, step, largest)
        axis.set_title(caption(run.steps[step - 1]["t"]), fontsize=8.5, fontweight="normal")
    legend(axes.flat[-1])
    return save(figure, path)


def animation(run, view, path, steps, caption, milliseconds=120):
    """An animated GIF of these steps."""
    largest, pictures = largest_traction(run, view, steps), []
    for step in steps:
        figure, axis = plt.subplots(figsize=view.size)
        frame(axis, run, view, step, largest)
        axis.set_title(caption(run.steps[step - 1]["t"]), fontsize=9, fontweight="normal")
        buffer = io.BytesIO()
        figure.savefig(buffer, format="png", dpi=80, bbox_inches=None)
        plt.close(figure)
        pictures.append(Image.open(buffer).convert("P", palette=Image.Palette.ADAPTIVE, colors=64))
    times = [milliseconds] * (len(pictures) - 1) + [1200]
    pictures[0].save(path, save_all=True, append_images=pictures[1:], duration=times, loop=0, optimize=True)
    return path


def history(curves, path, xlabel, ylabel, references=(), title=""):
    """Curves (label, x, y) over travel or time; references (label, x, y, style) besides: lines, or points."""
    figure, axis = plt.subplots(figsize=(6.6, 3.8))
    for (label, x, y), colour in zip(curves, (BLUE, RED, INK, GREY)):
        axis.plot(x, y, ".-" if len(x) < 80 else "-", color=colour, markersize=4, label=label, zorder=3)
    for label, x, y, style in references:
        axis.plot(x, y, style, color=INK, linewidth=0.9, markersize=5, mfc="none", label=label, zorder=2)
    axis.axhline(0, color=INK, linewidth=0.5)
    axis.set(xlabel=xlabel, ylabel=ylabel, title=title)
    axis.legend(frameon=False, fontsize=8.5)
    return save(figure, path)


def profile(series, path, xlabel, ylabel, title=""):
    """Nodal values against formulas: series of (label, x, nodal values, fine x, exact values)."""
    figure, axis = plt.subplots(figsize=(6.6, 3.8))
    colours = (BLUE, RED, "#4c9a5b", "#8a5fa8", INK)
    for (label, x, values, fine, exact), colour in zip(series, colours):
        axis.plot(fine, exact, color=colour, linewidth=0.9)
        axis.plot(x, values, "o", color=colour, markersize=3.2, mfc="none", label=label)
    axis.set(xlabel=xlabel, ylabel=ylabel, title=title)
    axis.legend(frameon=False, fontsize=8.5, title="points: computed; lines: formula", title_fontsize=8)
    return save(figure, path)


def convergence(sizes, errors, path, xlabel, ylabel, title=""):
    figure, axis = plt.subplots(figsize=(4.6, 3.6))
    for (label, values), marker, colour in zip(errors.items(), "os^D", (BLUE, RED, INK, GREY)):
        axis.loglog(sizes, values, marker + "-", color=colour, mfc="none", label=label)
    axis.set(xlabel=xlabel, ylabel=ylabel, title=title)
    axis.legend(frameon=False, fontsize=8.5)
    return save(figure, path)
