"""What the library has made and takes back."""

from __future__ import annotations

from types import TracebackType
from typing import TYPE_CHECKING, Any

from ._library import call, ffi, lib
from .errors import InvalidValue

if TYPE_CHECKING:
    from typing_extensions import Self


class Handle:
    """A handle of the library, given back by :meth:`close`, at the end of ``with``, or when nobody has it any more."""

    _handle: Any = ffi.NULL
    #: What it is, in what is refused.
    _kind = "handle"

    def _destroy(self, slot: Any) -> None:
        raise NotImplementedError

    def close(self) -> None:
        """Gives the handle back. A second time does nothing."""
        if self._handle != ffi.NULL:
            slot = ffi.new(f"struct stickslip_{self._kind} **", self._handle)
            self._handle = ffi.NULL
            self._destroy(slot)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    def __del__(self) -> None:
        if self._handle and lib is not None:
            self.close()

    def _open(self) -> Any:
        """The handle, if it is not closed."""
        if self._handle == ffi.NULL:
            raise InvalidValue(f"the {self._kind} is closed")
        return self._handle

    def _call(self, name: str, *arguments: Any) -> None:
        """Calls ``stickslip_<name>`` of the handle."""
        call(name, self._open(), *arguments)
