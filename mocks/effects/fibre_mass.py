"""The fibre's own mass moves with it: each strand between its ends (consistent mass), the arc with the rim."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, mass: float) -> None:
    """Spreads the mass over strands and arc by their lengths."""
    rig, arc = world.rig, world.rig.pulley_radius * world.rig.wrap_angle
    per_length = mass / (rig.free_length + arc)
    world.physics.mass1 += per_length * rig.weight_strand_length
    world.physics.mass_arc += per_length * arc
    world.physics.mass2 += per_length * rig.drive_strand_length


EFFECT = Effect(
    "fibre-mass",
    "fibre",
    (Size("mass", "kg", 0.3, 0.02, 2.0),),
    act,
)
