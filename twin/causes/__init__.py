"""Causes, one a file: ways in which reality may differ from the baseline."""
