"""Finite kinematics against exact solutions: coarse runs of the study converge as it states."""

import numpy as np
import pytest
from studies.benchmarks.trial import Quantity
from studies.finite_exact import elastica, rigid, shock, spin


def holds(quantity: Quantity, least: float) -> bool:
    """Whether a quantity is within its bound, or has at least this part of its order."""
    if quantity.bound is not None:
        return abs(quantity.difference) <= quantity.bound
    assert quantity.observed is not None and quantity.order is not None
    return quantity.observed >= least * quantity.order


@pytest.mark.parametrize("kind", ["bar", "block"])
def test_a_shock_has_the_speed_of_rankine_and_hugoniot(kind: shock.Kind, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shock, "ELEMENTS", shock.ELEMENTS[-1:])
    quantities = shock.shock(kind).quantities
    for each in quantities:
        assert holds(each, 1.0), each
    # The small-strain theory would have the wave speed, 3 and 4 % less.
    law = shock.Law(0.0 if kind == "bar" else 0.4)
    assert quantities[0].exact > 1.02 * law.wave_speed


def test_a_simple_wave_and_a_shock_differ_by_the_third_power() -> None:
    law = shock.Law(0.4)
    speeds = np.array([2.0, 4.0, 8.0])
    apart = [law.behind_shock(speed) - law.behind_wave(speed) for speed in speeds]
    orders = np.log2(np.array(apart[1:]) / apart[:-1])
    # 3 in the limit; the next power adds some per cent.
    assert orders == pytest.approx(3.0, abs=0.1)


def test_spinning_bodies_keep_their_steady_state(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(spin, "CELLS", (1, 2))
    for body in (spin.spinning_bar, spin.spinning_ring):
        # Order 2; the third power of coarse elements takes a tenth.
        for each in body().quantities:
            assert holds(each, 0.9), each


def test_a_slowly_spinning_bar_has_the_length_of_the_linear_theory() -> None:
    """At small spins the end moves by ρω²a³/(3E)."""
    spun = 0.01 * np.sqrt(spin.YOUNG / spin.DENSITY) / spin.HALVES[0]
    (end,) = spin.stretched(np.array([spin.HALVES[0]]), spin.HALVES[0], spun)
    assert end / spin.HALVES[0] - 1.0 == pytest.approx(1e-4 / 3.0, rel=1e-3)


def test_the_elastica_is_that_of_the_tables() -> None:
    """Mattiasson (1981), PL²/EI = 2: deflection 0.49346, shortening 0.16064, angle 0.78175."""
    x, y, angle, curvature = elastica.elastica(2.0, np.linspace(0.0, 1.0, 11))[-1]
    assert (y, 1.0 - x, angle) == pytest.approx((0.49346, 0.16064, 0.78175), abs=5e-6)
    assert abs(curvature) < 1e-10


def test_a_beam_bends_as_the_elastica(monkeypatch: pytest.MonkeyPatch) -> None:
    """A thicker beam, which takes fewer steps."""
    for name, value in {"ACROSS": (2, 4), "HEIGHT": 0.1 * elastica.LENGTH, "SETTLED": 0.02}.items():
        monkeypatch.setattr(elastica, name, value)
    deflection, shortening, extrapolated = elastica.bent_beam().quantities
    # Orders of 2.1 and 1.9: shear, which the elastica does not have, adds to the first.
    assert holds(deflection, 0.9) and holds(shortening, 0.9)
    # (height/length)²; 0.4 %.
    assert extrapolated.difference == pytest.approx(0.0, abs=0.01 * extrapolated.exact)


def test_a_stiff_block_moves_like_a_rigid_one(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rigid, "STIFFNESS", rigid.STIFFNESS[:2])
    for motion in (rigid.tumbling_block, rigid.struck_corner):
        for each in motion().quantities:
            assert holds(each, 0.9), each
