"""The figure of docs/exact.md: the wave's errors against facets, the stick radius against steps, the torques against the angle."""

import matplotlib

matplotlib.use("Agg")  # no display is needed

import matplotlib.pyplot as plt  # noqa: E402

import gears  # noqa: E402
import waves  # noqa: E402
from figures import BLUE, GREY, INK, RED, _save  # noqa: E402

GREEN, ORANGE, VIOLET, BROWN = "#3a8f5c", "#d0862c", "#7d5aa6", "#8a6d4b"
COLOURS = dict(zip((element.name for element in waves.ELEMENTS), (GREY, INK, RED, ORANGE, BLUE, BROWN, GREEN, VIOLET)))
TICKS = (*waves.FACETS, 40, 80)
SHOWN = {("quad", 12, "dual"), ("quad", 48, "dual"), ("quad", 24, "points")}


def draw(drawn, path):
    figure, axes = plt.subplots(1, 4, figsize=(17, 4.2))
    for axis, load in zip(axes, waves.LOADS):
        for element in waves.ELEMENTS:
            of = sorted((n, f) for (l, name, n), f in drawn["wave"].items() if (l, name) == (load, element.name))
            x, mean = [n for n, _ in of], [100 * f.errors.mean() for _, f in of]
            axis.loglog(x, mean, "o-", color=COLOURS[element.name], markersize=4, linewidth=1, label=element.name)
            axis.fill_between(x, [100 * f.errors.min() for _, f in of], [100 * f.errors.max() for _, f in of], color=COLOURS[element.name], alpha=0.08)
        axis.set(title=f"Wave, {load} load", xlabel="facets over the half-width", ylabel="error of the pressure [%]")
        axis.set_xticks(TICKS, [str(n) for n in TICKS])
        axis.set_xticks([], minor=True)
        axis.grid(True, which="major", color="#eeeeee", zorder=0)
    axes[0].legend(frameon=False, fontsize=7)
    for (mu, steps), (radii, _) in drawn["spence"].items():
        if mu == 0.2:
            axes[2].plot(radii[:, 0], radii[:, 1] / radii[:, 0], "o-", markersize=4, linewidth=1, label=f"{steps} steps")
    axes[2].set(title="Ball with friction 0.2", xlabel="contact radius a", ylabel="stick radius c / a", ylim=(0, 1))
    axes[2].legend(frameon=False, fontsize=7)
    for cell, flank, name, torques, _ in drawn["gears"]:
        if (cell, flank, name) in SHOWN:
            axes[3].plot(torques[:, 0], torques[:, 1], "o-", markersize=3, linewidth=1, label=f"{cell}, {flank} facets a flank, {name}")
    axes[3].axhline(gears.RATIO, color=INK, linewidth=0.8)
    axes[3].set(title="Gears", xlabel="turned by, pitches", ylabel="T_A / T_B", ylim=(0.65, 0.685))
    axes[3].legend(frameon=False, fontsize=7)
    figure.tight_layout()
    return _save(figure, path)

