"""Options by their names in the header, choices as words of its constants."""

import operator

from ._library import call, constants, ffi, value_of, words

# A member's name is the constants' prefix, but for these.
_PREFIX = {"multiplier_basis": "BASIS", "mortar_side": "MORTAR", "no_shortcuts": "SHORTCUT", "multiplier_space": "SPACE"}
# Short names of the interface's arguments.
_SHORT = {"basis": "multiplier_basis"}
_INTEGERS = ("index_base", "threads", "element_points")


def members() -> list[str]:
    """Every option of the header."""
    return [name for name, _ in ffi.typeof("struct stickslip_options").fields if name not in ("struct_size", "reserved")]


def make(given: dict):
    """The C struct: the library's defaults, then what was given."""
    out = ffi.new("struct stickslip_options *")
    call("options_init", out, ffi.sizeof("struct stickslip_options"))
    known = members()
    for name, value in given.items():
        name = _SHORT.get(name, name)
        if name not in known:
            raise TypeError(f"{name}: no option; there are {', '.join(known)}")
        setattr(out, name, _number(name, value))
    if out.index_base != 0:
        raise ValueError("index_base: 0 is needed, as arrays of Python count from 0")
    return out


def _number(name: str, value):
    kind = dict(ffi.typeof("struct stickslip_options").fields)[name].type.cname
    if kind == "double":
        if name == "weak_coverage" and value == "none":
            return constants["WEAK_COVERAGE_NONE"]
        return _taken(name, value, float, "a number")
    if name in _INTEGERS:
        return _taken(name, value, operator.index, "an integer")
    prefix = _PREFIX.get(name, name.upper())
    if name == "no_shortcuts":
        return _sum(value, prefix)
    return value_of(name, prefix, value)


def _taken(name: str, value, take, what: str):
    try:
        if isinstance(value, str):
            raise TypeError
        return take(value)
    except (TypeError, ValueError):
        raise TypeError(f"{name}: {value!r}, {what} is needed") from None


def _sum(value, prefix: str) -> int:
    """Shortcuts add up: a number, or words in a list."""
    if isinstance(value, int):
        return value
    listed = [value] if isinstance(value, str) else value
    return sum(value_of("no_shortcuts", prefix, word) for word in set(listed))


def word(prefix: str, number: int) -> str:
    """The word of a number, as in ``word("STATE", 1) == "stick"``."""
    return next(name for name, value in words(prefix).items() if value == number)
