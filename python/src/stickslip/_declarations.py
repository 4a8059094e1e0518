"""The header as cffi reads it: the only description of the ABI is ``include/stickslip.h``.

The wheel's build writes ``_abi.py`` by it. In the source tree ``_library.py`` makes the same at import.
"""

import contextlib
import io
import re
from pathlib import Path
from typing import Any

_INTEGER = re.compile(r"^#define (STICKSLIP_\w+) (-?\d+)$", re.MULTILINE)
_REAL = re.compile(r"^#define (STICKSLIP_\w+) (-?\d+\.\d+)$", re.MULTILINE)
_GUARD = re.compile(r"^#ifdef __cplusplus\n.*?^#endif.*?$", re.MULTILINE | re.DOTALL)
_COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.DOTALL)


def declarations(header: str) -> str:
    """The header's types, functions and integer constants, without comments and preprocessor lines."""
    text = _COMMENT.sub("", _GUARD.sub("", header))
    constants = "\n".join(f"#define {name} {value}" for name, value in _INTEGER.findall(text))
    # cffi takes no real constant in cdef; a declared one would need a compiler.
    body = "\n".join(line for line in text.splitlines() if line.strip() and not line.startswith("#"))
    return constants + "\n" + body + "\n"


def real_constants(header: str) -> dict[str, float]:
    """The header's constants that are no integers, by name."""
    return {name: float(value) for name, value in _REAL.findall(header)}


def builder(header: str) -> Any:
    """A cffi builder that knows the header."""
    from cffi import FFI

    ffi = FFI()
    ffi.set_source("stickslip._abi", None)
    ffi.cdef(declarations(header))
    return ffi


def write(header: Path, target: Path) -> None:
    """Writes ``_abi.py`` by cffi, with what cffi has no place for at its end."""
    text = Path(header).read_text(encoding="utf-8")
    ffi = builder(text)
    with contextlib.redirect_stdout(io.StringIO()):  # it says that it writes
        ffi.emit_python_code(str(target))
    with open(target, "a", encoding="utf-8") as out:
        out.write(f"\nINTEGERS = {dict((n, int(v)) for n, v in _INTEGER.findall(_COMMENT.sub('', text)))!r}\n")
        out.write(f"REALS = {real_constants(text)!r}\n")
