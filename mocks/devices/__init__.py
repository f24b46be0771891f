"""The simulated instruments and what makes them run in real time."""
