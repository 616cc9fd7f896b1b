"""The installed package and its command."""

import re
import signal
import subprocess
import sys
import sysconfig
import time
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


def processor_ticks(process: subprocess.Popen[str]) -> int:
    """Processor time of a process: unlike the clock it tells whether it has begun its work."""
    after_name = Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
    return int(after_name[11]) + int(after_name[12])


@pytest.mark.skipif(sys.platform != "linux", reason="asks /proc how far the run has come")
@pytest.mark.parametrize("command", COMMANDS)
def test_ctrl_c_prints_the_summary_of_the_steps_done(command: list[str], tmp_path: Path) -> None:
    block = (ROOT / "examples" / "block.toml").read_text()
    case = tmp_path / "case.toml"
    # Millions of steps: far longer than any test.
    case.write_text(re.sub(r"end = \S+", "end = 2.0", block))
    arguments = [*command, "run", str(case), "--quiet"]
    with subprocess.Popen(arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        while process.poll() is None and processor_ticks(process) < 100:
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate()
    assert process.returncode == 130 and "INTERRUPTED at step " in out and err == "", (out, err)
