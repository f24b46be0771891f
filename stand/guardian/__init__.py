"""The guardian: a small process of its own that stops the drive when the acquisition dies or hangs."""

from stand.guardian.client import Guardian

__all__ = ["Guardian"]
