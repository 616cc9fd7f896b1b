"""What percute raises.

All exceptions are `PercuteError`; each is also the built-in exception that fits, so that code that knows nothing of
percute can catch it. Messages name the argument, its value, its unit and what is allowed.
"""

__all__ = [
    "EstimateError",
    "ExistingFileError",
    "FileFormatError",
    "InputError",
    "InputWarning",
    "MeshWarning",
    "MissingFileError",
    "PercuteError",
    "SimulationError",
    "StorageError",
]


class PercuteError(Exception):
    """The root of all exceptions of percute."""


class InputError(PercuteError, ValueError):
    """An argument, a case file or a problem is wrong; nothing was computed."""


class InputWarning(UserWarning):
    """What was given is possible, but more likely a slip: units that look mixed, a body that never touches."""


class MissingFileError(PercuteError, FileNotFoundError):
    """There is no such file."""


class ExistingFileError(PercuteError, FileExistsError):
    """The file exists already; ``overwrite=True`` replaces it."""


class FileFormatError(PercuteError, ValueError):
    """The file is damaged, of another kind or newer than this program; or its contents contradict each other."""


class StorageError(PercuteError, OSError):
    """The file cannot be read or written: no space, no permission, in use by another program."""


class SimulationError(PercuteError, RuntimeError):
    """The simulation failed; ``history``, if there is one, holds the steps done."""


class EstimateError(PercuteError, RuntimeError):
    """The history cannot be estimated."""


class MeshWarning(UserWarning):
    """Something was reported, and left out, when a mesh was read; the message says what and why."""
