"""Estimate files that are not as they must be, and names of groups as they are in links."""

import json
import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import percute as pc
import pytest

REPORT, CELLS, STEPS = "percute/report", "VTKHDF/CellData", "VTKHDF/Steps"
COLUMNS = [f"percute/over_time/{name}" for name in ("time", "kinetic", "elastic", "contact", "total", "reference")]
SINGLE = [f"{CELLS}/{name}" for name in ("kinetic", "elastic", "contact", "total", "accumulated")]
FIELDS = [
    "VTKHDF/PointData/admissible_displacement",
    "VTKHDF/PointData/admissible_velocity",
    f"{CELLS}/admissible_stress",
    f"{CELLS}/compatible_stress",
    f"{CELLS}/admissible_acceleration",
]
MESH = [f"VTKHDF/{name}" for name in ("Points", "Connectivity", "Offsets", "Types")]
NUMBERS = [*COLUMNS, *SINGLE, *FIELDS, *MESH, f"{CELLS}/by_element", f"{STEPS}/Values"]
OTHERWISE = {name: "`VTKHDF/" for name in MESH} | {"percute/over_time/time": "percute/over_time/kinetic"}

Change = Callable[[h5py.File], None]


@pytest.fixture(scope="module")
def good(tmp_path_factory: pytest.TempPathFactory, block_history: pc.History) -> Path:
    file = tmp_path_factory.mktemp("good") / "error.vtkhdf"
    pc.estimate(block_history, instants=3, fields=True).save(file)
    return file


def changed(good: Path, folder: Path, change: Change) -> Path:
    file = folder / "changed.vtkhdf"
    file.write_bytes(good.read_bytes())
    with h5py.File(file, "r+") as opened:
        change(opened)
    return file


def replaced(name: str, value: Callable[[Any], Any]) -> Change:
    def change(file: h5py.File) -> None:
        new = value(file[name][()])
        del file[name]
        file[name] = new

    return change


def removed(name: str) -> Change:
    """With the checksum of the names of its group, as by somebody who removes it on purpose."""

    def change(file: h5py.File) -> None:
        file[name].parent.attrs.pop("checksum", None)
        del file[name]

    return change


def hollow(name: str) -> Change:
    """A shape of half a terabyte or more, of which nothing is stored."""

    def change(file: h5py.File) -> None:
        shape, dtype = (2**36, *file[name].shape[1:]), file[name].dtype
        del file[name]
        file.create_dataset(name, shape, dtype, chunks=(1024, *shape[1:]))

    return change


def refused(file: Path, name: str) -> None:
    with pytest.raises(pc.FileFormatError, match=re.escape(name)) as raised:
        pc.open(file)
    assert str(file) in str(raised.value)


@pytest.mark.parametrize("name", NUMBERS)
@pytest.mark.parametrize("how", ["missing", "short", "long", "flat", "text", "hollow"])
def test_a_data_set_that_is_not_as_it_must_be(how: str, name: str, good: Path, tmp_path: Path) -> None:
    change = {
        "missing": removed(name),
        "short": replaced(name, lambda numbers: numbers[:-1]),
        "long": replaced(name, lambda numbers: np.concatenate([numbers, numbers[-1:]])),
        "flat": replaced(name, lambda numbers: numbers.reshape(1, -1) if numbers.ndim == 1 else numbers.ravel()),
        "text": replaced(name, lambda numbers: np.full(numbers.shape, b"x")),
        "hollow": hollow(name),
    }[how]
    file = changed(good, tmp_path, change)
    # Where two contradict each other, either may be the wrong one.
    refused(file, OTHERWISE.get(name, name) if how in ("short", "long") else name)


@pytest.mark.parametrize("text", [b"{", b"[]", b"7", b'"x"', b"{}", b"[" * 100_000, b"\xff", b"1" * 5000, b'{"error": 3}'])
def test_a_report_that_is_none(text: bytes, good: Path, tmp_path: Path) -> None:
    refused(changed(good, tmp_path, replaced(REPORT, lambda _: np.bytes_(text))), REPORT)


KEYS = [
    ("error", "sup"),
    ("parts", "elastic"),
    ("time_of_sup",),
    ("end",),
    ("steps",),
    ("impulse_ratio",),
    ("residuals",),
    ("supplied", "velocity"),
    ("options", "reconstruction"),
    ("options", "every"),
]


@pytest.mark.parametrize("keys", KEYS, ids=".".join)
@pytest.mark.parametrize("value", ["gone", [1], {}, True, 10**400])
def test_a_report_without_what_is_needed(value: object, keys: tuple[str, ...], good: Path, tmp_path: Path) -> None:
    if (value, keys) in (({}, ("residuals",)), (True, ("supplied", "velocity"))) or (value == 10**400 and keys[-1] in ("steps", "every")):
        pytest.skip("that is allowed there")

    def report(text: bytes) -> np.bytes_:
        document = whole = json.loads(text)
        for key in keys[:-1]:
            document = document[key]
        if value == "gone":
            del document[keys[-1]]
        else:
            document[keys[-1]] = value
        return np.bytes_(json.dumps(whole).encode())

    file = changed(good, tmp_path, replaced(REPORT, report))
    refused(file, REPORT)
    refused(file, repr(".".join(keys)))


def test_a_number_that_json_cannot_have(good: Path, tmp_path: Path) -> None:
    def report(text: bytes) -> np.bytes_:
        document = json.loads(text)
        document["error"]["relative_sup"] = None
        return np.bytes_(json.dumps(document).encode())

    assert math.isnan(pc.open(changed(good, tmp_path, replaced(REPORT, report))).relative_sup)  # type: ignore[union-attr]


def test_the_relative_error_of_earlier_versions_is_the_published_one(good: Path, tmp_path: Path) -> None:
    """Up to format 2, files have no energy of vibration: the other relative errors are missing, not zero."""

    def report(text: bytes) -> np.bytes_:
        document = json.loads(text)
        error = document["error"]
        earlier = {name: error[name] for name in ("sup", "mean", "reference_sup", "reference_mean")}
        document["error"] = earlier | {f"relative_{which}": error[f"published_relative_{which}"] for which in ("sup", "mean")}
        return np.bytes_(json.dumps(document | {"format": 2}).encode())

    before, after = pc.open(good), pc.open(changed(good, tmp_path, replaced(REPORT, report)))
    assert isinstance(before, pc.Estimate) and isinstance(after, pc.Estimate)
    assert (after.published_relative_sup, after.published_relative_mean) == (before.published_relative_sup, before.published_relative_mean)
    assert math.isnan(after.relative_sup) and math.isnan(after.energy) and before.relative_sup > before.published_relative_sup


@pytest.mark.parametrize("reconstruction", ["corrected", "of tomorrow"])
def test_a_report_of_another_version(reconstruction: str, good: Path, tmp_path: Path) -> None:
    """Older ones have no verdict, newer ones may have a reconstruction that is unknown here."""

    def report(text: bytes) -> np.bytes_:
        document = json.loads(text)
        document["options"]["reconstruction"] = reconstruction
        del document["meaning"], document["verdict"], document["rebound"], document["warnings"]
        return np.bytes_(json.dumps(document).encode())

    estimate = pc.open(changed(good, tmp_path, replaced(REPORT, report)))
    assert isinstance(estimate, pc.Estimate) and estimate.options["reconstruction"] == reconstruction
    assert estimate.meaning.endswith(".") and str(estimate).count("\n") == 1
    assert estimate.verdict is None and estimate.trust is None and estimate.rebound is None


@pytest.mark.parametrize("name", ["percute/over_time", CELLS, STEPS, "VTKHDF/PointData", "percute/problem", REPORT])
def test_a_part_that_is_missing(name: str, good: Path, tmp_path: Path) -> None:
    refused(changed(good, tmp_path, removed(name)), name)


@pytest.mark.parametrize("attribute", ["dimension", "layout", "kind"])
def test_an_attribute_that_is_wrong(attribute: str, good: Path, tmp_path: Path) -> None:
    def change(file: h5py.File) -> None:
        file["percute"].attrs[attribute] = 7

    file = changed(good, tmp_path, change)
    with pytest.raises(pc.FileFormatError, match=attribute):
        pc.open(file)


def test_a_file_of_an_earlier_layout(good: Path, tmp_path: Path) -> None:
    def change(file: h5py.File) -> None:
        file["percute"].attrs["layout"] = 1

    with pytest.raises(pc.FileFormatError, match=r"has layout 1, but .* reads 2 only; simulate or estimate again"):
        pc.open(changed(good, tmp_path, change))


def test_a_file_that_is_removed_or_cut_while_it_is_open(good: Path, tmp_path: Path) -> None:
    file = changed(good, tmp_path, lambda file: None)
    first, second = pc.open(file), pc.open(file)
    assert isinstance(first, pc.Estimate) and isinstance(second, pc.Estimate)
    file.write_bytes(good.read_bytes()[:-4000])
    with pytest.raises(pc.FileFormatError, match="changed.vtkhdf"):
        first.maps
    file.unlink()
    with pytest.raises(pc.MissingFileError, match="changed.vtkhdf"):
        second.maps
    assert len(second.by_element) == len(second.mesh.cells)


def test_groups_have_their_names(tmp_path: Path) -> None:
    names = ["", ".", "..", "%", "100% steel", "a/b", "é\0x", "%2F"]
    points, cells = [[0, 0], [1, 0], [0, 1]], [[0, 1, 2]]
    mesh = pc.Mesh(points, cells, {name: [[0, 1]] for name in names}, {name: [0] for name in names})
    material = pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress")
    problem = pc.Problem(mesh, material=material, initial_velocity=(1.0, 0.0))
    pc.estimate(pc.simulate(problem, end=5e-4, courant=0.9)).save(tmp_path / "error.vtkhdf")
    again = pc.open(tmp_path / "error.vtkhdf").mesh  # type: ignore[union-attr]
    assert set(again.edge_groups) == set(again.element_groups) == set(names)
    assert all(again.edge_groups[name].tolist() == [[0, 1]] for name in names)
