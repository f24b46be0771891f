"""What goes wrong, told as what, where, the value and the remedy."""

from __future__ import annotations


class StandError(Exception):
    """Anything that this software refuses or fails to do.

    what: the fault in one clause. where: file, key, device or channel. value: the offending value, if there
    is one. remedy: what the reader can do about it.
    """

    def __init__(self, what: str, *, where: str = "", value: object = None, remedy: str = "") -> None:
        self.what, self.where, self.value, self.remedy = what, where, value, remedy
        super().__init__(what, where, value, remedy)

    def __str__(self) -> str:
        text = f"{self.where}: {self.what}" if self.where else self.what
        if self.value is not None:
            text += f" (got {self.value!r})"
        return f"{text}. {self.remedy}" if self.remedy else text


class InputError(StandError):
    """The user's input can't be used: a file, a key, a unit, an option. The command line exits with 2."""


class DeviceError(StandError):
    """A device didn't answer, answered wrongly or refused."""


class SafetyTrip(StandError):
    """A limit was passed or data went stale: the stand was stopped, and stays stopped."""
