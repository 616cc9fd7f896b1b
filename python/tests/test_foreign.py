"""A history that h5py alone has written gives the same estimate."""

from pathlib import Path
from typing import Any

import h5py
import numpy as np
import percute as pc
import pytest
from conftest import bar, block

STATEMENTS = {
    1: """
[material]
young = 70e9
density = 2700.0
section = 0.02
[[obstacle]]
point = -0.0002
normal = 1.0
""",
    2: """
[material]
young = 70e9
poisson = 0.3
density = 2700.0
plane = "stress"
[[obstacle]]
point = [0.0, -0.0002]
normal = [0.0, 1.0]
friction = 0.2
""",
}


def padded(field: Any) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Rows of three components, one row for each node and instant."""
    rows = np.zeros((field.shape[0] * field.shape[1], 3))
    rows[:, : field.shape[2]] = field.reshape(len(rows), -1)
    return rows


def write(path: Path, history: pc.History, given: tuple[str, ...]) -> None:
    mesh, steps = history.problem.mesh, len(history)
    d, cells, nodes = mesh.dimension, len(mesh.cells), len(mesh.points)
    with h5py.File(path, "w", libver=("v108", "v110")) as file:
        grid = file.create_group("VTKHDF")
        grid.attrs["Version"] = np.array([2, 2], dtype="i8")
        grid.attrs.create("Type", b"UnstructuredGrid", dtype=h5py.string_dtype("ascii", len("UnstructuredGrid")))
        for name, count in (("Points", nodes), ("Cells", cells), ("ConnectivityIds", cells * (d + 1))):
            grid[f"NumberOf{name}"] = np.array([count], dtype="i8")
        grid["Points"] = padded(mesh.points[None])
        grid["Connectivity"] = mesh.cells.astype("i8").ravel()
        grid["Offsets"] = np.arange(cells + 1, dtype="i8") * (d + 1)
        grid["Types"] = np.full(cells, 3 if d == 1 else 5, dtype="u1")
        for name in ("displacement", *given):
            grid[f"PointData/{name}"] = padded(getattr(history, name))
            grid[f"Steps/PointDataOffsets/{name}"] = np.arange(steps, dtype="i8") * nodes
        grid["Steps"].attrs["NSteps"] = steps
        grid["Steps/Values"] = history.time
        grid["Steps/NumberOfParts"] = np.ones(steps, dtype="i8")
        for name in ("PartOffsets", "PointOffsets", "CellOffsets", "ConnectivityIdOffsets"):
            grid[f"Steps/{name}"] = np.zeros(steps if name in ("PartOffsets", "PointOffsets") else (steps, 1), dtype="i8")
        own = file.create_group("percute")
        own.attrs["kind"], own.attrs["layout"], own.attrs["dimension"] = "history", np.int64(2), np.int64(d)
        own.attrs["program"] = "h5py"
        own["problem"] = STATEMENTS[d]
        own["initial_velocity"] = history.problem.initial_velocity
        # Single rows of nodes that never touch may be left out; here all are there, in another order.
        order = np.arange(len(history.contact_nodes))[::-1]
        own["contact/nodes"] = history.contact_nodes[order]
        own["contact/reaction"] = history.reaction[:, order]
        own["contact/touching"] = history.touching[:, order].astype("u1")


@pytest.mark.parametrize("make", [bar, block])
@pytest.mark.parametrize("given", [(), ("velocity",), ("velocity", "acceleration")])
def test_a_history_of_another_program(make: Any, given: tuple[str, ...], tmp_path: Path) -> None:
    ours = pc.simulate(make(), end=13e-6, courant=0.9)
    write(tmp_path / "foreign.vtkhdf", ours, given)
    theirs = pc.open(tmp_path / "foreign.vtkhdf")
    assert theirs.complete and np.array_equal(theirs.contact_nodes, ours.contact_nodes[::-1])
    assert np.array_equal(theirs.reaction, ours.reaction[:, ::-1])
    assert np.array_equal(theirs.displacement, ours.displacement)
    first, second = pc.estimate(ours), pc.estimate(theirs)
    assert dict(second.supplied) == {name: name in given for name in ("velocity", "acceleration")}
    if given:
        # What is given is rounded otherwise than what follows: 1e-16 of the largest velocity, over some tens of steps.
        assert np.allclose(second.by_element, first.by_element, rtol=1e-9, atol=1e-12 * first.sup)
        assert second.sup == pytest.approx(first.sup, rel=1e-9)
    else:
        assert second.by_element.tobytes() == first.by_element.tobytes() and second.sup == first.sup


@pytest.mark.parametrize("name", ["VTKHDF/PointData/displacement", "percute/contact/reaction", "percute/contact/touching"])
def test_half_precision_is_refused_by_name(name: str, tmp_path: Path) -> None:
    ours = pc.simulate(block(), end=4e-6, courant=0.9)
    write(tmp_path / "foreign.vtkhdf", ours, ())
    with h5py.File(tmp_path / "foreign.vtkhdf", "r+") as file:
        values = file[name][()]
        del file[name]
        file[name] = np.zeros(values.shape, "f2")
    with pytest.raises(pc.FileFormatError, match=f"`{name}` holds .* float16; it must be .*32 or 64 bits"):
        pc.estimate(pc.open(tmp_path / "foreign.vtkhdf"))
