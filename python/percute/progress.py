"""Progress of a computation."""

from __future__ import annotations

import html
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from percute._percute import Progress
from percute.checks import wrong

__all__ = ["Progress", "shown"]

ProgressOption = bool | Callable[[Progress], object] | None

WIDTH = 32
COUNTED = {"simulating": "step ", "estimating": "step ", "running cases": ""}
"""Stages that count, and their word for one; others are shown in per cent."""


def _seconds(seconds: float) -> str:
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60} s"
    return f"{whole // 3600} h {whole % 3600 // 60} min"


class _Line:
    """The text of a progress line."""

    def __init__(self) -> None:
        self.stage = ""
        self.start = 0.0

    def text(self, progress: Progress) -> tuple[str, float]:
        """Give the progress with the remaining time, and as a fraction."""
        now = time.monotonic()
        if progress.stage != self.stage:
            self.stage, self.start = progress.stage, now
        fraction = progress.done / progress.total if progress.total else 1.0
        spent = now - self.start
        left = f", {_seconds(spent * (1 - fraction) / fraction)} left" if 0 < fraction < 1 else ""
        counted = f"{COUNTED[progress.stage]}{progress.done} of {progress.total}" if progress.stage in COUNTED else f"{100 * fraction:.0f} %"
        return counted + left, fraction


class _Terminal(_Line):
    """A line of text that is overwritten."""

    def __call__(self, progress: Progress) -> None:
        text, fraction = self.text(progress)
        done = round(WIDTH * fraction)
        sys.stderr.write(f"\r\x1b[K{progress.stage} {'█' * done}{'░' * (WIDTH - done)} {text}")
        sys.stderr.flush()

    def close(self) -> None:
        sys.stderr.write("\r\x1b[K")
        sys.stderr.flush()


class _Notebook(_Line):
    """An updated output of the cell."""

    def __init__(self, display: Any, as_html: Any) -> None:
        super().__init__()
        self.display, self.html, self.handle = display, as_html, None
        self.begin = time.monotonic()
        self.last = ""

    def show(self, text: str) -> None:
        if self.handle is None:
            self.handle = self.display(self.html(text), display_id=True)
        elif text != self.last:
            self.handle.update(self.html(text))
        self.last = text

    def __call__(self, progress: Progress) -> None:
        text, fraction = self.text(progress)
        bar = f'<progress value="{fraction:.3f}" max="1" style="width: 20em; vertical-align: middle"></progress>'
        self.show(f"{html.escape(progress.stage)} {bar} {html.escape(text)}")

    def close(self) -> None:
        if self.handle is not None and self.stage:
            self.show(f"{self.last.rsplit('>', 1)[0]}> {_seconds(time.monotonic() - self.begin)}")


def _display() -> _Notebook | _Terminal | None:
    """Choose a display for the output; none if it would not be visible."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    if shell is not None and type(shell).__name__ == "ZMQInteractiveShell":
        from IPython.display import HTML, display

        return _Notebook(display, HTML)
    return _Terminal() if sys.stderr is not None and sys.stderr.isatty() else None


@contextmanager
def shown(progress: ProgressOption) -> Iterator[Callable[[Progress], object] | None]:
    """Give the callback of an option ``progress``, and clean up at the end."""
    if not (progress is None or isinstance(progress, bool) or callable(progress)):
        raise wrong("progress", progress, "True, False or a function that is called with a Progress")
    if progress is not True:
        yield progress or None
        return
    display = _display()
    try:
        yield display
    finally:
        if display is not None:
            display.close()
