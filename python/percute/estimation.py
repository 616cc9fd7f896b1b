"""Estimates of the error of a simulation, over elements and over time."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Literal, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from percute import _percute
from percute.checks import flag, instance, numbers, text, vtkhdf, warn, whole, wrong
from percute.checks import path as file_name
from percute.contact import Contact
from percute.errors import InputError
from percute.estimate_views import EstimateViews
from percute.history import History
from percute.mesh import Mesh
from percute.problem import Problem
from percute.progress import ProgressOption, shown
from percute.rebound import Rebound
from percute.records import ElementMap, OverTime, Parts, Separation, Sources, SourcesOverTime, WorstElement
from percute.stored import StoredEstimate

if TYPE_CHECKING:
    from percute.exact import Effectivity, TrueError

__all__ = ["Estimate", "estimate"]


def _measure(name: str, meaning: str) -> cached_property[float]:
    """Make a property of an estimate from one of its measures."""
    made: cached_property[float] = cached_property(lambda estimate: estimate._measures[name])
    made.__doc__ = meaning
    return made


class Estimate(EstimateViews):
    """The constitutive relation error of a history.

    Made by `estimate`, `run` or `percute.open`. Errors are in J^½ and include the thickness of a plane body. ``verdict``
    says in three sentences how far they can be trusted.
    """

    _data: _percute.EstimateData | StoredEstimate
    _history: History | None
    _name: str

    def __init__(self) -> None:
        raise TypeError("estimates are made by percute.estimate, percute.run and percute.open")

    @classmethod
    def _of(cls, data: _percute.EstimateData | StoredEstimate, history: History | None, name: str) -> Estimate:
        made = cls.__new__(cls)
        made._data = data
        made._history = history
        made._name = name
        return made

    @property
    def history(self) -> History | None:
        """The history that was estimated; None if the estimate was unpickled."""
        return self._history

    @cached_property
    def problem(self) -> Problem | None:
        """The problem that was simulated; None if the estimate comes from a file, which has no initial fields."""
        if isinstance(self._data, StoredEstimate):
            return None
        return self._history.problem if self._history is not None else Problem._of(self._data.problem())

    @cached_property
    def mesh(self) -> Mesh:
        """The mesh."""
        if isinstance(self._data, StoredEstimate):
            return self._data.mesh
        assert self.problem is not None
        return self.problem.mesh

    @cached_property
    def _measures(self) -> _percute._Measures:
        return cast("_percute._Measures", self._data.measures())

    sup = _measure("sup", "e_sup = √(sup η) (J^½), eq. [15].")
    mean = _measure("mean", "e_mean = √((1/T)∫η dt) (J^½), eq. [16].")
    relative_sup = _measure("relative_sup", "``sup`` over ``reference_sup``, eq. [22].")
    relative_mean = _measure("relative_mean", "``mean`` over ``reference_mean``.")
    reference_sup = _measure("reference_sup", "D = √(sup d) (J^½), eq. [23].")
    reference_mean = _measure("reference_mean", "√((1/T)∫d dt) (J^½).")
    time_of_sup = _measure("time_of_sup", "Time of the largest η (s).")

    @property
    def steps(self) -> int:
        """The last step that was estimated."""
        return self._measures["steps"]

    end = _measure("end", "Its time T (s).")

    @property
    def meaning(self) -> str:
        """The meaning of the error; `verdict` has its limits in cases like this one."""
        return _percute.meaning()

    @cached_property
    def _verdict(self) -> dict[str, Any]:
        found: dict[str, Any] = json.loads(self._data.verdict())
        return found

    @property
    def verdict(self) -> str | None:
        """Situation and effectivity index in tests of such cases, place of the error, and a recommendation, in at most three sentences.

        None if the estimate comes from a file of an earlier version.
        """
        verdict = self._verdict.get("verdict")
        return None if verdict is None else " ".join(verdict["text"])

    @property
    def trust(self) -> Literal["high", "limited", "low"] | None:
        """How far the estimate can be trusted; None if it comes from a file of an earlier version."""
        verdict = self._verdict.get("verdict")
        return None if verdict is None else cast("Literal['high', 'limited', 'low']", verdict["trust"])

    @cached_property
    def rebound(self) -> Rebound | None:
        """Velocities before and after contact, restitution and time in contact; None without contact."""
        return Rebound._of(self._verdict.get("rebound"))

    @property
    def kept_impulse(self) -> float | None:
        """Normal impulse of the admissible contact force over that of the simulation; None without contact."""
        return self._measures["kept_impulse"]

    @cached_property
    def parts(self) -> Parts:
        """Parts of η at its largest value (J), eq. [14]."""
        return Parts(*self._data.parts())

    @cached_property
    def over_time(self) -> OverTime:
        """η, its parts and d over time (J)."""
        return OverTime(**self._data.over_time())

    @cached_property
    def sources(self) -> Separation | None:
        """The sources of the error; None without an auxiliary solution, as with "consistent" and "published"."""
        found = self._data.sources()
        if found is None:
            return None
        return Separation(
            at_sup=Sources(*found["at_sup"]),
            mean=Sources(*found["mean"]),
            half_size=Sources(*found["half_size"]),
            half_step=found["half_step"],
            over_time=SourcesOverTime(**found["over_time"]),
        )

    @cached_property
    def by_element(self) -> NDArray[np.float64]:
        """e_E of each element (J^½), shape (elements,), eq. [20]; a read-only view."""
        return self._data.by_element()

    @cached_property
    def residuals(self) -> Mapping[str, float]:
        """Relative residuals of all admissibility conditions; above 1e-10 a field is not admissible (see ``docs/json.md``)."""
        return MappingProxyType(self._data.residuals())

    @cached_property
    def maps(self) -> tuple[ElementMap, ...]:
        """Contributions of the elements at the requested instants."""
        kept = [{k: v for k, v in each.items() if k not in ("step", "accumulated")} for each in self._data.maps()]
        return tuple(ElementMap(**arguments) for arguments in kept)

    @cached_property
    def contact(self) -> Contact | None:
        """Contact results from the history or the file; None after unpickling, or if the file has none."""
        if self._history is not None:
            return self._history.contact
        if not isinstance(self._data, StoredEstimate):
            return None
        found = self._data.contact()
        return None if found is None else Contact._of(found, self.mesh)

    @property
    def given(self) -> Mapping[str, bool]:
        """Whether the history has its own ``velocity`` and ``acceleration``; otherwise they follow from the scheme."""
        return MappingProxyType(dict(zip(("velocity", "acceleration"), self._data.given(), strict=True)))

    @cached_property
    def consistency(self) -> Mapping[str, float | None] | None:
        """How consistent a history of another program is: the figures of ``docs/foreign.md``; None for percute's own."""
        found = json.loads(self.to_json()).get("consistency")
        return None if found is None else MappingProxyType(found)

    @property
    def options(self) -> Mapping[str, str | int]:
        """The options ``reconstruction``, ``acceleration`` and ``every`` of the estimate."""
        return MappingProxyType(dict(zip(("reconstruction", "acceleration", "every"), self._data.options(), strict=True)))

    def effectivity(self, error: TrueError) -> Effectivity:
        """Give the effectivity index: the estimated over the true error, of the largest and of the mean error.

        Parameters
        ----------
        error : percute.TrueError
            The true error of the same history, as `History.error` and `percute.exact` give it.
        """
        from percute.exact import Effectivity, TrueError

        true = instance("error", error, TrueError)
        return Effectivity(sup=self.sup / true.sup, mean=self.mean / true.mean)

    def worst_elements(self, n: int = 5) -> list[WorstElement]:
        """Give the ``n`` largest contributions of elements, largest first."""
        count = whole("n", n, least=0)
        mesh = self.mesh
        worst = []
        for element, error in self._data.worst_elements(count):
            centroid = mesh.points[mesh.cells[element]].mean(axis=0)
            worst.append(WorstElement(element, error, tuple(centroid.tolist())))
        return worst

    def to_json(self) -> str:
        """Give the document that ``percute run --json`` prints, described in ``docs/json.md``."""
        return self._data.to_json(self._name)

    def save(self, path: str | os.PathLike[str], *, overwrite: bool = False) -> None:
        """Write an estimate file for ParaView, h5py and `percute.open`, described in ``docs/estimate.md``.

        It contains the contact results, unless the estimate was unpickled without its history.

        Parameters
        ----------
        path : str or path
            The file, such as ``"error.vtkhdf"``.
        overwrite : bool, default: False
            Whether a file that exists already is replaced.

        Raises
        ------
        ExistingFileError, StorageError
            The file exists already or cannot be written.
        InputError
            The estimate comes from a file; copy that file instead. Or ``path`` is the file of the history, which is never replaced.
        """
        file, replace = vtkhdf("path", path), flag("overwrite", overwrite)
        if isinstance(self._data, StoredEstimate):
            raise InputError(f"the estimate comes from the file {self._data.path!r}; copy that")
        history = self._history.path if self._history is not None else None
        if history is not None and os.path.exists(file) and history.exists() and history.samefile(file):
            raise InputError(f"`path` is {file!r}, the file of the history that was estimated; give another name")
        of = None if self._history is None else self._history._data
        self._data.save(os.path.abspath(file), replace, self._name, of)

    def picture(self, path: str | os.PathLike[str], *, overwrite: bool = False) -> None:
        """Write the picture of ``percute run --picture``: e_E of each element (J^½), eq. [20], on the mesh. It needs no matplotlib.

        Parameters
        ----------
        path : str or path
            The file, ``.svg`` or ``.png``.
        overwrite : bool, default: False
            Whether a file that exists already is replaced.

        Raises
        ------
        InputError
            The name of the file ends otherwise.
        ExistingFileError, StorageError
            The file exists already or cannot be written.
        """
        self._present(False, path, overwrite)

    def report(self, path: str | os.PathLike[str], *, overwrite: bool = False) -> None:
        """Write the page of ``percute report``: one HTML file to read, to print and to hand over, described in ``docs/report.md``.

        It shows the pressure along the surface unless the estimate was unpickled without its history.

        Parameters
        ----------
        path : str or path
            The file, ``.html``.
        overwrite : bool, default: False
            Whether a file that exists already is replaced.

        Raises
        ------
        InputError
            The name of the file ends otherwise, or is that of the estimate.
        ExistingFileError, StorageError
            The file exists already or cannot be written.
        """
        self._present(True, path, overwrite)

    def _present(self, page: bool, path: str | os.PathLike[str], overwrite: bool) -> None:
        file, replace = os.path.abspath(file_name("path", path)), flag("overwrite", overwrite)
        if isinstance(self._data, StoredEstimate):
            _percute.present_file(self._data.path, page, file, replace)
            return
        history = None if self._history is None else self._history._data
        _percute.present(self._data, page, file, replace, self._name, history)

    def __repr__(self) -> str:
        return (
            f"<percute.Estimate: sup {self.sup:.4g} J^½ ({self.relative_sup:.3%}) at {self.time_of_sup:.4g} s, "
            f"mean {self.mean:.4g} J^½ ({self.relative_mean:.3%}), {len(self.by_element)} elements, {self.steps} steps>"
        )

    def __str__(self) -> str:
        verdict = [] if self.verdict is None else [f"trust {self.trust}: {self.verdict}"]
        return "\n".join([repr(self).strip("<>"), *verdict, self.meaning])

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle all but the history, which is large and can be pickled separately."""
        data = self._data
        if isinstance(data, StoredEstimate):
            return _reopen, (data.path,)
        return _restore, (self.problem, data.state(self._name), self._name)


def _reopen(path: str) -> Estimate:
    return Estimate._of(StoredEstimate(path), None, path)


def _restore(problem: Problem, state: bytes, name: str) -> Estimate:
    restored = Estimate._of(_percute.EstimateData.restore(problem._data, state), None, name)
    restored.__dict__["problem"] = problem
    return restored


def estimate(
    history: History,
    *,
    reconstruction: Literal["corrected", "consistent", "published"] | None = None,
    acceleration: Literal["closest", "rigid", "weak", "mixed"] | None = None,
    every: int | Literal["auto"] | None = None,
    threads: int | None = None,
    window: int | None = None,
    instants: int | ArrayLike | None = None,
    fields: bool = False,
    force: bool = False,
    progress: ProgressOption = None,
    _ablation: str = "none",
) -> Estimate:
    """Estimate the constitutive relation error of a history.

    Parameters
    ----------
    history : History
        The steps; at least two instants.
    reconstruction : {"corrected", "consistent", "published"}, optional
        How reactions become admissible contact forces: all of them, those before contact included; on the edges that touch
        throughout a step, statically equivalent; or by the paper's construction, eq. [45] to [50]. By default what the
        history's file or case states, else "corrected".
    acceleration : {"closest", "rigid", "weak", "mixed"}, optional
        The field that balances the tractions of an element: the one closest to the finite-element one, a rigid motion,
        the linear one that does the lumped work, or the closest one for tractions that balance less of the lumped mass,
        which needs the reconstruction "corrected". By default as stated, else "mixed" for plane bodies with "corrected"
        and "closest" for all others.
    every : int or "auto", optional
        The error is sampled at every so many steps, and at the end; or, with "auto", around onset, release and peaks of the contact
        force, at the ``instants`` of maps, and between them as sparsely as keeps the mean: at every step on small meshes. By default
        as stated, else "auto".
    threads : int, optional
        How many threads to use, at most 1024; one for each core by default. The result does not depend on it.
    window : int, optional
        How many sampled steps are worked on at once, at most 8 (the default). The result does not depend on it.
    instants : int or (n,) floats, optional
        Number of evenly spaced instants, or times (s), at which ``maps`` are kept: at the nearest steps. None by default.
    fields : bool, default: False
        Whether these hold the admissible fields too; it needs ``instants``.
    force : bool, default: False
        Whether a history of another program is estimated even if it contradicts itself or its problem.
    progress : bool or callable, optional
        As for `simulate`.

    Returns
    -------
    Estimate

    Warns
    -----
    InputWarning
        The last instant of a history of another program is left out, because its contact forces are not known. Or it has samples
        that are farther apart than the steps of a solver.

    Raises
    ------
    InputError
        An argument is wrong. Or a history of another program is not consistent; the message has the likely cause.
    EstimateError
        The history cannot be estimated: fewer than two instants, or steps that do not fit the problem.
    StorageError
        The temporary file of a long flight cannot be written: no space in the folder ``TMPDIR`` or in ``/var/tmp``.
    """
    stated = instance("history", history, History)._data.options()
    options = (
        stated[0] if reconstruction is None else text("reconstruction", reconstruction),
        stated[1] if acceleration is None else text("acceleration", acceleration),
        # The default without one of its parts, for the evidence on each part.
        text("_ablation", _ablation),
        stated[2] if every is None else _sampling(every),
    )
    work = pace(threads, window)
    wanted = _wanted(instants, history)
    if flag("fields", fields) and wanted is None:
        raise InputError("`fields` needs `instants`: give the number of instants, or their times (s)")
    accept = flag("force", force)
    with shown(progress) as tell:
        data = _percute.estimate(history._data, *options, *work, wanted, bool(fields), accept, tell)
    warn(data.notices())
    return Estimate._of(data, history, history._name)


def _sampling(every: object) -> int | str:
    """Check at which steps the error is sampled."""
    if isinstance(every, str):
        if every != "auto":
            raise wrong("every", every, '"auto" or a whole number')
        return every
    return whole("every", every)


def pace(threads: int | None, window: int | None) -> tuple[int | None, int | None]:
    """Check threads and window."""
    return (
        None if threads is None else whole("threads", threads, most=_percute.MOST_THREADS),
        None if window is None else whole("window", window),
    )


def _wanted(instants: int | ArrayLike | None, history: History) -> int | list[float] | None:
    """Give the number of instants, or their times (s). A time may exceed the end by the digits lost in printing only."""
    if instants is None:
        return None
    if isinstance(instants, int | np.integer):
        return whole("instants", instants)
    times = np.atleast_1d(numbers("instants", instants, most=1))
    if len(times) == 0 or not np.all(np.isfinite(times) & (times >= 0)):
        raise wrong("instants", instants, "a number of instants, or at least one time (s), finite and not negative")
    end = float(history._data.times[-1])
    if np.max(times) > end * (1 + 1e-3):
        raise InputError(f"`instants` holds {np.max(times):g} s, but the run ends at {end:g} s; give instants before that, in seconds")
    return cast("list[float]", times.tolist())
