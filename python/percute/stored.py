"""Estimates read from files, as ``docs/estimate.md`` lays them out."""

from __future__ import annotations

import json
import math
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from percute import _percute
from percute.errors import FileFormatError
from percute.mesh import Mesh

MEASURES = (
    "sup", "mean", "mean_from_touch", "energy", "strain_energy", "kinetic_energy", "relative_sup", "relative_mean",
    "relative_stress_sup", "relative_stress_mean", "relative_velocity_sup", "relative_velocity_mean",
    "published_relative_sup", "published_relative_mean", "reference_sup", "reference_mean",
)  # fmt: skip
SOURCES = ("surface", "front", "dispersion", "mesh")
FIELDS = {
    "accumulated": "error",
    "admissible_displacement": "displacement",
    "admissible_velocity": "velocity",
    "admissible_acceleration": "acceleration",
    "admissible_stress": "stress",
    "compatible_stress": "compatible_stress",
}
"""Data sets, and their names here."""


class _Report:
    """The report in a file; a missing part is an error."""

    def __init__(self, path: str, text: str) -> None:
        self.path = path
        try:
            self.document = json.loads(text)
        except (ValueError, RecursionError) as error:
            raise FileFormatError(f"{path}: `percute/report` is no JSON: {error}") from None

    def part(self, *keys: str) -> Any:
        value = self.document
        for key in keys:
            if not isinstance(value, dict) or key not in value:
                raise self.wrong(keys, "is missing")
            value = value[key]
        return value

    def wrong(self, keys: tuple[str, ...], what: str) -> FileFormatError:
        return FileFormatError(f"{self.path}: `percute/report`: the key {'.'.join(keys)!r} {what}")

    def number(self, *keys: str) -> float:
        value = self.part(*keys)
        if value is None:  # JSON has neither infinity nor NaN.
            return math.nan
        if type(value) not in (int, float) or abs(value) > 1e308:
            raise self.wrong(keys, "must be a number")
        return float(value)

    def of(self, kind: type, *keys: str) -> Any:
        value = self.part(*keys)
        if type(value) is not kind:
            raise self.wrong(keys, f"must be of the JSON type that Python calls {kind.__name__}")
        return value


class StoredEstimate:
    """The contents of a file, with the interface of `percute._percute.EstimateData`. All is checked at once; the maps are read later."""

    def __init__(self, path: str) -> None:
        self.path = path
        self._data = _percute.EstimateFileData(path)
        report = _Report(path, self._data.report())
        self._measures = self._read_measures(report)
        self._measures |= {name: report.number(name) for name in ("time_of_sup", "end")}
        self._measures["steps"] = report.of(int, "steps")
        none = report.part("impulse_ratio") is None
        self._measures["impulse_ratio"] = None if none else report.number("impulse_ratio")
        kinetic, elastic, dissipation, contact = (report.number("parts", name) for name in ("kinetic", "elastic", "dissipation", "contact"))
        self._parts = kinetic, elastic, dissipation, contact
        self._sources = self._read_sources(report)
        self._residuals = {name: report.number("residuals", name) for name in report.of(dict, "residuals")}
        self._supplied: tuple[bool, bool] = report.of(bool, "supplied", "velocity"), report.of(bool, "supplied", "acceleration")
        every = report.part("options", "every")
        if type(every) is not int and every != "auto":
            raise report.wrong(("options", "every"), 'must be a whole number or "auto"')
        self._options = report.of(str, "options", "reconstruction"), report.of(str, "options", "acceleration"), every

    @staticmethod
    def _read_measures(report: _Report) -> dict[str, Any]:
        """Read them; up to format 2, files have the published relative errors alone, under other names."""
        if report.number("format") >= 3:
            return {name: report.number("error", name) for name in MEASURES}
        published = {f"published_relative_{which}": report.number("error", f"relative_{which}") for which in ("sup", "mean")}
        kept = {name: report.number("error", name) for name in ("sup", "mean", "reference_sup", "reference_mean")}
        return dict.fromkeys(MEASURES, math.nan) | published | kept

    @staticmethod
    def _read_sources(report: _Report) -> dict[str, Any] | None:
        """Read them; files of earlier versions have none."""
        if report.document.get("sources") is None:
            return None
        sources: dict[str, Any] = {key: [report.number("sources", key, name) for name in SOURCES] for key in ("at_sup", "mean", "halved_elements")}
        sources["halved_step"] = report.number("sources", "halved_step")
        columns = {name: report.of(list, "sources", "over_time", name) for name in SOURCES}
        # JSON has neither infinity nor NaN.
        sources["over_time"] = {name: np.array([math.nan if x is None else x for x in column], np.float64) for name, column in columns.items()}
        return sources

    @cached_property
    def mesh(self) -> Mesh:
        """The mesh."""
        return Mesh._of(self._data.mesh())

    def measures(self) -> dict[str, Any]:
        """Single numbers."""
        return self._measures

    def parts(self) -> tuple[float, float, float, float]:
        """Parts of η at the time of the sup (J)."""
        return self._parts

    def over_time(self) -> dict[str, NDArray[np.float64]]:
        """η, its parts and d at all samples."""
        return self._data.over_time()

    def sources(self) -> dict[str, Any] | None:
        """The sources of η; None if the file has none."""
        return self._sources

    def by_element(self) -> NDArray[np.float64]:
        """e_E (J^½)."""
        return self._data.by_element()

    def residuals(self) -> dict[str, float]:
        """Largest residuals."""
        return self._residuals

    def supplied(self) -> tuple[bool, bool]:
        """Whether the history had its own velocities and accelerations."""
        return self._supplied

    def options(self) -> tuple[str, str, int | str]:
        """Its options."""
        options: tuple[str, str, int | str] = self._options
        return options

    def worst_elements(self, count: int) -> list[tuple[int, float]]:
        """The largest contributions of elements, largest first; equal ones by element number."""
        errors = self.by_element()
        order = np.argsort(-errors, kind="stable")[:count]
        return [(int(element), float(errors[element])) for element in order]

    def maps(self) -> list[dict[str, Any]]:
        """Contributions of the elements at the instants of the file."""
        times, columns = self._data.maps()
        d = self.mesh.dimension
        found = {}
        for name, column in columns.items():
            if name.endswith("stress"):
                column = column.reshape(*column.shape[:2], d, d)
            elif name.startswith("admissible"):
                column = column[..., :d]
            found[FIELDS.get(name, name)] = column
        return [{"time": time, **{name: column[i] for name, column in found.items()}} for i, time in enumerate(times)]

    def contact(self) -> dict[str, Any] | None:
        """Contact results, if the file has them."""
        return self._data.contact()

    def surfaces(self) -> list[str | None]:
        """The group of edges of each side of an interface of bodies; None for each plane."""
        obstacles = json.loads(self._data.report())["problem"]["obstacles"]
        return [each["group"] if each["point"] is None else None for each in obstacles]

    def verdict(self) -> str:
        """A JSON document with verdict and rebound, if the file has them."""
        return self._data.report()

    def to_json(self, name: str) -> str:
        """The document as it is in the file."""
        return self._data.report()
