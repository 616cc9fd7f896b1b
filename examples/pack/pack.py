"""What the scripts beside have in common: a case with other settings, and a table of differences."""

import re
from pathlib import Path

import numpy as np
import percute as pc

HERE = Path(__file__).parent


def run(name: str, **settings: object) -> pc.History:
    """Run the case of this name with other values for some keys; a value is written as TOML has it."""
    text = (HERE / f"{name}.toml").read_text(encoding="utf-8")
    for key, value in settings.items():
        text, count = re.subn(rf"(?m)^{key} = .*$", f"{key} = {value}", text)
        assert count > 0, key
    return pc.run(text).history


def bar(length: float, elements: int) -> str:
    """Give the value of the key `bar`."""
    return f"{{ length = {length!r}, elements = {elements} }}"


def rectangle(width: float, height: float, nx: int, ny: int) -> str:
    """Give the value of the key `rectangle`."""
    return f"{{ width = {width!r}, height = {height!r}, nx = {nx}, ny = {ny} }}"


def numbers(values: np.ndarray) -> str:
    """Give a list of numbers, or of vectors."""
    return repr(np.asarray(values).tolist())


def mean(history: pc.History, field: np.ndarray) -> np.ndarray:
    """Average a nodal field with the masses: of displacements the path of the centre of mass, of velocities its velocity."""
    mass = history.problem.mass
    return np.einsum("k,tkc->tc", mass, field) / mass.sum()


def compare(quantity: str, exact: float, computed: list[float], unit: str = "") -> None:
    """Print a quantity on meshes ever finer, and the mean order at which it comes to its exact value."""
    apart = np.abs(np.array(computed) - exact)
    order = np.log2(apart[0] / apart[-1]) / (len(apart) - 1) if len(apart) > 1 and apart[-1] > 0 else float("nan")
    print(f"{quantity:<42} exact {exact:13.6g} {unit:<4} computed {computed[-1]:13.6g}   apart {apart[-1]:8.1e}   order {order:5.2f}")
