"""Exports: what VTK reads of them, and what is refused."""

import csv
import subprocess
import sys
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import percute as pc
import pytest
from conftest import bar, block, block_case
from percute import _percute


@pytest.fixture(scope="module")
def history() -> pc.History:
    return pc.simulate(block(), end=8e-6, courant=0.9)


@pytest.fixture(scope="module")
def estimate(history: pc.History) -> pc.Estimate:
    return pc.estimate(history)


def grids(file: Path) -> list[tuple[float, dict[str, np.ndarray]]]:
    """Time and arrays of each instant, read by VTK."""
    vtk = pytest.importorskip("vtkmodules.util.numpy_support")
    if file.suffix == ".vtkhdf":
        from vtkmodules.vtkIOHDF import vtkHDFReader

        reader = vtkHDFReader()
        reader.SetFileName(str(file))
        reader.UpdateInformation()
        found = []
        for n in range(reader.GetNumberOfSteps()):
            reader.SetStep(n)
            reader.Update()
            found.append((reader.GetTimeValue(), arrays(reader.GetOutput(), vtk)))
        return found
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

    found = []
    for entry in ET.parse(file).iter("DataSet"):
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(file.parent / entry.attrib["file"]))
        reader.Update()
        grid = reader.GetOutput()
        time = vtk.vtk_to_numpy(grid.GetFieldData().GetArray("TimeValue"))[0]
        assert time == float(entry.attrib["timestep"])
        found.append((float(time), arrays(grid, vtk)))
    return found


def arrays(grid, vtk) -> dict[str, np.ndarray]:
    found = {"points": vtk.vtk_to_numpy(grid.GetPoints().GetData()).copy()}
    for data in (grid.GetPointData(), grid.GetCellData()):
        for k in range(data.GetNumberOfArrays()):
            found[data.GetArrayName(k)] = vtk.vtk_to_numpy(data.GetArray(k)).copy()
    assert grid.GetCell(0).GetNumberOfPoints() in (2, 3)
    return found


@pytest.mark.parametrize("ending", ["vtkhdf", "pvd", "vtu"])
def test_vtk_reads_what_the_history_has(history: pc.History, estimate: pc.Estimate, ending: str, tmp_path: Path) -> None:
    fields = ["velocity", "acceleration", "reaction", "stress", "von_mises", "pressure", "error"]
    steps = [0, 5, -1]
    files = history.export(tmp_path / f"out.{ending}", steps=steps, fields=fields, estimate=estimate)
    assert sorted(tmp_path.iterdir()) == sorted(files)
    read = grids(files[0])
    assert [time for time, _ in read] == history.time[steps].tolist()
    u = history.displacement
    stress, von_mises, pressure, across = (
        _percute.element_field(history.problem._data, name, np.ascontiguousarray(u))
        for name in ("stress", "von_mises", "pressure", "stress_across")
    )
    reaction = np.zeros_like(u)
    reaction[:, history.contact_nodes] = history.reaction
    assert np.abs(reaction[steps]).max() > 0 and von_mises[5].max() > 0
    for (_, got), n in zip(read, steps, strict=True):
        assert np.array_equal(got["points"][:, :2], history.problem.mesh.points)
        for name, expected in (("displacement", u), ("velocity", history.velocity), ("acceleration", history.acceleration), ("reaction", reaction)):
            assert np.array_equal(got[name][:, :2], expected[n]) and not got[name][:, 2].any(), name
        tensor = got["stress"].reshape(-1, 3, 3)
        assert np.array_equal(tensor[:, :2, :2], stress[n]) and np.array_equal(tensor[:, 2, 2], across[n])
        assert not tensor[:, :2, 2].any() and not tensor[:, 2, :2].any()
        assert np.array_equal(got["von_mises"], von_mises[n]) and np.array_equal(got["pressure"], pressure[n])
        assert np.array_equal(got["error"], estimate.by_element)


def test_a_bar_and_a_single_instant(tmp_path: Path) -> None:
    history = pc.simulate(bar(), end=5e-6, courant=0.9, store=tmp_path / "bar.vtkhdf")
    assert history.export(tmp_path / "one.vtu", times=2e-6) == [tmp_path / "one.vtu"]
    vtk = pytest.importorskip("vtkmodules.util.numpy_support")
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(tmp_path / "one.vtu"))
    reader.Update()
    got = arrays(reader.GetOutput(), vtk)
    n = int(np.argmin(np.abs(history.time - 2e-6)))
    assert np.array_equal(got["displacement"][:, 0], history.displacement[n, :, 0])
    assert set(got) == {"points", "displacement", "velocity", "reaction", "stress", "von_mises"}


def test_the_command_writes_the_same_file(history: pc.History, tmp_path: Path) -> None:
    stored = pc.simulate(block(), end=8e-6, courant=0.9, store=tmp_path / "h.vtkhdf")
    pc.estimate(stored).save(tmp_path / "e.vtkhdf")
    stored.export(tmp_path / "python.vtkhdf", every=4, estimate=tmp_path / "e.vtkhdf")
    command = ["export", "h.vtkhdf", "-o", "shell.vtkhdf", "--every", "4", "--estimate", "e.vtkhdf"]
    done = subprocess.run([sys.executable, "-m", "percute", *command], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "error" in done.stdout
    first, second = grids(tmp_path / "python.vtkhdf"), grids(tmp_path / "shell.vtkhdf")
    assert [n for n, _ in first] == [n for n, _ in second] == [*history.time[:-1:4].tolist(), history.time[-1]]
    for (_, a), (_, b) in zip(first, second, strict=True):
        assert a.keys() == b.keys() and all(np.array_equal(a[name], b[name]) for name in a)


def test_existing_files_and_interrupts_leave_all_as_it_was(history: pc.History, tmp_path: Path) -> None:
    (tmp_path / "out_05.vtu").write_text("mine")
    with pytest.raises(pc.ExistingFileError, match=r"out_05\.vtu"):
        history.export(tmp_path / "out.pvd", steps=[5, 10])
    assert [file.name for file in tmp_path.iterdir()] == ["out_05.vtu"]
    assert len(history.export(tmp_path / "out.pvd", steps=[5, 10], overwrite=True)) == 3

    def stop(progress: pc.Progress) -> None:
        raise RuntimeError("stop")

    # Long enough for progress to be told before the end.
    long = pc.simulate(block(40, 32), end=13e-6, courant=0.2)
    before = sorted(file.name for file in tmp_path.iterdir())
    for name in ("new.vtkhdf", "new.pvd"):
        with pytest.raises(RuntimeError, match="stop"):
            long.export(tmp_path / name, progress=stop)
    assert sorted(file.name for file in tmp_path.iterdir()) == before


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        ({"path": "out.txt"}, r"\.vtkhdf"),
        ({"steps": [1000]}, "`steps`"),
        ({"steps": [0], "every": 2}, "several"),
        ({"times": [1.0]}, "ends at"),
        ({"every": 0}, "`every`"),
        ({"fields": ["strss"]}, "did you mean `stress`"),
        ({"fields": "stress"}, "`fields`"),
        ({"fields": ["error"]}, "estimate"),
        ({"estimate": 3}, "`estimate`"),
    ],
)
def test_mistakes_are_named(history: pc.History, wrong: dict, says: str, tmp_path: Path) -> None:
    path = tmp_path / wrong.pop("path", "out.vtkhdf")
    with pytest.raises(pc.InputError, match=says):
        history.export(path, **wrong)
    assert not list(tmp_path.iterdir())


def test_an_estimate_of_another_mesh_is_refused(history: pc.History, tmp_path: Path) -> None:
    other = pc.estimate(pc.simulate(bar(), end=5e-6, courant=0.9))
    with pytest.raises(pc.InputError, match="another mesh"):
        history.export(tmp_path / "out.vtkhdf", estimate=other)


CASE = block_case()


def table(file: Path) -> dict[str, np.ndarray]:
    with file.open(newline="", encoding="utf-8") as lines:
        header, *rows = csv.reader(lines)
    return {name: np.array([float(cell) if cell else np.nan for cell in column]) for name, column in zip(header, zip(*rows, strict=True), strict=True)}


def test_tables_hold_the_numbers_of_the_estimate(tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_text(CASE)

    def percute(*command: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run([sys.executable, "-m", "percute", *command], cwd=tmp_path, capture_output=True, text=True, check=False)

    done = percute("run", "case.toml", "--csv", "tables", "--history", "h.vtkhdf", "--estimate", "e.vtkhdf")
    assert done.returncode == 0, done.stderr
    estimate = pc.open(tmp_path / "e.vtkhdf")
    history = pc.open(tmp_path / "h.vtkhdf")
    assert isinstance(estimate, pc.Estimate) and isinstance(history, pc.History)
    assert estimate.contact is not None
    run = table(tmp_path / "tables" / "over_time.csv")
    total, over_time = estimate.contact.resultants, estimate.over_time
    # Samples lie between the steps, too.
    assert np.array_equal(run["time (s)"], np.union1d(history.time, over_time.time))
    step, sample = np.isin(run["time (s)"], history.time), np.isin(run["time (s)"], over_time.time)
    for name, values in (
        ("force_y (N/m)", total.force[:, 1]),
        ("normal_force (N/m)", total.normal_force),
        ("nodes_in_contact", total.in_contact),
        ("strain (J/m)", history.balance.strain),
        ("work_of_contact (J/m)", history.balance.work_of_contact),
    ):
        assert np.array_equal(run[name][step], values) and np.isnan(run[name][~step]).all() and values.any(), name
    assert np.array_equal(run["error_total (J/m)"][sample], over_time.total)
    assert np.array_equal(np.isfinite(run["error ((J/m)^(1/2))"]), sample)
    elements = table(tmp_path / "tables" / "elements.csv")
    assert np.array_equal(elements["error ((J/m)^(1/2))"], estimate.by_element)
    nodes = table(tmp_path / "tables" / "contact_nodes.csv")
    assert np.array_equal(nodes["node"], estimate.contact.nodes)
    assert np.array_equal(nodes["peak_normal_force (N/m)"], estimate.contact.peak_normal_force)
    text = (tmp_path / "tables" / "over_time.csv").read_bytes()
    assert text.count(b"\r\n") == len(step) + 1 == text.count(b"\n")

    for command in (["estimate", "h.vtkhdf"], ["info", "h.vtkhdf"], ["info", "e.vtkhdf"]):
        assert percute(*command, "--csv", f"{command[0]}-{command[1][0]}.csv").returncode == 0
    assert (tmp_path / "estimate-h.csv").read_bytes() == text
    later = table(tmp_path / "info-h.csv")
    assert all(np.array_equal(later[name], run[name][step]) for name in later) and "strain (J/m)" in later
    later = table(tmp_path / "info-e.csv")
    assert all(np.array_equal(later[name], run[name], equal_nan=True) for name in later) and "error ((J/m)^(1/2))" in later

    pandas = pytest.importorskip("pandas")
    frame = pandas.read_csv(tmp_path / "estimate-h.csv")
    assert frame["error_total (J/m)"].max() == pytest.approx(estimate.over_time.total.max(), rel=1e-15)

    again = percute("run", "case.toml", "--csv", "tables")
    assert again.returncode == 2 and "exists already" in again.stderr
    assert percute("run", "case.toml", "--csv", "tables", "--force").returncode == 0
    wrong = percute("run", "case.toml", "--csv", "table.txt")
    assert wrong.returncode == 2 and ".csv" in wrong.stderr
    wrong = percute("info", "case.toml", "--csv", "table.csv")
    assert wrong.returncode == 2 and "history or an estimate file" in wrong.stderr
