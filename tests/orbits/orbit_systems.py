"""Systems whose orbits are known in closed form or to many digits."""

import numpy as np
import scipy.linalg

from birdmb.orbits import OdeModel

ROESSLER = {
    # c: period, largest non-trivial multiplier
    3.5: (5.92034025, -0.812252197),
    5.0: (11.90427570, -0.572051852),
}


def mathieu(a, q, damping=0.0, **options):
    """x'' + damping x' + (a - 2 q cos 2t) x = 0."""

    def rhs(t, x):
        return [x[1], -damping * x[1] - (a - 2 * q * np.cos(2 * t)) * x[0]]

    return OdeModel(rhs, ("x", "v"), period=np.pi, guess=[0.0, 0.0], **options)


def van_der_pol(mu, **options):
    def rhs(_t, x):
        return [x[1], mu * (1 - x[0] ** 2) * x[1] - x[0]]

    return OdeModel(rhs, ("x", "v"), guess=[2.0, 0.0], **options)


def stuart_landau(mu, omega=2.0, **options):
    """Cycle of radius sqrt(mu), period 2 pi / omega, multipliers 1 and exp(-2 mu T)."""

    def rhs(_t, x):
        growth = mu - x @ x
        return [growth * x[0] - omega * x[1], growth * x[1] + omega * x[0]]

    return OdeModel(rhs, ("x", "y"), **options)


def roessler(c, a=0.15, b=0.2, **options):
    def rhs(_t, x):
        return [-x[1] - x[2], x[0] + a * x[1], b + x[2] * (x[0] - c)]

    def jacobian(_t, x):
        return [[0, -1, -1], [1, a, 0], [x[2], 0, x[0] - c]]

    return OdeModel(rhs, ("x", "y", "z"), jacobian=jacobian, guess=[0.0, -6.0, 0.05], **options)


def markus_yamabe():
    """Frozen eigenvalues are stable at all times, the system is not; T = pi."""

    def matrix(t, _x=None):
        c, s = np.cos(t), np.sin(t)
        return np.array([[-1 + 1.5 * c * c, 1 - 1.5 * c * s], [-1 - 1.5 * c * s, -1 + 1.5 * s * s]])

    return OdeModel(
        lambda t, x: matrix(t) @ x, ("x", "y"), period=np.pi, jacobian=matrix, guess=[0.0, 0.0]
    )


class ForcedLinear:
    """x' = A x + b cos(2 pi t / T), its flow in closed form (no integration error)."""

    state_names = ("position", "rate", "lag")

    def __init__(self, period=2.0):
        self.period = period
        self.matrix = np.array([[0, 1, 0], [-9, -0.3, 0.5], [0, 2, -1.5]])
        self._omega = 2 * np.pi / period
        # the periodic answer is the real part of c exp(i omega t)
        self._c = np.linalg.solve(
            1j * self._omega * np.eye(3) - self.matrix, np.array([0, 4.0, 1.0])
        )

    def orbit(self, t):
        return (self._c * np.exp(1j * self._omega * t)).real

    def flow(self, x0, t0, t1):
        decay = scipy.linalg.expm(self.matrix * (t1 - t0))
        return self.orbit(t1) + decay @ (x0 - self.orbit(t0))
