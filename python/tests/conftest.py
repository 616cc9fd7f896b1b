"""Problems that the tests share."""

import signal

import matplotlib
import numpy as np
import percute as pc
import pytest

matplotlib.use("Agg")
# A background job of a shell ignores SIGINT, one of nohup SIGHUP, and so would all processes that the tests start.
signal.signal(signal.SIGINT, signal.default_int_handler)
if hasattr(signal, "SIGHUP"):
    signal.signal(signal.SIGHUP, signal.SIG_DFL)


def block(nx: int = 8, ny: int = 6, friction: float = 0.2) -> pc.Problem:
    """The block of the paper, on a coarse mesh."""
    return falling(pc.Mesh.rectangle(0.05, 0.04, nx=nx, ny=ny), friction)


def block_case(mesh: str = "rectangle = { width = 0.05, height = 0.04, nx = 6, ny = 5 }", speed: float = 400.0, end: float = 6e-6, plane: str = "") -> str:
    """The case of a block; a slower one starts nearer to its plane. Further keys of the plane may be given."""
    return f"""
[mesh]
{mesh}
[material]
young = 70e9
poisson = 0.3
density = 2700.0
plane = "stress"
[initial]
velocity = [{speed}, -{speed}]
[[obstacle]]
point = [0.0, -{speed / 2e6}]
normal = [0.0, 1.0]
friction = 0.2
{plane}
[time]
end = {end}
courant = 0.9
"""


def bar(elements: int = 40) -> pc.Problem:
    """The bar of the paper."""
    return pc.Problem(
        pc.Mesh.bar(0.1, elements=elements),
        material=pc.Elastic(young=70e9, density=2700.0, section=0.02),
        obstacles=[pc.Plane(point=-2e-4, normal=1)],
        initial_velocity=-400,
    )


def tilted() -> pc.Problem:
    """A block that strikes the plane with a corner."""
    mesh = pc.Mesh.rectangle(0.05, 0.04, nx=8, ny=6)
    angle = np.radians(10.0)
    turned = mesh.points @ np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    return falling(pc.Mesh(turned, mesh.cells))


def disc() -> pc.Problem:
    """A disc that strikes the plane."""
    return falling(pc.Mesh.disc(0.025, rings=4))


def falling(mesh: pc.Mesh, friction: float = 0.2) -> pc.Problem:
    """A body of aluminium that flies to a plane with friction below it."""
    return pc.Problem(
        mesh,
        material=pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress"),
        obstacles=[pc.Plane(point=(0, mesh.points[:, 1].min() - 2e-4), normal=(0, 1), friction=friction)],
        initial_velocity=(400, -400),
    )


@pytest.fixture(scope="session")
def block_history() -> pc.History:
    return pc.simulate(block(), end=13e-6, courant=0.9)


@pytest.fixture(scope="session")
def bar_history() -> pc.History:
    return pc.simulate(bar(), end=50e-6, courant=0.9)


@pytest.fixture(scope="module", params=[bar, block, tilted, disc])
def correct(request: pytest.FixtureRequest) -> pc.History:
    return pc.simulate(request.param(), end=20e-6, courant=0.8)
