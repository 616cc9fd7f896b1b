"""The pictures of docs/gallery/finite.md: the bodies at some instants of their motion, with the von Mises stress.

    python examples/finite/pictures.py FOLDER
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import percute as pc
import ring

HERE = Path(__file__).parent
COLUMNS, WIDTH = 6, 11.0
"""Instants of a picture, and its width (inch)."""


def draw(history: pc.History, instants: Sequence[float], file: Path, marked: Sequence[int] = ()) -> None:
    """Draw the body at some times (ms), all on one scale, and a line through marked nodes, which shows how far it has turned."""
    mesh = history.problem.mesh
    steps = [int(np.abs(history.time - 1e-3 * t).argmin()) for t in instants]
    places = [1e3 * (mesh.points + history.displacement[step]) for step in steps]
    stresses = [1e-6 * history.von_mises(step) for step in steps]
    low, high = np.min([p.min(axis=0) for p in places], axis=0), np.max([p.max(axis=0) for p in places], axis=0)
    margin = 0.04 * float((high - low).max())
    sides = high - low + 2.0 * margin
    # A few elements at contacts and corners outshine the rest.
    brightest = float(np.quantile(stresses, 0.998))
    panel = (WIDTH - 1.2) / len(steps)
    figure, axes = plt.subplots(1, len(steps), figsize=(WIDTH, panel * sides[1] / sides[0] + 0.45), layout="constrained", sharex=True, sharey=True)
    for each, place, stress, t in zip(axes, places, stresses, instants, strict=True):
        drawn = each.tripcolor(*place.T, mesh.cells, facecolors=stress, cmap="viridis", vmin=0.0, vmax=brightest)
        for line in mesh.outline:
            each.plot(*place[np.append(line, line[0])].T, color="black", linewidth=0.6)
        each.plot(*place[list(marked)].T, color="red", linewidth=1.5)
        for plane in history.problem.obstacles:
            along = np.array([plane.normal[1], -plane.normal[0]])
            ends = 1e3 * np.asarray(plane.point) + np.array([[-1.0], [1.0]]) * 1e3 * along
            each.plot(*ends.T, color="black", linewidth=1.5)
        each.set(title=f"{t:g} ms", xlim=(low[0] - margin, high[0] + margin), ylim=(low[1] - margin, high[1] + margin), aspect="equal")
        each.title.set_fontsize(9)
        each.axis("off")
    figure.colorbar(drawn, ax=axes, label="von Mises stress (MPa)", extend="max", pad=0.01, aspect=12)
    figure.savefig(file, dpi=90)
    plt.close(figure)


CASES = {
    "rubber": (0.0, 0.4, 0.8, 1.4, 2.0, 3.0),
    "bracket": (0.0, 0.8, 1.8, 2.9, 4.2, 6.0),
    "cup": (0.0, 0.4, 0.9, 1.5, 2.2, 3.0),
}
"""The instants that are drawn of each case (ms)."""
OF_THE_RING = (0.0, 0.8, 1.6, 2.4, 3.2, 4.0)


def main() -> None:
    """Draw all."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])  # type: ignore[union-attr]
    parser.add_argument("folder", type=Path, help="the folder of the pictures")
    folder = parser.parse_args().folder
    for name, instants in CASES.items():
        history = pc.run(HERE / f"{name}.toml").history
        assert history is not None
        draw(history, instants, folder / f"finite_{name}.png")
    draw(ring.simulated(), OF_THE_RING, folder / "finite_ring.png", marked=range(0, (ring.ACROSS + 1) * ring.AROUND, ring.AROUND))


if __name__ == "__main__":
    main()
