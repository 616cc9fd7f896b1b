"""The file of a run is closed and complete before a signal is raised as an exception, and before the process ends."""

import signal
import subprocess
import sys
from pathlib import Path

import h5py
import percute as pc
import pytest

PROGRAM = """
import signal, sys, threading
import percute as pc
signal.signal(signal.SIGINT, signal.default_int_handler)
signal.signal(signal.SIGTERM, signal.SIG_DFL)
file = sys.argv[1]
problem = pc.Problem(
    pc.Mesh.rectangle(0.05, 0.04, nx=120, ny=96),
    material=pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress"),
    obstacles=[pc.Plane(point=(0, -2e-4), normal=(0, 1), friction=0.2)],
    initial_velocity=(400, -400),
)
def note(progress):
    print(progress.done, flush=True)
def simulate():
    pc.simulate(problem, end=1500 * problem.critical_time_step, courant=0.9, store=file, progress=note)
def run():
    text = open(sys.argv[2]).read().replace("nx = 20, ny = 16", "nx = 60, ny = 48").replace("end = 13e-6", "end = 1e-4")
    pc.run(text, store=file, progress=note)
def daemon():
    threading.Thread(target=simulate, daemon=True).start()
    sys.stdin.readline()
{work}()
"""
CASE = Path(__file__).parents[2] / "examples" / "block.toml"


def started(work: str, file: Path) -> subprocess.Popen[str]:
    command = [sys.executable, "-c", PROGRAM.format(work=work), str(file), str(CASE)]
    return subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def wait_for_step(process: subprocess.Popen[str], step: int) -> None:
    assert process.stdout is not None
    for line in process.stdout:
        if int(line) >= step:
            return
    raise AssertionError(process.communicate()[1])


def check(file: Path, step: int) -> None:
    with h5py.File(file) as found:
        assert found["percute/complete"][()] == 1, "the process ended before the file was closed"
        steps = int(found["percute/steps_written"][()])
        assert steps > step and found["VTKHDF/Steps"].attrs["NSteps"] == steps
    history = pc.open(file)
    assert isinstance(history, pc.History) and len(history) == steps and not history.complete
    file.unlink()  # Of some hundred megabytes.


@pytest.mark.parametrize("work", ["simulate", "run"])
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("step", [0, 30, 300])
def test_the_process_ends_after_the_file(work: str, number: signal.Signals, step: int, tmp_path: Path) -> None:
    """Nobody catches the exception, so that the interpreter ends at once."""
    file = tmp_path / "history.vtkhdf"
    with started(work, file) as process:
        wait_for_step(process, step)
        process.send_signal(number)
        said = process.communicate()[1]
    assert process.returncode == -number, said
    assert ("KeyboardInterrupt" in said) == (number == signal.SIGINT), said
    check(file, step)


def test_an_impatient_user_has_a_whole_file_too(tmp_path: Path) -> None:
    """A second signal raises the exception at once; the interpreter then waits for the file."""
    file = tmp_path / "history.vtkhdf"
    with started("simulate", file) as process:
        wait_for_step(process, 10)
        process.send_signal(signal.SIGINT)
        process.send_signal(signal.SIGINT)
        said = process.communicate()[1]
    assert process.returncode == -signal.SIGINT and "KeyboardInterrupt" in said, said
    check(file, 10)


def test_a_run_in_a_daemon_thread_is_closed_at_the_end_of_the_program(tmp_path: Path) -> None:
    file = tmp_path / "history.vtkhdf"
    with started("daemon", file) as process:
        wait_for_step(process, 10)
        said = process.communicate("end\n")[1]
    assert process.returncode == 0, said
    check(file, 10)
