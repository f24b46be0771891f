"""What the finite-segment kernel's constants hold behind the rig's."""

from twin.kernels.fibre_layout import RIG

SEGMENTS, POINTS, EI, CONTACT, SHEAR, STEP, LENGTHS = range(RIG, RIG + 7)
OWN = 7
BAND = 5
