"""Bars that strike each other, against their exact solution."""

import pickle
from dataclasses import replace

import numpy as np
import percute as pc
import pytest
from percute.exact import BarImpact, BarRow
from studies import bar_rows

ALUMINIUM = pc.Elastic(young=70e9, density=2700, section=1e-4)
STEEL = pc.Elastic(young=210e9, density=7800, section=1e-4)


def pair(elements: int = 20, gap: float = 1e-4) -> list[pc.Body]:
    bar = pc.Mesh.bar(0.1, elements=elements)
    left = pc.Body(name="left", mesh=bar, material=ALUMINIUM, origin=-0.1, velocity=10.0)
    return [left, pc.Body(name="right", mesh=bar, material=ALUMINIUM, origin=gap, velocity=-10.0)]


def simulated(bodies: list[pc.Body], end: float, courant: float = 0.9) -> pc.History:
    names = [body.name for body in bodies]
    contacts = [pc.Interface(groups=(f"{a}.end", f"{b}.start")) for a, b in zip(names, names[1:], strict=False)]
    return pc.simulate(pc.Problem(bodies=bodies, contacts=contacts), end=end, courant=courant)


def test_equal_bars_are_bars_on_a_plane() -> None:
    """The error of two equal bars head-on is √2 of that of one bar on a plane in the middle, by another solution and another sum."""
    bodies, end = pair(), 60e-6
    plane = BarImpact(length=0.1, young=70e9, density=2700, section=1e-4, speed=10.0, gap=5e-5)
    # In the bar on the plane, x starts at 0.
    alone = pc.Problem(pc.Mesh.bar(0.1, elements=20), material=ALUMINIUM, initial_velocity=-10.0, obstacles=[pc.Plane(point=-5e-5, normal=1.0)])
    one = plane.error(pc.simulate(alone, end=end, courant=0.9))
    row = BarRow(bodies=bodies, end=end)
    two = row.error(simulated(bodies, end))
    # Rounding of displacements of 1e-3 m that strains of 1e-4 amplify, and of places of the fronts.
    assert two.sup == pytest.approx(2**0.5 * one.sup, rel=1e-9) and two.mean == pytest.approx(2**0.5 * one.mean, rel=1e-9)
    [[start, stop]] = row.contacts(0)
    assert start == pytest.approx(plane.impact_time, rel=1e-9) and stop == pytest.approx(plane.release_time, rel=1e-9)
    x, t = np.linspace(0.0, 0.1, 7), np.linspace(1e-6, end, 11)[:, None]
    assert np.allclose(row.velocity("right", 1e-4 + x, t), plane.velocity(x, t), atol=1e-9)
    assert np.allclose(row.displacement("left", -x, t), -plane.displacement(x, t), atol=1e-15)
    assert row.contact_force(0, 15e-6) == pytest.approx(float(plane.contact_force(15e-6)), rel=1e-12)
    assert pickle.loads(pickle.dumps(row)) == row


def test_a_front_inside_an_element_is_exact() -> None:
    """A history that does not move, against bars that do: the integrals have a closed form.

    Before the bars meet, e² is the kinetic energy of both; afterwards N = ρcSv where the wave has been, and v elsewhere.
    """
    bodies = pair(3)
    problem = pc.Problem(bodies=bodies)
    history = simulated(bodies, 12e-6, courant=0.5)
    row = BarRow(bodies=bodies, end=1.0)
    nothing = np.zeros(4)
    speed = (70e9 / 2700) ** 0.5
    t, energy = 7.3e-6, 0.5 * 2700 * 1e-4 * 0.1 * 100
    kinetic, elastic = row._of_body(0, problem.mesh.points[:4, 0], nothing, nothing, t)
    # 5 µs of flight, then the wave runs for 2.3 µs.
    part = speed * 2.3e-6 / 0.1
    assert kinetic == pytest.approx(energy * (1 - part), rel=1e-9) and elastic == pytest.approx(energy * part, rel=1e-9)
    assert row.error(history).total[0] < 1e-20


@pytest.mark.parametrize("right", [ALUMINIUM, STEEL], ids=["equal", "on steel"])
def test_the_estimate_is_close_to_the_true_error(right: pc.Elastic) -> None:
    """0.86 to 1.23 is the range of tables of bodies of matching meshes; the larger study has more of them."""
    left, other = pair(50)
    bodies = [left, pc.Body(name="right", mesh=other.mesh, material=right, origin=other.origin, velocity=0.0)]
    row = BarRow(bodies=bodies, end=1e-4)
    history = simulated(bodies, float(row.contacts(0)[0, 1]), courant=0.7)
    index = row.effectivity(pc.estimate(history, every=1))
    assert 0.86 < index.sup < 1.12 and 0.89 < index.mean < 1.23


def test_what_is_not_a_row_is_refused() -> None:
    left, right = pair()
    with pytest.raises(pc.InputError, match="overlap or are not in the order"):
        BarRow(bodies=[right, left], end=1e-4)
    with pytest.raises(pc.InputError, match="`end` is 0 s"):
        BarRow(bodies=[left, right], end=0.0)
    square = pc.Body(name="square", mesh=pc.Mesh.rectangle(1, 1, nx=1, ny=1), material=ALUMINIUM)
    with pytest.raises(pc.InputError, match="plane body"):
        BarRow(bodies=[square], end=1.0)
    row = BarRow(bodies=[left, right], end=1e-4)
    with pytest.raises(pc.InputError, match=r"`x` holds 0.2 m; it must lie in left, from -0.1 to 0 m"):
        row.velocity("left", 0.2, 0.0)
    with pytest.raises(pc.InputError, match="the bars are left, right"):
        row.velocity("middle", 0.2, 0.0)
    with pytest.raises(pc.InputError, match="`t` holds 1 s"):
        row.contact_force(0, 1.0)
    with pytest.raises(pc.InputError, match="`first` is 1"):
        row.contacts(1)
    with pytest.raises(pc.InputError, match="mesh is not that"):
        row.error(simulated(pair(10), 2e-5))
    with pytest.raises(pc.InputError, match="after the end of the exact solution"):
        row.error(simulated(pair(), 2e-4))
    slower = [left, pc.Body(name="right", mesh=right.mesh, material=ALUMINIUM, origin=right.origin, velocity=-9.0)]
    with pytest.raises(pc.InputError, match="other initial velocities"):
        row.error(simulated(slower, 2e-5))


def test_contact_lasts_2l_over_c_and_velocities_are_exchanged() -> None:
    """Observed orders of 0.75 and more against 2/3 of a front smeared over h^(2/3); the page has finer bars."""
    exact = bar_rows._exact()
    coarse, fine = bar_rows._measured(50), bar_rows._measured(200)
    for at in range(3):
        assert np.log2(abs((coarse[at] - exact[at]) / (fine[at] - exact[at]))) / 2 > 2 / 3
    assert fine[3] == pytest.approx(exact[3], rel=1e-3)
    # A step on 200 elements is 0.9 h/c = 88 ns.
    assert abs(fine[4]) < 0.5 * 0.9 * 0.1 / 200 * (2700 / 70e9) ** 0.5


@pytest.mark.parametrize("case", bar_rows._rows(), ids=lambda case: f"{case[0].name}, {case[2][0]:g}")
def test_each_row_of_the_page_has_its_indices(case: tuple[bar_rows.Row, tuple[int, ...], tuple[float, ...]]) -> None:
    """0.82 to 1.25 below the critical step, on few elements; the page has all."""
    row, _, ratios = case
    few = replace(row, elements=20, ratio=ratios[0])
    index = few.index()
    low, high = (0.82, 1.25) if ratios[0] < 1 else (0.96, 1.7)
    assert low < index.sup < high and low < index.mean < high
