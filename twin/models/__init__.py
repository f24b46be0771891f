"""Fibre models, one a file: each holds one public `FibreModel`."""
