"""One changed byte of a file of percute is found wherever it is read, or changes nothing that is read."""

from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from conftest import block

import percute as pc


def flipped(path: Path, to: Path, name: str, place: float) -> None:
    """Change the lowest bit of one byte of a data set, at a part of its length."""
    with h5py.File(path, "r") as file:
        offset, count = file[name].id.get_offset(), file[name].id.get_storage_size()
    content = bytearray(path.read_bytes())
    content[offset + int(place * (count - 1))] ^= 1
    to.write_bytes(content)


def data_sets(path: Path) -> list[str]:
    found: list[str] = []
    with h5py.File(path, "r") as file:
        file.visititems(lambda name, item: found.append(name) if isinstance(item, h5py.Dataset) and item.id.get_offset() is not None else None)
    return found


def contents(path: Path) -> list[Any]:
    """Read all that an estimate file gives."""
    estimate = pc.open(path)
    assert isinstance(estimate, pc.Estimate)
    assert estimate.contact is not None
    values = [estimate.to_json(), estimate.by_element, *vars(estimate.over_time).values(), estimate.contact.force, estimate.contact.gap]
    values += [estimate.contact.status, estimate.contact.resultants.force, estimate.residuals]
    for each in estimate.maps:
        values += [each.error, each.displacement, each.velocity, each.acceleration, each.stress, each.compatible_stress]
    return [value.tobytes() if isinstance(value, np.ndarray) else value for value in values]


def test_each_data_set_of_an_estimate_file_has_a_checksum(tmp_path: Path) -> None:
    history = pc.simulate(block(), end=4e-6, courant=0.9)
    path, other = tmp_path / "e.vtkhdf", tmp_path / "other.vtkhdf"
    pc.estimate(history, instants=3, fields=True).save(path)
    whole, found = contents(path), 0
    names = data_sets(path)
    assert len(names) > 50
    for name in names:
        for place in (0.0, 0.6):
            flipped(path, other, name, place)
            try:
                assert contents(other) == whole, name
            except pc.FileFormatError as error:
                found += 1
                assert f"`{name}` does not have its checksum" in str(error) or f"`{name}" in str(error) or "NumberOf" in name, error
    # Fields for ParaView alone, offsets of steps and residuals are not read again.
    assert found > len(names)
    for name in ("VTKHDF/CellData/by_element", "percute/report", "percute/contact/force", "VTKHDF/CellData/admissible_stress"):
        flipped(path, other, name, 0.5)
        with pytest.raises(pc.FileFormatError, match=f"`{name}` does not have its checksum"):
            contents(other)


@pytest.mark.parametrize("name", ["displacement", "reaction", "touching"])
def test_views_of_a_history_are_checked(name: str, tmp_path: Path) -> None:
    path, other = tmp_path / "h.vtkhdf", tmp_path / "other.vtkhdf"
    whole = pc.simulate(block(), end=4e-6, courant=0.9, store=path)
    part = "VTKHDF/PointData/displacement" if name == "displacement" else f"percute/contact/{name}"
    flipped(path, other, part, 0.5)
    with pytest.raises(pc.FileFormatError, match=f"`{name}` does not have its checksum at instant"):
        getattr(pc.open(other), name)
    assert np.array_equal(getattr(pc.open(path), name), getattr(whole, name))


@pytest.mark.parametrize("field", ["stress", "displacement_at"])
def test_the_field_of_an_instant_is_checked_alone(field: str, tmp_path: Path) -> None:
    path, other = tmp_path / "h.vtkhdf", tmp_path / "other.vtkhdf"
    whole = pc.simulate(block(), end=4e-6, courant=0.9, store=path)
    flipped(path, other, "VTKHDF/PointData/displacement", 0.5)
    history = pc.open(other)
    assert isinstance(history, pc.History)
    wrong = 0
    for step in range(len(history)):
        try:
            assert np.array_equal(getattr(history, field)(step), getattr(whole, field)(step))
        except pc.FileFormatError as error:
            wrong += 1
            assert f"at instant {step}:" in str(error)
    assert wrong == 1 and "History: " in repr(history)
    with pytest.raises(pc.FileFormatError, match="does not have its checksum at instant"):
        getattr(history, field)(slice(None))


def test_the_instants_of_a_thinned_run_are_checked(tmp_path: Path) -> None:
    path, other = tmp_path / "h.vtkhdf", tmp_path / "other.vtkhdf"
    pc.simulate(block(), end=4e-6, courant=0.9, store=path, every=3)
    # The lowest bits of an instant that is not kept.
    with h5py.File(path, "r") as file:
        count = len(file["percute/run_times"])
    flipped(path, other, "percute/run_times", (8 * 4) / (8 * count - 1))
    with pytest.raises(pc.FileFormatError, match="instants or contact nodes` does not have its checksum"):
        pc.open(other)
