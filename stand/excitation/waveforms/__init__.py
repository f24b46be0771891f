"""Waveforms, one a file: each holds one public `Waveform`."""
