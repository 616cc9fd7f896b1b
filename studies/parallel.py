"""Independent runs side by side, their results in the order of the items."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass
from typing import Any, TypeVar

from percute import Progress

Stop = Callable[[Progress], object]
"""The ``progress`` of simulations and estimates through which a study is stopped."""
T = TypeVar("T")
R = TypeVar("R")
POLL = 0.05
"""How often progress is shown and Ctrl-C looked for (s)."""


class _Stopped(BaseException):
    """The study was stopped."""


@dataclass(frozen=True)
class Resolution:
    """How much of a study is computed, and how. A small study has some rows of the full one, digit for digit the same."""

    small: bool = False
    threads: int | None = None
    """Runs at once; by default one for each core. No number depends on it."""
    stage: str = "reproducing"
    tell: Stop | None = None

    @property
    def name(self) -> str:
        """``"small"`` or ``"full"``."""
        return self.either("small", "full")

    def either(self, small: T, full: T) -> T:
        """Give one of two settings."""
        return small if self.small else full

    def first(self, few: int, items: Sequence[T]) -> Sequence[T]:
        """Give the first ``few`` items in a small study, else all."""
        return items[:few] if self.small else items

    def map(
        self, work: Callable[[T, Stop], R], items: Sequence[T], cost: Callable[[T], float] | None = None
    ) -> list[R]:
        """Call ``work(item, stop)`` for each item, the costliest first, on several threads; results are in the order of the items.

        ``stop`` goes on as the ``progress`` of simulations and estimates, with ``threads=1``: through it Ctrl-C ends them.
        """
        halt = threading.Event()

        def stop(_: Progress) -> None:
            if halt.is_set():
                raise _Stopped

        order = sorted(range(len(items)), key=lambda i: -cost(items[i])) if cost else range(len(items))
        with ThreadPoolExecutor(self.threads or _cores()) as pool:
            running: dict[Future[R], int] = {pool.submit(work, items[i], stop): i for i in order}
            try:
                self._watch(list(running))
            except BaseException:
                halt.set()
                pool.shutdown(wait=True, cancel_futures=True)
                raise
        results = {i: future.result() for future, i in running.items()}
        return [results[i] for i in range(len(items))]

    def _watch(self, running: list[Future[Any]]) -> None:
        """Wait until all is done, show progress, and raise the first error."""
        pending: set[Future[Any]] = set(running)
        while True:
            if self.tell is not None:
                self.tell(Progress(self.stage, len(running) - len(pending), len(running)))
            if not pending:
                return
            done, pending = wait(pending, POLL, FIRST_COMPLETED)
            for future in done:
                future.result()


def _cores() -> int:
    """Count the cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
