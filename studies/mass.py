"""The second plateau of the paper's figure 10: the lumped mass, on a bar that vibrates without contact."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import percute as pc
from studies import figures
from studies.page import Column, Figure, Section, Table, percent, short
from studies.parallel import Resolution, Stop

RATIOS = (1.0, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1)
FEW = (1.0, 0.5)
"""Δt/Δt_c, and those of a small study."""
MESHES, PERIODS = (12, 24), 4.0
"""Elements in a wave length, and the end of the run in periods."""
LENGTH, YOUNG, DENSITY, SECTION, AMPLITUDE, NUMBER = 1.0, 70e9, 2700.0, 1e-4, 1e-4, 5
"""A bar of aluminium of 1 m between walls (SI) in its fifth mode, u = A sin(kx) sin(ωt)."""
WAVE_NUMBER = NUMBER * math.pi / LENGTH
FREQUENCY = WAVE_NUMBER * math.sqrt(YOUNG / DENSITY)
ENERGY = 0.25 * DENSITY * SECTION * LENGTH * (AMPLITUDE * FREQUENCY) ** 2
RULE = ((0.112_701_665_379_258_3, 5 / 18), (0.5, 8 / 18), (0.887_298_334_620_741_7, 5 / 18))
"""Points and weights of Gauss's rule on [0, 1], exact to degree 5."""


def problem_of(elements: int) -> pc.Problem:
    """Give the bar with so many elements."""
    mesh = pc.Mesh.bar(LENGTH, elements=elements)
    return pc.Problem(
        mesh,
        material=pc.Elastic(young=YOUNG, density=DENSITY, section=SECTION),
        initial_velocity=AMPLITUDE * FREQUENCY * np.sin(WAVE_NUMBER * mesh.points),
        supports=[pc.Support(group=group, components="x") for group in ("start", "end")],
    )


def _run(bar: tuple[int, float], stop: Stop) -> tuple[float, float, float]:
    """Give the largest true error and estimate (% of the norm of the mode), and the error of the frequency (%)."""
    per_wave, ratio = bar
    elements = round(per_wave * WAVE_NUMBER * LENGTH / math.tau)
    problem = problem_of(elements)
    # Δt_c = h/c on a uniform bar, eq. [33].
    step = ratio * LENGTH / elements * math.sqrt(DENSITY / YOUNG)
    count = round(PERIODS * math.tau / FREQUENCY / step)
    history = pc.simulate(problem, end=step * count, step=step, progress=stop)
    estimate = pc.estimate(history, every=1, threads=1, progress=stop)
    # sin(ω_hΔt/2) = (cΔt/h) sin(kh/2): central differences on the lumped mass.
    discrete = 2.0 / step * math.asin(ratio * math.sin(0.5 * WAVE_NUMBER * LENGTH / elements))
    scale = 100.0 / math.sqrt(ENERGY)
    return scale * _true_error(history), scale * estimate.sup, 100.0 * (discrete / FREQUENCY - 1.0)


def _true_error(history: pc.History) -> float:
    """Give the largest energy norm of the difference between the nodal fields and the mode, over the t_n (J^½)."""
    u, v, t = history.displacement[..., 0], history.velocity[..., 0], history.time[:, None]
    h, stiffness, inertia = LENGTH / (u.shape[1] - 1), YOUNG * SECTION, DENSITY * SECTION
    square = np.zeros(len(history))
    for s, weight in RULE:
        x = h * (np.arange(u.shape[1] - 1) + s)
        force = stiffness * (np.diff(u) / h - AMPLITUDE * WAVE_NUMBER * np.cos(WAVE_NUMBER * x) * np.sin(FREQUENCY * t))
        velocity = v[:, :-1] + s * np.diff(v) - AMPLITUDE * FREQUENCY * np.sin(WAVE_NUMBER * x) * np.cos(FREQUENCY * t)
        square += 0.5 * h * weight * np.sum(force**2 / stiffness + inertia * velocity**2, axis=1)
    return float(np.sqrt(square.max()))


def add(section: Section, resolution: Resolution) -> None:
    """Compute the bars and add text, figure and table."""
    ratios = resolution.either(FEW, RATIOS)
    bars = [(per_wave, ratio) for per_wave in MESHES for ratio in ratios]
    columns = [Column("elements per wave"), Column("Δt/Δt_c", digits=1), Column("true error", "% of the norm")]
    columns += [Column("e_sup", "% of the norm", "[15]"), Column("frequency off by", "%", digits=3)]
    caption = (
        f"A bar in its fifth mode over {PERIODS:g} periods: the largest true error (against the exact mode, in the energy norm) and the "
        "largest estimate, relative to the square root of the energy of the mode, and the relative error of the frequency by "
        "sin(½ω_hΔt) = (cΔt/h) sin(½kh)."
    )
    table = Table("time-steps-mass", caption, columns, on_page=False)
    for bar, values in zip(bars, resolution.map(_run, bars), strict=True):
        table.add(*bar, *values)
    section.add(
        "### The second cause: the lumped mass",
        _text(table, min(ratios)),
        Figure(
            "figure-10-mass",
            "A vibrating bar without contact: largest true error (solid) and largest estimate [15] (dashed) over Δt/Δt_c (logarithmic), in "
            "per cent of the square root of the energy, for two meshes.",
            _draw(table, ratios),
        ),
        table,
    )


def _text(table: Table, least: float) -> str:
    def at(column: str, mesh: int, ratio: float) -> str:
        return percent(0.01 * table.where(column, {"elements per wave": mesh, "Δt/Δt_c": ratio})[0])

    each = [
        f"with {mesh} elements in a wave length the true error is {at('true error', mesh, 1.0)} at the critical step and "
        f"{at('true error', mesh, least)} at {short(least, 1)} of it, the estimate {at('e_sup', mesh, 1.0)} and {at('e_sup', mesh, least)}"
        for mesh in MESHES
    ]
    return (
        "A bar that vibrates in one mode, whose exact motion is known, shows the same effect without any contact. At the critical step the errors of "
        "the lumped mass and of central differences cancel, and the nodes move exactly [33]: the interpolation between them remains. A "
        f"smaller step removes only the error of the time integration. The lumped mass then makes the waves too slow: {'; '.join(each)}. This "
        "error vanishes with the mesh only. It accumulates over the periods, and a measure of local misfit does not contain all of it."
    )


def _draw(table: Table, ratios: Sequence[float]) -> figures.Drawing:
    curves = []
    for k, mesh in enumerate(MESHES):
        for name, column in (("true error", "true error"), ("estimate", "e_sup")):
            values = table.where(column, {"elements per wave": mesh})
            curves.append(figures.Curve(f"{name}, {mesh} elements per wave", ratios, values, figures.own(k), name == "estimate", True))
    return figures.lines([("", curves)], "Δt/Δt_c", "error (% of the norm)", log="x", xticks=(0.1, 0.2, 0.3, 0.5, 0.7, 1.0), zero=True)
