"""The exact impact of a bar that yields on a rigid plane, by front tracking.

The states of a bar with linear hardening are piecewise constant, between fronts of constant speed: elastic waves (c),
waves of plastic flow (c_p) and places where the plastic strain jumps (0). Where fronts meet, or reach an end, a Riemann
problem gives new ones. Its solution is exact, because the velocity behind a wave is a piecewise linear function of the
stress there.

Where a wave of plastic flow reaches an end or another such wave, elastic waves between both run to and fro. If these
make the bar flow again, there are infinitely many of them in a finite time, and `strike` refuses to go on. With
isotropic hardening, up to 15 v_y and with E_t/E from 0.02 to 0.3, this has not occurred within 4 L/c; it does at
4.7 L/c for 8 v_y and 0.02. With kinematic hardening it is the rule at 3 v_y and more, at the earliest at L/c_p.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from studies.yielding.bar import Bar, Floats, Integers, positive

NOTHING = 1e-13
"""Waves of a smaller stress, over σ_y, are rounding."""
TOGETHER = 1e-14
"""Fronts nearer than this, over L, to a place where others meet meet there too: rounding of places."""
MEETINGS = 5000
"""Meetings of fronts before `strike` gives up: impacts with finitely many waves have some hundred within 2.5 L/c."""


class State(NamedTuple):
    """The state between two fronts, in the units of `_Law`."""

    stress: float
    velocity: float
    plastic_strain: float
    p: float


@dataclass(frozen=True)
class _Law:
    """The law in units of σ_y, v_y, L and L/c; strains in σ_y/E. There E = ρ = c = σ_y = 1."""

    slow: float
    """c_p."""
    kinematic: float

    @property
    def hardening(self) -> float:
        return self.slow**2 / (1.0 - self.slow**2)

    def limits(self, state: State) -> tuple[float, float]:
        """Give the least and the largest stress without plastic flow."""
        back = self.kinematic * self.hardening * state.plastic_strain
        radius = 1.0 + (1.0 - self.kinematic) * self.hardening * state.p
        return back - radius, back + radius

    def change(self, state: State, stress: float) -> float:
        """Give ∫dσ/(ρc) along waves that bring a state to a stress: its change of velocity if they run to the left."""
        low, high = self.limits(state)
        knee = min(max(stress, low), high)
        return knee - state.stress + (stress - knee) / self.slow

    def balanced(self, sides: Sequence[State], jump: float) -> float:
        """Give the stress at which the changes of these states add up to a jump of velocity."""
        limits = [self.limits(side) for side in sides]
        knees = sorted(knee for each in limits for knee in each)
        missing = [jump - sum(self.change(side, knee) for side in sides) for knee in knees]
        # The last knee before the zero; the sum increases.
        last = sum(each >= 0.0 for each in missing) - 1
        if last < 0:
            return knees[0] + missing[0] * self.slow / len(sides)
        if last == len(knees) - 1:
            return knees[last] + missing[last] * self.slow / len(sides)
        middle = 0.5 * (knees[last] + knees[last + 1])
        slope = sum(1.0 if low <= middle <= high else 1.0 / self.slow for low, high in limits)
        return knees[last] + missing[last] / slope

    def waves(self, state: State, stress: float, direction: int) -> list[tuple[float, State]]:
        """Give speed and state behind each wave that runs into a state, the first wave first."""
        low, high = self.limits(state)
        knee = min(max(stress, low), high)
        found: list[tuple[float, State]] = []
        behind = state
        if abs(knee - state.stress) > NOTHING:
            behind = state._replace(stress=knee, velocity=state.velocity - direction * (knee - state.stress))
            found.append((direction * 1.0, behind))
        if abs(stress - knee) > NOTHING:
            flow = (stress - knee) / self.hardening
            velocity = behind.velocity - direction * (stress - knee) / self.slow
            behind = State(stress, velocity, state.plastic_strain + flow, state.p + abs(flow))
            found.append((direction * self.slow, behind))
        return found

    def fan(self, left: State, right: State) -> tuple[list[float], list[State]]:
        """Solve a Riemann problem: give the speeds of its fronts and the states between them, from left to right."""
        stress = self.balanced((left, right), right.velocity - left.velocity)
        to_left, to_right = self.waves(left, stress, -1), self.waves(right, stress, 1)
        speeds, states = [speed for speed, _ in to_left], [state for _, state in to_left]
        a, b = (waves[-1][1] if waves else side for waves, side in ((to_left, left), (to_right, right)))
        inner = [state for _, state in reversed(to_right)]
        if max(abs(a.plastic_strain - b.plastic_strain), abs(a.p - b.p)) > NOTHING / self.hardening:
            speeds.append(0.0)
            states += inner
        elif to_left and to_right:
            states += inner[1:]
        elif to_left or to_right:
            # One side has no waves: its state is that of the middle.
            states = states[:-1] + inner[1:]
        else:
            speeds.append(0.0)
        return speeds + [speed for speed, _ in reversed(to_right)], states


class _Entry(NamedTuple):
    """The numbers of fronts and states from left to right, from one instant on."""

    time: float
    fronts: Integers
    regions: Integers


class _Tracker:
    """The fronts at one instant, and all that have been; units of `_Law`, times from the impact.

    Region k is to the right of front k − 1 and vanishes at ``vanishing[k]``; the first and the last region are at the
    ends of the bar.
    """

    def __init__(self, law: _Law, speed: float, gap: float) -> None:
        """Start the flight to the plane."""
        self.law = law
        self.time = -gap / speed
        self.touching = False
        self.gap, self.since = gap, self.time
        """The gap at an earlier instant, and this instant."""
        self.made: list[tuple[float, float]] = []
        """Place at time 0 and speed of each front."""
        self.states = [State(0.0, -speed, 0.0, 0.0)]
        self.fronts: list[int] = []
        self.regions = [0]
        self.vanishing = [math.inf]
        self.log: list[_Entry] = []
        self._note()

    def _edge(self, front: int) -> float:
        """Give the place of the front of this number, or of the end beyond the first or the last one."""
        if front < 0 or front == len(self.fronts):
            return 0.0 if front < 0 else 1.0
        start, speed = self.made[self.fronts[front]]
        return start + speed * self.time

    def _vanishes(self, region: int) -> float:
        """Give the time at which a region vanishes."""
        left, left_speed = (0.0, 0.0) if region == 0 else self.made[self.fronts[region - 1]]
        right, right_speed = (1.0, 0.0) if region == len(self.fronts) else self.made[self.fronts[region]]
        if left_speed <= right_speed:
            return math.inf
        return max((right - left) / (left_speed - right_speed), self.time)

    def _replace(self, first: int, last: int, place: float, speeds: list[float], states: list[State]) -> None:
        """Put new fronts from one place instead of regions first to last and the fronts at their sides."""
        before, after = max(first - 1, 0), min(last + 1, len(self.fronts))
        self.fronts[before:after] = range(len(self.made), len(self.made) + len(speeds))
        self.made += [(place - speed * self.time, speed) for speed in speeds]
        self.regions[first : last + 1] = range(len(self.states), len(self.states) + len(states))
        self.states += states
        self.vanishing[first : last + 1] = [math.inf] * len(states)
        for region in range(max(first - 1, 0), min(first + len(states) + 1, len(self.regions))):
            self.vanishing[region] = self._vanishes(region)
        self._note()

    def _note(self) -> None:
        """Log the present numbers."""
        self.log.append(_Entry(self.time, np.array(self.fronts, dtype=np.intp), np.array(self.regions, dtype=np.intp)))

    def _at_plane(self, last: int) -> None:
        """Replace the regions up to this one at the end that strikes: it rests without tension, or it is free."""
        law, inside = self.law, self.states[self.regions[last + 1]]
        if not self.touching:
            self.gap += self.states[self.regions[0]].velocity * (self.time - self.since)
            self.since = self.time
        stress = law.balanced((inside,), inside.velocity) if self.touching else 0.0
        if stress > 0.0:
            # The plane would have to pull.
            self.touching, self.gap, self.since, stress = False, 0.0, self.time, 0.0
        waves = law.waves(inside, stress, 1)[::-1]
        self._replace(0, last, 0.0, [speed for speed, _ in waves], [state for _, state in waves])

    def _at_free_end(self, first: int) -> None:
        """Replace the regions from this one at the other end."""
        waves = self.law.waves(self.states[self.regions[first - 1]], 0.0, -1)
        self._replace(first, len(self.fronts), 1.0, [speed for speed, _ in waves], [state for _, state in waves])

    def _closing(self) -> float:
        """Give the time at which the gap closes."""
        velocity = self.states[self.regions[0]].velocity
        return math.inf if self.touching or velocity >= 0.0 else max(self.since - self.gap / velocity, self.time)

    def step(self, end: float) -> bool:
        """Treat the next meeting of fronts, unless it is after the end."""
        closing = self._closing()
        now = min(closing, *self.vanishing)
        if now > end:
            return False
        self.time = now
        first = last = -1
        if closing > now:
            first = last = self.vanishing.index(now)
        # The place of the meeting, from both sides.
        left, right = (0.0, 0.0) if first <= 0 else (self._edge(first - 1), self._edge(last))
        while last < len(self.fronts) and self._edge(last + 1) <= right + TOGETHER:
            last += 1
        while first > 0 and self._edge(first - 2) >= left - TOGETHER:
            first -= 1
        if first <= 0:
            self.touching |= closing <= now
            self._at_plane(last)
        elif last == len(self.fronts):
            self._at_free_end(first)
        else:
            outer = self.states[self.regions[first - 1]], self.states[self.regions[last + 1]]
            self._replace(first, last, 0.5 * (left + right), *self.law.fan(*outer))
        return True


class Pieces(NamedTuple):
    """The state at one instant, constant between the edges: arrays from the end that strikes to the free end."""

    edges: Floats
    """The fronts and both ends of the bar (m), one more than there are pieces."""
    speeds: Floats
    """Of the fronts (m/s), one less than there are pieces."""
    stress: Floats
    """σ (Pa), positive in tension."""
    velocity: Floats
    """v (m/s), negative towards the plane."""
    plastic_strain: Floats
    """ε_p."""
    p: Floats
    """∫|dε_p|."""


class Energies(NamedTuple):
    """Parts of the energy (J); their sum is constant."""

    kinetic: float
    """½∫ρv²."""
    elastic: float
    """½∫σ²/E."""
    hardening: float
    """½∫(Cε_p² + H_i p²), the energy that hardening stores."""
    dissipated: float
    """∫σ_y p, the rest of the plastic work."""


@dataclass(frozen=True)
class Impact:
    """The exact solution of an impact, by `strike`.

    Times are from the start of the flight, places from the end that strikes.
    """

    bar: Bar
    speed: float
    """Of the flight (m/s)."""
    gap: float
    """To the plane at the start (m)."""
    end: float
    """The last instant (s)."""
    made: Floats = field(repr=False, compare=False)
    """Place at the instant of the impact (over L), on the line of the front, and speed (over c) of each front."""
    states: Floats = field(repr=False, compare=False)
    """Stress (Pa), velocity (m/s), plastic strain and p of each region."""
    log: tuple[_Entry, ...] = field(repr=False, compare=False)

    @property
    def impact_time(self) -> float:
        """The instant of the impact (s)."""
        return self.gap / self.speed

    @property
    def passage(self) -> float:
        """L/c (s)."""
        return self.bar.length / self.bar.wave_speed

    @cached_property
    def times(self) -> Floats:
        """The start of the flight and the instants at which fronts arise (s)."""
        times = self.impact_time + self.passage * np.array([entry.time for entry in self.log])
        # Rounding may put the first or the last one outside.
        return np.clip(times, 0.0, self.end)

    def _entry(self, t: float) -> int:
        """Give the last entry of the log at an instant."""
        if not 0.0 <= t <= self.end:
            told = f"`t` is {t:g} s; it must lie in the solution, from 0 to {self.end:g} s"
            raise ValueError(f"{told}: give `strike` a later `end`")
        return max(int(np.searchsorted(self.times, t, side="right")) - 1, 0)

    def pieces(self, t: float) -> Pieces:
        """Give the state at an instant (s); at a meeting of fronts, that after it.

        Raise ValueError outside of the solution.
        """
        entry = self.log[self._entry(t)]
        start, speed = self.made[entry.fronts].T
        # Rounding may exchange places of fronts from one meeting.
        places = np.clip(start + speed * (t - self.impact_time) / self.passage, 0.0, 1.0)
        edges = self.bar.length * np.concatenate([[0.0], np.maximum.accumulate(places), [1.0]])
        return Pieces(edges, self.bar.wave_speed * speed, *self.states[entry.regions].T)

    def at(self, x: ArrayLike, t: float) -> tuple[Floats, Floats, Floats, Floats]:
        """Give stress (Pa), velocity (m/s), plastic strain and p at places (m, any shape) at an instant (s).

        Raise ValueError outside of the bar and of the solution.
        """
        places = np.asarray(x, dtype=float)
        outside = places[~((places >= 0.0) & (places <= self.bar.length))]
        if outside.size:
            told = f"`x` holds {outside[0]:g} m; it must lie in the bar, from 0 to {self.bar.length:g} m"
            raise ValueError(f"{told}: give places in the undeformed bar")
        pieces = self.pieces(t)
        k = np.searchsorted(pieces.edges[1:-1], places, side="right")
        return pieces.stress[k], pieces.velocity[k], pieces.plastic_strain[k], pieces.p[k]

    def energies(self, t: float) -> Energies:
        """Give the parts of the energy at an instant (s), section 1 of the specification."""
        bar, pieces = self.bar, self.pieces(t)
        volume = bar.section * np.diff(pieces.edges)
        stored = bar.back * pieces.plastic_strain**2 + bar.isotropic * pieces.p**2
        return Energies(
            0.5 * bar.density * float(volume @ pieces.velocity**2),
            0.5 / bar.young * float(volume @ pieces.stress**2),
            0.5 * float(volume @ stored),
            bar.yield_stress * float(volume @ pieces.p),
        )

    def momentum(self, t: float) -> float:
        """Give ∫ρv (N s) at an instant (s)."""
        pieces = self.pieces(t)
        return self.bar.density * self.bar.section * float(np.diff(pieces.edges) @ pieces.velocity)

    def contact_force(self, t: float) -> float:
        """Give the force of the plane (N) at an instant (s)."""
        return -self.bar.section * float(self.pieces(t).stress[0])

    def impulse(self, t: float) -> float:
        """Give the impulse of the plane (N s) until an instant (s)."""
        last = self._entry(t)
        stress = np.array([self.states[entry.regions[0], 0] for entry in self.log[: last + 1]])
        return -self.bar.section * float(np.diff([*self.times[: last + 1], t]) @ stress)


def strike(bar: Bar, speed: float, gap: float, end: float) -> Impact:
    """Solve the impact of a bar that flies at ``speed`` (m/s) across ``gap`` (m) to a rigid plane, until ``end`` (s).

    The plane does not pull; the other end is free. Raise ValueError for other than positive speeds and ends, for
    negative gaps, and where infinitely many waves arise before the end.
    """
    positive("speed", speed, "m/s", "the bar must fly to the plane")
    positive("end", end, "s", "give an instant after the start of the flight")
    if not (math.isfinite(gap) and gap >= 0.0):
        raise ValueError(f"`gap` is {gap:g} m; it must be finite and not negative: start in front of the plane")
    passage = bar.length / bar.wave_speed
    law = _Law(bar.plastic_wave_speed / bar.wave_speed, bar.kinematic)
    # Places are in L, but the gap in v_y L/c, which makes it that of a flight at a velocity in v_y.
    tracker = _Tracker(law, speed / bar.yield_velocity, gap / (bar.yield_velocity * passage))
    while tracker.step((end - gap / speed) / passage):
        if len(tracker.log) > MEETINGS:
            reached = gap / speed + tracker.time * passage
            told = f"`end` is {end:g} s; after {MEETINGS} meetings of waves the solution has come to {reached:g} s only"
            remedy = "give an earlier `end`, a lower `speed`, or less `kinematic` hardening"
            raise ValueError(f"{told}, where they may go on without end: {remedy}")
    strain = bar.yield_stress / bar.young
    units = np.array([bar.yield_stress, bar.yield_velocity, strain, strain])
    made = np.array(tracker.made).reshape(-1, 2)
    return Impact(bar, speed, gap, end, made, units * np.array(tracker.states), tuple(tracker.log))
