"""Estimates read from files, as ``docs/estimate.md`` lays them out."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from percute.errors import FileFormatError, MissingFileError, StorageError
from percute.mesh import Mesh

__all__ = ["StoredEstimate"]

PARTS = ("kinetic", "elastic", "contact")
MEASURES = ("sup", "mean", "relative_sup", "relative_mean", "reference_sup", "reference_mean")


CODES = {"%25": "%", "%2F": "/", "%00": "\0", "%2E": "."}


def _group(link: str) -> str:
    """Give the name of a group of a link, as ``docs/history.md`` codes it."""
    return "" if link == "%" else re.sub("%(25|2F|00|2E)", lambda code: CODES[code[0]], link)


@contextmanager
def _file(path: str) -> Iterator[Any]:
    """Open a file; what it lacks is an error of the file."""
    # Few need it, and it takes as long to import as all of percute.
    import h5py

    try:
        with h5py.File(path) as file:
            yield file
    except FileNotFoundError:
        raise MissingFileError(f"{path}: there is no such file") from None
    except OSError as error:
        raise StorageError(f"{path}: cannot be read: {error}") from error
    except (AttributeError, KeyError, IndexError, TypeError, ValueError) as error:
        raise FileFormatError(f"{path}: the file is damaged, or not as docs/estimate.md lays it out: {error}") from error


def _whole(group: Any, name: str, *shape: int) -> NDArray[Any]:
    """Read a data set that has as many numbers as it must, in this shape."""
    data = group[name]
    if data.size != math.prod(shape):
        raise ValueError(f"{data.name} has the shape {data.shape}; it must have {shape}")
    array: NDArray[Any] = data[()].reshape(shape)
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
            self.dimension = int(file["percute"].attrs["dimension"])
            self.elements = file["VTKHDF/CellData/by_element"].size
            self.nodes = file["VTKHDF/Points"].shape[0]
            if self.nodes > self.elements * (self.dimension + 1):
                raise ValueError(f"{self.nodes} nodes are more than {self.elements} elements have")
            # What the report lacks is told here, not when it is looked for.
            for each in (self.measures, self.parts, self.residuals, self.given, self.options):
                each()

    @cached_property
    def mesh(self) -> Mesh:
        """The mesh."""
        with _file(self.path) as file:
            grid, own = file["VTKHDF"], file["percute"]
            cells = _whole(grid, "Connectivity", self.elements, self.dimension + 1)
            points = _whole(grid, "Points", self.nodes, 3)[:, : self.dimension]
            groups = {_group(link): rows[()] for link, rows in own.get("facet_groups", {}).items()}
            elements = {_group(link): numbers[()] for link, numbers in own.get("element_groups", {}).items()}
            # An InputError is a ValueError: a mesh that makes no sense is an error of the file, too.
            return Mesh(points, cells, groups, elements)

    def measures(self) -> dict[str, Any]:
        """Single numbers."""
        report, kept = self.report, self.report["kept_impulse"]
        single: dict[str, Any] = {name: float(report[name]) for name in ("time_of_sup", "end")}
        single["steps"] = int(report["steps"])
        single["kept_impulse"] = None if kept is None else float(kept)
        return {name: float(report["error"][name]) for name in MEASURES} | single

    def parts(self) -> tuple[float, float, float]:
        """Parts of η at the time of the sup (J)."""
        kinetic, elastic, contact = (float(self.report["parts"][name]) for name in PARTS)
        return kinetic, elastic, contact

    def over_time(self) -> dict[str, NDArray[np.float64]]:
        """η, its parts and d at all samples."""
        with _file(self.path) as file:
            columns = file["percute/over_time"]
            samples = columns["time"].size
            return {name: _whole(columns, name, samples) for name in ("time", *PARTS, "total", "reference")}

    def by_element(self) -> NDArray[np.float64]:
        """e_E (J^½)."""
        with _file(self.path) as file:
            return _whole(file, "VTKHDF/CellData/by_element", self.elements)

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
            count, d, elements, nodes = len(times), self.dimension, self.elements, self.nodes
            cells = grid["CellData"]
            columns = {name: _whole(cells, name, count, elements) for name in (*PARTS, "total")}
            columns["error"] = _whole(cells, "accumulated", count, elements)
            if "admissible_stress" in cells:
                points = grid["PointData"]
                columns["displacement"] = _whole(points, "admissible_displacement", count, nodes, 3)[..., :d]
                columns["velocity"] = _whole(points, "admissible_velocity", count, nodes, 3)[..., :d]
                columns["acceleration"] = _whole(cells, "admissible_acceleration", count, elements, 3)[..., :d]
                columns["stress"] = _whole(cells, "admissible_stress", count, elements, d, d)
                columns["compatible_stress"] = _whole(cells, "compatible_stress", count, elements, d, d)
        return [
            {"time": float(time), **{name: column[i] for name, column in columns.items()}}
            for i, time in enumerate(times)
        ]

    def to_json(self, name: str) -> str:
        """The document as it is in the file."""
        return self.text
