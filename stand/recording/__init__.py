"""Recordings: the HDF5 layout of one run, read from anyone's file and written as NeXus."""

from stand.recording.model import Channel, Quality, Recording
from stand.recording.read import read_recording
from stand.recording.write import write_recording

__all__ = ["Channel", "Quality", "Recording", "read_recording", "write_recording"]
