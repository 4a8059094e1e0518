"""The figures of the demonstration. Each function takes finished runs and the path of the PNG to write."""

import matplotlib

matplotlib.use("Agg")  # no display is needed

import matplotlib.pyplot as plt
import numpy as np

from reference import BLOCK, GAUSS_POINTS, Hertz, plane_strain, strain_matrix

INK, GREY, BLUE, RED, SAND = "#222222", "#8a8f98", "#1f5fa8", "#c8442b", "#f3ead8"

plt.rcParams.update(
    {
        "font.size": 9.5,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.edgecolor": INK,
        "axes.linewidth": 0.8,
        "axes.titlesize": 10,
        "axes.titleweight": "bold",
        "axes.titlelocation": "left",
        "lines.linewidth": 1.4,
        "savefig.dpi": 130,
        "savefig.bbox": "tight",
        "savefig.facecolor": "white",
    }
)


def _save(figure, path):
    figure.savefig(path)
    plt.close(figure)
    return path


def _shade_slip(axis, line):
    """A band over every slipping node, half an element to each side."""
    width = np.diff(line.x).min() / 2
    for x in line.x[line.state == "slip"]:
        axis.axvspan(max(x - width, line.x[0]), min(x + width, line.x[-1]), color=SAND, linewidth=0, zorder=0)


def traction(zone, bottom, path):
    """Normal and tangential traction along the contact: `zone` is the 3.6 zone with mu = 0.5, `bottom` the whole bottom
    with mu = 0.2 (Line each)."""
    figure, axes = plt.subplots(
        2, 2, figsize=(9.6, 6.0), sharex=True, sharey="row", gridspec_kw={"hspace": 0.12, "wspace": 0.08}
    )
    columns = (
        (zone, 0.5, "contact for 0.2 ≤ x ≤ 3.8", BLOCK["zone36_stick"], (("20x10", "s", GREY), ("160x80", "o", RED))),
        (bottom, 0.2, "contact on the whole bottom", BLOCK["bottom_slip"], (("320x160", "o", RED),)),
    )
    normal_limit = 330
    for column, (line, mu, title, table, meshes) in enumerate(columns):
        normal, tangential = line.traction[:, 2], -line.traction[:, 0]
        for axis, values, key in zip(axes[:, column], (normal, tangential), ("p_n", "p_t")):
            _shade_slip(axis, line)
            axis.axhline(0, color=INK, linewidth=0.6)
            axis.plot(line.x, values, ".-", color=BLUE, markersize=5, zorder=3, label="computed, 20x10")
            for mesh, marker, colour in meshes:
                style = {"mfc": "none", "mec": colour, "markersize": 7, "zorder": 4}
                axis.plot(table["x"], table[f"{key}_{mesh}"], marker, label=f"reference {mesh}", **style)
        axes[1, column].plot(line.x, mu * normal, "--", color=INK, linewidth=0.9, zorder=2)
        above = (1.0, mu * np.interp(1.0, line.x, normal))
        axes[1, column].annotate(r"$\mu\,p_n$", above, (0, 5), textcoords="offset points")
        for x, value, side in ((line.x[0], normal[0], 1), (line.x[-1], normal[-1], -1)):
            if value > normal_limit:
                text, align = f"{value:.0f} at the corner\n(singular)", "left" if side > 0 else "right"
                style = {"textcoords": "offset points", "color": GREY, "fontsize": 8.5, "ha": align, "va": "top"}
                axes[0, column].annotate(text, (x, normal_limit), (22 * side, -4), **style)
        axes[0, column].set_title(f"{title}, μ = {mu:g}")
        axes[0, column].legend(frameon=False, loc="upper center", bbox_to_anchor=(0.45, 0.84))
        axes[1, column].set_xlabel("x along the contact")
    # The cone binds the multiplier, which oscillates next to the singular end; the force drawn here lies within it.
    axes[1, 0].text(3.45, -9, "one multiplier on the cone", ha="right")
    axes[1, 1].text(3.1, 88, "slip", ha="center")
    axes[1, 1].text(1.1, 88, "stick", ha="center")
    axes[0, 0].set(xlim=(-0.1, 4.1), ylim=(150, normal_limit), ylabel="normal traction  $p_n$")
    axes[1, 0].set(ylim=(-15, 105), ylabel="tangential traction  $p_t$")
    return _save(figure, path)


_HEX_FACES = np.array([[0, 1, 2, 3], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]])


def front_quads(points, hexahedra):
    """Quadrilaterals of one body's hexahedra on its face y = min, counter-clockwise in (x, z)."""
    faces = hexahedra[:, _HEX_FACES].reshape(-1, 4)
    y = points[:, 1]
    front = y[hexahedra].min() + 1e-9 * np.ptp(y)
    faces = faces[np.all(y[faces] < front, axis=1)]
    corners = points[faces][:, :, [0, 2]]
    around = corners - corners.mean(axis=1, keepdims=True)
    order = np.argsort(np.arctan2(around[:, :, 1], around[:, :, 0]), axis=1)
    return np.take_along_axis(faces, order, axis=1)


def von_mises(points, displacement, quads, young, poisson):
    """Plane strain von Mises stress at the nodes: the Gauss values of the cells around, averaged."""
    elastic, total, count = plane_strain(young, poisson), np.zeros(len(points)), np.zeros(len(points))
    for quad in quads:
        corners, moved = points[quad][:, [0, 2]], displacement[quad][:, [0, 2]].ravel()
        for node, gauss in zip(quad, GAUSS_POINTS):
            xx, zz, xz = elastic @ strain_matrix(corners, gauss)[0] @ moved
            yy = poisson * (xx + zz)
            total[node] += np.sqrt(((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) / 2 + 3 * xz**2)
            count[node] += 1
    return total / np.maximum(count, 1)


def block(run, interface, path):
    """The deformed block on its foundation, true to scale, with stress and the contact traction as arrows."""
    points, cells, displacement = run.mesh()
    hexahedra = cells["hexahedron"]
    upper = points[hexahedra][:, :, 2].mean(axis=1) > 0
    quads, floor = front_quads(points, hexahedra[upper]), front_quads(points, hexahedra[~upper])
    deformed = (points + displacement)[:, [0, 2]]
    stress = von_mises(points, displacement, quads, 1000.0, 0.3)

    figure, axis = plt.subplots(figsize=(8.6, 4.6))
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    low, high = np.percentile(stress[quads], (2, 97))
    limits = {"vmin": 25 * np.floor(low / 25), "vmax": 25 * np.ceil(high / 25)}
    shade = axis.tripcolor(
        deformed[:, 0], deformed[:, 1], triangles, stress, shading="gouraud", cmap="viridis", **limits
    )
    for kind, colour, width in ((quads, "white", 0.35), (floor, GREY, 0.5)):
        axis.add_collection(
            matplotlib.collections.PolyCollection(
                deformed[kind], facecolors="none", edgecolors=colour, linewidths=width, alpha=0.8
            )
        )
    if len(floor):
        axis.add_collection(
            matplotlib.collections.PolyCollection(deformed[floor], facecolors=SAND, edgecolors="none", zorder=0)
        )
    outline = points[np.unique(quads)][:, [0, 2]]
    low, high = outline.min(axis=0), outline.max(axis=0)
    axis.add_patch(plt.Rectangle(low, *(high - low), fill=False, linestyle=":", linewidth=0.9, edgecolor=INK))

    line = run.line(interface)
    table = run.interface(interface)
    moved = [np.mean(table["ux"][np.isclose(table["X"], x)]) for x in line.x]
    pull = line.traction[:, [0, 2]] / 800.0  # 800 force per area: one unit of length
    inner = np.linalg.norm(pull, axis=1) < 0.45  # the singular corner would hide the rest
    start = np.stack([line.x + moved, np.zeros_like(line.x)], axis=1) - pull
    axis.quiver(
        *start[inner].T, *pull[inner].T, angles="xy", scale_units="xy", scale=1, width=0.0024, color=RED, zorder=5
    )
    label = "traction on the block, from the nodal forces of the interface"
    axis.text(2.0, -0.72, label, color=RED, ha="center", va="center", bbox={"facecolor": SAND, "edgecolor": "none"})
    for x in np.linspace(0.25, 3.75, 8):
        axis.annotate("", (x, 1.74), (x, 2.12), arrowprops={"arrowstyle": "-|>", "color": INK, "linewidth": 0.9})
    axis.text(2.0, 2.2, "200, first", ha="center")
    for z in np.linspace(0.25, 1.55, 4):
        axis.annotate("", (0.0, z), (-0.32, z), arrowprops={"arrowstyle": "-|>", "color": INK, "linewidth": 0.9})
    axis.text(-0.38, 0.9, "then 60", ha="right", va="center")
    figure.colorbar(shade, ax=axis, shrink=0.7, pad=0.02, extend="both", label="von Mises stress")
    axis.set(aspect="equal", xlim=(-1.05, 4.75), ylim=(-1.05, 2.45))
    axis.axis("off")
    return _save(figure, path)


def hertz(line, measured, path):
    """Pressure of the line contact against Hertz's ellipse; below, the difference."""
    pressure = line.traction[:, 2]
    figure, (top, bottom) = plt.subplots(
        2, 1, figsize=(7.2, 5.6), sharex=True, gridspec_kw={"height_ratios": [3.2, 1], "hspace": 0.1}
    )
    fine = np.linspace(-1, 1, 801) * Hertz.half_width
    top.plot(fine, Hertz.pressure(fine), color=INK, linewidth=1.0)
    top.plot(line.x, pressure, "o", color=BLUE, markersize=4.5)
    top.annotate(
        r"Hertz: $p_0\,\sqrt{1-x^2/a^2}$", (0.5, Hertz.pressure(0.5)), (10, 8), textcoords="offset points", color=INK
    )
    top.annotate(
        "computed",
        (-0.5, np.interp(-0.5, line.x, pressure)),
        (-14, 4),
        textcoords="offset points",
        color=BLUE,
        ha="right",
    )
    top.text(
        0,
        0.06,
        f"$p_0$ = {measured[0]:.3f} (Hertz {Hertz.peak:.3f})\n$a$ = {measured[1]:.4f} (Hertz {Hertz.half_width:.4f})",
        transform=top.get_xaxis_transform(),
        ha="center",
        va="bottom",
    )
    top.set_ylabel("contact pressure:\nnodal force / tributary length")
    top.set_ylim(0, None)
    # The 3 % bound is one on peak and half-width, not on single nodes: at the edge the profile has infinite slope.
    bottom.axhline(0, color=INK, linewidth=0.6)
    bottom.plot(
        line.x, 100 * (pressure - Hertz.pressure(line.x)) / Hertz.peak, "o-", color=BLUE, markersize=3, linewidth=0.8
    )
    bottom.set_ylabel("difference,\n% of $p_0$")
    bottom.set_xlabel("x across the contact")
    bottom.set_xlim(-1.75 * Hertz.half_width, 1.75 * Hertz.half_width)
    return _save(figure, path)


def patch(errors, bound, path):
    """Largest relative multiplier error of each patch scene; errors: {series: {label: error}}."""
    labels = list(dict.fromkeys(label for series in errors.values() for label in series))
    figure, axis = plt.subplots(figsize=(8.2, 3.8))
    for (name, series), marker, colour in zip(errors.items(), "osD^v", (BLUE, RED, INK, GREY, "#4c9a5b")):
        position = [labels.index(label) for label in series]
        axis.semilogy(
            position,
            np.maximum(list(series.values()), 1e-17),
            marker,
            color=colour,
            mfc="none",
            markersize=8,
            markeredgewidth=1.5,
            label=name,
        )
    axis.axhline(bound, color=INK, linestyle="--", linewidth=0.9)
    axis.text(len(labels) - 0.55, bound * 0.75, f"bound {bound:.0e}", ha="right", va="top")
    axis.axhspan(1e-17, 2.2e-16, color=SAND, zorder=0)
    axis.text(-0.4, 1.3e-17, "below double precision", color=GREY, va="bottom", fontsize=8.5)
    axis.set_xticks(range(len(labels)), labels)
    axis.set_xlim(-0.5, len(labels) - 0.5)
    axis.set_ylim(1e-17, bound * 10)
    axis.set_ylabel("largest relative error of the multiplier")
    axis.legend(frameon=False, ncol=len(errors), loc="upper left")
    return _save(figure, path)


def effects(rows, path):
    """What each effect costs relative to the leanest: one group of bars a quantity; `rows` as effects.py measures them."""
    quantities = [
        ("unknowns", "unknowns"),
        ("bytes", "memory of\nthe interface"),
        ("instructions", "instructions\nof residual\nand tangent"),
        ("integration", "time of search\nand integration"),
        ("tangent", "time of\nthe tangent"),
        ("newton_iterations", "Newton\niterations"),
    ]
    quantities = [(key, label) for key, label in quantities if all(row[key] for row in rows)]
    colours = plt.get_cmap("Blues")(np.linspace(0.3, 0.95, len(rows)))
    figure, axis = plt.subplots(figsize=(10.4, 4.4))
    width = 0.84 / len(rows)
    for k, (row, colour) in enumerate(zip(rows, colours)):
        ratio = [row[key] / rows[0][key] for key, _ in quantities]
        place = np.arange(len(quantities)) + (k - (len(rows) - 1) / 2) * width
        axis.bar(place, ratio, width * 0.94, color=colour, label=row["name"], zorder=2)
        for x, value in zip(place, ratio):
            text = f"{value:.3g}" if value < 100 else f"{value:.0f}"
            axis.annotate(text, (x, value), (0, 2), textcoords="offset points", ha="center", fontsize=7)
    axis.axhline(1, color=INK, linewidth=0.8, zorder=1)
    axis.set_yscale("log")
    axis.set_xticks(range(len(quantities)), [label for _, label in quantities])
    axis.tick_params(axis="x", length=0)
    axis.set_ylabel("relative to the leanest")
    axis.set_title("What each effect costs, added one by one")
    axis.legend(frameon=False, loc="upper left")
    return _save(figure, path)
