"""`birdmb check`: what the bird is, and what to beware of."""

from .conftest import COMPLIANT, HINGED, IBIS

# Where no feather reaches across the plane of symmetry, m.
WIDE = 0.08


def test_what_the_bird_is(run):
    result = run("check", COMPLIANT, "--set", f"wing.root.y={WIDE}")
    assert result.exit_code == 0, result.stderr
    rows = [" ".join(line.split()) for line in result.stdout.splitlines()]
    for row in (
        "mass of the whole bird 1.26 kg",
        "span, joints at zero 1.420 m",
        "aspect ratio, joints at zero 10.7",
        "speed U at lift coefficient 0.5 14.7 m/s",
        "Reynolds number of the mean chord at U 1.3e+05",
        "reduced frequency at U 0.11",
        "Strouhal number at U 0.22",
        "elements per wing 32 orthogonal",
        "humerus 0.134 0.01",
        "shoulder.flap humerus compliant 0.00 42.00 180.00",
        "shoulder.flap 20 0.2 0.00157 18 Hz",
        "Loads of a beat at mean trim, change",
        "from 32 to 64 elements",
        "No warnings.",
    ):
        assert row in rows
    assert max(map(len, result.stdout.splitlines())) <= 80


def test_hinges_of_feathers(run):
    """I = m l^2/3, of feathers at 15 and 30 degrees to straight aft, as the joints' offsets say."""
    result = run("check", HINGED)
    assert result.exit_code == 0, result.stderr
    rows = [" ".join(line.split()) for line in result.stdout.splitlines()]
    for row in (
        "mass of the whole bird 1.266 kg",
        "span, joints at zero 1.360 m",
        "feathers.5.hinge 1 0.002 1.05e-05 49.1 Hz",
        "feathers.3.hinge 1 0.002 1.5e-05 41.1 Hz",
    ):
        assert row in rows
    loose = run("check", HINGED, "--set", "feathers.5.hinge.stiffness=0")
    assert "feathers.5.hinge has stiffness 0: only the air holds" in loose.stdout
    slow = run("check", HINGED, "--set", "feathers.5.hinge.stiffness=0.0066")
    assert "feathers.5.hinge swings by itself at 3.99 Hz, close to" in " ".join(slow.stdout.split())


def test_drivers_that_are_no_sine(run):
    """Of 16 samples of a triangle one harmonic has 1/32 / sin(pi/16)^2 of the height, 82.11 deg.

    It leaves 17.89 deg at the corners. Of the triangle itself it leaves 18.9, as 1 - 8/pi^2.
    """
    result = run(
        "check", IBIS, "--set", "shoulder.flap.downstroke_fraction=0.4",
        "--set", "elbow.sweep.amplitude=0", "--set", "elbow.sweep.phase=0",
        "--set", "elbow.sweep.samples_deg=[0, 25, 50, 75, 100, 75, 50, 25, 0, -25, -50, -75, -100,"
        " -75, -50, -25]", "--set", "elbow.sweep.sample_harmonics=1",
    )  # fmt: skip
    assert result.exit_code == 0, result.stderr
    rows = [" ".join(line.split()) for line in result.stdout.splitlines()]
    assert "shoulder.flap humerus prescribed 0.00 * *" in rows
    assert "shoulder.flap -42.00 42.00 12" in rows
    assert "elbow.sweep -52.11 112.11 1 8.2 18 26" in rows
    tables = result.stdout.partition("\nWarning: ")[0]
    assert max(map(len, tables.splitlines())) <= 80


def test_what_is_attached_counts(run):
    """0.008 and 0.003 kg; 3/11 of the way of 25 mm to the battery."""
    rows = [" ".join(line.split()) for line in run("check", "flapping_robot").stdout.splitlines()]
    assert "mass of the body 0.008 kg" in rows
    assert "mass of the body, all attached 0.011 kg" in rows
    assert "its centre of mass, ahead by 0.006818 m" in rows


def test_warnings_are_printed_and_no_error(run):
    result = run("check", IBIS, "--set", "gravity=0")
    assert result.exit_code == 0
    assert "Warning: gravity is 0: nothing has to be carried." in result.stdout
