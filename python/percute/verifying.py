"""A problem on nested meshes: estimates beside true errors against the finest."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from percute import _percute
from percute.arrays import numbers
from percute.attached import attached
from percute.checks import flag, instance, text, warn, whole, wrong
from percute.errors import InputError
from percute.estimating import pace, sampling
from percute.pictures import convergence
from percute.problem import Problem
from percute.progress import ProgressOption, shown
from percute.simulation import instants_of, with_planes_moved
from percute.words import counted

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["Convergence", "Verification", "verify"]

Probes = str | Sequence[str | tuple[float | str, ...]] | None
"""Probes as texts, such as "0.01,0.02:von_mises", or as tuples, such as (0.01, 0.02, "von_mises")."""


@dataclass(frozen=True, kw_only=True)
class Convergence:
    """How a quantity changes on the finest meshes."""

    unit: str
    """The unit of the quantity."""
    change: float | None
    """Its change from the finest mesh but one to the finest, relative to the finest; None with one mesh or at zero."""
    order: float | None
    """p of differences that fall like h^p between the three finest meshes; negative where they grow. None where they change their sign."""
    remaining: float | None
    """The change from the finest mesh to the limit with this order, relative to the finest; None without a limit."""
    converges: bool | None
    """Whether differences fall and do not change their sign; None with fewer than three meshes, and where they fall and change their sign."""
    warning: str | None
    """A sentence about a quantity that does not converge, with the reason and the way out if they are known."""


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class Verification:
    """A problem on its mesh and on refinements of it. Arrays have a value for each level, NaN where there is none."""

    elements: NDArray[np.int64]
    """Number of elements."""
    steps: NDArray[np.int64]
    """Number of steps."""
    estimate_sup: NDArray[np.float64]
    """Largest estimated error (J^½), eq. [15]."""
    estimate_mean: NDArray[np.float64]
    """Mean estimated error (J^½), eq. [16]."""
    error_sup: NDArray[np.float64]
    """Largest true error against the finest mesh (J^½)."""
    error_mean: NDArray[np.float64]
    """Mean true error against the finest mesh (J^½)."""
    effectivity_sup: NDArray[np.float64]
    """Estimated over true error, of the largest."""
    effectivity_mean: NDArray[np.float64]
    """Estimated over true error, of the mean."""
    averaged_peak_force: NDArray[np.float64]
    """Largest normal force of all nodes together (N), averaged over the time in which a wave crosses the struck element."""
    impulse: NDArray[np.float64]
    """Normal impulse of all planes (N s)."""
    rebound: NDArray[np.float64]
    """Normal velocity of the centre of mass after contact (m/s)."""
    probes: dict[str, NDArray[np.float64]]
    """Largest values of probes over time, without their sign, by their names such as "0.01,0.02:von_mises"."""
    expected: tuple[float, float]
    """The range of the effectivity index on the first mesh that its verdict states."""
    orders: dict[str, float | None]
    """Observed orders of ``estimate``, ``averaged_peak_force``, ``impulse``, ``rebound`` and probes; None where values do not converge."""
    convergence: dict[str, Convergence]
    """How ``averaged_peak_force``, ``impulse``, ``rebound`` and probes change on the finest meshes."""
    moved: float | None
    """By how much the mean true error of the first mesh moves from the finest mesh but one to the finest, relative; None with one level."""
    fine_enough: bool | None
    """Whether that is at most 0.1."""
    per_metre: bool
    """Whether forces and energies are per metre of thickness."""
    _table: str

    @property
    def size(self) -> NDArray[np.float64]:
        """Element size over that of the first mesh."""
        return np.asarray(0.5 ** np.arange(len(self.elements)))

    def __str__(self) -> str:
        return self._table.rstrip()

    def __repr__(self) -> str:
        return f"<percute.Verification: {counted(len(self.elements), 'level')} of {self.elements[0]} to {self.elements[-1]} elements>"

    def plot(self, *, axes: Sequence[Axes] | None = None, save: str | os.PathLike[str] | None = None, overwrite: bool = False) -> list[Axes]:
        """Draw errors, effectivity index and contact over the element size.

        Above are estimate and true error, in the middle their quotient, the effectivity index, with the range that the verdict expects for
        the first mesh, and below averaged peak force, impulse, rebound velocity and probes over their values on the finest mesh.

        Parameters
        ----------
        axes : sequence of three matplotlib.axes.Axes, optional
            Axes of the plots; new ones by default.
        save, overwrite
            As for `History.plot_energies`.

        Returns
        -------
        list of matplotlib.axes.Axes
            The axes of the three plots.
        """
        return convergence.plot(self.size, vars(self), self.expected, self.per_metre, axes, save, flag("overwrite", overwrite))

    @classmethod
    def _of(cls, document: dict[str, Any], table: str) -> Verification:
        levels = document["levels"]

        def column(*keys: str) -> NDArray[np.float64]:
            values = []
            for level in levels:
                value = level
                for key in keys:
                    value = None if value is None else value[key]
                values.append(np.nan if value is None else value)
            return np.array(values, np.float64)

        pairs = {f"{key}_{name}": column(key, name) for key in ("estimate", "error", "effectivity") for name in ("sup", "mean")}
        settled = document["settled"] or {}
        convergence = {each.pop("quantity"): Convergence(**each) for each in [dict(each) for each in document["convergence"]]}
        names = [probe["name"] for probe in levels[0]["probes"]]
        of_probes = {name: np.array([level["probes"][at]["value"] for level in levels]) for at, name in enumerate(names)}
        orders = {name: order for name, order in document["orders"].items() if name != "probes"}
        return cls(
            elements=np.array([level["elements"] for level in levels]),
            steps=np.array([level["steps"] for level in levels]),
            **pairs,
            **{key: column(key) for key in ("averaged_peak_force", "impulse", "rebound")},
            probes=of_probes,
            expected=tuple(levels[0]["expected"]),
            orders=orders | dict(zip(names, document["orders"]["probes"], strict=True)),
            convergence=convergence,
            moved=settled.get("moved"),
            fine_enough=settled.get("fine_enough"),
            per_metre=document["per_metre"],
            _table=table,
        )


def verify(
    problem: Problem,
    *,
    end: float | Literal["rebound"] | None = None,
    courant: float | None = None,
    step: float | None = None,
    steps: ArrayLike | None = None,
    longest: float | None = None,
    after: float | None = None,
    levels: int = 2,
    reconstruction: Literal["corrected", "consistent", "published"] = "corrected",
    acceleration: Literal["closest", "rigid", "weak", "split"] | None = None,
    every: int | Literal["auto"] = "auto",
    threads: int | None = None,
    long: bool = False,
    probe: Probes = None,
    progress: ProgressOption = None,
) -> Verification:
    """Run a problem on its mesh and on nested refinements, and compare estimates with true errors against the finest.

    All meshes have the Courant number of the first. A level of a plane body has about eight times the work of the one before, of a bar
    four times. With ``progress=True`` the cost is printed before the work starts.

    Parameters
    ----------
    problem : Problem
        The problem.
    end, courant, step, steps, longest, after
        As for `simulate`; the rebound is that of the first mesh.
    levels : int, default: 2
        Number of refinements, 1 to 5.
    reconstruction : {"corrected", "consistent", "published"}, default: "corrected"
        As for `estimate`.
    acceleration : {"closest", "rigid", "weak", "split"}, optional
        As for `estimate`, on all meshes.
    every : int or "auto", default: "auto"
        As for `estimate`: the error of each mesh is sampled at every so many of its own steps, or at those that "auto" chooses.
    threads : int, optional
        How many threads to use; one for each core by default.
    long : bool, default: False
        Whether more than 1e10 elements times steps in all are allowed, which take minutes to hours.
    probe : str or sequence of str or tuple, optional
        Points of the undeformed body (m) with a field: ``"0.01,0.02:von_mises"``, or a list of such texts and of tuples
        ``(0.01, 0.02, "von_mises")``. Fields are ``von_mises``, ``pressure``, ``equivalent_plastic_strain``, ``displacement``, ``velocity``, of a
        plane body ``stress_xx``, ``stress_yy``, ``stress_xy``, of a bar ``stress``. The value is the largest over all steps, without its sign; displacement and velocity
        are magnitudes. On an edge or a node it is that of the mean of the elements around it, weighted by their angles there.
    progress : bool or callable, optional
        As for `simulate`.

    Returns
    -------
    Verification

    Raises
    ------
    InputError
        An argument is wrong; or the start is too near to a plane.
    SimulationError, EstimateError
        A run failed.
    """
    problem = with_planes_moved(instance("problem", problem, Problem), courant, step, steps)
    count = whole("levels", levels)
    if count > _percute.MOST_LEVELS:
        raise InputError(f"`levels` is {count}; give 1 to {_percute.MOST_LEVELS} refinements")
    stated = (
        text("reconstruction", reconstruction),
        None if acceleration is None else text("acceleration", acceleration),
        sampling(every),
    )
    (workers, _), allowed = pace(threads, None), flag("long", long)
    probes = _texts(probe)
    _percute.check_probes(problem._data, probes)
    times = instants_of(problem, end, courant, step, steps, longest, after, allowed, progress)
    _percute.check_run(problem._data, times, allowed)
    warn(_percute.plausibility_warnings(problem._data, times, False))
    tell = print if progress is True else None
    with shown(progress) as seen, attached("verification", lambda done: Verification._of(json.loads(done[0]), done[1])):
        document, table = _percute.verification(problem._data, times, count, stated, workers, allowed, probes, tell, seen)
    return Verification._of(json.loads(document), table)


def _texts(probe: object) -> list[str]:
    """Give probes as the command reads them."""
    given = [] if probe is None else [probe] if isinstance(probe, str) or _is_row(probe) else probe
    if not isinstance(given, list | tuple):
        raise _wrong(probe)
    return [_text(each) for each in given]


def _is_row(probe: object) -> bool:
    """Tell whether a tuple is one probe, not several."""
    return isinstance(probe, tuple) and len(probe) > 1 and not isinstance(probe[0], str | tuple | list)


def _text(probe: object) -> str:
    if isinstance(probe, str):
        return probe
    if not isinstance(probe, list | tuple) or len(probe) < 2 or not isinstance(probe[-1], str):
        raise _wrong(probe)
    point = numbers("probe", probe[:-1], most=1)
    return f"{','.join(repr(float(x)) for x in point)}:{probe[-1]}"


def _wrong(probe: object) -> InputError:
    return wrong("probe", probe, 'a text such as "0.01,0.02:von_mises", a tuple such as (0.01, 0.02, "von_mises"), or a list of them')
