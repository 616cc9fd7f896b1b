"""The installed package and its command."""

import subprocess
import sys
import sysconfig
import tomllib
from importlib import metadata
from pathlib import Path

import percute
import pytest

ROOT = Path(__file__).parents[2]
SCRIPT = str(Path(sysconfig.get_path("scripts")) / "percute")
COMMANDS = [[SCRIPT], [sys.executable, "-m", "percute"]]


def run(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(arguments, capture_output=True, text=True, check=False)


def test_there_is_one_version() -> None:
    workspace = tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]
    assert percute.__version__ == workspace["package"]["version"] == metadata.version("percute")


@pytest.mark.parametrize("command", COMMANDS)
def test_the_command_prints_the_version(command: list[str]) -> None:
    done = run(*command, "--version")
    assert (done.returncode, done.stdout, done.stderr) == (0, f"percute {percute.__version__}\n", "")


@pytest.mark.parametrize("command", COMMANDS)
def test_the_command_runs_a_case(command: list[str]) -> None:
    done = run(*command, "run", str(ROOT / "examples" / "bar.toml"), "--quiet")
    assert done.returncode == 0 and "energy" in done.stdout and done.stderr == ""


def test_the_exit_code_is_that_of_the_command() -> None:
    done = run(SCRIPT, "run", "no such file.toml")
    assert done.returncode == 2 and "no such file.toml" in done.stderr and done.stdout == ""
