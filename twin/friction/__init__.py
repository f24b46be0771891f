"""Friction laws, one a file: each holds one public `FrictionLaw`."""
