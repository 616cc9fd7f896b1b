"""A problem on nested meshes, in Python and in the command."""

import importlib
import json
import subprocess
import sys
import warnings
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import percute as pc
import pytest
from percute._percute import SERIES

MATERIAL = pc.Elastic(young=70e9, density=2700.0, section=0.02)
PLANE = pc.Plane(point=-1e-3, normal=1.0)
CASE = """
[mesh]
bar = {{ length = 0.1, elements = 16 }}
[material]
young = 70e9
density = 2700.0
section = 0.02
[initial]
velocity = -400.0
[[obstacle]]
point = -{gap}
normal = 1.0
[time]
end = 60e-6
courant = 0.9
"""
EXAMPLES = Path(__file__).parents[2] / "examples"


def bar(elements: int) -> pc.Problem:
    mesh = pc.Mesh.bar(0.1, elements=elements)
    # It starts with an initial velocity and a displacement that differ from node to node.
    velocity = -400.0 + 10.0 * np.sin(40.0 * mesh.points)
    return pc.Problem(mesh, material=MATERIAL, obstacles=[PLANE], initial_velocity=velocity)


def test_the_levels_are_those_of_separate_runs(tmp_path: Path) -> None:
    """Estimates are those of `estimate`, true errors those of `true_errors`, on problems stated by hand."""
    told = []
    found = pc.verify(bar(16), end=60e-6, courant=0.9, levels=2, progress=lambda seen: told.append(seen.stage))
    assert found.elements.tolist() == [16, 32, 64] and {"simulating"} <= set(told)
    history = pc.simulate(bar(16), end=60e-6, courant=0.9)
    estimate = pc.estimate(history)
    assert (found.estimate_sup[0], found.estimate_mean[0]) == (estimate.sup, estimate.mean)
    (error,) = pc.true_errors([history], refined(2), end=60e-6, courant=history_courant(history))
    # The steps of the reference differ by rounding.
    assert found.error_mean[0] == pytest.approx(error.mean, rel=1e-9)
    assert found.effectivity_mean[0] == pytest.approx(estimate.mean / error.mean, rel=1e-9)
    assert np.isnan(found.error_mean[2]) and np.isnan(found.effectivity_sup[2])
    assert found.expected == tuple(json.loads(estimate.to_json())["verdict"]["effectivity"])
    assert found.rebound[0] == estimate.rebound.normal_after  # type: ignore[union-attr]
    assert found.averaged_peak_force[0] == estimate.contact_peak.force  # type: ignore[union-attr]
    assert found.orders["estimate"] == pytest.approx(np.log2(found.estimate_mean[1] / found.estimate_mean[2]))
    for name in ("averaged_peak_force", "impulse", "rebound"):
        coarse, middling, fine = getattr(found, name)
        # A sequence that does not settle has no order, and one slower than h^0.1 does not in practice.
        ratio = (coarse - middling) / (middling - fine)
        assert found.orders[name] == (pytest.approx(np.log2(ratio), rel=1e-9) if ratio > 2**0.1 else None), name
    assert any(found.orders[name] for name in ("averaged_peak_force", "impulse", "rebound"))
    assert str(found).count("\n") >= 6 and found.moved is not None and found.fine_enough == (found.moved <= 0.1)
    (middle,) = pc.true_errors([history], refined(1), end=60e-6, courant=history_courant(history))
    assert found.moved == pytest.approx(abs(error.mean / middle.mean - 1.0), rel=1e-6)
    errors, indices, contact = found.plot(save=tmp_path / "convergence.svg")
    assert (tmp_path / "convergence.svg").stat().st_size > 1000
    assert [line.get_ydata()[0] for line in errors.lines] == [found.estimate_mean[0], found.estimate_sup[0], found.error_mean[0], found.error_sup[0]]
    assert indices.lines[0].get_ydata()[0] == found.effectivity_mean[0]
    shown = [found.averaged_peak_force, found.impulse, found.rebound]
    assert [line.get_ydata()[0] for line in contact.lines[:3]] == pytest.approx([each[0] / each[-1] for each in shown], rel=1e-15)
    with pytest.raises(pc.InputError, match="three axes"):
        found.plot(axes=[errors, indices])


def test_an_interrupt_keeps_the_levels_done() -> None:
    """Stopped in the third run, it has what two levels give."""

    class Stop(Exception):
        verification: pc.Verification | None

    def tell(seen: pc.Progress) -> None:
        # 10 000, 20 000 and 40 000 steps: the third run takes many times the 50 ms between two calls.
        if seen.total > 30000:
            raise Stop

    problem = bar(16)
    step = 0.005 * problem.critical_time_step
    with pytest.raises(Stop) as stopped:
        pc.verify(problem, end=60e-6, step=step, levels=2, progress=tell)
    partial = stopped.value.verification
    assert partial is not None and partial.elements.tolist() == [16, 32]
    whole = pc.verify(problem, end=60e-6, step=step, levels=1)
    assert partial.error_mean[0] == whole.error_mean[0] and partial.effectivity_sup[0] == whole.effectivity_sup[0]
    assert "Interrupted: the finest level done is the reference." in str(partial)


def test_the_rebound() -> None:
    """All meshes have the end that the first needs."""
    problem = bar(16)
    end = pc.simulate(problem, end="rebound", courant=0.9, longest=1e-3).time[-1]
    found, same = pc.verify(problem, end="rebound", courant=0.9, longest=1e-3, levels=1), pc.verify(problem, end=end, courant=0.9, levels=1)
    assert found.estimate_mean.tolist() == same.estimate_mean.tolist() and np.isfinite(found.rebound).all()
    with pytest.raises(pc.InputError, match="longest"):
        pc.verify(problem, end="rebound", courant=0.9)
    with pytest.raises(pc.InputError, match="leave them out"):
        pc.verify(problem, end=1e-5, courant=0.9, longest=1.0)


def test_no_error_has_no_index() -> None:
    """A rigid flight: estimate and true error are roundings, and their quotient says nothing."""
    mesh = pc.Mesh.bar(0.1, elements=4)
    problem = pc.Problem(mesh, material=MATERIAL, initial_velocity=3.0)
    found = pc.verify(problem, end=1e-5, courant=0.9, levels=2)
    assert np.isnan(found.effectivity_mean).all() and "zero to rounding" in str(found)


def test_much_work_must_be_asked_for() -> None:
    """1.4e7 elements times steps on the first mesh make 1365 times as many with five refinements."""
    with pytest.raises(pc.InputError, match="elements times steps in all.*`long=True`"):
        pc.verify(bar(16), end=1.0, courant=0.9, levels=5)


def test_a_single_refinement_does_not_judge() -> None:
    """The true error lacks that of the reference, so the index is too large: no range is missed."""
    told = str(pc.verify(bar(16), end=60e-6, courant=0.9, levels=1))
    assert "outside" not in told and "with one, the index is too large" in told


def refined(times: int) -> pc.Problem:
    """The bar of 16 elements on a finer mesh; its initial velocity is linear in the first elements."""
    coarse = bar(16)
    fine = coarse.mesh.refine(times)
    velocity = np.interp(fine.points[:, 0], coarse.mesh.points[:, 0], coarse.initial_velocity[:, 0])[:, None]
    return pc.Problem(fine, material=MATERIAL, obstacles=[PLANE], initial_velocity=velocity)


def history_courant(history: pc.History) -> float:
    """The longest step over the critical one."""
    return float(np.diff(history.time).max() / history.problem.critical_time_step)


def test_a_smooth_motion_settles() -> None:
    """A vibrating bar: the mean falls like h, and the finest of four meshes is fine enough."""
    mesh = pc.Mesh.bar(0.1, elements=16)
    material = pc.Elastic(young=70e9, density=2700.0, section=0.02)
    problem = pc.Problem(mesh, material=material, initial_velocity=np.cos(np.pi * mesh.points / 0.1))
    found = pc.verify(problem, end=20e-6, courant=0.5, levels=3)
    assert found.fine_enough and found.orders["estimate"] == pytest.approx(1.0, abs=0.1)
    assert np.isnan(found.averaged_peak_force).all() and found.orders["averaged_peak_force"] is None


def test_probes_are_those_of_histories() -> None:
    """The largest value of `history.probe` over time, at nodes and within elements, of one component or a magnitude."""
    problem = pc.Problem(
        pc.Mesh.rectangle(0.02, 0.01, nx=4, ny=2),
        material=pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="strain"),
        obstacles=[pc.Plane(point=(0.0, -1e-4), normal=(0.02, 1.0), friction=0.1)],
        initial_velocity=(3.0, -100.0),
    )
    history = pc.simulate(problem, end=8e-6, courant=0.9)
    inside, node = (0.0071, 0.0013), (0.01, 0.005)
    found = pc.verify(problem, end=8e-6, courant=0.9, levels=1, probe=[(*inside, "von_mises"), (*inside, "stress_xy"), (*node, "velocity")])
    stress = np.abs(history.probe(inside, "stress")[:, 0, 1]).max()
    speed = np.linalg.norm(history.probe(node, "velocity"), axis=1).max()
    known = {"0.0071,0.0013:von_mises": history.probe(inside, "von_mises").max(), "0.0071,0.0013:stress_xy": stress, "0.01,0.005:velocity": speed}
    # Solved in another order of the nodes, the values differ by rounding.
    assert {name: values[0] for name, values in found.probes.items()} == pytest.approx(known, rel=1e-9)
    single = pc.verify(problem, end=8e-6, courant=0.9, levels=1, probe="0.0071,0.0013:von_mises")
    assert single.probes["0.0071,0.0013:von_mises"].tolist() == found.probes["0.0071,0.0013:von_mises"].tolist()
    tupled = pc.verify(problem, end=8e-6, courant=0.9, levels=1, probe=(*inside, "von_mises"))
    assert list(tupled.probes) == ["0.0071,0.0013:von_mises"] and tupled.orders["0.0071,0.0013:von_mises"] is None
    assert found.convergence["0.01,0.005:velocity"].unit == "m/s" and found.convergence["impulse"].unit == "N s/m"


def test_convergence_is_that_of_the_values() -> None:
    """Changes, orders and limits of the three finest meshes, in Python, in the table and in JSON."""
    found = pc.verify(bar(16), end=60e-6, courant=0.9, levels=3, probe="0.05:displacement")
    for name, values in {"averaged_peak_force": found.averaged_peak_force, "impulse": found.impulse, **found.probes}.items():
        _, coarse, middle, fine = values
        judged, ratio = found.convergence[name], (middle - coarse) / (fine - middle)
        assert judged.change == pytest.approx((fine - middle) / fine, rel=1e-12)
        assert (judged.order is None) == (ratio < 0.0), name
        # Differences that fall more slowly than h^0.1 have no limit in practice.
        if ratio > 2**0.1:
            assert judged.converges and found.orders[name] == judged.order == pytest.approx(np.log2(ratio), rel=1e-9)
            # The rest of a geometric series.
            assert judged.remaining == pytest.approx((fine - middle) / fine / (ratio - 1.0), rel=1e-6)
        assert judged.warning is None or abs(judged.change) > 0.01
    assert any(each.converges for each in found.convergence.values())
    table = str(found).splitlines()
    assert [line.split()[0] for line in table[5:7]] == ["change", "order"] and all(len(line) <= 80 for line in table if line.startswith((" ", "probe")))
    assert "probe 0.05:displacement in m, the largest over time without its sign:" in table
    (shown,) = [line for line in table if line.split()[:1] == [f"{found.probes['0.05:displacement'][0]:.4g}"]]
    assert len(shown.split()) == 4


def test_levels_out_of_range() -> None:
    for levels in (0, 6):
        with pytest.raises(pc.InputError, match="levels"):
            pc.verify(bar(4), end=1e-5, courant=0.9, levels=levels)


def test_the_options_of_the_estimate() -> None:
    """Acceleration and sampling are those of `estimate`, and change it."""
    problem, plain = bar(16), {"end": 60e-6, "courant": 0.9}
    found = pc.verify(problem, **plain, levels=1, acceleration="weak", every=3)
    estimate = pc.estimate(pc.simulate(problem, **plain), acceleration="weak", every=3)
    assert (found.estimate_sup[0], found.estimate_mean[0]) == (estimate.sup, estimate.mean)
    assert found.estimate_mean[0] not in (pc.verify(problem, **plain, levels=1, **other).estimate_mean[0] for other in ({"acceleration": "weak"}, {"every": 3}))
    with pytest.raises(pc.InputError, match="`acceleration`.*split"):
        pc.verify(problem, **plain, reconstruction="published", acceleration="split")
    with pytest.raises(pc.InputError, match="every"):
        pc.verify(problem, **plain, every=0)


SVG = "{http://www.w3.org/2000/svg}"


def test_a_bar_that_flies_on_has_no_error_and_no_picture(tmp_path: Path) -> None:
    case, picture = tmp_path / "case.toml", tmp_path / "command.svg"
    case.write_text(CASE.format(gap=1.0))
    command = [sys.executable, "-m", "percute", "verify", str(case), "--picture", str(picture)]
    told = subprocess.run(command, check=True, capture_output=True, text=True)
    assert "no picture: there are no errors on two meshes" in told.stdout + told.stderr and not picture.exists()


def test_the_picture_of_the_command_is_that_of_python(tmp_path: Path) -> None:
    """Points, colours, dashes, legends, the shaded range and labels."""
    gap = 1e-3
    case = tmp_path / "case.toml"
    case.write_text(CASE.format(gap=gap))
    picture = tmp_path / "command.svg"
    probes = ["0.02:stress", "0.05:velocity", "0.05:displacement", "0.07:velocity"] if gap < 1.0 else []
    command = [sys.executable, "-m", "percute", "verify", str(case), *(word for probe in probes for word in ("--probe", probe))]
    subprocess.run([*command, "--quiet", "--picture", str(picture)], check=True, capture_output=True)
    problem = pc.Problem(pc.Mesh.bar(0.1, elements=16), material=MATERIAL, obstacles=[pc.Plane(point=-gap, normal=1.0)], initial_velocity=-400.0)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", pc.InputWarning)
        plots = pc.verify(problem, end=60e-6, courant=0.9, probe=probes).plot()
    root = ElementTree.parse(picture).getroot()
    style = root.findtext(f"{SVG}style") or ""
    texts = ["".join(text.itertext()) for text in root.iter(f"{SVG}text")]
    legends = [entry.get_text() for axes in plots for entry in (axes.get_legend().get_texts() if axes.get_legend() else [])]
    assert [text for text in texts if text in legends] == legends and "expected by the verdict on the first mesh" in legends
    labels = [label.get_text() for axes in plots for label in axes.get_xticklabels()]
    assert [text for text in texts if text in labels and text != "1" or text.startswith("1/")] == [label for label in labels if label != "1"]
    names = [axes.get_ylabel().replace("$^{1/2}$", "½") for axes in plots] + [plots[-1].get_xlabel()]
    assert sorted(text for text in texts if text in names) == sorted(names)
    notes = [text.get_text() for axes in plots for text in axes.texts]
    assert [text for text in texts if text in notes] == notes == []
    # Frames of the plots, by their axes: the vertical line is the second of both.
    axis = [[float(line.get(key, "")) for key in ("x1", "y1", "x2", "y2")] for line in root.iter(f"{SVG}line") if line.get("class") == "axis"]
    frames = [(across[0], across[2], up[1], up[3]) for across, up in zip(axis, axis[1:], strict=False) if across[2] - across[0] > 100]
    assert len(frames) == len(plots) == 3
    lines = [line for line in root.iter(f"{SVG}polyline")]
    drawn = [(axes, frame, line) for axes, frame in zip(plots, frames, strict=True) for line in axes.lines if line.get_marker() == "o"]
    assert len(drawn) == len(lines)
    for (axes, (left, right, top, bottom), line), mark in zip(drawn, lines, strict=True):
        values = np.array([point.split(",") for point in (mark.get("points") or "").split()], dtype=float)
        data = np.column_stack([np.asarray(line.get_xdata(), float), np.asarray(line.get_ydata(), float)])
        places = (axes.transScale + axes.transLimits).transform(data[np.isfinite(data[:, 1])])
        # Pixels have one decimal.
        assert np.abs(values - [left, bottom] - places * [right - left, top - bottom]).max() < 0.06
        series, look = (mark.get("class") or "").split()
        assert line.get_color() == SERIES[int(series[1])] and f".{series}{{stroke:{line.get_color()}" in style
        assert (look == "dashed") == (line.get_linestyle() == "--")
    (band,) = [mark for mark in root.iter(f"{SVG}rect") if mark.get("class") == "s2 band" and float(mark.get("width", "")) > 100]
    (span,) = plots[1].patches
    low, high = (plots[1].transLimits.transform((0.0, edge))[1] for edge in span.get_window_extent().transformed(plots[1].transData.inverted()).intervaly)
    top, bottom = frames[1][2:]
    assert [float(band.get("y", "")), float(band.get("height", ""))] == pytest.approx([bottom + high * (top - bottom), (high - low) * (bottom - top)], abs=0.15)


def test_errors_on_one_mesh_are_no_picture() -> None:
    class Stop(Exception):
        verification: pc.Verification | None

    def tell(seen: pc.Progress) -> None:
        # 50 000 and 100 000 steps: the second run takes many times the 50 ms between two calls.
        if seen.total > 60000:
            raise Stop

    problem = bar(16)
    with pytest.raises(Stop) as stopped:
        pc.verify(problem, end=60e-6, step=0.001 * problem.critical_time_step, progress=tell)
    assert stopped.value.verification is not None and len(stopped.value.verification.size) == 1
    with pytest.raises(pc.InputError, match="errors on two meshes"):
        stopped.value.verification.plot()


def test_the_command(tmp_path: Path) -> None:
    run = [sys.executable, "-m", "percute", "verify"]
    done = subprocess.run([*run, str(EXAMPLES / "bar.toml")], capture_output=True, text=True, check=True)
    assert "level 2: 400 elements" in done.stderr and "times the time of level 0" in done.stderr
    assert all(len(line) <= 80 or " " in line for line in done.stdout.splitlines()) and "order" in done.stdout
    json_done = subprocess.run([*run, str(EXAMPLES / "bar.toml"), "--json", "--quiet", "--levels", "1"], capture_output=True, text=True, check=True)
    document = json.loads(json_done.stdout)
    assert json_done.stderr == "" and [level["elements"] for level in document["levels"]] == [100, 200]
    picture = tmp_path / "convergence.svg"
    subprocess.run([*run, str(EXAMPLES / "bar.toml"), "--quiet", "--picture", str(picture)], check=True, capture_output=True)
    for text in ("error (J", "effectivity index", "peak force", "rebound velocity", "1/4"):
        assert text in picture.read_text(), text
    again = subprocess.run([*run, str(EXAMPLES / "bar.toml"), "--quiet", "--picture", str(picture)], capture_output=True, text=True)
    assert again.returncode == 2 and "--force" in again.stderr
    document_file = tmp_path / "verification.json"
    document_file.write_text(json_done.stdout)
    plot = [sys.executable, "-m", "percute", "plot", "--kind", "convergence"]
    subprocess.run([*plot, str(document_file), "--save", str(tmp_path / "plot.svg")], check=True, capture_output=True)
    assert (tmp_path / "plot.svg").stat().st_size > 1000
    wrong = subprocess.run([*plot, str(EXAMPLES / "bar.toml"), "--save", str(tmp_path / "other.svg")], capture_output=True, text=True)
    assert wrong.returncode == 2 and "bar.toml' is a case; --kind convergence draws" in wrong.stderr and "percute verify CASE --picture" in wrong.stderr
    refused = subprocess.run([*run, str(EXAMPLES / "bar.toml"), "--levels", "9"], capture_output=True, text=True)
    assert refused.returncode == 2 and "give 1 to 5 refinements" in refused.stderr


@pytest.mark.parametrize("name", ["bar", "two_bars", "stack", "sliding_blocks"])
def test_the_page_has_the_rows_of_the_examples(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The cheapest rows of the table of docs/verdict.md, and one of non-matching interfaces."""
    monkeypatch.syspath_prepend(str(EXAMPLES.parent / "tools"))
    verdict_rows = importlib.import_module("verdict_rows")
    (written,) = (found for found in verdict_rows.ROW.finditer(verdict_rows.PAGE.read_text(encoding="utf-8")) if found[1] == name)
    assert written[0] == verdict_rows.row(name, written[2]), "the estimate has changed: run `python tools/verdict_rows.py`"
