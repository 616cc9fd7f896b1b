"""The benchmarks: each quantity converges at the order that theory predicts, and is as near as it should be.

All tolerances of bars that strike follow from two lengths, for n elements of length h = L/n:

- the front of a jump of velocity is smeared over L(h/L)^⅔ (Airy front). A quantity that waits for it is off by at most that share,
  (1/n)^⅔, of a passage, and the energy norm by at most its root, (1/n)^⅓. Orders are ⅔ and ⅓ in the limit and higher before it, where
  the front fills the bar; instants are whole steps, which scatters single runs: four halvings leave ⅓ ± 0.1 and ⅔ + 0.3 − 0.1;
- each impact loses the energy of the node that is stopped, that of half an element: 1/(2n) of the whole. A new impact on a body
  that still swings loses a little less or more: order 1 ± 0.2.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from studies.benchmarks import BENCHMARKS
from studies.benchmarks.trial import CASES, Outcome, Quantity
from studies.choices import PLANE_CHOICES

FRONT, RETURN, LOSS = (0.23, 0.43), (0.57, 0.97), (0.8, 1.2)
NONE = None
"""Bounded quantities have no order."""

Must = tuple[str, tuple[float, float] | None, float]
"""The start of the name of a quantity, the range of its order, and its largest difference in the last run."""


def front(elements: int) -> float:
    """On n elements: (1/n)^⅔."""
    return elements ** (-2 / 3)


def bars() -> dict[str, list[Must]]:
    """Five places of the impact in a step, the worst of them: contact lasts 39.28 µs, the force is ρScv₀ = 110 MN, the impact is at 0.5 µs,
    and steps are 0.9·0.25 mm/5092 m/s = 44.2 ns, of which half are known at best. The tails leave less between the fronts than any front
    does: 1e-6 of the force.

    Bouncing bar, two periods: fronts pass 16 times, which smear as the cube root of the time, 16^⅓ = 2.5; energies are proportional to
    squares of errors. The momentum of a bounce is that of the fall, 100 N s twice, the period 16/3 s and the height 5 m. Four impacts.

    Clamped rod: six passages, two impacts, of all of the rod at the velocity that has all of the energy.

    Steel bar: steps of 0.9·2.5 mm/5189 m/s = 0.43 µs. The impact lies on a t_n within rounding, which is in the step before or after.
    """
    n = front(400)
    rod = front(320)
    return {
        "bar_impact": [
            ("error", FRONT, n**0.5),
            ("velocity of the rebound", RETURN, 400 * n),
            ("duration", RETURN, 39.28e-6 * n),
            ("contact force", NONE, 1.1e8 * 1e-6),
            ("impact", NONE, 22.1e-9),
        ],
        "bouncing_bar": [
            ("error", FRONT, n**0.5),
            ("impulse", RETURN, 1066.7 * n),
            ("second impact", RETURN, 2 / 3 * n),
            ("height", RETURN, 5 * n),
            ("energy", LOSS, 500 * 4 / (2 * 400)),
        ],
        "clamped_rod": [
            ("error", FRONT, rod**0.5),
            ("distance", RETURN, 0.5 * rod),
            ("energy", LOSS, 0.125 * 2 / (2 * 320)),
            ("contact force", NONE, 0.5 * 1e-5),
            ("impulse", RETURN, rod),
        ],
        "steel_bar": [
            ("error", FRONT, n**0.5),
            ("velocity of the rebound", RETURN, 0.1 * n),
            ("duration", RETURN, 3.8545e-4 * n),
            ("contact force", NONE, 1270.8 * 1e-6),
            ("impact", NONE, 0.43e-6),
        ],
    }


def vibrations() -> dict[str, list[Must]]:
    """The lag of phase after a time T is ωT(kh)²(1 − r²)/24: with 2.25 periods, kL = 3π/2, r = 0.7 and 80 elements 1.043e-3, and 5 % for
    the next term and the rounding of r. The energy norm has the piecewise constant stress: kh/√12 of half of the energy, 0.0120.

    Modes of the block: as for the bar, times the root mean square ½ of a mode, and half as much again for the shape of the elements: 1.2
    periods, 40 cells.

    The pull that grows, on 200 elements: a kink of u'' smeared over 0.03 L; (1/n)^(5/3), n⁻² and 1/n of the largest values, all with a
    factor below 1. The order of the first falls from 2, of the smooth part, to 5/3.
    """
    kh = 1.5 * math.pi / 80
    bar = 1.05 * 2.25 * math.tau * kh**2 * (1 - 0.49) / 24
    block = 1.5 * 0.5 * 1.2 * math.tau * ((math.pi / 0.05) ** 2 + (math.pi / 0.04) ** 2) * (0.05 / 40) ** 2 / 24
    return {
        "bar_mode": [("largest error", (1.95, 2.05), bar), ("error over", (0.9, 1.1), 1.05 * kh / 12**0.5 * 0.5**0.5)],
        "block_mode": [("pressure", (1.9, 2.1), block), ("shear", (1.9, 2.1), block)],
        "bar_ramp": [
            ("root mean square", (1.6, 2.1), 200 ** (-5 / 3)),
            ("displacement of the pulled end", (1.7, 2.2), 1.29e-4 / 200**2),
            ("error over", (0.9, 1.1), 1 / 200),
        ],
    }


def blocks() -> dict[str, list[Must]]:
    """The shear wave crosses the block of H = 0.2 m in τ = H/√(G/ρ) = 0.63 ms at E = 0.2 GPa, G = E/2: sliding starts within 2τ, the distance
    after T is off by aTτ' with τ' < τ, the acceleration by 2aτ²/T² and the energy like the distance (with the microscopic slip of the corners,
    twice). With more friction it slips by at most ½g(2τ)² while the shear of its weight, which comes suddenly, overshoots. The vibrations that
    are left scatter the acceleration.

    Stick and slip: each of the four times that it sticks and slips again costs a passage of the shear wave, H/c_s = 0.16 ms of the 0.2 s of a
    half wave, and the vibrations that are left scatter the start: orders 1 − 0.2 + 0.6.

    Oblique impact, 64 layers: the front over (1/64)^⅔ of the height, and 1/(2·64) of the normal energy for the layer that is stopped. All nodes
    slide, so that the ratio of the impulses is rounding. The sliding velocity drops by about a tenth in one step of 260.

    Patch test: zero to rounding for each choice of the method, 1e-16 of the displacement of 24 µm over the strains of 7e-4 on elements of 20 mm,
    which vibrate on for 94 steps; measured 1.5e-12. In contact forces are as exact, 1e-9 of the pressure; the contact law holds to rounding of
    velocities, of which the energy is the first power: its root is 1e-8.
    """
    sin, cos = 0.5, 0.75**0.5
    passage, acceleration, end = 0.2 / (1.024e8 / 1000) ** 0.5, 9.81 * (sin - 0.3 * cos), 0.2
    late = acceleration * end * passage
    return {
        "tilted_plane": [
            ("distance", (0.9, 1.1), late),
            ("acceleration", (1.5, 2.5), 2 * acceleration * (passage / end) ** 2),
            ("energy", (0.7, 1.3), 2 * 0.3 * 80 * 9.81 * cos * late),
            ("slip", (1.9, 2.1), 0.5 * 9.81 * (2 * passage) ** 2),
        ],
        "stick_slip": [("largest error", (0.8, 1.6), 4 * 0.16e-3 / 0.2), ("energy", (0.8, 1.6), 4 * 0.16e-3 / 0.2 * 3.44)],
        "oblique": [
            ("normal impulse", (0.57, 0.97), 108 * front(64)),
            ("tangential over normal", NONE, 1e-14),
            ("energy lost", (0.8, 1.3), 1 / (2 * 64)),
            ("work of the sliding forces", (0.6, 1.3), 0.1 / 260),
        ],
        "patch": [("relative error", NONE, 1e-11)] * len(PLANE_CHOICES),
        "patch_contact": [
            ("pressure", NONE, 5e7 * 1e-10),
            ("shear", NONE, 5e7 * 1e-10),
            ("relative elastic error", NONE, 1e-11),
            ("relative error", NONE, 1e-7),
        ],
    }


MUST = bars() | vibrations() | blocks()
RUNS = {case.key: case.run for case in BENCHMARKS}


@pytest.fixture(scope="module")
def steel() -> Outcome:
    return RUNS["steel_bar"](None)


def test_every_case_has_its_file_and_its_test() -> None:
    assert {path.stem for path in CASES.glob("*.toml")} == set(RUNS) == set(MUST)


@pytest.mark.parametrize("key", MUST)
@pytest.mark.filterwarnings("ignore::percute.InputWarning")
def test_orders_and_differences(key: str, request: pytest.FixtureRequest) -> None:
    outcome = request.getfixturevalue("steel") if key == "steel_bar" else RUNS[key](None)
    for quantity, (name, orders, largest) in zip(outcome.quantities, MUST[key], strict=True):
        assert quantity.name.startswith(name)
        assert abs(quantity.difference) <= largest, f"{name}: {quantity.computed[-1]} instead of {quantity.exact}, {largest} off at most"
        if orders is None:
            assert quantity.bound is not None and largest <= quantity.bound, f"{name}: the page promises less than {largest}"
        else:
            assert quantity.order is not None and quantity.observed is not None
            assert orders[0] <= quantity.order <= orders[1] and orders[0] <= quantity.observed <= orders[1], f"{name}: order {quantity.observed}"
    if outcome.curve is not None:
        curve = outcome.curve
        assert curve.time.shape == curve.exact.shape == curve.computed.shape
        assert np.isfinite(curve.exact).all() and np.isfinite(curve.computed).all()


def test_the_published_figures_of_the_steel_bar(steel: Outcome) -> None:
    """The case is known by 5e-4 s, 3.8545e-4 s and 1270.8 N, to the digits given."""
    exact = {quantity.name.split(",")[0]: quantity.exact for quantity in steel.quantities}
    assert abs(exact["impact"] - 5e-4) < 1e-12
    assert abs(exact["duration of contact"] - 3.8545e-4) < 0.5e-8
    assert abs(exact["contact force"] - 1270.8) < 0.05


def test_the_order_of_a_quantity() -> None:
    """Differences 8, −2, ½: order 2."""
    quantity = Quantity("length", "m", 1.0, "", order=2.0, computed=[9.0, -1.0, 1.5])
    assert quantity.observed == pytest.approx(2.0) and quantity.difference == 0.5
    assert Quantity("length", "m", 1.0, "", bound=1.0, computed=[9.0, 1.5]).observed is None
