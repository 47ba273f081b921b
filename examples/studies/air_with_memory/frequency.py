"""Growth in both kinds of air over the frequency of the beat."""

import numpy as np
from matplotlib.figure import Figure
from report import RIGID, Report, in_both, largest

import birdmb
from birdmb._typing import FloatArray

FREQUENCIES: dict[str, tuple[float, ...]] = {
    "ibis": (2.0, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0, 7.0, 8.0),
    "ibis_tail": (2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0),
}


def frequency(report: Report) -> None:
    """Growth without and with memory over the frequency of the beat, other values as they are."""
    rows, found = [], dict[str, FloatArray]()
    for name, values in FREQUENCIES.items():
        lines = []
        for hertz in values[3:5] if report.coarse else values:
            effect = in_both(report.bird(name, gait__frequency=hertz), RIGID)
            if effect is None:
                rows.append([name, f"{hertz:g}", "no flight"])
                continue
            pair = effect.quasi_steady, effect.unsteady
            k = birdmb.assess_validity(pair[0]).reduced_frequency
            moduli = [largest(cycle.multipliers) for cycle in pair]
            growth = hertz * np.log(moduli)
            rows.append(
                [
                    name, f"{hertz:g}", f"{k:.3f}", *(f"{cycle.mean_speed:.2f}" for cycle in pair),
                    *(f"{modulus:.4f}" for modulus in moduli), *(f"{g:+.3f}" for g in growth),
                    f"{growth[1] - growth[0]:+.4f}",
                ]
            )  # fmt: skip
            lines.append([hertz, k, *moduli, *growth])
        found[name] = np.array(lines)
    columns = (
        "flight", "Hz", "k", "m/s", "with", "|Λ|max", "with", "growth, 1/s", "with", "change",
    )  # fmt: skip
    report.table("frequency", "Over the frequency of the beat", columns, rows)
    figure = Figure(figsize=(8, 3.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    for (name, lines), (colour, mark) in zip(
        found.items(), (("C0", "o"), ("C1", "s")), strict=True
    ):
        hertz, k, *_, without, remembered = lines.T
        left.plot(hertz, without, f"{mark}-", color=colour, mfc="none", label=name)
        left.plot(hertz, remembered, f"{mark}--", color=colour, ms=4, label=f"{name}, with memory")
        right.plot(k, remembered - without, f"{mark}-", color=colour, label=name)
    left.axhline(0.0, color="0.6", lw=0.8)
    left.set(xlabel="frequency of the beat (Hz)", ylabel="growth of the least damped mode (1/s)")
    right.set(xlabel="reduced frequency k = π f c/U", ylabel="change of it by memory (1/s)")
    left.legend(frameon=False)
    report.picture("frequency", figure)
