"""The part of a run that the file of its history keeps."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike

from percute import _percute
from percute.checks import numbers, text, whole, wrong
from percute.errors import InputError


def kept(every: int | None, times: ArrayLike | None, fields: Iterable[str] | None, file: str | None) -> _percute._Kept:
    """Check the part of a run that its file keeps."""
    given = {"every": every, "times": times, "fields": fields}
    named = [name for name, value in given.items() if value is not None]
    if named and file is None:
        raise InputError(f"`{named[0]}` is given without `store`; it says what the file of the history keeps")
    if every is not None and times is not None:
        raise InputError("`times` is given beside `every`; give one of them")
    wanted = None if times is None else np.atleast_1d(numbers("times", times, most=1))
    if wanted is not None and (len(wanted) == 0 or not np.all(np.isfinite(wanted) & (wanted >= 0))):
        raise wrong("times", times, "at least one time (s), finite and not negative")
    if isinstance(fields, str):
        raise wrong("fields", fields, 'a list of names, such as ["displacement", "velocity"]')
    names = None if fields is None else [text("fields", name) for name in fields]
    return None if every is None else whole("every", every), None if wanted is None else wanted.tolist(), names
