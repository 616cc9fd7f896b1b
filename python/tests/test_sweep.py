"""Sweeps from Python."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import time
import warnings
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import percute as pc
import pytest
from conftest import block_case

BLOCK = block_case("rectangle = { width = 0.05, height = 0.04, nx = 5, ny = 4 }", speed=4.0, end=4e-6)
GRID: dict[str, list[object]] = {"mesh.rectangle.nx": [5, 6, 7], "obstacle.0.friction": [0.0, 0.3]}


@pytest.fixture
def case(tmp_path: Path) -> Path:
    file = tmp_path / "block.toml"
    file.write_text(BLOCK)
    return file


@pytest.fixture(scope="module")
def swept(tmp_path_factory: pytest.TempPathFactory) -> pc.Sweep:
    folder = tmp_path_factory.mktemp("sweep")
    (folder / "block.toml").write_text(BLOCK)
    return pc.sweep(folder / "block.toml", GRID, folder=folder / "sweep", jobs=2)


def test_each_case_is_its_single_run(swept: pc.Sweep, tmp_path: Path) -> None:
    assert swept.cases[:3] == ("nx=5,friction=0", "nx=5,friction=0.3", "nx=6,friction=0") and len(swept) == 6
    assert swept.parameters == tuple(GRID) and set(swept["status"]) == {"done"} and swept.failures == {}
    for i, name in enumerate(swept.cases):
        nx, friction = swept["mesh.rectangle.nx"][i], swept["obstacle.0.friction"][i]
        alone = pc.run(BLOCK.replace("nx = 5", f"nx = {nx}").replace("friction = 0.2", f"friction = {friction}"))
        assert (swept["sup"][i], swept["relative_mean"][i]) == (alone.sup, alone.relative_mean)
        assert swept["verdict"][i] == " ".join(alone.verdict) if isinstance(alone.verdict, tuple | list) else alone.verdict
        assert swept.document(name)["error"]["sup"] == alone.sup


def test_the_command_makes_the_same_folder(swept: pc.Sweep, tmp_path: Path, case: Path) -> None:
    grid = "\n".join(f'"{key}" = {values}' for key, values in GRID.items())
    (tmp_path / "sweep.toml").write_text(f'case = "block.toml"\n[grid]\n{grid}\n')
    command = [sys.executable, "-m", "percute", "sweep", "sweep.toml", "--quiet"]
    printed = subprocess.run(command, cwd=tmp_path, check=True, capture_output=True, text=True).stdout
    assert printed.splitlines()[0] == "6 cases: 6 done"
    for name in swept.cases:
        mine, theirs = swept.folder / name, tmp_path / "sweep" / name
        assert (mine / "case.toml").read_text() == (theirs / "case.toml").read_text()
        documents = [json.loads((folder / "result.json").read_text()) for folder in (mine, theirs)]
        for document in documents:
            del document["seconds"]
        assert documents[0] == documents[1]
    # What the command has done, Python does not do again.
    before = [(tmp_path / "sweep" / name / "result.json").stat().st_mtime_ns for name in swept.cases]
    pc.sweep(case, GRID, folder=tmp_path / "sweep")
    assert before == [(tmp_path / "sweep" / name / "result.json").stat().st_mtime_ns for name in swept.cases]


def test_results_are_replaced_by_overwrite_only(tmp_path: Path, case: Path) -> None:
    grid: dict[str, list[object]] = {"obstacle.0.friction": [0.3]}
    before = pc.sweep(case, grid, folder=tmp_path / "sweep")
    case.write_text(BLOCK.replace("young = 70e9", "young = 71e9"))
    with pytest.raises(pc.ExistingFileError, match="friction=0.3: .* another case file .* overwrite=True"):
        pc.sweep(case, grid, folder=tmp_path / "sweep")
    assert json.loads((tmp_path / "sweep" / "friction=0.3" / "result.json").read_text())["error"]["sup"] == before["sup"][0]
    after = pc.sweep(case, grid, folder=tmp_path / "sweep", overwrite=True)
    assert list(after["status"]) == ["done"] and after["sup"][0] != before["sup"][0]


def test_tables(swept: pc.Sweep) -> None:
    frame = swept.to_pandas()
    assert list(frame.index) == list(swept.cases) and frame["sup"].tolist() == swept["sup"].tolist()
    assert frame.attrs["units"]["averaged_peak_force"] == "N/m"
    found = swept.to_xarray()
    assert found["sup"].dims == tuple(GRID) and found["sup"].shape == (3, 2) and found["sup"].attrs["units"] == "(J/m)^½"
    for i in range(len(swept)):
        place = {key: swept[key][i] for key in GRID}
        assert found["sup"].sel(place).item() == swept["sup"][i]
    with pytest.raises(pc.InputError, match="no column `relative_men`; did you mean `relative_mean`?"):
        swept["relative_men"]


def test_rows_failures_and_what_is_not_done(case: Path, tmp_path: Path) -> None:
    rows = [{"time.courant": 0.9, "initial.velocity": [0.0, -4.0]}, {"time.courant": 1.9, "initial.velocity": np.array([0.0, -8.0])}]
    found = pc.sweep(case, rows, folder=tmp_path / "rows", jobs=1)
    assert found.cases == ("courant=0.9,velocity=0,-4", "courant=1.9,velocity=0,-8")
    assert list(found["status"]) == ["done", "failed"] and np.isnan(found["sup"][1])
    assert "courant" in found.failures[found.cases[1]]
    assert "case" in found.to_xarray().dims and repr(found).endswith("1 done, 1 failed>")
    with pytest.raises(pc.InputError, match="is not done: it is failed"):
        found.document(found.cases[1])


def test_pictures(swept: pc.Sweep, tmp_path: Path) -> None:
    cells = swept.plot("relative_mean")
    image = cells.images[0].get_array()
    assert image.shape == (2, 3) and image[1, 2] == swept["relative_mean"][-1]
    assert (cells.get_xlabel(), cells.get_ylabel()) == tuple(GRID)
    curve = swept.plot("sup", over="mesh.rectangle.nx", where={"obstacle.0.friction": 0.3}, save=tmp_path / "a.svg")
    x, y = curve.lines[0].get_data()
    assert list(x) == [5, 6, 7] and list(y) == list(swept["sup"][1::2]) and (tmp_path / "a.svg").exists()
    plt.close("all")
    for wrong, told in [
        ({"over": "mesh.rectangle.nx"}, "several cases have the same mesh.rectangle.nx; choose some by `where`"),
        ({"quantity": "trust"}, "no numbers"),
        ({"over": "nx"}, "the keys that are varied are"),
        ({"where": {"obstacle.0.friction": 0.1}}, "no case has the values"),
    ]:
        with pytest.raises(pc.InputError, match=told):
            swept.plot(**wrong)  # type: ignore[arg-type]


def test_mistakes_are_told_before_any_work(case: Path, tmp_path: Path) -> None:
    folder = tmp_path / "none"
    for parameters, told in [
        ({"mesh.rectangel.nx": [5]}, "did you mean `rectangle`"),
        ({"obstacle.0.friction": 0.3}, "must be a list of values"),
        ({"obstacle.0.friction": []}, "there is no value"),
        ({"obstacle.0.friction": [float("nan")]}, "must be finite"),
        ({"obstacle.0.friction": [None]}, "a case holds numbers"),
        ({"obstacle.0.friction": [-1.0]}, "friction"),
        ({}, "names no key"),
        ([{"a": 1}, {"b": 2}], "entry 1 has the keys b"),
        ("mesh", "must be a dict"),
    ]:
        with pytest.raises(pc.InputError, match=told):
            pc.sweep(case, parameters, folder=folder)  # type: ignore[arg-type]
    assert not folder.exists()
    (tmp_path / "file").touch()
    with pytest.raises(pc.StorageError, match="the folder of the sweep: cannot write"):
        pc.sweep(case, {"obstacle.0.friction": [0.1]}, folder=tmp_path / "file" / "sweep")
    with pytest.raises(pc.MissingFileError):
        pc.sweep(tmp_path / "none.toml", GRID)


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
def test_ctrl_c_leaves_nothing_half(tmp_path: Path, case: Path) -> None:
    script = (
        "import percute as pc, signal, sys\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "pc.sweep('block.toml', {'time.end': [1e-6, 2.0]}, folder='out', jobs=1, long=True)\n"
    )
    process = subprocess.Popen([sys.executable, "-c", script], cwd=tmp_path, stderr=subprocess.PIPE, text=True)
    while not any("end=2" in entry.name for entry in (tmp_path / "out").glob(".attempt-*")):
        time.sleep(0.01)
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=60)
    assert "KeyboardInterrupt" in said
    assert [entry.name for entry in (tmp_path / "out").iterdir()] == ["end=1e-6"]


def test_a_lost_worker_of_dask_changes_nothing(swept: pc.Sweep, case: Path, tmp_path: Path) -> None:
    """Two workers, of which one is killed on the way: the sweep ends complete, and equals that of one machine."""
    distributed = pytest.importorskip("distributed")
    with warnings.catch_warnings():
        # Of the cluster: busy ports, and the worker that is killed.
        warnings.simplefilter("ignore")
        with (
            distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
            distributed.Client(cluster) as client,
        ):
            told: list[pc.Progress] = []
            processes = client.run(os.getpid)

            def progress(now: pc.Progress) -> None:
                if not told:
                    os.kill(min(processes.values()), signal.SIGKILL)
                told.append(now)

            found = pc.sweep(case, GRID, folder=tmp_path / "dask", client=client, progress=progress)
            assert client.run(os.getpid) != processes
    assert told[-1].done == told[-1].total == len(GRID["mesh.rectangle.nx"]) * len(GRID["obstacle.0.friction"])
    for column in swept.columns:
        if column != "seconds":
            assert list(found[column]) == list(swept[column]) or np.array_equal(found[column], swept[column], equal_nan=True), column


def test_the_page_runs(case: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    page = (Path(__file__).parents[2] / "docs" / "sweep.md").read_text()
    (tmp_path / "sweep.toml").write_text(re.findall(r"```toml\n(.*?)```", page, re.DOTALL)[0])
    command = [sys.executable, "-m", "percute", "sweep", "sweep.toml", "--list"]
    listed = subprocess.run(command, cwd=tmp_path, check=True, capture_output=True, text=True).stdout.splitlines()
    assert len(listed) == 12 and listed[0].split() == ["open", "young=7e10,density=2700,nx=10,friction=0"]
    monkeypatch.chdir(tmp_path)
    exec(re.findall(r"```python\n(.*?)```", page, re.DOTALL)[0], {})
    plt.close("all")
    assert (tmp_path / "map.png").exists() and len(list((tmp_path / "block-sweep").glob("*/result.json"))) == 6

