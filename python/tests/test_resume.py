"""A simulation that was killed or stopped goes on."""

from __future__ import annotations

import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import percute as pc

SIMULATION = """
import sys
import percute as pc

mesh = pc.Mesh.rectangle(0.05, 0.04, nx=40, ny=32)
problem = pc.Problem(
    mesh,
    material=pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress"),
    initial_velocity=(20.0, -40.0),
    obstacles=[pc.Plane(point=(0.0, -1e-5), normal=(0.0, 1.0), friction=0.2)],
)
if __name__ == "__main__":
    pc.simulate(problem, end=2e-4, step=1e-7, store=sys.argv[1])
"""


def simulation(folder: Path) -> list[str]:
    script = folder / "simulation.py"
    script.write_text(SIMULATION)
    return [sys.executable, str(script)]


def killed(command: list[str], file: Path, steps: int) -> None:
    """Start a simulation, and kill it once so many steps are in its file."""
    with subprocess.Popen([*command, str(file)]) as process:
        while not file.exists() or len(opened(file)) < steps:
            assert process.poll() is None, "it ended before"
            time.sleep(0.002)
        process.send_signal(signal.SIGKILL)


def opened(file: Path) -> pc.History:
    history = pc.open(file)
    assert isinstance(history, pc.History)
    return history


def test_a_killed_simulation_goes_on(tmp_path: Path) -> None:
    """The file, the energies and the estimate are those of a simulation that was not interrupted."""
    command = simulation(tmp_path)
    file, whole = tmp_path / "killed.vtkhdf", tmp_path / "whole.vtkhdf"
    subprocess.run([*command, str(whole)], check=True)
    killed(command, file, 500)
    assert not opened(file).complete
    told: list[tuple[int, int]] = []
    history = pc.resume(file, progress=lambda progress: told.append((progress.done, progress.total)))
    assert history.complete
    assert len(history) == 2001
    assert told
    assert told[0][0] >= 448, "it goes on from the checkpoint before the kill"
    assert file.read_bytes() == whole.read_bytes()
    undisturbed = opened(whole)
    np.testing.assert_array_equal(history.balance.energy_drift, undisturbed.balance.energy_drift)
    assert pc.estimate(history, every=100).sup == pc.estimate(undisturbed, every=100).sup
    # One that has ended is opened.
    assert len(pc.resume(file)) == 2001
    assert file.read_bytes() == whole.read_bytes()


def test_a_file_of_another_kind_is_refused(tmp_path: Path) -> None:
    with pytest.raises(pc.MissingFileError, match="no such file"):
        pc.resume(tmp_path / "none.vtkhdf")
    text = tmp_path / "text.vtkhdf"
    text.write_text("no history")
    with pytest.raises(pc.FileFormatError, match="not an HDF5 file"):
        pc.resume(text)


def test_the_file_of_another_version_is_refused(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    file, other = tmp_path / "killed.vtkhdf", tmp_path / "other.vtkhdf"
    killed(simulation(tmp_path), file, 100)
    shutil.copy(file, other)
    with h5py.File(other, "r+") as stored:
        stored["percute"].attrs.modify("program", np.bytes_("percute 0.0.1"))
    before = other.read_bytes()
    with pytest.raises(pc.FileFormatError, match="written by percute 0.0.1.*whose numbers may differ; run again"):
        pc.resume(other)
    assert other.read_bytes() == before
