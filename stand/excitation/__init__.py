"""Excitation: what the drive is asked to do, and whether the stand can take it."""
