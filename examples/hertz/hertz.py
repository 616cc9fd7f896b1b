"""A disc strikes a rigid plane, against Hertz's theory: the study of docs/hertz.md.

    python examples/hertz/hertz.py                    # prints the study
    python examples/hertz/hertz.py --figures docs     # and draws its figures into a folder
"""

from __future__ import annotations

import argparse
import warnings
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import percute as pc
from impact import FLIGHT, PEAK, Run, differences, profile, refined, rms, simulate
from theory import Cylinder, Impact

HERE = Path(__file__).parent
DISC = Cylinder(radius=0.01, young=70e9, poisson=0.3, density=2700.0)
SPEED = 30.0
"""m/s. At the peak, b is a tenth of the radius and spans fifteen edges."""
SPEEDS = (3.75, 7.5, 15.0, 30.0, 60.0)
RECONSTRUCTIONS = ("published", "consistent", "corrected")
CUT = 6.0
"""Cut-off frequency of vibrations (c/R). Their waves, about R long, are long against b, so the force acts at a point."""


@dataclass(frozen=True)
class Study:
    """The runs of docs/hertz.md."""

    main: Run
    history: pc.History
    speeds: tuple[Run, ...]
    """At `SPEEDS`, including the main run."""
    variants: dict[str, Run]
    """Finer meshes, smaller steps, plane stress, until after the peak."""
    estimates: dict[str, pc.Estimate]
    """Of the main run, by reconstruction of the contact force."""


def study(every: int = 1) -> Study:
    """Run everything; the error is sampled at every k-th step."""
    mesh = pc.Mesh.read(HERE / "disc.msh")
    main, history = simulate(DISC, mesh, SPEED, end=15e-6)
    # Slower impacts last a little longer.
    speeds = tuple(main if speed == SPEED else simulate(DISC, mesh, speed, end=18e-6)[0] for speed in SPEEDS)
    fine, stress, end = refined(mesh, DISC.radius), replace(DISC, plane="stress"), PEAK + 2e-7
    variants = {
        "step halved": simulate(DISC, mesh, SPEED, end, courant=0.45)[0],
        "step quartered": simulate(DISC, mesh, SPEED, end, courant=0.225)[0],
        "plane stress": simulate(stress, mesh, SPEED, end)[0],
        "cut in four": simulate(DISC, fine, SPEED, end)[0],
        "cut in four, half the speed": simulate(DISC, fine, SPEED / 2, end)[0],
        "cut in four, twice the speed": simulate(DISC, fine, SPEED * 2, end)[0],
    }
    with warnings.catch_warnings():
        # At a curve, `published` is near its ceiling: the study shows that.
        warnings.filterwarnings("ignore", "the relative error", pc.SimulationWarning)
        estimates = {name: pc.estimate(history, reconstruction=name, every=every) for name in RECONSTRUCTIONS}
    return Study(main, history, speeds, variants, estimates)


def report(done: Study) -> Iterator[str]:
    """Give the study, line by line."""
    main, points = done.main, done.history.problem.mesh.points
    yield (
        f"{main.triangles} triangles, {len(points)} nodes, edges of {main.edge * 1e3:.4f} mm where contact begins;"
        f" {SPEED:g} m/s, {len(main.time) - 1} steps of {(main.time[1] - main.time[0]) * 1e9:.2f} ns"
    )
    yield from report_peak(main)
    yield from report_relations(done)
    yield from report_speeds(done.speeds)
    yield from report_momentum(done)
    yield from report_estimates(done.estimates)
    of, worst = differences(main), max(max(estimate.residuals.values()) for estimate in done.estimates.values())
    yield (
        f"\nhertz: width within {of.width:.2%} and pressure within {of.pressure:.2%} of Hertz, peak force within"
        f" {abs(excess(main, DISC.impact(SPEED, CUT))):.2%} of the vibrating disc, residuals at most {worst:.1e}"
    )


def report_peak(main: Run) -> Iterator[str]:
    """The instant of the largest force."""
    at, force = main.peak, main.force.max()
    yield f"\nAt the largest force, {force / 1e6:.3f} MN/m      finite elements   Hertz  difference"
    rows = (
        ("half-width by the pressure, mm", 1e3, main.half_width[at], main.hertz_half_width[at]),
        ("half-width that touches, mm", 1e3, main.touching_half_width[at], main.hertz_half_width[at]),
        ("pressure in the middle, GPa", 1e-9, main.pressure_in_the_middle[at], main.hertz_pressure[at]),
    )
    for name, factor, value, theory in rows:
        yield f"  {name:36} {value * factor:15.4f} {theory * factor:7.4f} {value / theory - 1.0:+11.2%}"
    place, pressure, ellipse = profile(main)
    for limit, name in ((0.9, "|x| < 0.9 b"), (1.0, "|x| < b")):
        inside = np.abs(place) < limit
        yield f"  pressure less ellipse, over p0, r.m.s. for {name:12} {rms((pressure - ellipse)[inside]):.2%}"
    yield "\nPeak force by theory                     MN/m  over finite elements"
    for name, cut in (("no vibrations", 0.0), *((f"vibrations up to {cut:g} c/R", cut) for cut in (4.0, CUT, 8.0))):
        impact = DISC.impact(SPEED, cut)
        yield f"  {name:32} {impact.force.max() / 1e6:10.3f} {excess(main, impact):+9.2%}"


def report_relations(done: Study) -> Iterator[str]:
    """Hertz's relations at each instant."""
    yield "\nFrom Hertz at each instant                      mean, b > 0.9 peak    r.m.s., b > 0.5 peak   touching   ripple"
    yield "                               b/R  MN/m, peak   width  pressure       width  pressure      edges"
    for name, run in {"as it is": done.main, **done.variants}.items():
        of = differences(run)
        yield (
            f"  {name:28} {run.hertz_half_width.max() / DISC.radius:.4f} {run.force.max() / 1e6:9.4f}"
            f" {of.width_mean:+9.2%} {of.pressure_mean:+8.2%}   {of.width:9.2%} {of.pressure:8.2%} {of.touching:10.2f} {of.ripple:11.3%}"
        )


def report_speeds(speeds: tuple[Run, ...]) -> Iterator[str]:
    """The difference as a function of the speed."""
    yield "\n          finite elements                     quasi-static       vibrating disc"
    yield "  m/s     b/R    MN/m     µs  rebound     force    time     force    time  rebound"
    for run in speeds:
        slow, waves = DISC.impact(run.speed), DISC.impact(run.speed, CUT)
        yield (
            f"{run.speed:5.4g} {run.hertz_half_width.max() / DISC.radius:7.4f} {run.force.max() / 1e6:7.4f}"
            f" {run.contact_time * 1e6:6.2f} {run.rebound:8.4f}  {excess(run, slow):+8.2%} {slow.time[-1] / run.contact_time - 1.0:+7.2%}"
            f"  {excess(run, waves):+8.2%} {waves.time[-1] / run.contact_time - 1.0:+7.2%} {waves.rebound:8.4f}"
        )


def excess(run: Run, impact: Impact) -> float:
    """Peak force of theory over that of finite elements, less 1."""
    return float(impact.force.max() / run.force.max() - 1.0)


def report_momentum(done: Study) -> Iterator[str]:
    """Impulse, momentum, and the transit time of waves."""
    main, transit = done.main, 2.0 * DISC.radius / done.history.problem.wave_speed
    yield (
        f"\nRelative to the initial momentum: impulse {main.impulse:.6f}, change of momentum {1.0 + main.rebound:.6f};"
        f" difference {abs(main.impulse - 1.0 - main.rebound):.0e}"
    )
    lasts = ", ".join(f"{run.contact_time / transit:.2f}" for run in done.speeds)
    yield f"A pressure wave crosses the disc in {transit * 1e6:.2f} µs; at these speeds contact lasts {lasts} transits"
    before = main.mass * SPEED**2 / 2.0
    drift = float(done.history.balance.energy_drift.max())
    yield f"Energy {before:.2f} J/m; {1.0 - main.rebound**2:.2%} of it is in vibrations at the end; energy balance kept to {drift:.0e}"


def report_estimates(estimates: dict[str, pc.Estimate]) -> Iterator[str]:
    """All reconstructions of the contact force."""
    yield "\nConstitutive relation error    sup    mean   at (µs)  kinetic part  kept impulse  largest residual"
    for name, estimate in estimates.items():
        worst, value = max(estimate.residuals.items(), key=lambda item: item[1])
        yield (
            f"  {name:24} {estimate.relative_sup:8.2%} {estimate.relative_mean:7.2%} {(estimate.time_of_sup - FLIGHT) * 1e6:7.2f}"
            f" {estimate.parts.kinetic / estimate.parts.total:12.1%} {estimate.impulse_ratio:12.2%}   {value:.1e} ({worst})"
        )


def main() -> None:
    """Run and print the study, and draw its figures on request."""
    parser = argparse.ArgumentParser(description="A disc strikes a rigid plane: percute against Hertz.")
    parser.add_argument("--figures", type=Path, metavar="FOLDER", help="draw the figures of docs/hertz.md into this folder")
    folder = parser.parse_args().figures
    # Problems with the figures appear before the work.
    if folder is not None:
        if not folder.is_dir():
            parser.error(f"--figures {folder}: there is no such folder")
        import figures
    done = study()
    for line in report(done):
        print(line)
    if folder is not None:
        figures.draw(done, folder)


if __name__ == "__main__":
    main()
