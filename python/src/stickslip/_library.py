"""The shared library: where it lies, its constants, and how a status becomes an exception."""

import importlib
import importlib.util
import os
import tempfile
from pathlib import Path
from typing import Any

_HERE = Path(__file__).resolve().parent
_CHECKOUT = _HERE.parents[2]


def _abi() -> Any:
    """The generated declarations: of the wheel, or, in the source tree, made now."""
    generated = _HERE / "_abi.py"
    if generated.exists():
        return importlib.import_module("stickslip._abi")
    from . import _declarations

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "_abi.py"
        _declarations.write(_CHECKOUT / "include" / "stickslip.h", path)
        specification = importlib.util.spec_from_file_location("stickslip._abi", path)
        assert specification is not None and specification.loader is not None
        module = importlib.util.module_from_spec(specification)
        specification.loader.exec_module(module)
    return module


def _path() -> str:
    """STICKSLIP_LIBRARY, the package's own library, or one built in the source tree."""
    given = os.environ.get("STICKSLIP_LIBRARY")
    if given:
        return given
    places = [
        _HERE / "libstickslip.so",
        _CHECKOUT / "target" / "release" / "libstickslip.so",
        _CHECKOUT / "build" / "lib" / "libstickslip.so",
    ]
    for place in places:
        if place.exists():
            return str(place)
    raise ImportError("no libstickslip.so: set STICKSLIP_LIBRARY, or run cargo build --release; looked at "
                      + ", ".join(map(str, places)))


#: The header, with what each function does: of the wheel, or the checkout's.
HEADER = next((path for path in (_HERE / "stickslip.h", _CHECKOUT / "include" / "stickslip.h") if path.exists()), None)

_module = _abi()
ffi = _module.ffi
lib = ffi.dlopen(_path())

#: Every constant of the header by its name without ``STICKSLIP_``.
constants: dict[str, Any] = {name.removeprefix("STICKSLIP_"): value
             for name, value in {**_module.INTEGERS, **_module.REALS}.items()}


def text(pointer: Any) -> str:
    """A string of the library."""
    return str(ffi.string(pointer).decode("utf-8", "replace"))


def call(name: str, *arguments: Any) -> None:
    """Calls ``stickslip_<name>`` and raises what its status means."""
    status = getattr(lib, "stickslip_" + name)(*arguments)
    if status != 0:
        from .errors import exception_of

        raise exception_of(status)(text(lib.stickslip_last_error_message()), status)


def words(prefix: str) -> dict[str, int]:
    """The words of a choice: ``words("BASIS")`` is ``{"standard": 0, "dual": 1}``."""
    start = prefix + "_"
    return {name.removeprefix(start).lower(): value for name, value in constants.items() if name.startswith(start)}


def value_of(argument: str, prefix: str, word: Any) -> int:
    """The number behind a word; a number of the header is taken as it is."""
    allowed = words(prefix)
    if isinstance(word, str) and word in allowed:
        return allowed[word]
    if isinstance(word, int) and not isinstance(word, bool) and word in allowed.values():
        return word
    raise ValueError(f"{argument}: {word!r} is none of {', '.join(map(repr, allowed))}")
