"""The acquisition: configuration, wires, drivers, excitation, safety, time base, recorder, runs."""
