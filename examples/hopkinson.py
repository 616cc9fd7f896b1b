"""A split Hopkinson bar with a specimen of plastic: pulses, strain of the specimen, and the error of both.

``python examples/hopkinson.py`` takes some seconds; ``--picture FILE`` draws the pulses and the strain.
"""

import argparse

import numpy as np
import percute as pc
from numpy.typing import NDArray

BAR = pc.Elastic(young=70e9, density=2700, section=2e-4)
PLASTIC = pc.Elastic(young=3e9, density=1190, section=1e-4)
STRIKER, LONG, SPECIMEN = 0.2, 1.0, 0.01  # lengths (m)
SPEED, GAP, END = 10.0, 1e-7, 380e-6  # m/s, m, s
WAVES = float(np.sqrt(BAR.young / BAR.density))  # m/s

Floats = NDArray[np.float64]


def bodies() -> list[pc.Body]:
    """Give striker, incident bar, specimen and transmission bar, one behind the other."""
    long = pc.Mesh.bar(LONG, elements=500)
    parts = [
        ("striker", pc.Mesh.bar(STRIKER, elements=100), BAR, SPEED),
        ("incident", long, BAR, 0.0),
        ("specimen", pc.Mesh.bar(SPECIMEN, elements=16), PLASTIC, 0.0),
        ("transmission", long, BAR, 0.0),
    ]
    made, origin = [], 0.0
    for name, mesh, material, velocity in parts:
        made.append(pc.Body(name=name, mesh=mesh, material=material, origin=origin, velocity=velocity))
        # The striker is 5 µs away from the incident bar; the others all but touch.
        origin += mesh.size + (5e-6 * SPEED if name == "striker" else GAP)
    return made


def simulate() -> tuple[pc.History, pc.exact.BarRow]:
    """Simulate, and give the exact solution."""
    parts = bodies()
    contacts = [pc.Interface(groups=(f"{a.name}.end", f"{b.name}.start")) for a, b in zip(parts, parts[1:], strict=False)]
    return pc.simulate(pc.Problem(bodies=parts, contacts=contacts), end=END, courant=0.9), pc.exact.BarRow(bodies=parts, end=END)


def gauge(history: pc.History, body: str) -> Floats:
    """Give the strain in the middle of a bar over time."""
    mesh = history.problem.mesh
    elements = mesh.element_groups[body]
    left, right = mesh.cells[elements[len(elements) // 2]]
    return np.asarray((history.displacement[:, right, 0] - history.displacement[:, left, 0]) / (mesh.points[right, 0] - mesh.points[left, 0]))


def exact_gauge(exact: pc.exact.BarRow, body: str, time: Floats) -> Floats:
    """Give the exact strain there."""
    (origin,) = next(each.origin for each in exact.bodies if each.name == body)  # type: ignore[misc, union-attr]
    return exact.normal_force(body, origin + LONG / 2, time) / (BAR.young * (BAR.section or 0.0))


def three_waves(time: Floats, incident: Floats, transmitted: Floats) -> Floats:
    """Give the strain of the specimen from the strains at both gauges.

    The incident pulse passes the gauge, reaches the specimen after half a bar, and its reflection is at the gauge after another
    half. The pulses do not overlap there. With the strains at the faces of the specimen, its rate is c (ε_i − ε_r − ε_t)/L.
    """
    way = LONG / 2 / WAVES
    between = 2e-4  # between the pulses at the gauge (s)
    incoming = np.interp(time - way, time, np.where(time < between + 5e-5, incident, 0.0), left=0.0)
    reflected = np.interp(time + way, time, np.where(time < between + 5e-5, 0.0, incident), right=np.nan)
    passed = np.interp(time + way, time, transmitted, right=np.nan)
    rate = WAVES / SPECIMEN * (incoming - reflected - passed)
    return np.concatenate([[0.0], np.cumsum(np.diff(time) * (rate[1:] + rate[:-1]) / 2)])


def specimen_strain(history: pc.History) -> Floats:
    """Give the mean strain of the specimen over time."""
    first, last = history.problem.mesh.cells[history.problem.mesh.element_groups["specimen"][[0, -1]]]
    return np.asarray((history.displacement[:, last[1], 0] - history.displacement[:, first[0], 0]) / SPECIMEN)


def exact_specimen_strain(exact: pc.exact.BarRow, time: Floats) -> Floats:
    """Give the exact one."""
    (start,) = exact.bodies[2].origin  # type: ignore[misc]
    return np.asarray((exact.displacement("specimen", start + SPECIMEN, time) - exact.displacement("specimen", start, time)) / SPECIMEN)


def draw(path: str, time: Floats, pulses: list[Floats], strains: list[Floats]) -> None:
    """Draw the pulses at the gauges, and the strain of the specimen."""
    from matplotlib import pyplot

    figure, (above, below) = pyplot.subplots(2, sharex=True, layout="constrained", figsize=(7.2, 5.4))
    names = ("incident bar", "transmission bar", "exact", "exact")
    for values, name, style in zip(pulses, names, ("C0-", "C1-", "k:", "k:"), strict=True):
        above.plot(1e6 * time, 1e6 * values, style, label=name, linewidth=1.2)
    for values, name, style in zip(strains, ("simulated", "three waves", "exact"), ("C0-", "C3--", "k:"), strict=True):
        below.plot(1e6 * time, 100 * values, style, label=name, linewidth=1.2)
    above.set_ylabel("strain at the gauge (µm/m)")
    below.set_ylabel("strain of the specimen (%)")
    below.set_xlabel("t (µs)")
    for axes in (above, below):
        axes.grid(alpha=0.3)
        handles, labels = axes.get_legend_handles_labels()
        shown = dict(zip(labels, handles, strict=True))
        axes.legend(shown.values(), shown.keys(), loc="lower left")
    figure.savefig(path, dpi=110)


def main() -> None:
    """Print the pulses, the strains and the errors."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])  # type: ignore[union-attr]
    parser.add_argument("--picture", metavar="FILE", help="draw the pulses and the strain")
    given = parser.parse_args()
    history, exact = simulate()
    estimate, time = pc.estimate(history), np.asarray(history.time)
    at_gauges = [gauge(history, "incident"), gauge(history, "transmission")]
    pulses = [*at_gauges, *(exact_gauge(exact, body, time) for body in ("incident", "transmission"))]
    strains = [specimen_strain(history), three_waves(time, *at_gauges), exact_specimen_strain(exact, time)]
    # Plateaus in the middle of the pulses, and the end of the load.
    for name, values, of, when in (("incident", *pulses[0::2], 142e-6), ("reflected", *pulses[0::2], 340e-6), ("transmitted", *pulses[1::2], 340e-6)):
        plateau = abs(time - when) < 10e-6
        print(f"{name:<12} {1e6 * values[plateau].mean():8.1f} µm/m around {1e6 * when:.0f} µs, exact {1e6 * of[plateau].mean():8.1f}")
    print("strain of the specimen at 260 µs (%)")
    for name, values in zip(("simulated", "three waves", "exact"), strains, strict=True):
        print(f"  {name:<12} {100 * np.interp(260e-6, time, values):8.4f}")
    index = exact.effectivity(estimate)
    print(f"estimated error {100 * estimate.relative_mean:.2f} % (mean), {100 * estimate.relative_sup:.2f} % (largest); over the true one {index.mean:.2f}, {index.sup:.2f}")
    if given.picture:
        draw(given.picture, time, pulses, strains)


if __name__ == "__main__":
    main()
