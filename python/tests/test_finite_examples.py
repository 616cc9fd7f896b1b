"""The ring that spins and widens, among the examples of finite kinematics, prints what it printed."""

import subprocess
import sys
from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[2] / "examples" / "finite"


def test_the_ring() -> None:
    done = subprocess.run([sys.executable, FOLDER / "ring.py"], capture_output=True, text=True, check=True)
    radius, turns, moment, energy, error = (line.split() for line in done.stdout.splitlines())
    # Measured: 45.19 to 50.66 mm.
    assert float(radius[6]) == pytest.approx(45.19) and float(radius[8]) == pytest.approx(50.66, abs=0.02)
    assert float(turns[1].rstrip(";")) == pytest.approx(1.784, abs=0.002)
    assert float(moment[4]) < 1e-12 and float(energy[3]) < 1e-4
    assert error[2] == "3.2"
