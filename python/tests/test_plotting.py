"""Pictures: what is drawn, with which labels."""

import subprocess
import sys
from collections.abc import Iterator

import matplotlib.pyplot as plt
import numpy as np
import percute as pc
import pytest


@pytest.fixture(autouse=True)
def closed() -> Iterator[None]:
    yield
    plt.close("all")


def test_a_map_shows_all_elements(block_history: pc.History) -> None:
    estimate = pc.estimate(block_history)
    axes = estimate.plot_map()
    drawn = axes.collections[0].get_array()
    assert drawn is not None and np.array_equal(drawn, estimate.by_element)
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("x (mm)", "y (mm)")
    assert "J" in axes.child_axes[0].get_ylabel()


def test_over_time_shows_the_sup(block_history: pc.History) -> None:
    estimate = pc.estimate(block_history)
    figure, axes = plt.subplots()
    assert estimate.plot_over_time(axes=axes) is axes and axes.figure is figure
    assert axes.get_xlabel() == "t (µs)" and axes.lines[0].get_ydata().max() == pytest.approx(estimate.sup)  # type: ignore[union-attr]


@pytest.mark.parametrize(
    ("quantity", "label"),
    [("displacement", "displacement (mm)"), ("velocity", "velocity (m/s)"), ("von_mises", "von Mises stress (GPa)")],
)
def test_fields_on_the_deformed_body(quantity: str, label: str, block_history: pc.History) -> None:
    axes = block_history.plot(quantity, step=15)
    assert axes.child_axes[0].get_ylabel() == label and axes.get_title().startswith("t = ")


def test_stresses_are_those_of_the_law() -> None:
    """Stretched by ε along x, with no stress across: σ = Eε in plane stress with ε_yy = -νε, whatever the element."""
    mesh = pc.Mesh.rectangle(1.0, 1.0, nx=3, ny=2)
    strain = 1e-3
    field = np.column_stack([strain * mesh.points[:, 0], -0.3 * strain * mesh.points[:, 1]])
    for plane, expected in (("stress", 2e11 * strain), ("strain", None)):
        law = pc.Elastic(young=2e11, poisson=0.3, density=7800.0, plane=plane)  # type: ignore[arg-type]
        history = pc.simulate(pc.Problem(mesh, material=law, initial_displacement=field), end=2e-9, step=1e-9)
        values = history.plot("von_mises", step=0).collections[0].get_array()
        pressure = history.plot("pressure", step=0).collections[0].get_array()
        assert values is not None and pressure is not None
        if expected is not None:
            assert np.allclose(values * 1e6, expected, rtol=1e-9) and np.allclose(pressure * -3e6, expected, rtol=1e-9)
        else:
            # tr σ = 3K tr ε with the bulk modulus K = E/(3(1-2ν)).
            assert np.allclose(pressure * -1e6, 2e11 / 1.2 * 0.7 * strain, rtol=1e-9)


def test_bars(bar_history: pc.History) -> None:
    axes = bar_history.plot("stress", step=20)
    assert axes.get_ylabel() == "stress (GPa)" and axes.get_xlabel() == "x (mm)"
    pc.estimate(bar_history).plot_map()
    with pytest.raises(pc.InputError, match="must be one of displacement, velocity, stress"):
        bar_history.plot("von_mises")
    with pytest.raises(pc.InputError, match="`step` is 1000"):
        bar_history.plot(step=1000)


def test_without_matplotlib_the_way_out_is_named() -> None:
    program = """
import sys
sys.modules["matplotlib"] = None
import percute as pc
problem = pc.Problem(pc.Mesh.bar(1.0, elements=2), material=pc.Elastic(young=1.0, density=1.0, section=1.0))
try:
    pc.simulate(problem, end=1.0, courant=0.9).plot()
except pc.PercuteError as error:
    print(error)
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout == 'pictures need matplotlib: pip install "percute[plot]"\n'
