"""The scripts among the examples run as they stand and print what they printed."""

import importlib.util
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np

EXAMPLES = Path(__file__).parents[2] / "examples"


def module(name: str) -> Any:
    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    assert spec is not None and spec.loader is not None
    made = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(made)
    return made


def test_loads() -> None:
    """The exact answers stand in the script; that the largest difference is the scheme's is shown below."""
    done = subprocess.run([sys.executable, EXAMPLES / "loads.py"], capture_output=True, text=True, check=True)
    lines = done.stdout.splitlines()
    assert len(lines) == 6
    assert lines[-1] == "largest difference 1.5e-05"


def test_the_difference_of_a_wave_is_of_second_order() -> None:
    pressed = module("loads").pressed_block
    coarse, fine = (abs(computed / exact - 1) for computed, exact in (pressed(50), pressed(100)))
    # 4 for O(h²); a tenth for the time of the end, which lies anywhere in a step's dispersion.
    assert 3.6 < coarse / fine < 4.4


def test_hopkinson() -> None:
    """Pulses and strains against the exact solution: fronts are dispersed, plateaus are not."""
    done = subprocess.run([sys.executable, EXAMPLES / "hopkinson.py"], capture_output=True, text=True, check=True)
    lines = done.stdout.splitlines()
    for line in lines[:3]:
        computed, exact = float(line.split()[1]), float(line.split()[-1])
        # Means over 20 µs, over which the exact strain has steps of up to a tenth that fronts reach a µs late.
        assert abs(computed / exact - 1) < 0.01, line
    simulated, waves, exact = (float(line.split()[-1]) for line in lines[4:7])
    assert abs(simulated / exact - 1) < 1e-3 and abs(waves / exact - 1) < 3e-3
    mean, largest = (float(number) for number in lines[7].rsplit("one ", 1)[1].split(", "))
    # The range of bars that strike each other in the page of the evidence.
    assert 0.82 < mean < 1.25 and 0.82 < largest < 1.25


def test_the_three_wave_formula_is_exact_on_exact_pulses() -> None:
    """From exact strains at the gauges the strain of the specimen follows but for the quadrature, and for the 0.1 µm of its gaps."""
    hopkinson = module("hopkinson")
    exact = hopkinson.pc.exact.BarRow(bodies=hopkinson.bodies(), end=hopkinson.END)
    time = np.linspace(0, hopkinson.END, 20001)
    waves = hopkinson.three_waves(time, *(hopkinson.exact_gauge(exact, body, time) for body in ("incident", "transmission")))
    strain = hopkinson.exact_specimen_strain(exact, time)
    until = time < 278e-6
    # 2e-7 m of both gaps over 10 mm, and fronts within a step of 19 ns at 10 m/s over 10 mm.
    assert np.abs(waves - strain)[until].max() < 2e-5 + 10 * 10 * 19e-9 / 0.01


def test_how_fine() -> None:
    """Three kinds of meshes reach their targets; a front does not reach 1 %, and no second run is tried."""
    done = subprocess.run([sys.executable, EXAMPLES / "how_fine.py"], capture_output=True, text=True, check=True)
    front, corner, bracket, disc, too_much = done.stdout.strip().split("\n\n")
    for told, branch in ((front, "uniform"), (corner, "graded"), (bracket, "map"), (disc, "graded")):
        runs = [line.split() for line in told.splitlines() if line[:3].strip().isdigit()]
        assert 2 <= len(runs) <= 4 and all(run[1] == branch for run in runs[1:]), told
        assert " reached: " in told, told
    assert "not reached within the limit" in too_much and "run 0 has" in too_much
