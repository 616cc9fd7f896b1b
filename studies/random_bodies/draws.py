"""Random draws that follow from the numbers of a seed alone."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

T = TypeVar("T")


class Draws:
    """Draws from one generator of NumPy, all from ``random``, the numbers of which are the same in all versions."""

    def __init__(self, *seed: int) -> None:
        self._generator = np.random.default_rng(seed)

    def uniform(self, low: float, high: float) -> float:
        """Give a number between two others."""
        return low + (high - low) * float(self._generator.random())

    def log_uniform(self, low: float, high: float) -> float:
        """Give a number between two others, its logarithm evenly distributed."""
        return float(low * (high / low) ** self._generator.random())

    def whole(self, low: int, high: int) -> int:
        """Give a whole number between two others, which it may be."""
        return low + int((high - low + 1) * self._generator.random())

    def chance(self, part: float) -> bool:
        """Say yes in a part of all cases."""
        return bool(self._generator.random() < part)

    def one(self, items: Sequence[T]) -> T:
        """Give one of some items."""
        return items[self.whole(0, len(items) - 1)]

    def array(self, *shape: int) -> NDArray[np.float64]:
        """Give numbers between 0 and 1."""
        return self._generator.random(shape)
