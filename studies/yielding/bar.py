"""A bar that hardens linearly: its data, its waves and its law."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.intp]

UNITS = {"length": "m", "young": "Pa", "density": "kg/m³", "yield_stress": "Pa", "tangent": "Pa", "section": "m²"}


def positive(name: str, value: float, unit: str, remedy: str) -> None:
    """Refuse what is not a positive number."""
    if not (math.isfinite(value) and value > 0.0):
        raise ValueError(f"`{name}` is {value:g} {unit}; it must be positive and finite: {remedy}")


@dataclass(frozen=True)
class Bar:
    """A bar with linear hardening at small strains, section 1 of the specification of plasticity.

    Stresses σ with |σ − X| ≤ σ_y + R are possible, where X = Cε_p, R = H_i p and H = C + H_i = E E_t/(E − E_t).
    """

    length: float
    """L (m)."""
    young: float
    """E (Pa)."""
    density: float
    """ρ (kg/m³)."""
    yield_stress: float
    """σ_y (Pa)."""
    tangent: float
    """E_t, the slope of the stress over the strain during plastic flow (Pa)."""
    section: float = 1.0
    """S (m²)."""
    kinematic: float = 0.0
    """C/H, the kinematic share of the hardening, from 0 (isotropic) to 1."""

    def __post_init__(self) -> None:
        """Refuse what is no bar, ValueError."""
        for name, unit in UNITS.items():
            positive(name, getattr(self, name), unit, "give data of a bar in SI units")
        if self.tangent >= self.young:
            told = f"`tangent` is {self.tangent:g} Pa; it must be less than `young`, {self.young:g} Pa"
            raise ValueError(f"{told}: for an elastic bar give a higher `yield_stress`")
        if not 0.0 <= self.kinematic <= 1.0:
            told = f"`kinematic` is {self.kinematic:g}; it must be a share from 0 to 1"
            raise ValueError(f"{told}: give C/H, 0 for isotropic hardening")

    @property
    def hardening(self) -> float:
        """H (Pa)."""
        return self.young * self.tangent / (self.young - self.tangent)

    @property
    def back(self) -> float:
        """C, the kinematic part of H (Pa)."""
        return self.kinematic * self.hardening

    @property
    def isotropic(self) -> float:
        """H_i (Pa)."""
        return (1.0 - self.kinematic) * self.hardening

    @property
    def wave_speed(self) -> float:
        """The speed c of elastic waves (m/s)."""
        return math.sqrt(self.young / self.density)

    @property
    def plastic_wave_speed(self) -> float:
        """The speed c_p of waves of plastic flow (m/s)."""
        return math.sqrt(self.tangent / self.density)

    @property
    def yield_velocity(self) -> float:
        """v_y = σ_y/(ρc), the slowest impact with plastic flow (m/s)."""
        return self.yield_stress / (self.density * self.wave_speed)

    def beyond(self, stress: Floats, plastic_strain: Floats, p: Floats) -> Floats:
        """Give f = |σ − X| − σ_y − R (Pa)."""
        return np.asarray(np.abs(stress - self.back * plastic_strain) - self.yield_stress - self.isotropic * p)

    def returned(self, strain: Floats, plastic_strain: Floats, p: Floats) -> tuple[Floats, Floats]:
        """Give plastic strain and p after a step to a strain, by radial return from those before."""
        tried = self.young * (strain - plastic_strain)
        flow = np.maximum(self.beyond(tried, plastic_strain, p), 0.0) / (self.young + self.hardening)
        direction = np.sign(tried - self.back * plastic_strain)
        return plastic_strain + flow * direction, p + flow
