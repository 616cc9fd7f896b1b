"""The mesh on which a problem has a wanted accuracy."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from percute import _percute
from percute.attached import attached
from percute.checks import flag, instance, number, path, text, warn, whole, wrong
from percute.errors import InputError
from percute.estimating import pace, sampling
from percute.estimation import Estimate
from percute.history import History
from percute.mesh import Mesh
from percute.problem import Problem
from percute.progress import ProgressOption, shown
from percute.simulation import instants_of, simulate, with_planes_moved
from percute.words import counted

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["Adaptation", "Iterations", "adapt"]


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
    doubts: tuple[tuple[str, ...], ...]
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
            element_steps=floats([run["element_steps"] for run in runs]),
            smallest=floats([run["sizes"][0] for run in runs]),
            largest=floats([run["sizes"][1] for run in runs]),
            error=floats([run["error"] for run in runs]),
            predicted=floats([run["predicted"] for run in runs]),
            quantity=floats([run["quantity"] for run in runs]),
            surface=sources[:, 0],
            front=sources[:, 1],
            dispersion=sources[:, 2],
            mesh=sources[:, 3],
            trust=tuple(run["trust"] for run in runs),
            doubts=tuple(tuple(run["doubts"]) for run in runs),
        )


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class Adaptation:
    """The runs towards a wanted accuracy, and the best of them."""

    target: float
    """The relative error that was wanted."""
    measure: str
    """Which one: "mean" or "sup", or the quantity that the target is about."""
    reached: bool
    """Whether it is reached."""
    reason: str
    """Why the runs ended: "reached", "limit", "runs", "same_mesh", "doubt", "no_limit", "no_sources", "failed" or "interrupted"."""
    conclusion: str
    """The same in a sentence."""
    needed: float | None
    """Elements times steps that the target needs, if it is not reached and they can be told."""
    reachable: float | None
    """The relative error of a uniform mesh with as much work as the limit allows, if that ended the runs."""
    warnings: tuple[str, ...]
    """Warnings about the meshes, such as one of a polygon in the place of a curve."""
    iterations: Iterations
    """The runs, in order."""
    best: int | None
    """The number of the best run, from 0; None if the first was interrupted."""
    problem: Problem | None
    """The problem on the best mesh."""
    estimate: Estimate | None
    """The estimate on the best mesh; its history is `history`."""
    _times: tuple[float | None, float | None]
    _table: str

    @property
    def mesh(self) -> Mesh | None:
        """The best mesh."""
        return None if self.problem is None else self.problem.mesh

    @cached_property
    def history(self) -> History | None:
        """The history on the best mesh: simulated again at the first use, with the same bits."""
        if self.problem is None:
            return None
        end, step = self._times
        return simulate(self.problem, end=end, step=step)

    def __str__(self) -> str:
        return self._table.rstrip()

    def __repr__(self) -> str:
        error = "" if self.best is None else f", {100 * self.iterations.error[self.best]:.3g} %"
        return f"<percute.Adaptation: {counted(len(self.iterations), 'run')}{error}, target {100 * self.target:.3g} %: {self.reason}>"

    def plot(self, *, axes: Sequence[Axes] | None = None, save: str | os.PathLike[str] | None = None, overwrite: bool = False) -> list[Axes]:
        """Draw the error over the elements of the best mesh, and the error over the cost of the runs.

        Parameters
        ----------
        axes : sequence of two matplotlib.axes.Axes, optional
            Axes of the plots; new ones by default.
        save : str or path, optional
            A file ``.svg``, ``.png`` or ``.pdf`` for the picture.
        overwrite : bool, default: False
            Whether a file that exists already is replaced.

        Returns
        -------
        list of matplotlib.axes.Axes
            The axes of the two plots.
        """
        from percute.pictures import adaptation

        return adaptation.plot(self, axes, save, flag("overwrite", overwrite))


def adapt(
    problem: Problem,
    *,
    target: float,
    measure: str = "mean",
    end: float | Literal["rebound"] | None = None,
    courant: float | None = None,
    step: float | None = None,
    steps: ArrayLike | None = None,
    longest: float | None = None,
    after: float | None = None,
    mesher: Literal["bisect", "gmsh"] = "bisect",
    geometry: str | os.PathLike[str] | None = None,
    scale: float = 1.0,
    limit: float = _percute.LIMIT,
    runs: int = _percute.RUNS,
    acceleration: Literal["closest", "rigid", "weak", "split"] | None = None,
    every: int | Literal["auto"] = "auto",
    threads: int | None = None,
    progress: ProgressOption = None,
) -> Adaptation:
    """Find the mesh on which a problem has a wanted accuracy.

    The problem is run and its error estimated; the sources of the error decide on the next mesh, until the target is reached. Where
    fronts and dispersion are the source, all elements become smaller alike; at slow contacts the mesh is graded towards the nodes that
    touch; elsewhere each element gets its size by its error. All meshes are bisections of the first one, or meshes of the same generator,
    with the same end and Courant number. With ``progress=True`` each run and its cost are printed before it starts.

    Parameters
    ----------
    problem : Problem
        The problem on its first mesh.
    target : float
        The relative error to reach, above 0 and below 0.5.
    measure : str, default: "mean"
        The target is about ``relative_mean`` of the estimate; with "sup", about ``relative_sup``. With "peak_force", "impulse", "rebound" or a
        probe such as "probe:0.01,0.02:von_mises", it is about this quantity: within this part of its limit, judged on at least three
        meshes by the change from the mesh before and by the order of its changes. No estimate is claimed of quantities.
    end, courant, step, steps, longest, after
        As for `simulate`; the rebound is that of the first mesh.
    mesher : {"bisect", "gmsh"}, default: "bisect"
        Bisection of the first mesh; or the program Gmsh, with any sizes.
    geometry : str or path, optional
        The geometry that Gmsh meshes (``.geo``, ``.step``), with the groups of the first mesh: curves stay curves. By default the outline
        of the first mesh, polygons.
    scale : float, default: 1.0
        Metres per unit of length in this file.
    limit : float, default: 1e8
        The most elements times steps of a run.
    runs : int, default: 8
        The most runs.
    acceleration : {"closest", "rigid", "weak", "split"}, optional
        As for `estimate`.
    every : int or "auto", default: "auto"
        As for `estimate`.
    threads : int, optional
        How many threads to use; one for each core by default.
    progress : bool or callable, optional
        As for `simulate`.

    Returns
    -------
    Adaptation

    Raises
    ------
    InputError
        An argument is wrong; or the start is too near to a plane.
    SimulationError, EstimateError
        The first run failed. If a later one fails, the adaptation ends with the best run before it.
    KeyboardInterrupt
        Its ``adaptation`` has the runs so far.
    """
    problem = with_planes_moved(instance("problem", problem, Problem), courant, step, steps)
    wanted = (number("target", target), text("measure", measure), number("limit", limit), whole("runs", runs))
    stated = ("corrected", None if acceleration is None else text("acceleration", acceleration), sampling(every))
    (workers, _) = pace(threads, None)
    times = instants_of(problem, end, courant, step, steps, longest, after, True, progress)
    _percute.check_run(problem._data, times, True)
    warn(_percute.plausibility_warnings(problem._data, times, False))
    if text("mesher", mesher) not in ("bisect", "gmsh"):
        raise wrong("mesher", mesher, '"bisect" or "gmsh"')
    if geometry is not None and mesher != "gmsh":
        raise InputError('`geometry` needs mesher="gmsh"')
    gmsh = None if mesher == "bisect" else (None if geometry is None else path("geometry", geometry), number("scale", scale))
    adapting = _percute.AdaptingData(problem._data, times, wanted, gmsh, stated, workers)

    def so_far(_: object) -> Adaptation:
        return _adaptation(adapting)

    with attached("adaptation", so_far):
        try:
            while (announced := adapting.next()) is not None:
                if progress is True:
                    print(announced)
                with shown(progress) as seen:
                    adapting.run(seen)
        except BaseException as error:
            if not isinstance(error, Exception):
                error.adaptation = adapting  # type: ignore[attr-defined]
            raise
    adaptation = _adaptation(adapting)
    warn(adaptation.warnings)
    return adaptation


def _adaptation(adapting: _percute.AdaptingData) -> Adaptation:
    told, table, problem, estimate = adapting.so_far()
    document = json.loads(told)
    reason = document["reason"]
    needed = document["needed"]
    return Adaptation(
        target=document["target"],
        measure=document["on"] or document["measure"],
        reached=document["reached"],
        reason=next(iter(reason)) if isinstance(reason, dict) else (reason or "interrupted"),
        conclusion=document["conclusion"],
        needed=None if needed is None else needed["element_steps"],
        reachable=document["reachable"],
        warnings=tuple(document["warnings"]),
        iterations=Iterations._of(document["iterations"]),
        best=document["best"],
        problem=None if problem is None else Problem._of(problem),
        estimate=None if estimate is None else Estimate._of(estimate, None, ""),
        _times=(document["end"], document["step"]),
        _table=table,
    )
