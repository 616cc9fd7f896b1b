"""The command ``percute``, also as ``python -m percute``."""

import signal
import sys

from percute._percute import command
from percute.plot_command import main as plot


def main() -> int:
    """Run the command with the arguments of this process and return its exit code."""
    if sys.argv[1:2] == ["plot"]:
        return plot(sys.argv[2:])
    # Ctrl-C is the command's own: Python would answer only once the command has ended.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return command(["percute", *sys.argv[1:]], [sys.executable, "-m", "percute"])


if __name__ == "__main__":
    sys.exit(main())
