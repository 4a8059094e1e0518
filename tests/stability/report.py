"""The report on the matrix: heat maps, a table, one HTML page, and a summary in words."""

import html
import json
import math
import shutil

import host  # noqa: F401  (puts studies on the path)
from cell import CORRECT, ELEMENT, REFUSED, SCENE, VERDICTS, WARNING, WRONG
from folders import FIGURES
from gallery_page import STYLE

COMMITTED = {SCENE: FIGURES / "stability.png", ELEMENT: FIGURES / "stability_calls.png"}
MARKS = {CORRECT: "●", WARNING: "▲", REFUSED: "×", WRONG: "■"}
MEANINGS = {
    CORRECT: "correct: within its bound of an exact or refined answer",
    WARNING: "correct, and the run says that it was hard",
    REFUSED: "refused, with the cause",
    WRONG: "wrong",
}


def counts(results):
    return {verdict: sum(r["verdict"] == verdict for r in results) for verdict in VERDICTS}


def summary(results, lines):
    seconds = sum(r["seconds"] for r in results)
    parts = ", ".join(f"{n} {verdict}" for verdict, n in counts(results).items())
    held = [f"  {'holds' if line.holds else 'FAILS':<6} {line.text}: {line.figure}" for line in lines]
    return "\n".join([f"\n{len(results)} cells: {parts}; {seconds / 60:.1f} minutes of one core", *held])


def rows(results):
    """case -> its cells, mildest first; in the order of the results."""
    table = {}
    for result in results:
        table.setdefault(result["case"], []).append(result)
    return {case: sorted(cells, key=lambda r: r["level"]) for case, cells in table.items()}


def heat_map(table, path):
    """Case against severity; colour: Newton iterations, mark: verdict."""
    import figures  # matplotlib is slow to load

    plt = figures.plt
    n_columns = max(cell["level"] for cells in table.values() for cell in cells) + 1
    scale = plt.matplotlib.colors.LogNorm(1, 100)
    colours = plt.matplotlib.colormaps["YlGnBu"]
    figure, axis = plt.subplots(figsize=(0.82 * n_columns + 3.6, 0.36 * len(table) + 1.2))
    for y, cells in enumerate(table.values()):
        for cell in cells:
            n = cell["iterations"]
            colour = colours(scale(max(n, 1))) if n is not None else "#ecebe6"
            dark = n is not None and scale(max(n, 1)) > 0.55
            axis.add_patch(plt.Rectangle((cell["level"] - 0.48, y - 0.46), 0.96, 0.92, color=colour, linewidth=0))
            ink = figures.RED if cell["verdict"] == WRONG else "white" if dark else figures.INK
            size = 6.5 if len(cell["severity"]) < 9 else 5.2
            axis.text(cell["level"] - 0.38, y, MARKS[cell["verdict"]], ha="center", va="center", color=ink, fontsize=8)
            axis.text(cell["level"] + 0.1, y, cell["severity"], ha="center", va="center", color=ink, fontsize=size)
    axis.set(xlim=(-0.5, n_columns - 0.5), ylim=(len(table) - 0.5, -0.5), xticks=[], xlabel="severity →")
    axis.set_yticks(range(len(table)), list(table), fontsize=8)
    axis.tick_params(left=False)
    for side in ("left", "bottom"):
        axis.spines[side].set_visible(False)
    present = [v for v in VERDICTS if any(c["verdict"] == v for cells in table.values() for c in cells)]
    axis.set_title(
        "    ".join(f"{MARKS[v]} {MEANINGS[v].split(':')[0]}" for v in present), fontsize=8, fontweight="normal"
    )
    if any(cell["iterations"] is not None for cells in table.values() for cell in cells):
        bar = figure.colorbar(
            plt.matplotlib.cm.ScalarMappable(scale, colours), ax=axis, fraction=0.025, pad=0.01, aspect=12, shrink=0.7
        )
        bar.set_label("Newton iterations of the run", fontsize=7.5)
        bar.ax.tick_params(labelsize=7)
    return figures._save(figure, path)


def number(value, form):
    return "" if value is None or not math.isfinite(value) else format(value, form)


def worst_error(result):
    """The error nearest to its bound."""
    ratio = lambda e: (e["error"] or 0) / e["bound"] if e["bound"] else math.inf if e["error"] else 0
    return max(result["errors"], key=ratio, default=None)


def table_html(cells):
    heads = ("severity", "verdict", "Newton iterations", "kappa", "compared", "error", "bound", "what it says")
    yield "<table><tr>" + "".join(f"<th>{head}</th>" for head in heads) + "</tr>"
    for cell in cells:
        error = worst_error(cell) or {"quantity": "", "error": None, "bound": None}
        said = cell["why"] if cell["verdict"] != CORRECT else ""
        columns = (
            html.escape(cell["severity"]),
            f"{MARKS[cell['verdict']]} {cell['verdict']}",
            number(cell["iterations"], "d"),
            number(cell["kappa"], ".1e"),
            html.escape(error["quantity"]),
            number(error["error"], ".1e"),
            number(error["bound"], ".1e"),
            html.escape(said),
        )
        style = ' class="failed"' if cell["verdict"] == WRONG else ""
        yield f"<tr{style}>" + "".join(f"<td>{column}</td>" for column in columns) + "</tr>"
    yield "</table>"


def page(path, title, results, lines, drawn):
    parts = [f"<!doctype html><meta charset='utf-8'><title>stickslip: {title}</title><style>{STYLE}</style>"]
    parts.append(f"<h1>{title}</h1><pre>{html.escape(summary(results, []))}</pre><ul>")
    parts += [f"<li>{MARKS[v]} {html.escape(MEANINGS[v])}</li>" for v in VERDICTS]
    parts.append("</ul><h2>What must hold</h2><table>")
    for line in lines:
        holds = "holds" if line.holds else '<span class="failed">FAILS</span>'
        parts.append(f"<tr><td>{html.escape(line.text)}</td><td>{html.escape(line.figure)}</td><td>{holds}</td></tr>")
    parts.append("</table>")
    parts += [f'<p><img src="{picture.name}" alt="{picture.stem}"></p>' for picture in drawn]
    parts.append(
        "<p>kappa: condition number of the last Newton matrix, rows and columns scaled. Per cell the error nearest "
        "to its bound is shown; all of them are in cells/CELL.json.</p>"
    )
    for case, cells in rows(results).items():
        parts.append(f"<h2>{html.escape(case)}</h2>" + "".join(table_html(cells)))
    path.write_text("\n".join(parts) + "\n")
    return path


def markdown(results, lines):
    """Two tables for docs/stability.md: what must hold, and what aids are worth."""
    yield from ("| | measured |", "|---|---|")
    yield from (f"| {line.text} | {line.figure}{'' if line.holds else ' **FAILS**'} |" for line in lines)
    aids = {case: cells for case, cells in rows(results).items() if case.startswith("aids, ")}
    if aids:
        columns = [cell["severity"] for cell in next(iter(aids.values()))]
        yield from ("", "| | " + " | ".join(columns) + " |", "|---|" + "---:|" * len(columns))
    for case, cells in aids.items():
        texts = [cell["verdict"] if cell["iterations"] is None else str(cell["iterations"]) for cell in cells]
        yield f"| {case.removeprefix('aids, ')} | " + " | ".join(texts) + " |"


def write(folder, name, results, lines, renew):
    """NAME.html, NAME.json and, where matplotlib is there, the heat maps; the page's path."""
    drawn = []
    try:
        for kind in sorted({r["kind"] for r in results}):
            drawn.append(heat_map(rows([r for r in results if r["kind"] == kind]), folder / f"{name}_{kind}.png"))
            if renew:
                shutil.copy(drawn[-1], COMMITTED[kind])
    except ImportError:
        print("matplotlib is not there: no heat maps")
    table = {"cells": results, "lines": [vars(line) for line in lines], "counts": counts(results)}
    (folder / f"{name}.json").write_text(json.dumps(table, indent=1) + "\n")
    (folder / f"{name}.md").write_text("\n".join(markdown(results, lines)) + "\n")
    return page(folder / f"{name}.html", "Stability matrix", results, lines, drawn)
