"""What was done before an exception, as an attribute of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import Any

from percute.errors import PercuteError

__all__ = ["attached"]


@contextmanager
def attached(name: str, make: Callable[[Any], object]) -> Iterator[None]:
    """Replace the data that an exception has as its attribute ``name`` by what ``make`` makes of them.

    Where nothing was done, an exception of others, such as `KeyboardInterrupt`, gets None; a `PercuteError` is left as it is.
    """
    try:
        yield
    except BaseException as error:
        data = getattr(error, name, None)
        if data is not None or not isinstance(error, PercuteError):
            made = None if data is None else make(data)
            # An exception without room for attributes is raised unchanged.
            with suppress(AttributeError):
                setattr(error, name, made)
        raise
