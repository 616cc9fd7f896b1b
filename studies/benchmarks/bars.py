"""Bars that strike an obstacle: the simulation smears a front over h^(2/3), and quantities that wait for it are of that order."""

from __future__ import annotations

import numpy as np

from percute.exact import BarImpact, BouncingBar, ClampedRod
from studies.bar import BAR
from studies.benchmarks.trial import Curve, Outcome, Quantity, Trial, bar, filled, values
from studies.parallel import Stop

MESHES = (50, 100, 200, 400)
"""Elements of a bar."""
RODS = (20, 40, 80, 160, 320)
"""Elements of the rod."""
FRACTIONS = (0.1, 0.3, 0.5, 0.7, 0.9)
"""The place of the impact in a step, after `FLIGHT` whole steps."""
FLIGHT = 2
COURANT = 0.9

FRONT = "a jump that the scheme disperses over a width of h^(2/3) (Airy front): its energy norm is of order 1/3"
RETURN = "it waits for the smeared front, which is as late as it is wide: h^(2/3)"
PLATEAU = "between the fronts only their tails are left: a thousandth of the force"
HALF_MASS = "each impact stops the mass of the node that touches, ρSh/2, and loses its energy: order 1"


def _impact_quantities(exact: BarImpact, step: float) -> list[Quantity]:
    contact = exact.release_time - exact.impact_time
    force = float(exact.contact_force(exact.impact_time + contact / 2))
    return [
        Quantity("error over the energy norm of the flight, mean over time", "", 0.0, FRONT, order=1 / 3),
        Quantity("velocity of the rebound", "m/s", exact.speed, RETURN, order=2 / 3),
        Quantity("duration of contact", "s", contact, RETURN, order=2 / 3),
        Quantity("contact force, middle half", "N", force, PLATEAU, bound=1e-3 * force),
        Quantity("impact", "s", exact.impact_time, "known to the step in which it falls", bound=step),
    ]


def _measure_impact(exact: BarImpact, trial: Trial) -> list[float]:
    start, contact = exact.impact_time, exact.release_time - exact.impact_time
    flight = 0.5 * trial.mass * exact.speed**2
    return [
        exact.error(trial.history).mean / flight**0.5,
        trial.mean(trial.history.velocity)[-1, 0],
        np.count_nonzero(trial.resultants.normal_force > 0) * trial.step,
        trial.mean_force(start + contact / 4, start + 3 * contact / 4),
        # The first force brings the end to the plane: the impact is in that step.
        trial.history.contact.first_touch.min() - trial.step / 2,
    ]


def bar_impact(stop: Stop | None = None) -> Outcome:
    """Strike a wall, which sends a wave of N = -ρScv through the bar. When it is back, the bar leaves with its velocity.

    Of several places of the impact in a step, each value is the one farthest from the exact one.
    """
    whole = BarImpact(gap=2e-4, **BAR)
    runs, curve, step = [], None, float("nan")
    for elements in MESHES:
        measured = []
        for fraction in FRACTIONS:
            gap = (FLIGHT + fraction) * BAR["length"] / elements * COURANT / whole.wave_speed * BAR["speed"]
            exact = BarImpact(**{**BAR, "gap": gap})
            end = exact.release_time + 0.5 * (exact.release_time - exact.impact_time)
            trial = Trial("bar_impact", stop, bar=bar(exact.length, elements), point=-gap, end=end)
            *others, impact = _measure_impact(exact, trial)
            # Each gap has an impact of its own.
            measured.append([*others, impact + whole.impact_time - exact.impact_time])
            step = trial.step
            if curve is None:
                force = exact.contact_force(trial.time), trial.resultants.normal_force
                curve = Curve("contact force", "MN", 1e6 * trial.time, "µs", 1e-6 * force[0], 1e-6 * force[1])
        runs.append(measured)
    quantities = _impact_quantities(whole, step)
    worst = [[max(each, key=lambda v: abs(v - q.exact)) for q, each in zip(quantities, zip(*run, strict=True), strict=True)] for run in runs]
    return Outcome(filled(quantities, worst), curve)


def steel_bar(stop: Stop | None = None) -> Outcome:
    """Creep against a wall: impact after 5e-4 s, contact for 3.8545e-4 s, a force of 1270.8 N."""
    exact = BarImpact(length=1.0, young=210e9, density=7800.0, section=3.14e-4, speed=0.1, gap=5e-5)
    trials = [Trial("steel_bar", stop, bar=bar(exact.length, elements)) for elements in MESHES]
    return Outcome(filled(_impact_quantities(exact, trials[-1].step), [_measure_impact(exact, trial) for trial in trials]))


def bouncing_bar(stop: Stop | None = None) -> Outcome:
    """Fall for 1 s, touch for 2/3 s, fly for 2 s: the next bounce is the first one backwards, and all repeats after 16/3 s."""
    exact = BouncingBar(length=10.0, young=900.0, density=1.0, section=1.0, gravity=10.0, height=5.0)
    airborne = 2 * exact.impact_time + exact.contact_duration
    runs, curve = [], None
    for elements in MESHES:
        trial = Trial("bouncing_bar", stop, bar=bar(exact.length, elements))
        touching = trial.time[(trial.resultants.normal_force > 0) & (trial.time >= airborne)]
        height = trial.path[:, 0] + exact.height
        runs.append([
            exact.error(trial.history).mean / exact.energy**0.5,
            trial.resultants.impulse[-1, 0],
            touching[0] + trial.step / 2,
            np.interp(exact.period, trial.time, height),
            trial.energy[-1] + trial.mass * exact.gravity * height[-1],
        ])  # fmt: skip
        if curve is None:
            gap = (u + exact.height for u in (exact.displacement(0.0, trial.time), trial.history.displacement[:, 0, 0]))
            curve = Curve("gap of the lower end", "m", trial.time, "s", *gap)
    # After two periods it is at rest again: the bounces have given back the impulse of the weight.
    impulse = exact.energy / exact.height * 2 * exact.period
    quantities = [
        Quantity("error over the energy norm, mean over two periods", "", 0.0, FRONT, order=1 / 3),
        Quantity("impulse of four bounces", "N s", impulse, RETURN, order=2 / 3),
        Quantity("second impact", "s", airborne + exact.impact_time, RETURN, order=2 / 3),
        Quantity("height of the bar after a period of 16/3 s", "m", exact.height, RETURN, order=2 / 3),
        Quantity("energy after four bounces", "J", exact.energy, HALF_MASS, order=1.0),
    ]
    return Outcome(filled(quantities, runs), curve)


def clamped_rod(stop: Stop | None = None) -> Outcome:
    """Spring back from (1 - x)/2 and arrive undeformed after 1 s: it touches for 1 s with a force of 1/2, period 3 s, energy 1/8."""
    exact = ClampedRod(length=1.0, young=1.0, density=1.0, section=1.0, distance=0.5)
    runs, curve = [], None
    for elements in RODS:
        start = exact.displacement(np.arange(elements + 1) / elements, 0.0)
        trial = Trial("clamped_rod", stop, bar=bar(exact.length, elements), displacement=values(start))
        end = trial.history.displacement[:, 0, 0]
        runs.append([
            exact.error(trial.history).mean / exact.energy**0.5,
            end[len(end) // 2],  # after half of the run, a period
            trial.energy[-1],
            trial.mean_force(1.25 * exact.passage, 1.75 * exact.passage),
            trial.resultants.impulse[-1, 0],
        ])  # fmt: skip
        curve = curve or Curve("gap of the free end", "m", trial.time, "s", exact.displacement(0.0, trial.time), end)
    force = float(exact.contact_force(1.5 * exact.passage))
    quantities = [
        Quantity("error over the energy norm, mean over two periods", "", 0.0, FRONT, order=1 / 3),
        Quantity("distance of the end after a period of 3 s", "m", exact.distance, RETURN, order=2 / 3),
        Quantity("energy after two periods", "J", exact.energy, HALF_MASS, order=1.0),
        Quantity("contact force, middle half of the first contact", "N", force, PLATEAU, bound=1e-3 * force),
        Quantity("impulse of two contacts", "N s", 2 * force * exact.passage, RETURN, order=2 / 3),
    ]
    return Outcome(filled(quantities, runs), curve)
