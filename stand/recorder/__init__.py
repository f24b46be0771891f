"""The recorder: raw streams to an HDF5 file that survives a kill; the final alignment on close."""

from stand.recorder.layout import FilePlan
from stand.recorder.raw import Happening, StreamSpec, Taken, Wire
from stand.recorder.recorder import Recorder

__all__ = ["FilePlan", "Happening", "Recorder", "StreamSpec", "Taken", "Wire"]
