"""The runs of an adaptation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["Iterations"]


@dataclass(frozen=True, eq=False, kw_only=True)
class Iterations:
    """The runs of an adaptation. Arrays have a value for each run, NaN where there is none."""

    branch: tuple[str | None, ...]
    """How the mesh was made: "uniform", "graded" or "map"; None for the first."""
    elements: NDArray[np.int64]
    """Number of elements."""
    steps: NDArray[np.int64]
    """Number of steps."""
    element_steps: NDArray[np.float64]
    """Elements times steps."""
    smallest: NDArray[np.float64]
    """Size of the smallest element (m): the root of its area, or its length."""
    largest: NDArray[np.float64]
    """Size of the largest element (m)."""
    error: NDArray[np.float64]
    """The relative error that the target is about."""
    predicted: NDArray[np.float64]
    """The error that was expected of the mesh."""
    quantity: NDArray[np.float64]
    """The value of the quantity that the target is about, if it is about one."""
    surface: NDArray[np.float64]
    """Part of the source ``surface`` in the squared mean error."""
    front: NDArray[np.float64]
    """The same of ``front``."""
    dispersion: NDArray[np.float64]
    """The same of ``dispersion``."""
    mesh: NDArray[np.float64]
    """The same of ``mesh``."""
    trust: tuple[str, ...]
    """How far the estimate can be trusted."""
    reasons: tuple[tuple[str, ...], ...]
    """Reasons not to trust it, beside strains and rotations that are not small."""

    def __len__(self) -> int:
        return len(self.elements)

    @classmethod
    def _of(cls, runs: Sequence[dict[str, Any]]) -> Iterations:
        def floats(values: Sequence[Any]) -> NDArray[np.float64]:
            return np.array([np.nan if value is None else value for value in values], np.float64)

        sources = np.array([[np.nan] * 4 if run["sources"] is None else run["sources"] for run in runs], np.float64).reshape(-1, 4)
        return cls(
            branch=tuple(run["branch"] for run in runs),
            elements=np.array([run["elements"] for run in runs], np.int64),
            steps=np.array([run["steps"] for run in runs], np.int64),
            smallest=floats([run["sizes"][0] for run in runs]),
            largest=floats([run["sizes"][1] for run in runs]),
            **{name: floats([run[name] for run in runs]) for name in ("element_steps", "error", "predicted", "quantity")},
            **dict(zip(("surface", "front", "dispersion", "mesh"), sources.T, strict=True)),
            trust=tuple(run["trust"] for run in runs),
            reasons=tuple(tuple(run["reasons"]) for run in runs),
        )
