"""The plant behind the simulated instruments: its own equations, its own integrator."""
