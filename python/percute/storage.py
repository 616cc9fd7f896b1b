"""The part of a run that the file of its history keeps."""

from __future__ import annotations

from collections.abc import Iterable

from numpy.typing import ArrayLike

from percute import _percute
from percute.arrays import times as checked_times
from percute.checks import names, whole
from percute.errors import InputError


def storage(every: int | None, times: ArrayLike | None, fields: Iterable[str] | None, file: str | None) -> _percute._Storage:
    """Check the part of a run that its file keeps."""
    given = {"every": every, "times": times, "fields": fields}
    named = [name for name, value in given.items() if value is not None]
    if named and file is None:
        raise InputError(f"`{named[0]}` is given without `store`; it says what the file of the history keeps")
    if every is not None and times is not None:
        raise InputError("`times` is given beside `every`; give one of them")
    wanted = None if times is None else checked_times("times", times)
    chosen = names("fields", fields, '["displacement", "velocity"]')
    return None if every is None else whole("every", every), wanted, chosen
