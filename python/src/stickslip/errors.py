"""An exception class for every status of the header, all below :class:`Error`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ._library import constants


class Error(Exception):
    """A refused call. ``status`` is the header's number; nothing was changed."""

    status: int = 0

    def __init__(self, message: str, status: int | None = None):
        super().__init__(message)
        if status is not None:
            self.status = status


class WrongType(Error, TypeError):
    """An argument of another type than the call needs, which the package finds before the library is asked."""


class StepRefused(Error):
    """A step that a host has solved and that must not count. Nothing was changed."""


class StepWarning(UserWarning):
    """A step that counts, and is off by more than a mesh shows."""


if TYPE_CHECKING:  # what is made from the header below, for editors and type checkers

    class NullPointer(Error): ...
    class StructSize(Error): ...
    class InvalidSize(Error, ValueError): ...
    class NotFinite(Error, ValueError): ...
    class IndexOutOfRange(Error, IndexError): ...
    class DuplicateNode(Error, ValueError): ...
    class DegenerateFacet(Error, ValueError): ...
    class InvalidValue(Error, ValueError): ...
    class MissingStiffness(Error, ValueError): ...
    class Unsupported(Error, NotImplementedError): ...
    class UndefinedNormal(Error): ...
    class ProjectionNotConvex(Error): ...
    class BufferTooSmall(Error): ...
    class MissingEntry(Error): ...
    class NothingToRollBack(Error): ...
    class HistoryMismatch(Error, ValueError): ...
    class TurnedTooFar(Error): ...
    class OutOfMemory(Error, MemoryError): ...
    class ContactLost(Error): ...
    class Panic(Error, SystemError): ...


# Where a class of Python says the same, the exception is one of it too.
_ALSO: dict[str, type[Exception]] = {
    "INVALID_SIZE": ValueError,
    "NOT_FINITE": ValueError,
    "INVALID_VALUE": ValueError,
    "DUPLICATE_NODE": ValueError,
    "DEGENERATE_FACET": ValueError,
    "MISSING_STIFFNESS": ValueError,
    "HISTORY_MISMATCH": ValueError,
    "INDEX_OUT_OF_RANGE": IndexError,
    "OUT_OF_MEMORY": MemoryError,
    "UNSUPPORTED": NotImplementedError,
    "PANIC": SystemError,
}


def _statuses() -> dict[str, int]:
    """The header's statuses: what it declares after OK, up to PANIC."""
    names = list(constants)
    return {name: constants[name] for name in names[names.index("OK") + 1 : names.index("PANIC") + 1]}


def _class(name: str, status: int) -> type[Error]:
    bases = (Error, _ALSO[name]) if name in _ALSO else (Error,)
    title = "".join(part.capitalize() for part in name.split("_"))
    return type(title, bases, {"status": status, "__module__": __name__, "__doc__": f"STICKSLIP_{name}."})


statuses = _statuses()
by_status: dict[int, type[Error]] = {status: _class(name, status) for name, status in statuses.items()}
globals().update({made.__name__: made for made in by_status.values()})
__all__ = ["Error", "StepRefused", "StepWarning", "WrongType", "by_status", "exception_of", "statuses",
           *(made.__name__ for made in by_status.values())]


def exception_of(status: int) -> type[Error]:
    """The exception class of a status; :class:`Error` where the header has no name for it."""
    return by_status.get(status, Error)
