"""Stands with hidden effects in numbers, drawn from a seed, for measuring a diagnosis."""
