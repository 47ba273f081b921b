"""One table of quantities: whatever describes a flight has all of them, and the same numbers."""

import numpy as np
import pytest

import birdmb
from birdmb.cli.results import result_object
from birdmb.quantities import BY_NAME, QUANTITIES, VALIDITIES, described_by, quantities
from birdmb.studies.sweeps.point import described
from birdmb.studies.sweeps.study import _NUMBERS


@pytest.fixture(scope="module")
def cycle(ibis_tail):
    return birdmb.find_limit_cycle(
        birdmb.RigidModel(ibis_tail.with_values({"wing.discretisation": 8}))
    )


def test_json_files_and_sweeps_have_the_whole_table(cycle):
    values = described_by(cycle)
    assert [quantity.name for quantity in QUANTITIES] == list(values)
    for holder in (
        result_object(cycle, birdmb.assess_validity(cycle), "rigid"),
        described(cycle),
        cycle.to_xarray().attrs,
    ):
        assert {name: holder[name] for name in values} == values
    for quantity in (*QUANTITIES, *VALIDITIES):
        assert _NUMBERS[quantity.name][0] == quantity.unit


def test_the_report_shows_them_in_degrees_and_without_a_sign_of_zero():
    angle = BY_NAME["mean_bank"]
    assert angle.text(np.pi / 2) == "+90.00"
    assert angle.text(-1e-9) == "+0.00"
    assert angle.axis_label == "bank (°)"
    assert BY_NAME["cost_of_transport"].axis_label == "cost of transport"


def test_losses_are_those_of_the_cycle(cycle):
    lost = {f"lost_to_{name}": power for name, power in cycle.dissipation.items()}
    assert lost.items() <= described_by(cycle).items()


def test_a_choice_keeps_its_order():
    assert [each.unit for each in quantities(["power", "mean_speed"])] == ["W", "m/s"]
    with pytest.raises(KeyError):
        quantities(["speed"])
