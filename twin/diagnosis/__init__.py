"""The diagnosis: what the simulation gets wrong, why, and what is gained by saying so."""
