"""The body's inertia: three moments, a tensor, or moments by name; one in pitch is enough."""

import numpy as np
import pytest

from birdmb.errors import TopologyError
from birdmb.topology import load_bird

from .conftest import TOPOLOGIES

IBIS = (TOPOLOGIES / "ibis.toml").read_text(encoding="utf-8")
BY_NAME = [line for line in IBIS.splitlines() if line.startswith("inertia_")]


@pytest.fixture
def with_body(tmp_path):
    """The ibis with other lines for its body's inertia."""

    def load(*lines):
        text = IBIS
        for line in BY_NAME:
            text = text.replace(f"{line}\n", "")
        path = tmp_path / "bird.toml"
        path.write_text(text.replace("mass = 1.2\n", "\n".join(["mass = 1.2", *lines, ""])))
        return load_bird(path)

    return load


def test_three_moments_and_a_tensor_are_moments_by_name(with_body, ibis):
    assert with_body(*BY_NAME) == ibis
    three = with_body("inertia = [0.02, 0.1, 0.11]")
    assert three == ibis
    tensor = with_body("inertia = [[0.02, 0, 0.001], [0, 0.1, 0], [0.001, 0, 0.11]]")
    assert tensor == ibis.with_values({"body.inertia_xz": 0.001})
    np.testing.assert_array_equal(
        tensor.body.inertia_tensor, [[0.02, 0, 0.001], [0, 0.1, 0], [0.001, 0, 0.11]]
    )


def test_the_moment_in_pitch_is_enough(with_body):
    bird = with_body("inertia_yy = 0.1")
    assert bird.body.missing_moments == ("inertia_xx", "inertia_zz")
    assert bird.body.inertia_tensor[1, 1] == 0.1


@pytest.mark.parametrize(
    ("lines", "sentence"),
    [
        (["inertia = [0.02, 0.1]"], r"body\.inertia: must be three moments or a 3x3 tensor"),
        (["inertia = 0.1"], r"body\.inertia: must be three moments or a 3x3 tensor, not 0\.1"),
        (["inertia = [0.02, 0.1, 'x']"], r"body\.inertia: must be three moments"),
        (["inertia = [0.02, 0.1, 0.1]", "inertia_yy = 0.1"], r"given twice, as inertia and iner"),
        (
            ["inertia = [[0.02, 0.01, 0], [0.01, 0.1, 0], [0, 0, 0.1]]"],
            r"body\.inertia: .* is not that of a body with a plane of symmetry",
        ),
        (["inertia = [0.02, -0.1, 0.1]"], r"body\.inertia_yy: must be"),
        ([], r"body\.inertia_yy: missing"),
    ],
)
def test_what_is_no_inertia_is_refused_with_a_sentence(with_body, lines, sentence):
    with pytest.raises(TopologyError, match=sentence) as caught:
        with_body(*lines)
    assert "\n" not in str(caught.value)
