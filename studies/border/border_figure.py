"""The figure of the study: pressures beside the border, error against facets, error against r."""

import matplotlib

matplotlib.use("Agg")  # no display is needed

import matplotlib.pyplot as plt
import numpy as np

import formulas
from compared import frozen_laws
from figures import BLUE, GREY, INK, RED, _save
from frozen import FrozenPoints
from scenes import Hertz

SIZES = (5, 10, 20, 40)
FACTORS = np.logspace(-2, 2, 9)


STYLES = {
    "nodes, standard": {"marker": "o", "color": RED, "mfc": "none"},
    "nodes, dual": {"marker": "o", "color": BLUE},
    "penalty, fixed": {"marker": "x", "color": GREY},
    "points": {"marker": "s", "color": INK},
}


def errors(scene, law):
    return [100 * scene.error(scene.scene.solve(law, scene.prescribed(a))) for a in scene.loads()]


def draw_profile(axis, library):
    """Five facets, a border in the middle of one."""
    scene = Hertz(5)
    a = scene.loads()[0]
    laws = frozen_laws(library, scene.scene.pair, 5)
    for name in ("nodes, standard", "nodes, dual", "points"):
        line = scene.scene.line(scene.scene.solve(laws[name], scene.prescribed(a)))
        hertz = formulas.LineContact(line.force[:, 1].sum(), scene.modulus, scene.radius)
        exact = formulas.nodal_mean(hertz.pressure, line.x)
        shown = np.abs(line.x) < 1.2
        error = 100 * (line.traction[:, 1] - exact) / hertz.peak
        axis.plot(line.x[shown], error[shown], **STYLES[name], markersize=4.5, linewidth=1, label=name)
    for side in (-a, a):
        axis.axvline(side, color=GREY, linewidth=0.8, zorder=0)
    axis.axhline(0, color=INK, linewidth=0.6, zorder=0)
    axis.set(title="Error at the nodes, 5 facets", xlabel="x over the half-width; grey: the border",
             ylabel="per cent of the largest pressure")
    axis.legend(frameon=False, fontsize=8)


def draw_sizes(axis, library):
    found = {}
    for n in SIZES:
        scene = Hertz(n)
        laws = frozen_laws(library, scene.scene.pair, n)
        for name in STYLES:
            found.setdefault(name, []).append(errors(scene, laws[name]))
    for k, (name, values) in enumerate(found.items()):
        mean, low, high = (f(np.array(values), axis=1) for f in (np.mean, np.min, np.max))
        beside = np.array(SIZES) * (1 + 0.04 * (k - 1.5))
        axis.errorbar(beside, mean, [mean - low, high - mean], **STYLES[name], markersize=5, elinewidth=0.8, label=name)
    axis.set(xscale="log", yscale="log", title="Hertz' line: mean and range of ten loads", xlabel="facets over the half-width",
             ylabel="error of the pressure, per cent")
    axis.set_xticks(SIZES, map(str, SIZES))
    axis.set_xticks([], minor=True)
    axis.set_yticks((0.2, 0.5, 1, 2, 5), ("0.2", "0.5", "1", "2", "5"))
    axis.set_yticks([], minor=True)
    axis.legend(frameon=False, fontsize=8)


def draw_augmentation(axis, library):
    scene = Hertz(5)
    pair = scene.scene.pair
    lines = {"K over rhat": (INK, "-", {}), "K over r": (INK, "--", {"apart": False}),
             "without K": (GREY, "-", {"stabilised": False})}
    for name, (color, style, choice) in lines.items():
        mean = [np.mean(errors(scene, FrozenPoints(pair, factor=f, **choice))) for f in FACTORS]
        axis.plot(FACTORS, mean, style, marker=".", color=color, label=f"points, {name}")
    dual = np.mean(errors(scene, frozen_laws(library, pair, 5)["nodes, dual"]))
    axis.axhline(dual, color=BLUE, linewidth=1, label="nodes, dual")
    axis.set(xscale="log", ylim=(0, 6), title="Hertz' line, 5 facets: error over r", xlabel="r over 0.9 E* / h",
             ylabel="error of the pressure, per cent")
    axis.legend(frameon=False, fontsize=8)


def draw(library, path):
    figure, axes = plt.subplots(1, 3, figsize=(13.8, 4.2))
    for axis, fill in zip(axes, (draw_profile, draw_sizes, draw_augmentation)):
        fill(axis, library)
    figure.tight_layout()
    return _save(figure, path)
