"""The mesh on which a problem has a wanted accuracy."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Literal

from numpy.typing import ArrayLike

from percute import _percute, adaptation_pictures
from percute.attached import attached
from percute.checks import flag, instance, number, path, text, warn, whole, wrong
from percute.errors import InputError
from percute.estimating import pace, sampling
from percute.estimation import Estimate
from percute.history import History
from percute.iterations import Iterations
from percute.mesh import Mesh
from percute.problem import Problem
from percute.progress import ProgressOption, shown
from percute.simulation import instants_of, simulate, with_planes_moved
from percute.words import counted

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["Adaptation", "adapt"]


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
    """Why the runs ended: "reached", "limit", "runs", "same_mesh", "not_trusted", "no_limit", "no_sources", "failed" or "interrupted"."""
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
        save, overwrite
            As for `History.plot_energies`.

        Returns
        -------
        list of matplotlib.axes.Axes
            The axes of the two plots.
        """
        drawn = None if self.estimate is None or self.best is None else (self.estimate, self.best)
        return adaptation_pictures.plot(drawn, self.iterations, self.measure, self.target, axes, save, flag("overwrite", overwrite))


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
