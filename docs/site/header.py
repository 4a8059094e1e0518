"""The directive `stickslip-header`: every constant, struct and function of the C header, in its order, with its comment.

Names are targets of the C domain, so that the site's search and index know them. What begins with "Errors:", "Cost:" or "Owner:"
becomes a paragraph with a bold first word.
"""

import re
from pathlib import Path

from docutils import nodes
from docutils.statemachine import StringList
from sphinx.util.docutils import SphinxDirective

HEADER = Path(__file__).resolve().parents[2] / "include" / "stickslip.h"
_FIRST_WORD = re.compile(r"^(Errors|Cost|Owner): ")


def declarations(header):
    """(kind, comment lines, code) of each constant, struct, type of a function, and function."""
    lines = iter(header[header.index("*/") + 2:].splitlines())
    comment = []
    for line in lines:
        if line.startswith("///"):
            comment.append(line[3:].strip())
        elif line.startswith("#define ") and comment:
            yield "macro", comment, line.split()[1:]
            comment = []
        elif line.startswith("typedef struct") and line.endswith("{"):
            body = []
            for inner in lines:
                if inner.startswith("}"):
                    break
                body.append(inner.strip())
            yield "struct", comment, [line.split()[2], body]
            comment = []
        elif line.startswith("typedef struct"):
            yield "struct", comment, [line.split()[2], []]
            comment = []
        elif "(" in line and comment:
            code = line.strip()
            while not code.endswith(";"):
                code += " " + next(lines).strip()
            is_type = code.startswith("typedef ")
            yield "type" if is_type else "function", comment, code.removeprefix("typedef ").rstrip(";")
            comment = []
        elif not line.strip():
            comment = []


def prose(comment):
    """The lines of a comment as reStructuredText."""
    out = []
    for line in comment:
        marked = _FIRST_WORD.match(line)
        if marked:
            out += ["", f"**{marked[1]}:** {escaped(line[marked.end():])}"]
        else:
            out.append(escaped(line))
    return out


def escaped(text):
    """Names in backquotes become code; what reStructuredText would read as markup is text."""
    parts = re.split(r"(`[^`]*`)", text)
    return "".join(f"`{part}`" if part.startswith("`") else re.sub(r"([\\*_])(?=\W|$)|\|", r"\\\g<0>", part) for part in parts)


def members(body):
    """(comment, declaration) of the members of a struct."""
    comment = []
    for line in body:
        if line.startswith("///"):
            comment.append(line[3:].strip())
        elif line:
            yield comment, line.rstrip(";")
            comment = []


def text(header):
    """The reference as reStructuredText."""
    out = []
    for kind, comment, code in declarations(header):
        indented = ["", *("   " + line for line in prose(comment)), ""]
        if kind == "macro":
            out += [f".. c:macro:: {code[0]}", "", f"   = {code[1]}", *indented]
        elif kind in ("function", "type"):
            out += [f".. c:{kind}:: {code}", *indented]
        else:
            name, body = code
            out += [f".. c:struct:: {name}", *indented]
            for about, declaration in members(body):
                out += [f"   .. c:member:: {declaration}", "", *("      " + line for line in prose(about)), ""]
    return out


class StickslipHeader(SphinxDirective):
    def run(self):
        self.env.note_dependency(str(HEADER))
        node = nodes.section()
        node.document = self.state.document
        lines = text(HEADER.read_text(encoding="utf-8"))
        self.state.nested_parse(StringList(lines, source=str(HEADER)), 0, node)
        return node.children


def setup(app):
    app.add_directive("stickslip-header", StickslipHeader)
    return {"parallel_read_safe": True}
