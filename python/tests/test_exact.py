"""The exact bar, and errors measured against it."""

import numpy as np
import percute as pc
import pytest
from conftest import bar

EXACT = pc.exact.bar_impact(length=0.1, young=70e9, density=2700.0, section=0.02, speed=400.0, gap=2e-4)


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
    other = pc.exact.bar_impact(length=0.1, young=70e9, density=2700.0, section=0.03, speed=400.0, gap=2e-4)
    with pytest.raises(pc.InputError, match="section"):
        other.error(bar_history)
    with pytest.raises(pc.InputError, match="plane body"):
        EXACT.error(block_history)
    with pytest.raises(pc.InputError, match="`gap` is 0 m"):
        pc.exact.bar_impact(length=0.1, young=70e9, density=2700.0, section=0.02, speed=400.0, gap=0.0)
