"""Estimates read from files, as ``docs/estimate.md`` lays them out."""

from __future__ import annotations

import json
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from percute.mesh import Mesh

__all__ = ["StoredEstimate"]

PARTS = ("kinetic", "elastic", "contact")
MEASURES = ("sup", "mean", "relative_sup", "relative_mean", "reference_sup", "reference_mean")


def _file(path: str) -> Any:
    # Few need it, and it takes as long to import as all of percute.
    import h5py

    return h5py.File(path)


def _whole(group: Any, name: str, *shape: int) -> NDArray[Any]:
    array: NDArray[Any] = group[name][()].reshape(shape or (-1,))
    array.flags.writeable = False
    return array


class StoredEstimate:
    """What a file says, in the words of `percute._percute.EstimateData`; the file has been found whole."""

    def __init__(self, path: str) -> None:
        self.path = path
        with _file(path) as file:
            report = file["percute/report"].asstr()[()]
        self.text: str = report
        self.report: dict[str, Any] = json.loads(report)

    @cached_property
    def mesh(self) -> Mesh:
        """The mesh."""
        with _file(self.path) as file:
            grid, own = file["VTKHDF"], file["percute"]
            dimension = int(own.attrs["dimension"])
            cells = _whole(grid, "Connectivity", -1, dimension + 1)
            points = grid["Points"][:, :dimension]
            groups = {name: rows[()] for name, rows in own.get("facet_groups", {}).items()}
            elements = {name: numbers[()] for name, numbers in own.get("element_groups", {}).items()}
        return Mesh(points, cells, groups, elements)

    def measures(self) -> dict[str, Any]:
        """Single numbers."""
        single = {name: self.report[name] for name in ("time_of_sup", "steps", "end", "kept_impulse")}
        return {name: self.report["error"][name] for name in MEASURES} | single

    def parts(self) -> tuple[float, float, float]:
        """Parts of η at the time of the sup (J)."""
        kinetic, elastic, contact = (self.report["parts"][name] for name in PARTS)
        return kinetic, elastic, contact

    def over_time(self) -> dict[str, NDArray[np.float64]]:
        """η, its parts and d at all samples."""
        with _file(self.path) as file:
            columns = file["percute/over_time"]
            return {name: _whole(columns, name) for name in ("time", *PARTS, "total", "reference")}

    def by_element(self) -> NDArray[np.float64]:
        """e_E (J^½)."""
        with _file(self.path) as file:
            return _whole(file, "VTKHDF/CellData/by_element")

    def residuals(self) -> dict[str, float]:
        """Largest residuals."""
        residuals: dict[str, float] = self.report["residuals"]
        return residuals

    def given(self) -> tuple[bool, bool]:
        """Whether the history brought velocities, and accelerations."""
        return self.report["given"]["velocity"], self.report["given"]["acceleration"]

    def options(self) -> tuple[str, str, int]:
        """The choices it was made with."""
        options = self.report["options"]
        return options["contact_force"], options["acceleration"], options["every"]

    def worst_elements(self, count: int) -> list[tuple[int, float]]:
        """The elements that contribute most, largest first; of equal ones the one with the lower number."""
        errors = self.by_element()
        order = np.argsort(-errors, kind="stable")[:count]
        return [(int(element), float(errors[element])) for element in order]

    def maps(self) -> list[dict[str, Any]]:
        """What each element contributes at the instants of the file."""
        with _file(self.path) as file:
            grid = file["VTKHDF"]
            if "Steps" not in grid:
                return []
            times = grid["Steps/Values"][()]
            count, d = len(times), int(file["percute"].attrs["dimension"])
            cells = grid["CellData"]
            columns = {name: _whole(cells, name, count, -1) for name in (*PARTS, "total")}
            columns["error"] = _whole(cells, "accumulated", count, -1)
            if "admissible_stress" in cells:
                points = grid["PointData"]
                columns["displacement"] = _whole(points, "admissible_displacement", count, -1, 3)[..., :d]
                columns["velocity"] = _whole(points, "admissible_velocity", count, -1, 3)[..., :d]
                columns["acceleration"] = _whole(cells, "admissible_acceleration", count, -1, 3)[..., :d]
                columns["stress"] = _whole(cells, "admissible_stress", count, -1, d, d)
                columns["compatible_stress"] = _whole(cells, "compatible_stress", count, -1, d, d)
        return [
            {"time": float(time), **{name: column[i] for name, column in columns.items()}}
            for i, time in enumerate(times)
        ]

    def to_json(self, name: str) -> str:
        """The document as it is in the file."""
        return self.text
