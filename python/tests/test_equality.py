"""The same bits from Python and from the command, from memory and from a file, for any threads and windows."""

import json
import pickle
import re
import subprocess
import sys
from pathlib import Path
from typing import Any, get_args, get_type_hints

import percute as pc
from percute import stored
import pytest

EXAMPLES = Path(__file__).parents[2] / "examples"
# What may differ: how it was asked for, by whom, and how long it took.
ASKED = ("case", "seconds", "versions", "held")
# Of the contact force, by name, the default first; None is the last of what the argument may be.
RECONSTRUCTIONS: tuple[str, ...] = get_args(get_args(get_type_hints(pc.estimate)["reconstruction"])[0])


def command(*arguments: str | Path) -> dict[str, Any]:
    program = [sys.executable, "-m", "percute"]
    done = subprocess.run([*program, *map(str, arguments)], capture_output=True, text=True, check=True)
    return bare(done.stdout)


def bare(text: str) -> dict[str, Any]:
    """The document without what may differ; its numbers have all their digits."""
    document: dict[str, Any] = json.loads(text)
    for name in ASKED:
        document.pop(name, None)
    for name in ("threads", "window"):
        document["options"].pop(name)
    return document


@pytest.fixture(scope="module", params=["bar", "block", "stack"])
def case(request: pytest.FixtureRequest) -> Path:
    return EXAMPLES / f"{request.param}.toml"


@pytest.fixture(scope="module")
def told(case: Path) -> dict[str, Any]:
    return command("run", case, "--json", "--quiet")


@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize("window", [1, 7, None])
def test_python_says_what_the_command_says(
    case: Path, told: dict[str, Any], threads: int, window: int | None, tmp_path: Path
) -> None:
    in_memory = pc.run(case, threads=threads, window=window)
    assert bare(in_memory.to_json()) == told
    file = tmp_path / "history.vtkhdf"
    stored = pc.run(case.read_text(), store=file, threads=threads, window=window)
    assert bare(stored.to_json()) == told and stored.history is not None and stored.history.path == file
    again = pc.estimate(pc.open(file), threads=threads, window=window)
    assert bare(again.to_json()) == told


def test_the_command_estimates_what_python_stored(case: Path, told: dict[str, Any], tmp_path: Path) -> None:
    file = tmp_path / "history.vtkhdf"
    pc.run(case, store=file)
    assert command("estimate", file, "--json", "--quiet") == told


def test_python_estimates_what_the_command_stored(case: Path, told: dict[str, Any], tmp_path: Path) -> None:
    file = tmp_path / "history.vtkhdf"
    subprocess.run([sys.executable, "-m", "percute", "simulate", case, "--history", file, "--quiet"], check=True)
    assert bare(pc.estimate(pc.open(file)).to_json()) == told


def test_a_problem_stated_in_python_is_that_of_the_case() -> None:
    problem = pc.Problem(
        pc.Mesh.rectangle(0.05, 0.04, nx=20, ny=16),
        material=pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress"),
        obstacles=[pc.Plane(point=(0, -2e-4), normal=(0, 1), friction=0.2)],
        initial_velocity=(400, -400),
    )
    # As the case states it.
    estimate = pc.estimate(pc.simulate(problem, end=13e-6, courant=0.9), every=1)
    assert bare(estimate.to_json()) == bare(pc.run(EXAMPLES / "block.toml").to_json())


def test_the_estimate_says_what_its_document_says(block_history: pc.History) -> None:
    estimate = pc.estimate(block_history)
    document = json.loads(estimate.to_json())
    for name in stored.MEASURES:
        assert getattr(estimate, name) == document["error"][name]
    assert estimate.by_element.tolist() == document["by_element"]
    assert dict(estimate.residuals) == document["residuals"]
    for name, values in document["over_time"].items():
        assert getattr(estimate.over_time, name).tolist() == values
    for name, values in document["balance_over_time"].items():
        if name != "time":
            assert getattr(block_history.balance, name).tolist() == values
    worst = document["worst_elements"]
    assert [each.element for each in estimate.worst_elements()] == [each["element"] for each in worst]
    assert estimate.parts.total == pytest.approx(estimate.sup**2, rel=1e-14)
    assert document["case"] == ""
    assert estimate.meaning == document["meaning"]
    assert estimate.verdict == " ".join(document["verdict"]["text"]) and estimate.trust == document["verdict"]["trust"]
    figures, *told, verdict, meaning = str(estimate).split("\n")
    assert told == [f"warning: {each}" for each in estimate.warnings]
    assert f"<{figures}>" == repr(estimate) and meaning == estimate.meaning
    assert verdict == f"trust {estimate.trust}: {estimate.verdict}"
    assert estimate.rebound is not None and estimate.rebound.velocity_before.tolist() == document["rebound"]["velocity_before"]


def test_all_readings_are_named_in_the_signature(block_history: pc.History) -> None:
    with pytest.raises(pc.InputError, match=re.escape(f"choose one of {', '.join(RECONSTRUCTIONS)}")):
        pc.estimate(block_history, reconstruction="blunt")  # type: ignore[arg-type]
    assert pc.estimate(block_history).options["reconstruction"] == RECONSTRUCTIONS[0]


@pytest.mark.parametrize("reconstruction", RECONSTRUCTIONS)
def test_the_options_of_the_case_go_with_its_history(reconstruction: str, tmp_path: Path) -> None:
    text = (EXAMPLES / "block.toml").read_text().replace('# acceleration = "split"', 'acceleration = "weak"').replace("every = 1", "every = 3")
    text = text.replace('reconstruction = "corrected"', f'reconstruction = "{reconstruction}"')
    text += f'\n[output]\nestimate = "{tmp_path / "error.vtkhdf"}"\ninstants = 4\n'
    estimate = pc.run(text, store=tmp_path / "history.vtkhdf")
    stated = {"reconstruction": reconstruction, "acceleration": "weak", "every": 3}
    assert estimate.options == stated and estimate.history is not None
    for history in (pc.open(tmp_path / "history.vtkhdf"), pickle.loads(pickle.dumps(pc.run(text, overwrite=True).history))):
        assert pc.estimate(history).options == stated
        assert pc.estimate(history, every=1, acceleration="rigid").options == stated | {"every": 1, "acceleration": "rigid"}
    written = pc.open(tmp_path / "error.vtkhdf")
    assert isinstance(written, pc.Estimate) and len(written.maps) == 4 and written.sup == estimate.sup
    assert written.options == stated and written.meaning == estimate.meaning
    assert written.verdict == estimate.verdict and written.trust == estimate.trust
    for same in (written.rebound, pickle.loads(pickle.dumps(estimate)).rebound, estimate.history.rebound):
        assert str(same) == str(estimate.rebound) and same is not None
    with pytest.raises(pc.ExistingFileError, match=r"error\.vtkhdf"):
        pc.run(text)
