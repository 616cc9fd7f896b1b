"""The arrays of a history file, mapped into memory."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from percute import _percute
from percute.errors import FileFormatError, MissingFileError, PercuteError, StorageError

MAPPED: dict[str, np.dtype[Any]] = {
    "displacement": np.dtype("<f8"),
    "reaction": np.dtype("<f8"),
    "touching": np.dtype("u1"),
    "checksums": np.dtype("<i8"),
}
AT_ONCE = 1 << 25
"""Bytes whose checksums are computed at once, between looks for Ctrl-C."""


class MappedArrays:
    """All arrays of a file that can be mapped, mapped at once, so that they belong to one run; none of a history in memory."""

    def __init__(self, data: _percute.HistoryData) -> None:
        self._data = data
        self._arrays = self._map(data)

    def view(self, name: str) -> NDArray[Any] | None:
        """Give an array of the file; None if it cannot be mapped."""
        array = self._arrays.get(name)
        # A read beyond the end of a truncated mapped file ends the process by a signal.
        if array is not None and array._mmap.size() < array.offset + array.nbytes:  # type: ignore[attr-defined]
            raise FileFormatError(f"{self._data.path}: the file has been truncated")
        return None if array is None else array[: self._data.count]

    def checked(self, name: str) -> NDArray[Any] | None:
        """Give an array of the file after it was compared with its checksums; None if it cannot be mapped."""
        view = self.view(name)
        if view is not None and view.size:
            rows = max(AT_ONCE // view[0].nbytes, 1)
            for start in range(0, self._data.count, rows):
                self.check(name, np.arange(start, min(start + rows, self._data.count)), view[start : start + rows])
        return view

    def check(self, name: str, steps: NDArray[np.intp], values: NDArray[Any]) -> None:
        """Compare the values of a field at some instants with their checksums."""
        sums = self.view("checksums")
        if sums is None:
            return
        if name == "touching":
            self._data.check_mapped_flags(steps.tolist(), values, np.ascontiguousarray(sums[steps]))
        else:
            self._data.check_mapped(name, steps.tolist(), values, np.ascontiguousarray(sums[steps]))

    @staticmethod
    def _map(data: _percute.HistoryData) -> dict[str, np.memmap[Any, Any]]:
        path = data.path
        if path is None:
            return {}
        try:
            with path.open("rb") as file:
                # Checked after the file is open: this fails if it was replaced.
                arrays = {name: (shape, offset) for name, shape, offset in data.arrays() if 0 not in shape}
                return {
                    name: np.memmap(file, dtype, "r", arrays[name][1], tuple(arrays[name][0]))
                    for name, dtype in MAPPED.items()
                    if name in arrays
                }
        except PercuteError:
            raise
        except FileNotFoundError:
            raise MissingFileError(f"{path}: the file is no longer there") from None
        except OSError as error:
            raise StorageError(f"{path}: cannot be read: {error.strerror}") from error
        except ValueError:
            raise FileFormatError(f"{path}: the file has been truncated") from None
