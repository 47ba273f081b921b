"""The bones and both edges against the reference program, to round-off."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from birdmb.aerodynamics.prescribed import driver_motion
from birdmb.wing.arrays import wing_arrays
from birdmb.wing.chain import joint_chain
from birdmb.wing.edges import wing_edges
from tests.conftest import REFERENCE

angles_in_reach = st.lists(st.floats(-1.2, 1.2), min_size=6, max_size=6).map(np.array)


def from_reference_axes(points):
    """The body's axes: x = -z, y = x, z = -y of the reference's."""
    return np.stack([-points[..., 2], points[..., 0], -points[..., 1]], axis=-1)


@pytest.fixture(scope="module")
def wing(ibis):
    return wing_arrays(ibis)


def test_edges_are_the_reference_programs(wing):
    reference = np.load(REFERENCE / "geometry.npz")
    for i, t in enumerate(reference["t"]):
        angles, _, _ = driver_motion(wing, t)
        leading, trailing = wing_edges(wing, angles + 0j)
        np.testing.assert_allclose(
            leading.real, from_reference_axes(reference["LE_vertices"][i]), atol=1e-14
        )
        np.testing.assert_allclose(
            trailing.real, from_reference_axes(reference["TE_vertices"][i]), atol=1e-14
        )


def test_driver_derivatives(wing):
    t, h = 0.037, 1e-5
    angles, rates, accelerations = driver_motion(wing, t)
    before, after = driver_motion(wing, t - h), driver_motion(wing, t + h)
    np.testing.assert_allclose((after[0] - before[0]) / (2 * h), rates, rtol=1e-6, atol=1e-8)
    np.testing.assert_allclose(
        (after[1] - before[1]) / (2 * h), accelerations, rtol=1e-6, atol=1e-6
    )
    assert np.degrees(angles[1]) == pytest.approx(-42 * np.sin(8 * np.pi * t))


@settings(max_examples=50)
@given(angles=angles_in_reach)
def test_bones_keep_their_lengths_and_frames_stay_orthonormal(wing, angles):
    bones = joint_chain(wing, angles + 0j)
    ends = np.vstack([bones.origin[1:], bones.tip]).real
    np.testing.assert_allclose(
        np.linalg.norm(ends - bones.origin.real, axis=1), wing.bone_length, rtol=1e-13
    )
    for R in bones.rotation.real:
        np.testing.assert_allclose(R.T @ R, np.eye(3), atol=1e-14)


@settings(max_examples=50)
@given(angles=angles_in_reach)
def test_joint_axes_are_what_the_hand_turns_about(wing, angles):
    """d(tip)/dq_j = axis_j x (tip - joint's place), the definition of a revolute joint."""
    chain = joint_chain(wing, angles)
    for j in range(6):
        q = angles + 0j
        q[j] += 1e-30j
        bones = joint_chain(wing, q)
        arm = bones.tip.real - chain.origin[wing.segment[j]]
        np.testing.assert_allclose(bones.tip.imag / 1e-30, np.cross(chain.axis[j], arm), atol=1e-14)
    np.testing.assert_allclose(
        chain.frame[3], joint_chain(wing, angles + 0j).rotation[0].real, atol=1e-15
    )


def test_twist_spreads_along_the_forearm(ibis):
    """A feather half-way along the forearm feels half of its roll, one at the elbow none."""
    bird = ibis.model_validate(
        ibis.model_dump()
        | {
            "feathers": [
                *ibis.model_dump()["feathers"],
                {"name": "4", "bone": "forearm", "position": 0.5, "length": 0.175},
            ]
        }
    )
    wing = wing_arrays(bird)
    straight, rolled = np.zeros(6) + 0j, np.zeros(6) + 0j
    rolled[4] = 0.6
    _, before = wing_edges(wing, straight)
    _, after = wing_edges(wing, rolled)
    mid = [f.name for f in bird.feathers].index("4")
    # Leading edge up turns what points aft downwards (z).
    aft, drop = -(after[mid] - before[mid]).real[[0, 2]] * [1, -1]
    length = 0.175 + 0.01
    assert drop == pytest.approx(length * np.sin(0.3))
    assert -aft == pytest.approx(length * (1 - np.cos(0.3)))
