"""Exceptions and warnings of percute.

All exceptions are `PercuteError`; each is also the built-in exception that fits, so that code without knowledge of
percute can catch it. Messages name the argument, its value, its unit and what is allowed.
"""


class PercuteError(Exception):
    """The root of all exceptions of percute."""


class InputError(PercuteError, ValueError):
    """An argument, a case file or a problem is wrong; nothing was computed."""


class InputWarning(UserWarning):
    """A plausibility warning: the input is possible but probably a mistake, such as mixed units or a body that never touches."""


class SimulationWarning(UserWarning):
    """A result is doubtful: the energy balance is off, no contact force acted, or a field is not admissible."""


class MissingFileError(PercuteError, FileNotFoundError):
    """There is no such file."""


class ExistingFileError(PercuteError, FileExistsError):
    """The file exists already; ``overwrite=True`` replaces it."""


class FileFormatError(PercuteError, ValueError):
    """The file is damaged, of another kind, newer than this program, or inconsistent."""


class StorageError(PercuteError, OSError):
    """The file cannot be read or written: no space, no permission, in use by another program."""


class SimulationError(PercuteError, RuntimeError):
    """The simulation failed; ``history``, if not None, has the completed steps."""


class EstimateError(PercuteError, RuntimeError):
    """The history cannot be estimated."""


class MeshWarning(UserWarning):
    """An import warning: a part of a mesh file was left out or changed; the message gives the part and the reason."""
