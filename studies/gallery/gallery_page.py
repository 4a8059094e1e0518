"""The gallery's page: one table of all comparisons, then each entry with its figures and the command of its run."""

import html
import math

STYLE = """
body { font: 15px/1.45 sans-serif; max-width: 62em; margin: 2em auto; padding: 0 1em; color: #222 }
table { border-collapse: collapse; font-size: 13px } td, th { padding: 2px 10px; border-bottom: 1px solid #ddd }
td.number, th.number { text-align: right; font-variant-numeric: tabular-nums }
.failed { color: #c8442b; font-weight: bold }
img { max-width: 100%; margin: 6px 0 } code { font-size: 12.5px; background: #f5f2ea; padding: 1px 4px }
"""


def number(value, form=".6g"):
    return "" if value is None or not math.isfinite(value) else format(value, form)


def rows(verdicts):
    for row in verdicts.rows:
        verdict = "ok" if row.passed else '<span class="failed">FAILED</span>'
        cells = (number(row.computed), number(row.reference), number(row.error, ".1e"), number(row.bound, ".2g"))
        numbers = "".join(f'<td class="number">{cell}</td>' for cell in cells)
        quantity, reason = html.escape(row.quantity), html.escape(row.reason)
        yield f"<tr><td>{quantity}</td>{numbers}<td>{verdict}</td><td>{reason}</td></tr>"


def table(verdicts):
    heads = "".join(f'<th class="number">{name}</th>' for name in ("computed", "reference", "error", "bound"))
    head = f"<tr><th>quantity</th>{heads}<th></th><th>source or reason</th></tr>"
    return f"<table>{head}{''.join(rows(verdicts))}</table>"


def write(path, pages):
    """The page of (entry, verdicts, figures) in this order, next to the figures; returns its path."""
    head = f"<!doctype html><meta charset='utf-8'><title>stickslip: gallery</title><style>{STYLE}</style>"
    parts = [head, "<h1>Gallery</h1>"]
    parts.append("<ul>")
    for entry, verdicts, _ in pages:
        state = "" if verdicts.passed else ' <span class="failed">FAILED</span>'
        parts.append(f'<li><a href="#{entry.name}">{html.escape(entry.title)}</a>{state}</li>')
    parts.append("</ul>")
    for entry, verdicts, figures in pages:
        parts.append(f'<h2 id="{entry.name}">{html.escape(entry.title)}</h2><p>{html.escape(entry.text)}</p>')
        parts.append(f"<p><code>make gallery ONLY={entry.name}</code></p>{table(verdicts)}")
        parts += [f'<p><img src="{path.name}" alt="{path.stem}"></p>' for path in figures]
    path.write_text("\n".join(parts) + "\n")
    return path
