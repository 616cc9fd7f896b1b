"""The values of an estimate, over elements and over time."""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import cached_property
from types import MappingProxyType
from typing import Any, Literal, Self, cast

import numpy as np
from numpy.typing import NDArray

from percute import _percute
from percute.checks import whole
from percute.contact import Contact
from percute.deformation import ContactPeak, Deformation, ElasticMargin, Nearest, PoorElement
from percute.documents import optional, records
from percute.history import History
from percute.immutable import Immutable
from percute.impacts import Impacts, NonMatchingEstimate
from percute.mesh import Mesh
from percute.problem import Problem
from percute.rebound import Rebound
from percute.records import ElementMap, OverTime, Parts, Separation, Sources, SourcesOverTime, WorstElement
from percute.stored import StoredEstimate
from percute.words import counted

__all__ = ["ErrorResults"]


def _measure(name: str, meaning: str) -> cached_property[float]:
    """Make a property of an estimate from one of its measures."""
    made: cached_property[float] = cached_property(lambda estimate: estimate._measures[name])
    made.__doc__ = meaning
    return made


class ErrorResults(Immutable):
    """What a `percute.Estimate` holds."""

    _data: _percute.EstimateData | StoredEstimate
    _history: History | None
    _named: str

    def __init__(self) -> None:
        raise TypeError("estimates are made by percute.estimate, percute.run and percute.open")

    @classmethod
    def _of(cls, data: _percute.EstimateData | StoredEstimate, history: History | None, name: str) -> Self:
        made = cls.__new__(cls)
        made._data = data
        made._history = history
        made._named = name
        return made

    @property
    def _name(self) -> str:
        """The name of the case or history; that of a file into which the history was saved later."""
        return self._named or ("" if self._history is None else self._history._name)

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
    mean_from_touch = _measure("mean_from_touch", "The same mean from the first touch on (J^½); from the start without contact.")
    energy = _measure("energy", "Largest energy of deformation and vibration (J): strain energy plus kinetic energy relative to the rigid motion of each body.")
    strain_energy = _measure("strain_energy", "Largest strain energy (J).")
    kinetic_energy = _measure("kinetic_energy", "Largest kinetic energy relative to the rigid motion of each body (J).")
    relative_sup = _measure("relative_sup", "``sup`` over √``energy``.")
    relative_mean = _measure("relative_mean", "``mean_from_touch`` over √``energy``.")
    relative_stress_sup = _measure("relative_stress_sup", "Error of the stresses: √sup of the elastic part of η over √``strain_energy``.")
    relative_stress_mean = _measure("relative_stress_mean", "The same with the mean from the first touch on.")
    relative_velocity_sup = _measure("relative_velocity_sup", "Error of the velocities: √sup of the kinetic part of η over √``kinetic_energy``.")
    relative_velocity_mean = _measure("relative_velocity_mean", "The same with the mean from the first touch on.")
    published_relative_sup = _measure("published_relative_sup", "``sup`` over ``reference_sup``, eq. [22].")
    published_relative_mean = _measure("published_relative_mean", "``mean`` over ``reference_mean``.")
    reference_sup = _measure("reference_sup", "D = √(sup d) (J^½), eq. [23].")
    reference_mean = _measure("reference_mean", "√((1/T)∫d dt) (J^½).")
    time_of_sup = _measure("time_of_sup", "Time of the largest η (s).")

    @property
    def steps(self) -> int:
        """The last step that was estimated."""
        return self._measures["steps"]

    end = _measure("end", "Its time T (s).")

    @property
    def per_metre(self) -> bool:
        """Whether forces and energies are per metre of thickness; errors are then in (J/m)^½."""
        return bool((self._verdict.get("problem") or {}).get("per_metre", False))

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
        """Situation and effectivity index in tests of such cases, place of the error, and a recommendation.

        It begins with whether nothing touched, and ends with elements to repair and with stress beyond the linear law, if there are any. None if the estimate comes from a file of an earlier version.
        """
        verdict = self._verdict.get("verdict")
        return None if verdict is None else " ".join(verdict["text"])

    @property
    def trust(self) -> Literal["high", "limited", "low"] | None:
        """How far the estimate can be trusted; None if it comes from a file of an earlier version."""
        verdict = self._verdict.get("verdict")
        return None if verdict is None else cast("Literal['high', 'limited', 'low']", verdict["trust"])

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """All warnings about the problem, the simulation and the estimate, as ``percute run`` prints them."""
        return tuple(each["message"] for each in self._verdict.get("warnings", ()))

    @cached_property
    def rebound(self) -> Rebound | None:
        """Velocities before and after contact, restitution and time in contact; None without contact."""
        return Rebound._of(self._verdict.get("rebound"))

    @cached_property
    def impacts(self) -> Impacts | None:
        """Velocities of several bodies before and after contact, and restitution at each interface; None of a single body."""
        return Impacts._of(self._verdict.get("impacts"))

    @cached_property
    def deformation(self) -> Deformation | None:
        """The largest strains, rotations and stresses; None if the estimate comes from a file of an earlier version."""
        return optional(Deformation, self._verdict.get("deformation"))

    @cached_property
    def elastic_margin(self) -> ElasticMargin | None:
        """How near the body is to yielding; None without a yield stress, where all such materials yield, and from a file of an earlier version."""
        return optional(ElasticMargin, (self._verdict.get("verdict") or {}).get("elastic_margin"))

    @cached_property
    def contact_peak(self) -> ContactPeak | None:
        """The largest contact force and pressure, averaged over the time in which a wave crosses the struck element; None without contact."""
        return optional(ContactPeak, (self._verdict.get("contact") or {}).get("averaged_peak"))

    @cached_property
    def poor_elements(self) -> tuple[PoorElement, ...]:
        """The elements to repair, with the largest parts of the error first; empty where bad shapes do not matter."""
        return records(PoorElement, (self._verdict.get("verdict") or {}).get("poor_elements", ()))

    @cached_property
    def nearest(self) -> Nearest | None:
        """The gap that is left if nothing touched, although there is a plane or another body; else None."""
        return optional(Nearest, (self._verdict.get("contact") or {}).get("nearest"))

    @cached_property
    def non_matching(self) -> tuple[NonMatchingEstimate, ...]:
        """The estimate at non-matching interfaces, in the order of ``problem.contacts``; empty without any."""
        return records(NonMatchingEstimate, ({"couple": None, **each} for each in self._verdict.get("non_matching", ())))

    @property
    def impulse_ratio(self) -> float | None:
        """Normal impulse of the admissible contact force over that of the simulation; None without contact."""
        return self._measures["impulse_ratio"]

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
            halved_elements=Sources(*found["halved_elements"]),
            halved_step=found["halved_step"],
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
        """Contact results from the history or the file; None after unpickling, or if the file has none: `no_contact` tells why."""
        if self._history is not None:
            return self._history.contact
        if not isinstance(self._data, StoredEstimate):
            return None
        found = self._data.contact()
        return None if found is None else Contact._of(found, self.mesh, self._data.surfaces(), self.per_metre)

    @property
    def no_contact(self) -> str | None:
        """Why `contact` is None; None if it is not."""
        if self.contact is not None:
            return None
        if isinstance(self._data, StoredEstimate):
            return "the file has no contact results: nothing could touch, or the estimate had been unpickled without its history"
        return "the estimate was unpickled without its history, which has the contact results; pickle both, or save the estimate to a file"

    @property
    def supplied(self) -> Mapping[str, bool]:
        """Whether the history has its own ``velocity`` and ``acceleration``; otherwise they follow from the scheme."""
        return MappingProxyType(dict(zip(("velocity", "acceleration"), self._data.supplied(), strict=True)))

    @cached_property
    def consistency(self) -> Mapping[str, float | None] | None:
        """How consistent a history of another program is: the figures of ``docs/foreign.md``; None for percute's own."""
        found = json.loads(self.to_json()).get("consistency")
        return None if found is None else MappingProxyType(found)

    @property
    def options(self) -> Mapping[str, str | int]:
        """The options ``reconstruction``, ``acceleration`` and ``every`` of the estimate."""
        return MappingProxyType(dict(zip(("reconstruction", "acceleration", "every"), self._data.options(), strict=True)))

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

    def __repr__(self) -> str:
        norm = _percute.unit("J^½", self.per_metre)
        return (
            f"<percute.Estimate: sup {self.sup:.4g} {norm} ({self.relative_sup:.3%}) at {self.time_of_sup:.4g} s, "
            f"mean {self.mean_from_touch:.4g} {norm} ({self.relative_mean:.3%}), {counted(len(self.by_element), 'element')}, {counted(self.steps, 'step')}>"
        )

    def __str__(self) -> str:
        verdict = [] if self.verdict is None else [f"trust {self.trust}: {self.verdict}"]
        warnings = [f"warning: {each}" for each in self.warnings]
        return "\n".join([repr(self).strip("<>"), *warnings, *verdict, self.meaning])

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle all but the history, which is large and can be pickled separately."""
        data = self._data
        if isinstance(data, StoredEstimate):
            return self._reopen, (data.path,)
        return self._restore, (self.problem, data.state(self._name), self._name)

    @classmethod
    def _reopen(cls, path: str) -> Self:
        return cls._of(StoredEstimate(path), None, path)

    @classmethod
    def _restore(cls, problem: Problem, state: bytes, name: str) -> Self:
        restored = cls._of(_percute.EstimateData.restore(problem._data, state), None, name)
        restored.__dict__["problem"] = problem
        return restored
