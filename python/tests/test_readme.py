"""The Python of the README and of the package runs as it stands."""

import re
import shlex
import shutil
import subprocess
import sys
import textwrap
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import percute as pc
import pytest
from conftest import block

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("page", ["README.md", "docs/python.md", "docs/fields.md"])
def test_the_examples_of_a_page_run(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    examples = re.findall(r"```python\n(.*?)```", (ROOT / page).read_text(), re.DOTALL)
    assert examples
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    for example in examples:
        exec(example, names)
    plt.close("all")
    assert isinstance(names["estimate"], pc.Estimate) and names["estimate"].published_relative_sup < 0.1


@pytest.mark.parametrize("page", ["docs/export.md", "docs/fields.md", "docs/report.md"])
def test_the_commands_of_a_page_run(page: str, tmp_path: Path) -> None:
    """In a folder with the files that the pages name; then the Python that reads what the commands wrote."""
    text = (ROOT / page).read_text()
    commands = re.findall(r"(?m)^    percute ([^#\n]*)", text)
    assert commands
    for name in ("case.toml", "block.toml"):
        shutil.copy(ROOT / "examples" / "block.toml", tmp_path / name)
    made = "run block.toml --quiet --history block.vtkhdf --estimate error.vtkhdf"
    for command in (made, *commands):
        # Pages name the same file twice: for a run, and for its history.
        extra = ["--force"] if command.startswith(("report", "run")) else []
        done = subprocess.run([sys.executable, "-m", "percute", *shlex.split(command), *extra], cwd=tmp_path, capture_output=True, text=True)
        assert done.returncode == 0, f"percute {command}: {done.stderr}"
    readers = [each for each in re.findall(r"```python\n(.*?)```", text, re.DOTALL) if "vtkHDFReader" in each]
    for reader in readers:
        (tmp_path / "reader.py").write_text(reader)
        done = subprocess.run([sys.executable, "reader.py"], cwd=tmp_path, capture_output=True, text=True)
        assert done.returncode == 0 and done.stdout.count("(640,") >= 2, done.stderr + done.stdout


def test_the_readme_prints_what_it_says(capsys: pytest.CaptureFixture[str]) -> None:
    """The Python of the first example, and the summary of the first command but for the time that it took."""
    text = (ROOT / "README.md").read_text()
    example, printed = re.findall(r"```python\n(.*?)```\n\n```text\n(.*?)```", text, re.DOTALL)[0]
    exec(example, {})
    assert capsys.readouterr().out == printed
    done = subprocess.run(
        [sys.executable, "-m", "percute", "run", "examples/block.toml"], cwd=ROOT, capture_output=True, text=True, check=True
    )
    shown = textwrap.dedent("".join(re.findall(r"(?m)^    case .*\n(?:    .*\n)*", text)))
    # What the residual is, is rounding: which one is largest, and by how much, is no promise.
    told, given = (re.sub(r"(?m)^(residual  largest) \S+ \(\w+\)", r"\1", part) for part in (shown, done.stdout))
    assert told.count("residual  largest,") == 1
    assert told.splitlines()[1:] == given.splitlines()[1:]


def test_the_solver_of_the_page_on_other_programs_is_graded(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It prints what the page says, agrees with percute's own run, and makes a file and a page."""
    monkeypatch.chdir(tmp_path)
    text = (ROOT / "docs" / "foreign.md").read_text()
    example, printed = re.findall(r"```python\n(.*?)```\n\nprints\n\n```text\n(.*?)```", text, re.DOTALL)[0]
    names: dict[str, Any] = {}
    with pytest.warns(pc.InputWarning, match="the last instant, 1.33e-5 s, is left out"):
        exec(example, names)
    assert capsys.readouterr().out == printed
    ours = pc.simulate(names["problem"], steps=[names["dt"]] * names["steps"])
    # Some roundings of the path, 0.3 mm, and of places of 50 mm.
    assert abs(ours.displacement - names["displacement"]).max() < 1e-16
    last = names["history"].time[-1]
    shorter = pc.estimate(pc.simulate(names["problem"], end=last, step=names["dt"]))
    assert names["estimate"].sup == pytest.approx(shorter.sup, rel=1e-9)
    exec(re.findall(r"```python\n(history.save.*?)```", text, re.DOTALL)[0], names)
    assert names["estimate"].by_element.tobytes() == pc.estimate(pc.open("theirs.vtkhdf")).by_element.tobytes()
    assert "simulated by Solver 3, estimated by" in Path("theirs.html").read_text(encoding="utf-8")


def test_the_step_of_flight_of_the_page_on_other_programs() -> None:
    """A history that starts on its plane is that of percute one step before."""
    text = (ROOT / "docs" / "foreign.md").read_text()
    solver = re.findall(r"```python\n(import numpy.*?)# Its grade", text, re.DOTALL)[0]
    assert "20.0, 1e-5, 0.2" in solver
    names: dict[str, Any] = {}
    exec(solver.replace("20.0, 1e-5, 0.2", "20.0, 0.0, 0.2"), names)
    with pytest.warns(pc.InputWarning, match="the last instant"):
        exec(re.findall(r"```python\n(flight = .*?)```", text, re.DOTALL)[0], names)
    ours = pc.simulate(names["problem"], steps=[names["dt"]] * (len(names["later"]) - 1))
    # Some roundings of the path, 0.3 mm, and of places of 50 mm.
    assert abs(ours.displacement - names["later"]).max() < 1e-16
    assert pc.estimate(names["history"]).trust == "high"


def test_the_cut_of_the_page_on_other_programs_ends_with_the_first_contact() -> None:
    text = (ROOT / "docs" / "foreign.md").read_text()
    time, cut = re.findall(r"```python\n(time = [^\n]*\n)(loaded = .*?)```", text, re.DOTALL)[0]
    # As printed, after the solver of the page.
    names: dict[str, Any] = {}
    exec(re.findall(r"```python\n(import numpy.*?)# Its grade", text, re.DOTALL)[0], names)
    exec(re.findall(r"# Its grade\.\n(.*?)history = ", text, re.DOTALL)[0], names)
    exec(time + cut, names)
    assert len(names["history"]) == names["steps"]
    whole = pc.simulate(block(), end=40e-6, courant=0.8)
    loaded = whole.reaction.any(axis=(1, 2))
    last = int(loaded.nonzero()[0].max())
    assert loaded[loaded.argmax() : last].all() and last + 2 < len(whole)
    for count, kept in ((len(whole), last + 2), (last, last)):
        arrays = {name: getattr(whole, name)[:count] for name in ("time", "displacement", "reaction")}
        names = {"np": np, "pc": pc, "problem": whole.problem, **arrays}
        exec(cut, names)
        assert len(names["history"]) == kept


def test_the_example_of_the_package_runs() -> None:
    assert pc.__doc__ is not None
    names: dict[str, object] = {}
    exec(textwrap.dedent(pc.__doc__.split("::\n\n")[1].split("\n\nAll quantities")[0]), names)
    assert isinstance(names["estimate"], pc.Estimate)


def test_every_public_name_is_in_the_reference() -> None:
    page = (ROOT / "docs" / "python.md").read_text()
    for name in pc.__all__:
        assert name == "__version__" or f"`{name}" in page or f".{name}" in page, name
    for kind in (pc.Mesh, pc.Problem, pc.History, pc.Contact, pc.Estimate, pc.exact.BarImpact):
        for name in dir(kind):
            value = getattr(kind, name)
            if not name.startswith("_") and (callable(value) or value.__doc__):
                assert f"`{name}" in page or f".{name}(" in page, f"{kind.__name__}.{name}"
            assert name.startswith("_") or value.__doc__, f"{kind.__name__}.{name} says nothing"
