"""The extension module: what the package is made of. Use the package."""

from collections.abc import Callable, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, Final, TypedDict, final

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "CaseData",
    "EstimateData",
    "EstimateFileData",
    "ExactData",
    "HistoryData",
    "MOST_LEVELS",
    "MOST_THREADS",
    "MeshData",
    "ProblemData",
    "Progress",
    "SERIES",
    "SweepPlan",
    "__version__",
    "check_run",
    "close_files",
    "colour_scale",
    "command",
    "deformed_outline",
    "element_field",
    "errors_against_history",
    "errors_against_simulation",
    "estimate",
    "export",
    "hint",
    "is_estimate",
    "meaning",
    "open_history",
    "plausibility_warnings",
    "present",
    "present_file",
    "rebound_end",
    "resume",
    "run_case",
    "simulate",
    "stranger",
    "sweep_case",
    "true_error_of_bar_impact",
    "verification",
]

MOST_LEVELS: int
MOST_THREADS: int
SERIES: list[str]
__version__: str

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]
_Tell = Callable[[Progress], object] | None
_Times = tuple[float | None, float | None, float | None, Sequence[float] | None]
_Kept = tuple[int | None, Sequence[float] | None, Sequence[str] | None]
_TrueError = tuple[float, float, dict[str, _Floats]]

class _Measures(TypedDict):
    sup: float
    mean: float
    relative_sup: float
    relative_mean: float
    reference_sup: float
    reference_mean: float
    time_of_sup: float
    steps: int
    end: float
    kept_impulse: float | None

class _Outputs(TypedDict):
    history: Path | None
    estimate: Path | None
    instants: int | list[float]
    fields: bool

@final
class Progress:
    def __new__(cls, stage: str, done: int, total: int) -> Progress: ...
    stage: Final[str]
    done: Final[int]
    total: Final[int]

@final
class MeshData:
    @staticmethod
    def rectangle(width: float, height: float, nx: int, ny: int) -> MeshData: ...
    @staticmethod
    def disc(radius: float, rings: int) -> MeshData: ...
    @staticmethod
    def bar(length: float, elements: int) -> MeshData: ...
    def refined(self, times: int) -> MeshData: ...
    def refined_where(self, chosen: list[bool]) -> MeshData: ...
    @staticmethod
    def from_arrays(points: _Floats, cells: _Integers, edge_groups: dict[str, _Integers], element_groups: dict[str, _Integers]) -> MeshData: ...
    @staticmethod
    def read(path: str | PathLike[str], scale: float) -> MeshData: ...
    def write(self, path: str | PathLike[str], old: bool, binary: bool, overwrite: bool) -> None: ...
    def import_warnings(self) -> list[str]: ...
    dimension: Final[int]
    points: Final[_Floats]
    cells: Final[NDArray[np.uint32]]
    edge_groups: Final[dict[str, _Integers]]
    element_groups: Final[dict[str, _Integers]]
    size: Final[float]
    reoriented_elements: Final[int]

@final
class ProblemData:
    def __new__(
        cls,
        mesh: MeshData,
        materials: Sequence[tuple[str | None, object]],
        obstacles: Sequence[object],
        supports: Sequence[object],
        tractions: Sequence[object],
        body_forces: Sequence[object],
        velocity: _Floats | None,
        displacement: _Floats | None,
    ) -> ProblemData: ...
    def mesh(self) -> MeshData: ...
    critical_time_step: Final[float]
    mass: Final[_Floats]
    initial_displacement: Final[_Floats]
    initial_velocity: Final[_Floats]
    contact_nodes: Final[_Integers]
    wave_speed: Final[float]
    def stiffness(self) -> list[_Floats]: ...
    def materials(self) -> list[tuple[str | None, dict[str, Any]]]: ...
    def obstacles(self) -> list[dict[str, Any]]: ...
    def supports(self) -> list[dict[str, Any]]: ...
    def tractions(self) -> list[dict[str, Any]]: ...
    def body_forces(self) -> list[dict[str, Any]]: ...

@final
class HistoryData:
    @staticmethod
    def from_arrays(
        problem: ProblemData,
        times: Sequence[float],
        displacement: _Floats,
        reaction: _Floats,
        touching: NDArray[np.bool_],
        options: tuple[str, str | None, int | str],
        motion: tuple[_Floats | None, _Floats | None],
        derived: Sequence[str] | None,
    ) -> HistoryData: ...
    @staticmethod
    def foreign(
        problem: ProblemData,
        times: Sequence[float],
        displacement: _Floats,
        reaction: _Floats | None,
        touching: NDArray[np.bool_] | None,
        velocity: _Floats | None,
        acceleration: _Floats | None,
    ) -> tuple[HistoryData, str | None]: ...
    derived: Final[list[str] | None]
    given: Final[list[bool]]
    problem: Final[ProblemData]
    times: Final[_Floats]
    count: Final[int]
    complete: Final[bool]
    def options(self) -> tuple[str, str | None, int | str]: ...
    contact_nodes: Final[_Integers]
    path: Final[Path | None]
    def arrays(self) -> list[tuple[str, list[int], int]]: ...
    def displacement(self) -> _Floats: ...
    def reaction(self) -> _Floats: ...
    def touching(self) -> NDArray[np.bool_]: ...
    def steps(self) -> _Integers | None: ...
    def lacks(self) -> list[str]: ...
    def stored_motion(self, acceleration: bool) -> _Floats: ...
    def motion(self) -> list[_Floats]: ...
    def contact(self) -> dict[str, Any]: ...
    def balance(self) -> dict[str, _Floats]: ...
    def rebound(self) -> str: ...

@final
class EstimateData:
    @staticmethod
    def restore(problem: ProblemData, state: bytes) -> EstimateData: ...
    def state(self, name: str) -> bytes: ...
    def problem(self) -> ProblemData: ...
    def measures(self) -> _Measures: ...
    def parts(self) -> tuple[float, float, float]: ...
    def over_time(self) -> dict[str, _Floats]: ...
    def sources(self) -> dict[str, Any] | None: ...
    def by_element(self) -> _Floats: ...
    def residuals(self) -> dict[str, float]: ...
    def given(self) -> tuple[bool, bool]: ...
    def warnings(self, options: bool, input: bool) -> list[tuple[str, bool]]: ...
    def options(self) -> tuple[str, str, int | str]: ...
    def worst_elements(self, count: int) -> list[tuple[int, float]]: ...
    def maps(self) -> list[dict[str, Any]]: ...
    def verdict(self) -> str: ...
    def to_json(self, name: str) -> str: ...
    def save(self, path: str | PathLike[str], overwrite: bool, name: str, history: HistoryData | None) -> None: ...

@final
class EstimateFileData:
    def __new__(cls, path: str | PathLike[str]) -> EstimateFileData: ...
    def mesh(self) -> MeshData: ...
    def report(self) -> str: ...
    def over_time(self) -> dict[str, _Floats]: ...
    def by_element(self) -> _Floats: ...
    def contact(self) -> dict[str, Any] | None: ...
    def maps(self) -> tuple[list[float], dict[str, _Floats]]: ...

@final
class CaseData:
    def __new__(cls, name: str, text: str, folder: str | PathLike[str]) -> CaseData: ...
    def resolved(self, progress: _Tell) -> tuple[CaseData, str | None]: ...
    def check_run(self, long: bool) -> None: ...
    def plausibility_warnings(self, in_memory: bool) -> list[str]: ...
    def import_warnings(self) -> list[str]: ...
    def outputs(self, case: str | PathLike[str] | None, store: str | PathLike[str] | None, overwrite: bool) -> _Outputs: ...

@final
class ExactData:
    @staticmethod
    def bar_impact(values: Sequence[float]) -> ExactData: ...
    @staticmethod
    def bouncing_bar(values: Sequence[float]) -> ExactData | None: ...
    @staticmethod
    def clamped_rod(values: Sequence[float]) -> ExactData: ...
    @staticmethod
    def bar_mode(values: Sequence[float], number: int, fixed: str) -> ExactData | None: ...
    @staticmethod
    def bar_ramp(values: Sequence[float]) -> ExactData: ...
    @staticmethod
    def block_mode(values: Sequence[float], numbers: Sequence[int], across: bool) -> ExactData: ...
    @staticmethod
    def rigid_slide(mass: float, limit: float, push: Sequence[tuple[float, float]]) -> ExactData | None: ...
    constants: Final[dict[str, float]]
    def evaluate(self, name: str, rows: _Floats) -> _Floats: ...

def command(arguments: Sequence[str], itself: Sequence[str]) -> int: ...
def element_field(problem: ProblemData, quantity: str, nodal: _Floats) -> _Floats: ...
def hint(given: str, known: Sequence[str]) -> str: ...
def close_files() -> None: ...
def check_run(problem: ProblemData, times: _Times, long: bool) -> None: ...
def meaning() -> str: ...
def rebound_end(
    problem: ProblemData,
    pace: tuple[float | None, float | None],
    longest: float,
    after: float | None,
    progress: _Tell,
) -> tuple[float, str | None]: ...
def stranger(file: str | PathLike[str], content: bytes) -> str | None: ...
def verification(
    problem: ProblemData,
    times: _Times,
    levels: int,
    stated: tuple[str, str | None, int | str],
    threads: int | None,
    long: bool,
    tell: Callable[[str], object] | None,
    progress: _Tell,
) -> tuple[str, str]: ...
def plausibility_warnings(
    problem: ProblemData,
    times: _Times,
    in_memory: bool,
) -> list[str]: ...
def simulate(
    problem: ProblemData,
    times: _Times,
    store: str | PathLike[str] | None,
    keep: _Kept,
    overwrite: bool,
    progress: _Tell,
) -> tuple[HistoryData, str | None]: ...
def run_case(
    case: CaseData,
    store: str | PathLike[str] | None,
    overwrite: bool,
    pace: tuple[int | None, int | None],
    instants: int | Sequence[float] | None,
    fields: bool,
    contact_steps: bool,
    progress: _Tell,
) -> tuple[HistoryData, EstimateData]: ...
def colour_scale(values: _Floats, count: int) -> tuple[float, float, bool, list[tuple[float, str]]]: ...
def deformed_outline(mesh: MeshData, report: str) -> tuple[list[list[list[float]]], str] | None: ...
def present(estimate: EstimateData, page: bool, path: str | PathLike[str], overwrite: bool, name: str, history: HistoryData | None) -> None: ...
def present_file(estimate: str | PathLike[str], page: bool, path: str | PathLike[str], overwrite: bool) -> None: ...
def export(
    history: HistoryData,
    path: str | PathLike[str],
    choice: tuple[Sequence[int] | None, int | None, Sequence[float] | None],
    fields: Sequence[str] | None,
    error: Sequence[float] | None,
    inputs: Sequence[str | PathLike[str]],
    overwrite: bool,
    progress: _Tell,
) -> list[Path]: ...
def is_estimate(path: str | PathLike[str]) -> bool: ...
def open_history(path: str | PathLike[str]) -> HistoryData: ...
def resume(path: str | PathLike[str], progress: _Tell) -> tuple[HistoryData, str | None]: ...
def errors_against_history(histories: Sequence[HistoryData], reference: HistoryData) -> list[_TrueError]: ...
def errors_against_simulation(histories: Sequence[HistoryData], problem: ProblemData, times: _Times, progress: _Tell) -> list[_TrueError]: ...
def estimate(
    history: HistoryData,
    reconstruction: str,
    acceleration: str | None,
    ablation: str,
    every: int | str,
    threads: int | None,
    window: int | None,
    instants: int | Sequence[float] | None,
    fields: bool,
    accept: bool,
    progress: _Tell,
) -> EstimateData: ...
def true_error_of_bar_impact(values: Sequence[float], history: HistoryData) -> _TrueError: ...

_Way = tuple[Sequence[str], int | None, int, bool, bool]

@final
class SweepPlan:
    def __new__(cls, case: str, folder: str, parts: Sequence[tuple[Sequence[str], str]], long: bool) -> SweepPlan: ...
    def cases(self) -> list[tuple[str, str]]: ...
    def run(self, names: Sequence[str], way: _Way, progress: _Tell) -> tuple[list[int], list[tuple[str, str]]]: ...
    def columns(self) -> list[tuple[str, str, str]]: ...
    def write(self) -> Path: ...

def sweep_case(folder: str, name: str, text: str, way: _Way) -> tuple[list[int], list[tuple[str, str]]]: ...
