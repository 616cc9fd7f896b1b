"""Pictures: what is drawn, with which labels."""

import pickle
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import percute as pc
import pytest
from conftest import bar, block
from matplotlib.colors import to_rgb


@pytest.fixture(autouse=True)
def closed() -> Iterator[None]:
    yield
    plt.close("all")


def test_a_map_shows_all_elements(block_history: pc.History) -> None:
    estimate = pc.estimate(block_history)
    axes = estimate.plot_map()
    drawn = axes.collections[0].get_array()
    assert drawn is not None and np.array_equal(drawn, estimate.by_element)
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("x (mm)", "y (mm)")
    assert axes.lines and axes.get_ylim()[0] < -0.2  # Mesh lines, and the plane 0.2 mm below the body.
    assert "J" in axes.child_axes[0].get_ylabel()


def test_a_map_shows_the_outline_at_the_end(block_history: pc.History) -> None:
    estimate = pc.estimate(block_history)
    axes = estimate.plot_map()
    (line,) = axes.collections[-2].get_segments()  # type: ignore[attr-defined]
    mesh = block_history.problem.mesh
    # The block is deformed by more than a hundredth of itself: places as they are, in mm.
    places = 1e3 * (mesh.points + block_history.displacement[-1])
    outer = np.unique([edge for group in mesh.edge_groups.values() for edge in group])
    nearest = [np.linalg.norm(places[outer] - point, axis=1).min() for point in line]
    assert len(line) == len(outer) + 1 and max(nearest) < 1e-9 and np.array_equal(line[0], line[-1])
    assert axes.get_title().endswith("— outline at 13 µs, deformation × 1")
    assert "outline" not in estimate.plot_map(outline=False).get_title()


def test_symbols_and_numbers_are_typeset() -> None:
    from percute.pictures.canvas import typeset

    for text, expected in {
        "Δt/Δt_c, e_E (J^½)": r"Δ$t$/Δ$t_{\mathrm{c}}$, $e_{\mathrm{E}}$ (J$^{1/2}$)",
        "≤ 2.5e-05, 1e9": r"≤ $2.5 \times 10^{-5}$, $10^{9}$",
        "-3 (-2.5e+8)": r"−3 (−$2.5 \times 10^{8}$)",
        "bar_impact, a-2, mesh1e5": "bar_impact, a-2, mesh1e5",
    }.items():
        assert typeset(text) == expected


def test_planes_are_hatched_from_end_to_end(block_history: pc.History) -> None:
    from percute.pictures.body import draw_body

    mesh = block_history.problem.mesh
    for angle in (0.0, 0.6, 2.2):
        normal = np.array([-np.sin(angle), np.cos(angle)])
        axes = plt.figure().add_subplot()
        draw_body(axes, mesh.points, mesh.cells, np.ones(len(mesh.cells)), "", planes=[(mesh.points.mean(axis=0), normal)])
        strokes = np.array(axes.collections[-1].get_segments())  # type: ignore[attr-defined]
        low, high = np.array([axes.get_xlim(), axes.get_ylim()]).T
        # Each stroke begins on the plane and ends behind it; they go on until the plane has left the picture.
        depths = (strokes - 1e3 * mesh.points.mean(axis=0)) @ normal
        assert np.allclose(depths[:, 0], 0.0, atol=1e-9) and np.all(depths[:, 1] < 0.0)
        ends = strokes[[0, -1], 0]
        assert np.all(((ends < low) | (ends > high)).any(axis=1))


def test_over_time_shows_the_sup(block_history: pc.History) -> None:
    estimate = pc.estimate(block_history)
    figure, axes = plt.subplots()
    assert estimate.plot_over_time(axes=axes) is axes and axes.figure is figure
    assert axes.get_xlabel() == "t (µs)" and axes.lines[0].get_ydata().max() == pytest.approx(estimate.sup)  # type: ignore[union-attr]


def test_parts_that_alternate_are_a_range_and_a_mean() -> None:
    """The parts of a bar go up and down with each sample: as lines, they are solid blocks."""
    estimate = pc.estimate(pc.simulate(bar(100), end=50e-6, courant=0.9))
    axes = estimate.plot_over_time()
    time, elastic = 1e6 * estimate.over_time.time, np.sqrt(np.maximum(estimate.over_time.elastic, 0.0))
    mean = {line.get_label(): line for line in axes.lines}["elastic part"]
    (band,) = [each for each in axes.collections if each.get_facecolor()[0, :3].tolist() == list(to_rgb(mean.get_color()))]
    outline = band.get_paths()[0].vertices
    # The first and the last sample lie on the outline itself.
    assert np.all(band.get_paths()[0].contains_points(np.column_stack([time, elastic])[1:-1], radius=1e-9))
    assert outline[:, 1].max() == pytest.approx(elastic.max()) and outline[:, 0].max() == pytest.approx(time.max())
    turns = [np.count_nonzero(np.diff(values)[1:] * np.diff(values)[:-1] < 0.0) for values in (elastic, mean.get_ydata())]
    assert turns[0] > 500 and turns[1] < 50
    assert np.interp(30.0, mean.get_xdata(), mean.get_ydata()) == pytest.approx(elastic[abs(time - 30.0) < 1.0].mean(), rel=0.01)  # type: ignore[arg-type]
    labels = [text.get_text() for text in axes.get_legend().get_texts()]
    assert labels == ["error √η", "kinetic part", "elastic part", "contact part", "mean error", "sup", "range of the samples"]


@pytest.mark.parametrize(
    ("quantity", "label"),
    [("displacement", "displacement (mm)"), ("velocity", "velocity (m/s)"), ("von_mises", "von Mises stress (GPa)")],
)
def test_fields_on_the_deformed_body(quantity: str, label: str, block_history: pc.History) -> None:
    axes = block_history.plot(quantity, step=15)
    assert axes.child_axes[0].get_ylabel() == label and axes.get_title() == "t = 10.83 µs, displacement × 1"


def test_titles_tell_what_a_factor_is_of(block_history: pc.History, bar_history: pc.History) -> None:
    """A map and a field exaggerate the whole displacement, an outline the deformation alone."""
    estimate = pc.estimate(block_history)
    assert block_history.plot(scale=20.0).get_title().endswith(", displacement × 20, rigid motion included")
    assert "\ndisplacement × 2.5, rigid motion included, at t = " in estimate.plot_map(scale=2.5).get_title()
    assert "rigid" not in block_history.plot().get_title() and "rigid" not in estimate.plot_map().get_title()
    # A bar is drawn along its undeformed axis.
    assert "×" not in bar_history.plot("stress", scale=20.0).get_title()


def test_stresses_are_those_of_the_law() -> None:
    """Stretched by ε along x, with no stress across: σ = Eε in plane stress with ε_yy = -νε, whatever the element."""
    mesh = pc.Mesh.rectangle(1.0, 1.0, nx=3, ny=2)
    strain = 1e-3
    field = np.column_stack([strain * mesh.points[:, 0], -0.3 * strain * mesh.points[:, 1]])
    for plane, expected in (("stress", 2e11 * strain), ("strain", None)):
        law = pc.Elastic(young=2e11, poisson=0.3, density=7800.0, plane=plane)  # type: ignore[arg-type]
        history = pc.simulate(pc.Problem(mesh, material=law, initial_displacement=field), end=2e-9, step=1e-9)
        values = history.plot("von_mises", step=0).collections[0].get_array()
        pressure = history.plot("pressure", step=0).collections[0].get_array()
        assert values is not None and pressure is not None
        if expected is not None:
            assert np.allclose(values * 1e6, expected, rtol=1e-9) and np.allclose(pressure * -3e6, expected, rtol=1e-9)
        else:
            # tr σ = 3K tr ε with the bulk modulus K = E/(3(1-2ν)).
            assert np.allclose(pressure * -1e6, 2e11 / 1.2 * 0.7 * strain, rtol=1e-9)


def test_colours_are_logarithmic_where_an_element_outshines_the_rest() -> None:
    from percute.pictures.body import scale_of

    values = np.ones(200)
    values[:2], values[3] = 1e-9, 5.0
    assert scale_of(values)[:3] == (0.0, 5.0, False)
    values[3] = 5.01
    # From the hundredth part on.
    assert scale_of(values)[:3] == (1.0, 5.01, True) and scale_of(values[:150])[2]
    assert scale_of(np.array([1.0, 1e9]))[:3] == (0.0, 1e9, False) and scale_of(np.array([1.0, 1.0, 1e9]))[:3] == (1e5, 1e9, True)
    assert scale_of(np.zeros(3))[:3] == (0.0, 1.0, False)
    assert scale_of(np.array([1.0, 1.0, 1e9])).marks[:2] == [(1e5, "≤ 100000"), (1e6, "1e6")]


def test_the_map_of_a_local_error_is_logarithmic(block_history: pc.History) -> None:
    estimate = pc.estimate(block_history)
    values = np.full(96, 1e-3)
    values[0] = 1.0
    estimate.__dict__["by_element"] = values
    axes = estimate.plot_map()
    assert type(axes.collections[0].norm).__name__ == "LogNorm"


def test_a_map_on_the_deformed_body(block_history: pc.History, tmp_path: Path) -> None:
    estimate = pc.estimate(block_history, instants=3, fields=True)
    step = int(np.argmin(abs(block_history.time - estimate.time_of_sup)))
    x = estimate.plot_map(scale=2.0).collections[0].get_paths()[0].vertices[0, 0]  # type: ignore[index]
    node = block_history.problem.mesh.cells[0, 0]
    moved = block_history.problem.mesh.points[node] + 2 * block_history.displacement[step, node]
    assert 1e-3 * float(x) == pytest.approx(moved[0], rel=1e-12)
    estimate.save(tmp_path / "with.vtkhdf")
    pc.estimate(block_history).save(tmp_path / "without.vtkhdf")
    stored = pc.open(tmp_path / "with.vtkhdf")
    assert isinstance(stored, pc.Estimate) and "displacement × 1, at t = 13" in stored.plot_map(scale=1.0).get_title()
    without = pc.open(tmp_path / "without.vtkhdf")
    assert isinstance(without, pc.Estimate) and without.plot_map().get_title()
    with pytest.raises(pc.InputError, match="`scale` needs displacements"):
        without.plot_map(scale=1.0)


def test_sources_over_time(block_history: pc.History) -> None:
    estimate = pc.estimate(block_history)
    assert estimate.sources is not None
    axes = estimate.plot_over_time("sources")
    drawn = {line.get_label(): line.get_ydata() for line in axes.lines}
    assert np.allclose(drawn["dispersion"], np.sqrt(np.maximum(estimate.sources.over_time.dispersion, 0.0)))  # type: ignore[arg-type]
    with pytest.raises(pc.InputError, match='"corrected" separates them, for elastic materials'):
        pc.estimate(block_history, reconstruction="published").plot_over_time("sources")


def test_energies_of_a_history_and_of_a_file(block_history: pc.History, tmp_path: Path) -> None:
    pc.estimate(block_history).save(tmp_path / "error.vtkhdf")
    stored = pc.open(tmp_path / "error.vtkhdf")
    for subject in (block_history, pc.estimate(block_history), stored):
        axes = subject.plot_energies()
        drawn = {line.get_label(): line.get_ydata() for line in axes.lines}
        assert np.allclose(1e3 * drawn["strain"], block_history.balance.strain)  # type: ignore[operator]
        # Nothing does work but contact.
        assert list(drawn) == ["kinetic + strain", "kinetic", "strain", "work of contact", "dissipated by friction"]


def test_force_and_pressure(block_history: pc.History, bar_history: pc.History, tmp_path: Path) -> None:
    contact = block_history.contact
    axes = block_history.plot_force()
    assert np.allclose(1e6 * axes.lines[0].get_ydata(), contact.resultants.normal_force)  # type: ignore[operator]
    zone = pc.estimate(block_history).plot_pressure()
    values = zone.collections[0].get_array()
    assert values is not None and 1e9 * values.max() == pytest.approx(contact.pressure[:-1].max()) and zone.get_xlabel() == "t (µs)"
    bar = bar_history.plot_pressure()
    assert np.allclose(1e9 * bar.lines[0].get_ydata(), bar_history.contact.pressure[:, 0])  # type: ignore[operator]
    with pytest.raises(pc.InputError, match="`plane` is 1"):
        block_history.plot_pressure(1)
    rod = pc.Problem(pc.Mesh.bar(1.0, elements=2), material=pc.Elastic(young=1.0, density=1.0, section=1.0), initial_velocity=0.1)
    free = pc.simulate(rod, end=1.0, courant=0.9)
    for call in (free.plot_force, free.plot_pressure, pickle.loads(pickle.dumps(pc.estimate(block_history))).plot_force):
        with pytest.raises(pc.InputError, match="there is nothing to draw: (the problem has no planes|the estimate was unpickled)"):
            call()


def test_the_plane_with_the_largest_force_is_drawn() -> None:
    base = block(2, 2)
    mesh = pc.Mesh(base.mesh.points, base.mesh.cells, {"bottom": [[0, 1], [1, 2]], "left": [[3, 6]]})
    planes = [pc.Plane(point=(0, -1e-5), normal=(0, 1), friction=0.0, group="bottom"), pc.Plane(point=(-1e-5, 0), normal=(1, 0), friction=0.0, group="left")]
    history = pc.simulate(pc.Problem(mesh, material=base.material, obstacles=planes, initial_velocity=(-40, -1)), end=3e-6, courant=0.5)
    peaks = [each.normal_force.max() for each in history.contact.obstacles]
    assert peaks[1] > peaks[0] > 0.0
    assert [history.plot_pressure(plane).get_title() for plane in (None, 0, 1)] == ["plane 1", "plane 0", "plane 1"]
    assert [line.get_label() for line in history.plot_force().lines][2] == "normal, plane 1"


@pytest.mark.parametrize("ending", ["svg", "png", "pdf"])
def test_figures_are_saved_with_the_same_bytes(ending: str, block_history: pc.History, tmp_path: Path) -> None:
    file, again = tmp_path / f"energies.{ending}", tmp_path / f"again.{ending}"
    block_history.plot_energies(save=file)
    block_history.plot_energies(save=str(again))
    assert file.read_bytes() == again.read_bytes() and len(list(tmp_path.iterdir())) == 2
    before = file.stat().st_mtime_ns
    with pytest.raises(pc.ExistingFileError, match="the file exists already; give another name, or overwrite=True"):
        block_history.plot_force(save=file)
    assert file.stat().st_mtime_ns == before
    block_history.plot_force(save=file, overwrite=True)
    assert file.read_bytes() != again.read_bytes()


def test_files_are_checked_before_anything_is_drawn(block_history: pc.History, tmp_path: Path) -> None:
    with pytest.raises(pc.InputError, match=r"`save` is 'map.jpg'; the name must end in .svg or .png or .pdf"):
        block_history.plot(save="map.jpg")
    with pytest.raises(pc.MissingFileError, match="there is no folder"):
        block_history.plot(save=tmp_path / "none" / "map.svg")
    (tmp_path / "folder.svg").mkdir()
    with pytest.raises(pc.StorageError, match="not a regular file"):
        block_history.contact.plot(save=tmp_path / "folder.svg", overwrite=True)
    assert not plt.get_fignums() and len(list(tmp_path.iterdir())) == 1


def test_bars(bar_history: pc.History) -> None:
    axes = bar_history.plot("stress", step=20)
    assert axes.get_ylabel() == "stress (GPa)" and axes.get_xlabel() == "x (mm)"
    pc.estimate(bar_history).plot_map()
    with pytest.raises(pc.InputError, match="must be one of displacement, velocity, acceleration, stress, equivalent_plastic_strain, strain_energy"):
        bar_history.plot("von_mises")
    with pytest.raises(pc.InputError, match="`step` is 1000"):
        bar_history.plot(step=1000)


def test_without_matplotlib_the_way_out_is_named() -> None:
    program = """
import sys
sys.modules["matplotlib"] = None
import percute as pc
problem = pc.Problem(pc.Mesh.bar(1.0, elements=2), material=pc.Elastic(young=1.0, density=1.0, section=1.0))
try:
    pc.simulate(problem, end=1.0, courant=0.9).plot()
except pc.PercuteError as error:
    print(error)
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout == 'pictures need matplotlib: pip install matplotlib\n'
