"""Problems that the tests share."""

import signal

import matplotlib
import percute as pc
import pytest

matplotlib.use("Agg")
# A background job of a shell ignores SIGINT, one of nohup SIGHUP, and so would all processes that the tests start.
signal.signal(signal.SIGINT, signal.default_int_handler)
if hasattr(signal, "SIGHUP"):
    signal.signal(signal.SIGHUP, signal.SIG_DFL)


def block(nx: int = 8, ny: int = 6, friction: float = 0.2) -> pc.Problem:
    """The block of the paper, on a coarse mesh."""
    return pc.Problem(
        pc.Mesh.rectangle(0.05, 0.04, nx=nx, ny=ny),
        material=pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress"),
        obstacles=[pc.Plane(point=(0, -2e-4), normal=(0, 1), friction=friction)],
        initial_velocity=(400, -400),
    )


def bar(elements: int = 40) -> pc.Problem:
    """The bar of the paper."""
    return pc.Problem(
        pc.Mesh.bar(0.1, elements=elements),
        material=pc.Elastic(young=70e9, density=2700.0, section=0.02),
        obstacles=[pc.Plane(point=-2e-4, normal=1)],
        initial_velocity=-400,
    )


@pytest.fixture(scope="session")
def block_history() -> pc.History:
    return pc.simulate(block(), end=13e-6, courant=0.9)


@pytest.fixture(scope="session")
def bar_history() -> pc.History:
    return pc.simulate(bar(), end=50e-6, courant=0.9)
