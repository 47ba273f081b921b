"""Plates whose flow separates."""

import numpy as np

from birdmb.topology import Bird

SPEED = 10.0
ANGLES = np.array([0, 4, 8, 10, 12, 15, 20, 30, 40, 60, 90, 120, 150, 180.0])
SLOPE, NORMAL, STALL, WIDTH = 2 * np.pi, 1.98, 14.0, 3.0


def polar():
    """A stalling plate: lift, drag and moment to either side of zero."""
    degrees = np.concatenate([-ANGLES[:0:-1], ANGLES])
    angle = np.radians(degrees)
    attached = 0.5 * (1 - np.tanh((np.abs(degrees) - 13.0) / 2.0))
    normal = 1.8 * np.sin(angle)
    return {
        "angle_deg": degrees.tolist(),
        "lift": (attached * SLOPE * angle + (1 - attached) * normal * np.cos(angle)).tolist(),
        "drag": (0.01 + (1 - attached) * normal * np.sin(angle)).tolist(),
        "moment": (-(1 - attached) * 0.2 * normal).tolist(),
    }


def plate(half_span, elements, joints=(), points=None, **profile):
    """A heavy body with plates of chord 1 m, which goes straight on whatever the air does."""
    return Bird.model_validate(
        {
            "name": "plate",
            "gravity": 0.0,
            "gait": {"frequency": 0.1 * 2 * SPEED / (2 * np.pi)},
            "body": {"mass": 1e9, "inertia_yy": 1e12},
            "air": {"wake": "unsteady", "wake_points": points or elements},
            "wing": {
                "root": {"x": 0.0, "y": 0.0},
                "profile": profile,
                "discretisation": elements,
            },
            "segments": {"bar": {"length": half_span, "mass": 1e-6, "inertia": [1e-6] * 3}},
            "joints": list(joints),
            "sections": [
                {"name": "root", "bone": "bar", "position": 0, "chord": 1.0},
                {"name": "tip", "bone": "bar", "position": 1, "chord": 1.0},
            ],
        }
    )


def steady_state(model, angle):
    """State (n,) in steady flow at an angle of attack (rad), by Newton's method."""
    body = np.array([[SPEED * np.cos(angle), SPEED * np.sin(angle), 0.0, 0.0]])
    still, at_rest = np.zeros(1), model.wake.attached[None]
    state = np.hstack([body, at_rest])
    for step in range(100):
        rates = model.rates(still, state)[0, 4:]
        if np.abs(rates).max() < 1e-9:
            return state[0]
        slopes = model.rate_jacobians(still, state)[0, 4:, 4:]
        # Carefully at first: between two stable flows lies a branch that folds.
        state[0, 4:] -= (0.3 if step < 30 else 1.0) * np.linalg.solve(slopes, rates)
    raise AssertionError(np.abs(rates).max())
