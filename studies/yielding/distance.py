"""The true error of a computed impact of a bar that yields: its distance from the exact solution."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from studies.yielding.bar import Bar, Floats, Integers
from studies.yielding.front_tracking import Impact, Pieces

ROUNDED = 1e-6
"""Of σ_y, and of σ_y/E: inadmissible stresses and strains up to this are rounding of single precision."""


@dataclass(frozen=True)
class BarHistory:
    """A computed history of T instants on a mesh of N linear elements, numbered from the end that strikes."""

    time: Floats
    """From the start of the flight (s), shape T."""
    nodes: Floats
    """Undeformed places (m), shape N + 1."""
    displacement: Floats
    """u (m), shape T × (N + 1)."""
    velocity: Floats
    """v at the same instants (m/s), shape T × (N + 1); linear in an element."""
    plastic_strain: Floats
    """ε_p, shape T × N."""
    p: Floats
    """∫|dε_p|, shape T × N."""

    def __post_init__(self) -> None:
        """Refuse arrays that do not fit, ValueError."""
        instants, count = np.size(self.time), np.size(self.nodes)
        nodal, elemental = (instants, count), (instants, count - 1)
        shapes = {"displacement": nodal, "velocity": nodal, "plastic_strain": elemental, "p": elemental}
        for name, shape in {"time": (instants,), "nodes": (count,), **shapes}.items():
            values = getattr(self, name)
            if np.shape(values) != shape:
                told = f"`{name}` has the shape {np.shape(values)}; it must have {shape}"
                raise ValueError(f"{told}: give a row for each of `time`, with a value for each node or element")
            if not np.isfinite(values).all():
                raise ValueError(f"`{name}` holds {np.asarray(values)[~np.isfinite(values)][0]}: give finite values")
        for name, unit in (("time", "s"), ("nodes", "m")):
            values = getattr(self, name)
            late = np.flatnonzero(np.diff(values) <= 0.0)
            if late.size or values.size < 2:
                two = values[late[0] : late[0] + 2] if late.size else values
                told = f"{', then '.join(f'{value:g}' for value in two)} {unit}"
                raise ValueError(f"`{name}` holds {told}; it must increase: give two values or more in their order")

    def stress(self, bar: Bar) -> Floats:
        """Give σ = E(∂u/∂x − ε_p) (Pa), shape T × N."""
        strain = np.diff(self.displacement, axis=1) / np.diff(self.nodes)
        return np.asarray(bar.young * (strain - self.plastic_strain))

    def refined(self, parts: int) -> BarHistory:
        """Cut each step into equal parts, with fields that are linear in time: sums over the steps then are integrals.

        Stresses between admissible ones are admissible. Raise ValueError for less than one part.
        """
        if parts < 1:
            raise ValueError(f"`parts` is {parts}; it must be positive: 1 leaves the history as it is")
        instants = np.arange(len(self.time), dtype=np.float64)
        between = np.linspace(0.0, instants[-1], parts * (len(instants) - 1) + 1)
        before = np.minimum(between.astype(np.intp), len(instants) - 2)
        share = (between - before)[:, None]

        def cut(field: Floats) -> Floats:
            return np.asarray((1.0 - share) * field[before] + share * field[before + 1])

        return BarHistory(
            np.interp(between, instants, self.time),
            self.nodes,
            cut(self.displacement),
            cut(self.velocity),
            cut(self.plastic_strain),
            cut(self.p),
        )


@dataclass(frozen=True)
class Distance:
    """Section 2 of the specification, between exact and computed solution, at each instant (J)."""

    time: Floats
    """Instants (s)."""
    kinetic: Floats
    """½∫ρ|Δv|²."""
    elastic: Floats
    """½∫Δσ²/E."""
    hardening: Floats
    """½∫(CΔε_p² + H_iΔp²)."""
    flow_computed: Floats
    """D1 = ∫∫[φ(Ė) − Σ·Ė] of the computed flow in the exact stress; it does not decrease."""
    flow_exact: Floats
    """D2, of the exact flow in the computed stress; it does not decrease."""

    @property
    def mechanical(self) -> Floats:
        """T1, without plasticity."""
        return self.kinetic + self.elastic

    @property
    def state(self) -> Floats:
        """T2, of the present states, without the past."""
        return self.mechanical + self.hardening

    @property
    def total(self) -> Floats:
        """T3, the true error."""
        return self.state + self.flow_computed + self.flow_exact

    @property
    def sup(self) -> float:
        """The largest true error (J^½), eq. [15]."""
        return math.sqrt(self.total.max())

    @property
    def mean(self) -> float:
        """The root of the mean of T3 over time, by the trapezoidal rule (J^½), eq. [16]."""
        total = self.total
        area = float(np.diff(self.time) @ (total[1:] + total[:-1])) / 2.0
        return math.sqrt(area / (self.time[-1] - self.time[0]))


@dataclass(frozen=True)
class _Flow:
    """Plastic strain, p and the forces on them, σ − X and R, of one solution on some intervals."""

    plastic_strain: Floats
    p: Floats
    driving: Floats
    resistance: Floats

    @classmethod
    def of(cls, bar: Bar, stress: Floats, plastic_strain: Floats, p: Floats) -> _Flow:
        """Give the forces of a state."""
        return cls(plastic_strain, p, stress - bar.back * plastic_strain, bar.isotropic * p)


def _lost(bar: Bar, flow: tuple[_Flow, _Flow], stress: tuple[_Flow, _Flow]) -> Floats:
    """Give σ_yΔp − Σ̄·ΔE_p of the flow between two instants in the mean of the forces of the other solution (J/m³)."""
    (before, after), (first, second) = flow, stress
    p = after.p - before.p
    driving, resistance = 0.5 * (first.driving + second.driving), 0.5 * (first.resistance + second.resistance)
    return np.asarray(bar.yield_stress * p - driving * (after.plastic_strain - before.plastic_strain) + resistance * p)


def _check(exact: Impact, history: BarHistory, stress: Floats) -> None:
    """Refuse a history of another bar, or one that the law does not admit."""
    bar = exact.bar
    first, last = float(history.nodes[0]), float(history.nodes[-1])
    if max(abs(first), abs(last - bar.length)) > 1e-9 * bar.length:
        told = f"`nodes` reach from {first:g} to {last:g} m; they must reach from 0 to `length`, {bar.length:g} m"
        raise ValueError(f"{told}: give undeformed places from the end that strikes")
    if history.time[0] < 0.0 or history.time[-1] > exact.end:
        told = f"`time` reaches from {history.time[0]:g} to {history.time[-1]:g} s"
        raise ValueError(f"{told}; the exact solution reaches from 0 to {exact.end:g} s: give `strike` a later `end`")
    if max(history.p[0].max(), exact.pieces(history.time[0]).p.max()) > 0.0:
        told = f"`time` starts at {history.time[0]:g} s, after plastic flow"
        raise ValueError(f"{told}; its part of the distance would be missing: start before the impact")
    strain = bar.yield_stress / bar.young
    beyond = bar.beyond(stress, history.plastic_strain, history.p)
    if beyond.max() > ROUNDED * bar.yield_stress:
        told = f"the stress is up to {beyond.max():g} Pa beyond σ_y + R"
        raise ValueError(f"{told}; it must be admissible: give `plastic_strain` and `p` of the instant itself")
    less = np.abs(np.diff(history.plastic_strain, axis=0)) - np.diff(history.p, axis=0)
    if less.max(initial=0.0) > ROUNDED * strain:
        told = f"`p` grows by up to {less.max():g} less than |ε_p| changes"
        raise ValueError(f"{told}; it must grow at least as much: give p = ∫|dε_p|")


def distance(exact: Impact, history: BarHistory) -> Distance:
    """Give the distance between exact and computed solution at each instant of a history.

    The integrals over the bar are exact: between nodes and fronts stresses are constant and velocities linear. D1 and
    D2 are sums over the steps of the history, with the forces in the mean of both ends of a step (section 1). Long
    steps make these sums larger: give all instants, or `BarHistory.refined`. Raise ValueError for a history of another
    bar or with inadmissible stresses.
    """
    bar, stress = exact.bar, history.stress(exact.bar)
    _check(exact, history, stress)
    parts = np.zeros((5, len(history.time)))
    before = exact.pieces(float(history.time[0]))
    for n, t in enumerate(history.time):
        now = exact.pieces(float(t))
        edges = np.unique(np.concatenate([history.nodes, now.edges, before.edges]))
        middle, length = 0.5 * (edges[1:] + edges[:-1]), bar.section * np.diff(edges)
        element = np.clip(np.searchsorted(history.nodes, middle) - 1, 0, len(history.nodes) - 2)
        there, there_before = (np.searchsorted(pieces.edges[1:-1], middle) for pieces in (now, before))
        velocity = np.interp(edges, history.nodes, history.velocity[n])
        left, right = velocity[:-1] - now.velocity[there], velocity[1:] - now.velocity[there]
        parts[0, n] = bar.density / 6.0 * float(length @ (left**2 + left * right + right**2))
        parts[1, n] = 0.5 / bar.young * float(length @ (stress[n, element] - now.stress[there]) ** 2)
        strain, p = history.plastic_strain[n, element] - now.plastic_strain[there], history.p[n, element] - now.p[there]
        parts[2, n] = 0.5 * float(length @ (bar.back * strain**2 + bar.isotropic * p**2))
        if n > 0:
            of_exact = _exact_flow(bar, before, there_before), _exact_flow(bar, now, there)
            m = n - 1
            of_computed = (
                _Flow.of(bar, stress[m, element], history.plastic_strain[m, element], history.p[m, element]),
                _Flow.of(bar, stress[n, element], history.plastic_strain[n, element], history.p[n, element]),
            )
            parts[3, n] = parts[3, m] + float(length @ _lost(bar, of_computed, of_exact))
            parts[4, n] = parts[4, m] + float(length @ _lost(bar, of_exact, of_computed))
        before = now
    return Distance(history.time, *parts)


def _exact_flow(bar: Bar, pieces: Pieces, there: Integers) -> _Flow:
    """Give the exact forces in some pieces."""
    return _Flow.of(bar, pieces.stress[there], pieces.plastic_strain[there], pieces.p[there])
