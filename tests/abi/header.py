"""What the C header declares, read from the header itself: constants, structs, functions."""

import re
from dataclasses import dataclass
from pathlib import Path

HEADER = Path(__file__).resolve().parents[2] / "include" / "stickslip.h"


@dataclass
class Function:
    name: str
    result: str
    parameters: str

    def __str__(self):
        return f"{self.result} {self.name}({self.parameters})"


def text(path=HEADER):
    """The header without comments."""
    code = re.sub(r"/\*.*?\*/", "", path.read_text(), flags=re.S)
    return re.sub(r"\n\s*//[^\n]*", "", code)


def number(text):
    """A whole number, or a real one, which has a point."""
    return float(text) if "." in text else int(text)


def constants(path=HEADER):
    """Name -> value of every macro; each is a plain number."""
    macros = re.findall(r"^ *# *define +(STICKSLIP_\w+)(.*)$", text(path), flags=re.M)
    return {name: number(value) for name, value in macros if name != "STICKSLIP_H"}


def functions(path=HEADER):
    """Every function, in the header's order."""
    declaration = re.compile(r"^((?:const )?\w+ \*?)(stickslip_\w+)\(([^)]*)\);", flags=re.M)
    return [Function(name, result.strip(), " ".join(parameters.split()))
            for result, name, parameters in declaration.findall(text(path))]
