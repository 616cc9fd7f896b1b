"""Bars and blocks without contact: standing waves, and a pull that grows."""

from __future__ import annotations

from typing import Literal

import numpy as np

from percute.exact import BarMode, BarRamp, BlockMode
from percute.statement import Elastic
from studies.benchmarks.trial import Curve, Outcome, Quantity, Trial, bar, filled, rectangle, values
from studies.parallel import Stop

BARS = (10, 20, 40, 80)
RAMPS = (25, 50, 100, 200)
BLOCKS = (10, 20, 40)
"""Cells along the width of the block."""
ALUMINIUM = {"length": 0.1, "young": 70e9, "density": 2700.0, "section": 1e-4}
WAVES: tuple[Literal["pressure", "shear"], ...] = ("pressure", "shear")

SMOOTH = "the frequencies of the scheme are right to O(h²) with Δt ∝ h"
LINEAR = "the stress of linear elements is right to O(h)"
KINK = (
    "u'' jumps at the front: a field with s derivatives has an error of order 2s/3, s = 5/2; on coarse meshes the order of the "
    "smooth part, 2"
)
AWAY = "the front is near the clamp then; away from it the field is smooth: order 2"
KINK_OF_STRESS = "stress and velocity have a kink at the front: s = 3/2, order 1, which is that of linear elements, too"


def bar_mode(stop: Stop | None = None) -> Outcome:
    """Swing in the second mode, u = A sin(kx) cos(ωt), k = 3π/2L: after T the lag of phase is ωT(kh)²(1 − r²)/24, r = Δt/Δt_c."""
    exact = BarMode(**ALUMINIUM, amplitude=1e-4, number=2, fixed="start")
    runs = []
    for elements in BARS:
        x = exact.length * np.arange(elements + 1) / elements
        trial = Trial("bar_mode", stop, bar=bar(exact.length, elements), displacement=values(exact.displacement(x, 0.0)))
        apart = trial.history.displacement[-1, :, 0] - exact.displacement(x, trial.time[-1])
        runs.append([abs(apart).max() / exact.amplitude, exact.error(trial.history).mean / exact.energy**0.5])
    quantities = [
        Quantity("largest error of a node after 2.25 periods over the amplitude", "", 0.0, SMOOTH, order=2.0),
        Quantity("error over the energy norm, mean over time", "", 0.0, LINEAR, order=1.0),
    ]
    return Outcome(filled(quantities, runs))


def block_mode(stop: Stop | None = None) -> Outcome:
    """Swing between rollers in a wave whose field is a gradient (pressure) or free of divergence (shear)."""
    law = Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress", thickness=0.01)
    quantities, runs = [], []
    for wave in WAVES:
        exact = BlockMode(width=0.05, height=0.04, material=law, wave=wave, numbers=(1, 1), amplitude=1e-5)
        name = f"{wave} wave: root mean square error after 1.2 periods over the amplitude"
        quantities.append(Quantity(name, "", 0.0, SMOOTH, order=2.0))
        end = 1.2 * 2 * np.pi / exact.angular_frequency
        errors = []
        for nx in BLOCKS:
            ny = nx * 4 // 5
            x, y = (each.ravel() for each in np.meshgrid(exact.width * np.arange(nx + 1) / nx, exact.height * np.arange(ny + 1) / ny))
            start = exact.displacement(np.stack([x, y], axis=1), 0.0)
            # On the rollers sin(nπ) is rounding only; the supports need exact zeros.
            start[(x == 0) | (x == exact.width), 0] = 0.0
            start[(y == 0) | (y == exact.height), 1] = 0.0
            trial = Trial("block_mode", stop, rectangle=rectangle(exact.width, exact.height, nx, ny), displacement=values(start), end=end)
            points = trial.history.problem.mesh.points
            apart = trial.history.displacement[-1] - exact.displacement(points, trial.time[-1])
            errors.append((trial.masses @ (apart**2).sum(axis=1) / trial.mass) ** 0.5 / exact.amplitude)
        runs.append(errors)
    return Outcome(filled(quantities, list(zip(*runs, strict=True))))


def bar_ramp(stop: Stop | None = None) -> Outcome:
    """Pull the end of a clamped bar by a traction that grows linearly: the modal series, in d'Alembert's finite form."""
    exact = BarRamp(**ALUMINIUM, rate=1e12)
    runs, curve, largest = [], None, float("nan")
    for elements in RAMPS:
        trial = Trial("bar_ramp", stop, bar=bar(exact.length, elements))
        end = trial.time[-1]
        x = exact.length * np.arange(elements + 1) / elements
        u, u_exact = trial.history.displacement[-1, :, 0], exact.displacement(x, end)
        largest = float(u_exact[-1])
        # The energy of a bar in equilibrium with the traction at the end.
        energy = (exact.rate * end) ** 2 * exact.section * exact.length / (2 * exact.young)
        runs.append([np.mean((u - u_exact) ** 2) ** 0.5 / largest, u[-1], exact.error(trial.history).mean / energy**0.5])
        velocity = exact.velocity(exact.length, trial.time), trial.history.velocity[:, -1, 0]
        curve = curve or Curve("velocity of the pulled end", "m/s", 1e6 * trial.time, "µs", *velocity)
    quantities = [
        Quantity("root mean square error of the displacement at the end over the largest", "", 0.0, KINK, order=5 / 3),
        Quantity("displacement of the pulled end", "m", largest, AWAY, order=2.0),
        Quantity("error over the energy norm, mean over time", "", 0.0, KINK_OF_STRESS, order=1.0),
    ]
    return Outcome(filled(quantities, runs), curve)
