"""The battery of hidden effects: stands drawn from a seed, diagnosed blind, judged against what was hidden."""
