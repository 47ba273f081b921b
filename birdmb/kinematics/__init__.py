"""Gaits from measured flights: joint angles of a topology's own chain out of points or angles."""

from birdmb.kinematics.errors import KinematicsError
from birdmb.kinematics.fitting import fit_kinematics
from birdmb.kinematics.result import JointMotion, KinematicsFit

__all__ = ["JointMotion", "KinematicsError", "KinematicsFit", "fit_kinematics"]
