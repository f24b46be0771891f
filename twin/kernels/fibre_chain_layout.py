"""What the point-mass kernel's constants hold behind the rig's."""

from twin.kernels.fibre_layout import RIG

COUNT, POINT_MASS, SEGMENT, STIFFNESS, ROUND, RIM_STIFFNESS, BOND, ONSET, CAPSTAN, STEP, RIM_LOSS, ORDER = range(
    RIG, RIG + 12
)
OWN = 12
BAND = 3
HYSTERESIS = 5e-5  # m, of the handover between segments
