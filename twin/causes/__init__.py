"""Causes: ways in which reality may differ from the operator's model, one in each file."""
