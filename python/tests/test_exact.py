"""The exact bar, and errors measured against it."""

import pickle

import numpy as np
import percute as pc
import pytest
from conftest import bar

EXACT = pc.exact.BarImpact(length=0.1, young=70e9, density=2700.0, section=0.02, speed=400.0, gap=2e-4)


def test_fields_are_those_of_the_wave() -> None:
    """Before, during and after contact at the struck end: flight, rest under the force ρScv, flight back."""
    instants = np.array([0.5 * EXACT.impact_time, EXACT.impact_time + 1e-5, EXACT.release_time + 1e-6])
    assert EXACT.velocity(0.0, instants).tolist() == [-400.0, 0.0, 400.0]
    plateau = 2700.0 * 0.02 * EXACT.wave_speed * 400.0
    assert np.allclose(EXACT.contact_force(instants), [0.0, plateau, 0.0], rtol=1e-14)
    assert np.allclose(EXACT.normal_force(0.0, instants), [0.0, -plateau, 0.0], rtol=1e-14)
    assert EXACT.wave_speed == pytest.approx((70e9 / 2700.0) ** 0.5, rel=1e-15)
    assert EXACT.release_time - EXACT.impact_time == pytest.approx(0.2 / EXACT.wave_speed, rel=1e-12)


def test_places_and_instants_are_broadcast() -> None:
    x, t = np.linspace(0.0, 0.1, 5)[:, None], np.linspace(0.0, 5e-5, 7)
    fields = EXACT.displacement(x, t)
    assert fields.shape == (5, 7) and fields[2, 3] == EXACT.displacement(x[2, 0], t[3])
    with pytest.raises(pc.InputError, match="`x` holds 0.2 m; it must lie in the bar"):
        EXACT.velocity(0.2, 0.0)


def test_true_errors_shrink_and_effectivities_do_not(bar_history: pc.History) -> None:
    """Halved elements bring the error of a wave front down by the root of two, or a little less (dispersion)."""
    coarse, fine = bar_history, pc.simulate(bar(160), end=50e-6, courant=0.9)
    errors = [EXACT.error(history) for history in (coarse, fine)]
    assert 1.3 < errors[0].mean / errors[1].mean < 2.2
    assert errors[0].sup**2 == pytest.approx(errors[0].total.max(), rel=1e-14)
    assert np.allclose(errors[0].kinetic + errors[0].elastic, errors[0].total, rtol=1e-15, atol=0)
    assert errors[0].time.shape == coarse.time.shape
    effectivity = EXACT.effectivity(pc.estimate(coarse))
    assert 0.5 < effectivity.mean < 2.0 and 0.5 < effectivity.sup < 2.0


def test_another_bar_is_refused(bar_history: pc.History, block_history: pc.History) -> None:
    other = pc.exact.BarImpact(length=0.1, young=70e9, density=2700.0, section=0.03, speed=400.0, gap=2e-4)
    with pytest.raises(pc.InputError, match="section"):
        other.error(bar_history)
    with pytest.raises(pc.InputError, match="plane body"):
        EXACT.error(block_history)
    with pytest.raises(pc.InputError, match="`gap` is 0 m"):
        pc.exact.BarImpact(length=0.1, young=70e9, density=2700.0, section=0.02, speed=400.0, gap=0.0)


STEEL = {"length": 2.0, "young": 200e9, "density": 8000.0, "section": 1e-3}
SOFT = {"length": 10.0, "young": 900.0, "density": 1.0, "section": 1.0}
BARS = [
    pc.exact.BouncingBar(**SOFT, gravity=10.0, height=5.0),
    pc.exact.ClampedRod(**STEEL, distance=1e-3),
    pc.exact.BarMode(**STEEL, amplitude=1e-4, number=3, fixed="start", phase=0.3),
    pc.exact.BarMode(**STEEL, amplitude=1e-4, number=2, fixed="both"),
    pc.exact.BarRamp(**STEEL, rate=1e12),
]


@pytest.mark.parametrize("exact", BARS, ids=lambda exact: type(exact).__name__)
def test_fields_of_bars_are_derivatives_of_the_displacement(exact: pc.exact.BarMode) -> None:
    """Central differences over 1e-6 of a passage: at 400 places a front lies inside of a few of them at most."""
    rng = np.random.default_rng(1)
    passage = exact.length / (exact.young / exact.density) ** 0.5
    x, t = exact.length * rng.uniform(0.01, 0.99, 400), passage * rng.uniform(0.1, 9.0, 400)
    dt, dx = 1e-6 * passage, 1e-6 * exact.length
    velocity = (exact.displacement(x, t + dt) - exact.displacement(x, t - dt)) / (2 * dt)
    force = exact.young * exact.section * (exact.displacement(x + dx, t) - exact.displacement(x - dx, t)) / (2 * dx)
    for value, difference in ((exact.velocity(x, t), velocity), (exact.normal_force(x, t), force)):
        assert np.mean(abs(value - difference) < 1e-5 * abs(value).max()) > 0.98
    assert pickle.loads(pickle.dumps(exact)) == exact


def test_the_error_against_a_mode_falls_with_the_mesh() -> None:
    """Linear elements: order 1 in the energy norm; half of the energy is strain energy, off by kh/√12."""
    mode = pc.exact.BarMode(length=0.1, young=70e9, density=2700.0, section=1e-4, amplitude=1e-4, number=2, fixed="start")

    def error(elements: int) -> float:
        x = np.linspace(0, mode.length, elements + 1)
        problem = pc.Problem(
            pc.Mesh.bar(mode.length, elements=elements),
            material=pc.Elastic(young=mode.young, density=mode.density, section=mode.section),
            supports=[pc.Support(group="start", components="x")],
            initial_displacement=mode.displacement(x, 0.0),
        )
        return mode.error(pc.simulate(problem, end=4 * np.pi / mode.angular_frequency, courant=0.7)).mean / mode.energy**0.5

    coarse, fine = error(20), error(40)
    assert 1.9 < coarse / fine < 2.1
    assert fine == pytest.approx(mode.wave_number * mode.length / 40 / 24**0.5, rel=0.05)


def test_modes_of_a_block_and_a_rigid_block() -> None:
    law = pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress")
    mode = pc.exact.BlockMode(width=0.05, height=0.04, material=law, wave="pressure", numbers=(1, 1), amplitude=1e-5)
    speed = (70e9 / (1 - 0.09) / 2700.0) ** 0.5
    assert mode.angular_frequency == pytest.approx(np.pi * np.hypot(20, 25) * speed, rel=1e-14)
    corner = mode.displacement([[0.025, 0.0], [0.0, 0.02]], np.pi / mode.angular_frequency)
    assert np.allclose(corner, -1e-5 / np.hypot(20, 25) * np.array([[20, 0], [0, 25]]), atol=1e-20)
    slide = pc.exact.RigidSlide(mass=2.0, limit=3.0, push=[(0.0, 5.0)])
    assert np.allclose(slide.position([1.0, 2.0]), [0.5, 2.0]) and slide.dissipated(2.0) == pytest.approx(6.0)
    assert slide.velocity(2.0) == pytest.approx(2.0) and slide.friction(1.0) == -3.0


def test_what_has_no_closed_form_is_refused(block_history: pc.History, bar_history: pc.History) -> None:
    with pytest.raises(pc.InputError, match="whole number, at least 3, of periods"):
        pc.exact.BouncingBar(**SOFT, gravity=10.0, height=5.1)
    with pytest.raises(pc.InputError, match="`fixed` is 'end'"):
        pc.exact.BarMode(**STEEL, amplitude=1e-4, number=1, fixed="end")  # type: ignore[arg-type]
    with pytest.raises(pc.InputError, match="`push`"):
        pc.exact.RigidSlide(mass=1.0, limit=1.0, push=[(1.0, 1.0), (0.0, 2.0)])
    with pytest.raises(pc.InputError, match="length"):
        BARS[1].error(bar_history)
    with pytest.raises(pc.InputError, match="plane body"):
        BARS[1].error(block_history)
