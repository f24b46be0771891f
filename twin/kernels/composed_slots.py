"""Places in the composed stepper's work vector `q`; a cause's hooks read and write them by these names.

Where there are hooks, written afresh in every evaluation, in this order: constants; time, state and drive; elongations;
then the hooks `before` (they may change constants, elongations, extra tensions); tensions, and with them whether a
strand is taut; then the hooks `after` (they add forces on the weight and on the rim, and the rates of the causes' own
states).
"""

from typing import Final

TIME: Final = 0  # s since the run's start
U: Final = 1  # weight position, m
V: Final = 2  # weight speed, m/s
S: Final = 3  # rim displacement, m
W: Final = 4  # rim speed, m/s
X: Final = 5  # fibre's drive end, m (linear-drive: the applied force, N)
XD: Final = 6  # its speed, m/s
C1: Final = 7  # weight strand's stiffness, N/m
C2: Final = 8  # drive strand's
B1: Final = 9  # weight strand's damping, N s/m
B2: Final = 10
D1: Final = 11  # weight strand's elongation, m
DD1: Final = 12  # its rate, m/s
D2: Final = 13
DD2: Final = 14
E1: Final = 15  # extra tension in the weight strand, N, beyond c d + b d'
E2: Final = 16
T1: Final = 17  # weight strand's tension, N
T2: Final = 18
G: Final = 19  # force on the weight against +u, N (friction, drag, contact), gravity apart
R: Final = 20  # force on the rim against +s, N
SMOOTH: Final = 21  # tanh(v / v_s)
MASS: Final = 22  # kg
RIM: Final = 23  # pulley's inertia at the rim, kg
WEIGHT: Final = 24  # m g sin(alpha), N
REST: Final = 25  # rest tension, N
RADIUS: Final = 26  # pulley's, m
PULL: Final = 27  # further force on the rim along +s, N, from an eccentric strand
FRICTION: Final = 28  # Coulomb force F_c, N
GAMMA1: Final = 29  # factor by which the weight strand's tension works on the rim
STIFF: Final = 30  # fastest decay that a hook brings, 1/s: the step is shortened to it
XDD: Final = 31  # the drive end's acceleration, m/s^2, over the sample interval
AUX: Final = 32  # the causes' own states
RATE: Final = 40  # their rates
STATES: Final = 8
SHARED: Final = 48  # mass that couples the accelerations of weight and rim, kg
ZERO1: Final = 49  # the weight strand's elongation at u = s = 0, m
ZERO2: Final = 50  # the drive strand's at s = x = 0, m
SIZE: Final = 51

# columns of a run's constants
(K_MASS, K_WEIGHT, K_C1, K_C2, K_B1, K_B2, K_RIM, K_FC, K_VS, K_REST, K_RADIUS, K_OFFSET, K_SYSTEM, K_OWN) = range(14)
CONSTANTS: Final = 14
WFPD, WF, AXIS = 0, 1, 2
