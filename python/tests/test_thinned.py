"""Histories that keep a part of their run."""

import json
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
import percute as pc
import pytest
from conftest import block
from test_export import CASE, grids

END = 8e-6


@pytest.fixture(scope="module")
def full() -> pc.History:
    return pc.simulate(block(), end=END, courant=0.9)


def thin(file: Path, **keep) -> pc.History:
    return pc.simulate(block(), end=END, courant=0.9, store=file, **keep)


def test_every_fourth_step_has_the_bits_of_the_run(full: pc.History, tmp_path: Path) -> None:
    history = thin(tmp_path / "h.vtkhdf", every=4)
    steps = [*range(0, len(full) - 1, 4), len(full) - 1]
    assert history.steps.tolist() == steps and full.steps.tolist() == list(range(len(full)))
    assert history.complete and len(history) == len(steps)
    assert np.array_equal(history.time, full.time[steps])
    for name in ("displacement", "velocity", "acceleration"):
        assert np.array_equal(getattr(history, name), getattr(full, name)[steps]), name
    order = [full.contact_nodes.tolist().index(node) for node in history.contact_nodes]
    assert np.array_equal(history.reaction, full.reaction[steps][:, order]) and history.reaction.any()
    assert np.array_equal(history.touching, full.touching[steps][:, order])
    assert [time for time, _ in grids(tmp_path / "h.vtkhdf")] == history.time.tolist()
    assert repr(history).startswith("<percute.History: part of a run: ")


@pytest.mark.parametrize("name", ["balance", "contact", "estimate", "error"])
def test_a_part_of_a_run_refuses_what_needs_all_steps(full: pc.History, name: str, tmp_path: Path) -> None:
    history = thin(tmp_path / "h.vtkhdf", every=4)
    with pytest.raises(pc.InputError, match=r"keeps \d+ of \d+ instants.*`every`.*percute run"):
        match name:
            case "estimate":
                pc.estimate(history)
            case "error":
                history.error(full)
            case _:
                getattr(history, name)


def test_times_and_fields(full: pc.History, tmp_path: Path) -> None:
    history = thin(tmp_path / "h.vtkhdf", times=[2e-6, 3.1e-6], fields=["displacement"])
    nearest = [int(np.argmin(np.abs(full.time - t))) for t in (2e-6, 3.1e-6)]
    assert history.steps.tolist() == [0, *nearest, len(full) - 1]
    assert np.array_equal(history.displacement, full.displacement[history.steps])
    for name in ("velocity", "acceleration", "reaction", "touching"):
        with pytest.raises(pc.InputError, match="`fields`"):
            getattr(history, name)
    files = history.export(tmp_path / "out.vtkhdf")
    expected = full.export(tmp_path / "full.vtkhdf", steps=history.steps, fields=["stress", "von_mises"])
    thinned, complete = grids(files[0]), grids(expected[0])
    for (time, a), (other, b) in zip(thinned, complete, strict=True):
        assert time == other and a.keys() == b.keys() and all(np.array_equal(a[key], b[key]) for key in a)
    with pytest.raises(pc.InputError, match="`fields`.*\"velocity\" is not in this history"):
        history.export(tmp_path / "more.vtkhdf", fields=["velocity"])


def test_an_export_has_the_motion_that_is_kept(full: pc.History, tmp_path: Path) -> None:
    history = thin(tmp_path / "h.vtkhdf", every=5)
    got = grids(history.export(tmp_path / "out.pvd", fields=["velocity", "acceleration", "reaction"])[0])
    for (_, arrays), n in zip(got, history.steps, strict=True):
        assert np.array_equal(arrays["velocity"][:, :2], full.velocity[n])
        assert np.array_equal(arrays["acceleration"][:, :2], full.acceleration[n])
        assert np.array_equal(arrays["reaction"][full.contact_nodes, :2], full.reaction[n])
    with pytest.raises(pc.InputError, match=r"instants of its run, which are counted here; `history\.steps`"):
        history.export(tmp_path / "beyond.vtu", steps=int(history.steps[-1]))


def test_velocities_beside_all_steps_leave_the_estimate_its_bits(full: pc.History, tmp_path: Path) -> None:
    history = thin(tmp_path / "h.vtkhdf", fields=["displacement", "velocity", "reaction"])
    estimate, expected = pc.estimate(history), pc.estimate(full)
    assert not any(estimate.supplied.values())
    assert (estimate.sup, estimate.mean) == (expected.sup, expected.mean)
    with h5py.File(tmp_path / "h.vtkhdf") as file:
        assert np.array_equal(file["VTKHDF/PointData/velocity"][:, :2].reshape(full.velocity.shape), full.velocity)
        assert "acceleration" not in file["VTKHDF/PointData"] and "steps" not in file["percute"]


def test_the_run_of_a_case_estimates_all_steps(tmp_path: Path) -> None:
    def percute(*command: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run([sys.executable, "-m", "percute", *command], cwd=tmp_path, capture_output=True, text=True, check=False)

    output = '[output]\nhistory = "h.vtkhdf"\nevery = 3\nfields = ["displacement", "velocity"]\n'
    (tmp_path / "case.toml").write_text(CASE + output)
    expected = pc.run(CASE)
    done = percute("run", "case.toml", "--csv", "t.csv")
    assert done.returncode == 0, done.stderr
    assert f"{100 * expected.relative_sup:.3g} %" in done.stdout
    history = pc.open(tmp_path / "h.vtkhdf")
    assert isinstance(history, pc.History) and expected.history is not None
    assert np.array_equal(history.velocity, expected.history.velocity[history.steps])
    planned = percute("info", "case.toml").stdout
    told = percute("info", "h.vtkhdf").stdout
    assert f"{len(history)} instants only: displacement, velocity" in told and "complete" in told
    size = (tmp_path / "h.vtkhdf").stat().st_size
    predicted = json.loads(percute("info", "case.toml", "--json").stdout)["history_bytes"]
    # Some kB of the library are an estimate.
    assert abs(predicted - size) < 12_000, planned
    refused = percute("estimate", "h.vtkhdf")
    assert refused.returncode == 2 and "keeps" in refused.stderr and "no reactions" in refused.stderr


@pytest.mark.parametrize(
    ("keep", "says"),
    [
        ({"every": 2, "times": [1e-6]}, "`times`"),
        ({"every": 0}, "`every`"),
        ({"times": [1.0]}, "`times`.*ends at"),
        ({"times": []}, "`times`"),
        ({"fields": "velocity"}, "`fields`"),
        ({"fields": ["velocty"]}, "`fields`.*did you mean `velocity`"),
    ],
)
def test_mistakes_are_named(keep: dict, says: str, tmp_path: Path) -> None:
    with pytest.raises(pc.InputError, match=says):
        thin(tmp_path / "h.vtkhdf", **keep)
    assert not list(tmp_path.iterdir())


def test_without_a_file_nothing_is_left_out() -> None:
    with pytest.raises(pc.InputError, match="`every` is given without `store`"):
        pc.simulate(block(), end=END, courant=0.9, every=2)
