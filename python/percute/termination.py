"""Files are closed before the process ends: by a signal, or by the end of the interpreter while a run goes on."""

from __future__ import annotations

import atexit
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Never

from percute import _percute

SIGNALS = tuple(getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name))
"""Signals of batch systems and closed terminals; by default they end the process at once."""

atexit.register(_percute.close_files)


class _Ended(BaseException):
    """The process is to end by a signal."""

    def __init__(self, number: int) -> None:
        self.number = number


def _end(number: int, _: FrameType | None) -> Never:
    raise _Ended(number)


@contextmanager
def file_closed_at_signals(file: object) -> Iterator[None]:
    """End the process by a signal only after a run has closed its file, if it has one.

    Signals with a handler of the user, ignored signals and other threads are left alone.
    """
    taken = []
    try:
        for number in SIGNALS if file is not None else ():
            if signal.getsignal(number) == signal.SIG_DFL:
                signal.signal(number, _end)
                taken.append(number)
    except ValueError:  # Only the main thread of the main interpreter has handlers.
        pass
    try:
        yield
    except _Ended as ended:
        signal.signal(ended.number, signal.SIG_DFL)
        signal.raise_signal(ended.number)
    finally:
        for number in taken:
            signal.signal(number, signal.SIG_DFL)
