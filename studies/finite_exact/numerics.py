"""Ordinary differential equations and zeros, with NumPy alone."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from studies.benchmarks.trial import Floats


def integrated(slope: Callable[[float, Floats], Floats], start: Floats, places: Floats, between: int = 20) -> Floats:
    """Integrate from the first of these places to the others, by the classical method of Runge and Kutta."""
    state, states = start, [start]
    for left, right in zip(places[:-1], places[1:], strict=True):
        step = (right - left) / between
        for k in range(between):
            at = left + k * step
            a = slope(at, state)
            b = slope(at + 0.5 * step, state + 0.5 * step * a)
            c = slope(at + 0.5 * step, state + 0.5 * step * b)
            d = slope(at + step, state + step * c)
            state = state + step / 6.0 * (a + 2.0 * b + 2.0 * c + d)
        states.append(state)
    return np.array(states)


def root(function: Callable[[float], float], first: float, second: float) -> float:
    """Give a zero of a smooth function, by secants."""
    left, right = function(first), function(second)
    while abs(second - first) > 1e-13 * abs(second) and right != left:
        first, left, second = second, right, second - right * (second - first) / (right - left)
        right = function(second)
    return second
