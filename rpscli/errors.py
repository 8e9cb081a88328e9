"""What can go wrong, one class for each exit code of the command line.

A message names the place, the value found, the rule that it breaks and a remedy. Nothing here
knows about terminals: the command line turns these into text and an exit status.
"""


class RpsError(Exception):
    """Base of every error that `rps` raises on purpose."""

    exit_code = 1


class UsageError(RpsError):
    """The command was called with options that do not fit together."""

    exit_code = 2


class CaseError(RpsError):
    """A case or study file is invalid; the text holds one line for each fault."""

    exit_code = 3


class RecordError(RpsError):
    """A ground motion cannot be read, or is not what it says it is."""

    exit_code = 3


class AnalysisError(RpsError):
    """The analysis ended as `failed`: the numbers cannot be trusted."""

    exit_code = 4


class StudyIncomplete(RpsError):
    """A study ran to its end, but some of its points failed."""

    exit_code = 5


class VerificationMismatch(RpsError):
    """A computed value lies outside its tolerance about the expected one."""

    exit_code = 6


class Refused(RpsError):
    """Going on would overwrite or mix results that are not ours to touch."""

    exit_code = 7


class LimitExceeded(RpsError):
    """An acceptance limit of the case, or of `--fail-on`, was exceeded."""

    exit_code = 10


class OutputError(RpsError):
    """A result cannot be written: no permission, a full disk, a file where a folder should be."""
