"""Other threads, signals, callbacks, forks: what surrounds the work."""

import multiprocessing
import os
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import percute as pc
import pytest
from conftest import bar, block

# Interrupted after half a second of work that takes much longer; `late` is the time from the signal to the exception.
INTERRUPTED = """
import os, signal, sys, threading, time
import percute as pc
problem = pc.Problem(
    pc.Mesh.rectangle(0.05, 0.04, nx=400, ny=320),
    material=pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress"),
    obstacles=[pc.Plane(point=(0, -2e-4), normal=(0, 1), friction=0.2)],
    initial_velocity=(400, -400),
)
critical = problem.critical_time_step
history = pc.simulate(problem, end=8 * critical, courant=0.9)
sent = []
under_way = threading.Event()
def note(progress):
    if progress.done > 1:
        under_way.set()
def interrupt():
    # What tells no progress is under way after half a second.
    under_way.wait({patience})
    sent.append(time.monotonic())
    os.kill(os.getpid(), signal.SIGINT)
threading.Thread(target=interrupt).start()
try:
    {work}
except KeyboardInterrupt as error:
    late = time.monotonic() - sent[0]
    print("late", late)
    done = getattr(error, "history", None)
else:
    sys.exit("not interrupted")
{then}
"""
THEN = "print('steps', len(done), done.complete, done.displacement.shape == (len(done), len(problem.mesh.points), 2))"
LONG = "pc.simulate(problem, end=300 * critical, courant=0.9, progress=note{store})"


def interrupted(work: str, then: str = THEN) -> list[str]:
    program = INTERRUPTED.format(work=work, then=then, patience=60.0 if "note" in work else 0.5)
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == 0, done.stderr
    late, *rest = done.stdout.split("\n")
    assert float(late.split()[1]) < 0.5, late
    return rest


@pytest.mark.parametrize("stored", [False, True])
def test_ctrl_c_stops_a_simulation(stored: bool, tmp_path: Path) -> None:
    file = tmp_path / "history.vtkhdf"
    steps = interrupted(LONG.format(store=f", store={str(file)!r}" if stored else ""))[0].split()
    assert int(steps[1]) > 1 and steps[2:] == ["False", "True"]
    if stored:
        history = pc.open(file)
        assert len(history) >= int(steps[1]) and len(history.time) < len(history._data.times)


def test_ctrl_c_stops_an_estimate_in_the_midst_of_a_window() -> None:
    assert interrupted("pc.estimate(history, threads=1, window=8)", "print(done)")[0] == "None"


def test_ctrl_c_keeps_the_steps_of_a_run() -> None:
    """The estimate is made beside the simulation."""
    heard: list[pc.Progress] = []

    def interrupt(progress: pc.Progress) -> None:
        heard.append(progress)
        if progress.done >= 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt) as raised:
        pc.run(Path(__file__).parents[2] / "examples" / "bar.toml", progress=interrupt)
    history = raised.value.history  # type: ignore[attr-defined]
    assert len(history) > heard[-1].done and {p.stage for p in heard} == {"simulating"}


def test_other_threads_run_meanwhile() -> None:
    count, over = 0, threading.Event()

    def work() -> None:
        nonlocal count
        while not over.is_set():
            count += 1
            time.sleep(0.001)

    problem = block(60, 48)
    switches = sys.getswitchinterval()
    thread = threading.Thread(target=work)
    # Without switches on time, the other thread gets the interpreter only while this one has let it go.
    sys.setswitchinterval(1000.0)
    try:
        thread.start()
        before = count
        pc.simulate(problem, end=13e-6, courant=0.9)
        after = count
    finally:
        over.set()
        sys.setswitchinterval(switches)
        thread.join()
    assert after > before


def test_a_callback_hears_of_progress(block_history: pc.History) -> None:
    heard: list[pc.Progress] = []
    history = pc.simulate(block(), end=13e-6, courant=0.9, progress=heard.append)
    pc.estimate(history, progress=heard.append)
    assert {p.stage for p in heard} == {"simulating", "estimating"}
    assert [heard[-1].done, heard[-1].total] == [len(history) - 1] * 2
    last = len(history) - 1
    assert repr(heard[-1]) == f"Progress(stage='estimating', done={last}, total={last})"


class Enough(Exception):
    """Raised by a callback."""


def enough(progress: pc.Progress) -> None:
    raise Enough


def after_some_steps(progress: pc.Progress) -> None:
    if progress.done >= 3:
        raise Enough


@pytest.mark.parametrize("stored", [False, True])
def test_an_exception_of_a_callback_stops_a_simulation(stored: bool, tmp_path: Path) -> None:
    problem, store = block(100, 80), tmp_path / "h.vtkhdf" if stored else None
    with pytest.raises(Enough) as raised:
        pc.simulate(problem, end=1e-4, courant=0.9, store=store, progress=after_some_steps)
    history = raised.value.history  # type: ignore[attr-defined]
    assert isinstance(history, pc.History) and not history.complete and history.path == store
    # What was done is what a whole run does.
    whole = pc.simulate(problem, end=1e-4, courant=0.9, store=tmp_path / "whole.vtkhdf")
    assert 4 <= len(history) < len(whole)
    for name in ("time", "displacement", "reaction", "touching"):
        first = getattr(whole, name)[: len(history)]
        assert first.tobytes() == getattr(history, name).tobytes(), name


def test_an_exception_of_a_callback_stops_an_estimate(block_history: pc.History) -> None:
    with pytest.raises(Enough):
        pc.estimate(block_history, progress=enough)


def test_an_unstable_run_shows_how_far_it_came() -> None:
    """Steps that change feed some modes, here 600 times, of which a run is only warned; all modes have energy from the start."""
    velocity = np.random.default_rng(1).normal(size=(41, 1))
    problem = pc.Problem(pc.Mesh.bar(0.1, elements=40), material=bar(10).material, initial_velocity=velocity)
    steps = [problem.critical_time_step * (0.9 if i % 2 else 0.8) for i in range(110)]
    with pytest.warns(pc.InputWarning, match="amplify"), pytest.raises(pc.SimulationError, match="unstable at step") as raised:
        pc.simulate(problem, steps=steps)
    assert isinstance(raised.value, RuntimeError)
    assert 0 < len(raised.value.history) < 111  # type: ignore[attr-defined]


def estimated(history: pc.History) -> bytes:
    return pc.estimate(history, threads=2).by_element.tobytes()


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system cannot fork")
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_a_forked_child_gets_the_same_bits(block_history: pc.History, tmp_path: Path) -> None:
    expected = estimated(block_history)
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            file = tmp_path / "child.vtkhdf"
            fresh = pc.simulate(block(), end=13e-6, courant=0.9, store=file)
            same = estimated(block_history) == expected == estimated(fresh) == estimated(pc.open(file))
            os.write(write, b"same" if same else b"different")
        finally:
            os._exit(0)
    os.close(write)
    with os.fdopen(read, "rb") as answer:
        assert answer.read() == b"same"
    assert os.waitpid(child, 0)[1] == 0


@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
@pytest.mark.parametrize("method", ["spawn", "fork"])
def test_other_processes_get_the_same_bits(method: str, block_history: pc.History) -> None:
    with multiprocessing.get_context(method).Pool(2) as pool:
        answers = pool.map(estimated, [block_history] * 2)
        problem = pool.apply(block)
    assert set(answers) == {estimated(block_history)}
    assert problem.critical_time_step == block_history.problem.critical_time_step
