"""A plane wing that moves in a stream, as in wind and water tunnels."""

from birdmb.studies.moving_wing.loads import MovingWingLoads, Wake, moving_wing_loads
from birdmb.studies.moving_wing.motion import WingMotion
from birdmb.studies.moving_wing.plane_wing import PlaneWing

__all__ = ["MovingWingLoads", "PlaneWing", "Wake", "WingMotion", "moving_wing_loads"]
