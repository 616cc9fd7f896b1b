"""The scripts among the examples run as they stand and print what they printed."""

import importlib.util
import subprocess
import sys
from pathlib import Path
from typing import Any

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
