"""A line and a piezoelectric bar as three-port: Mason, KLM and the equivalent circuit; its reduction to two ports.

Velocities point into the bar at both faces, forces are compressive, e^{+i omega t}. Wave along the field (33): W. P.
Mason, Electromechanical Transducers and Wave Filters (1948), and D. Berlincourt, D. Curran, H. Jaffe, Physical
Acoustics I-A (1964), Eq. (75). Wave across the field (31): IEEE Std 176-1987, Sec. 6.4.1.
"""

from typing import Any

import msgspec
import numpy as np

from verify.actuators.materials import Form
from verify.actuators.port import Number, Port


class Line(msgspec.Struct, frozen=True, kw_only=True):
    """A passive bar in longitudinal vibration."""

    impedance: complex  # Zc = rho v A, kg/s
    speed: complex  # v, m/s
    length: float  # l, m

    def input_impedance(self, omega: Any, load: Any) -> Any:
        """Impedance of one face whose other face has the impedance `load`, kg/s; None is a rigid load."""
        own = self.impedance / (1j * np.tan(omega * self.length / self.speed))
        return own if load is None else (self.impedance**2 + own * load) / (own + load)

    def after(self, omega: Any, port: Port) -> Port:
        """The port at the far face of the line, whose near face is joined to `port`."""
        theta = omega * self.length / self.speed
        own, transfer = self.impedance / (1j * np.tan(theta)), self.impedance / (1j * np.sin(theta))
        joint = port.short_impedance + own
        return Port(
            force_factor=port.force_factor * transfer / joint,
            short_impedance=(self.impedance**2 + own * port.short_impedance) / joint,
            blocked_admittance=port.blocked_admittance + port.force_factor**2 / joint,
        )


class ThreePort(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """F1 = a v1 + b v2 + N V, F2 = b v1 + a v2 + N V, I = Y V - N (v1 + v2).

    Its mechanical part is in terms of a + b and a - b, which are free of cancellation in bars short against the wave.
    """

    symmetric: Number  # a + b, with short-circuited electrodes, kg/s
    antisymmetric: Number  # a - b, kg/s
    force_factor: Number  # N, N/V
    blocked_admittance: Number  # Y = i omega C0, S

    def repeated(self, layers: int) -> "ThreePort":
        """Equal layers mechanically in series and electrically in parallel (G. Martin, JASA 36:1366, 1964).

        With short-circuited electrodes they are a periodic line, whose impedance and phase are those of a layer.
        """
        tangent = np.sqrt(-self.antisymmetric / self.symmetric + 0j)
        characteristic, tangent = 1j * tangent * self.symmetric, np.tan(layers * np.arctan(tangent))
        return ThreePort(
            symmetric=characteristic / (1j * tangent),
            antisymmetric=1j * characteristic * tangent,
            force_factor=self.force_factor,
            blocked_admittance=layers * self.blocked_admittance,
        )

    def port(self, base: Any) -> Port:
        """The port at face 2, where face 1 has the impedance `base` (kg/s): 0 is free, None is fixed."""
        own, n, y = 0.5 * (self.symmetric + self.antisymmetric), self.force_factor, self.blocked_admittance
        if base is None:
            return Port(force_factor=n, short_impedance=own, blocked_admittance=y)
        joint = own + base
        return Port(
            force_factor=n * (self.antisymmetric + base) / joint,
            short_impedance=(self.symmetric * self.antisymmetric + own * base) / joint,
            blocked_admittance=y + n**2 / joint,
        )


class PiezoLine(Line, frozen=True, kw_only=True):
    """A piezoelectric bar, or a layer of a stack; its speed is that with open (33) or closed electrodes (31)."""

    capacitance: complex  # C0 with both faces clamped, F
    force_factor: complex  # N = h C0, N/V
    along: bool  # whether the wave runs along the field (33)
    form: Form = "mason"
    branches: int = 20  # number of branches of the circuit
    layers: int = 1  # number of equal layers

    def three_port(self, omega: Any) -> ThreePort:
        """The three-port of all layers at angular frequencies omega, rad/s."""
        single = self._klm(omega) if self.form == "klm" else self._mason(omega)
        return single if self.layers == 1 else single.repeated(self.layers)

    def _mason(self, omega: Any) -> ThreePort:
        """Mason's three-port, or its circuit: the series of its tangent.

        It is [F1 F2 V] = [[a b t], [b a t], [t t 1/(i omega C0)]] [v1 v2 I] along the field, a = Zc/(i tan
        theta), b = Zc/(i sin theta), t = h/(i omega), theta = omega l/v. Solved for I it has a negative capacitance
        -C0 in series with the mechanical branches; across the field it has none.
        """
        if self.form == "circuit":
            tangent, cotangent = self._series(omega)
        else:
            tangent = np.tan(0.5 * omega * self.length / self.speed)
            cotangent = 1.0 / tangent
        capacitor = 1j * omega * self.capacitance
        return ThreePort(
            symmetric=self.impedance / (1j * tangent) - self.along * 2.0 * self.force_factor**2 / capacitor,
            antisymmetric=1j * self.impedance / cotangent,
            force_factor=self.force_factor,
            blocked_admittance=capacitor,
        )

    def _klm(self, omega: Any) -> ThreePort:
        """R. Krimholtz, D. Leedom, G. Matthaei, Electron. Lett. 6:398 (1970): two half lines with a tap at the centre.

        Along the field an ideal transformer phi in series with C0 and X1 feeds the tap; across it a gyrator g parallel
        to C0 and the dual of X1. Antisymmetric motion leaves the tap without force.
        """
        zc, n, half = self.impedance, self.force_factor, 0.5 * omega * self.length / self.speed
        own, transfer = zc / (1j * np.tan(half)), zc / (1j * np.sin(half))
        capacitor = 1j * omega * self.capacitance
        if self.along:
            m = n / (self.capacitance * omega * zc)
            ratio = 1.0 / (2.0 * m * np.sin(half))
            admittance = 1.0 / (1.0 / capacitor + 1j * zc * m**2 * np.sin(2.0 * half) + own / (2.0 * ratio**2))
            factor = admittance * transfer / (2.0 * ratio)
            negative = factor * transfer / (2.0 * ratio)
        else:
            gyrator = 2.0 * n / transfer
            admittance = capacitor + 1j * n**2 * np.sin(2.0 * half) / zc - 0.5 * gyrator**2 * own
            factor, negative = 0.5 * gyrator * transfer, 0.0
        return ThreePort(
            symmetric=own - 2.0 * negative,
            antisymmetric=1j * zc * np.tan(half),
            force_factor=factor,
            blocked_admittance=admittance,
        )

    def _series(self, omega: Any) -> tuple[Any, Any]:
        """(tan X, cot X), X = omega l/(2v), as branches L_n, C_n: S. Butterworth 1914, K. Van Dyke 1928.

        tan X = sum of 8X/((2n-1)^2 pi^2 - 4X^2) has the symmetric modes of the free bar, cot X = 1/X - sum of 2X/(n^2
        pi^2 - X^2) its rigid motion and the antisymmetric modes. The static part of the branches left out is one
        capacitance (R. MacNeal, Comput. Struct. 1:581, 1971): the error falls with the third power of their number.
        """
        half = np.asarray(0.5 * omega * self.length / self.speed)[..., None]
        number = np.arange(1, self.branches + 1)
        odd, even, x = ((2 * number - 1) * np.pi) ** 2, (number * np.pi) ** 2, half[..., 0]
        tangent = np.sum(8.0 * half / (odd - 4.0 * half**2), -1) + x * (1.0 - np.sum(8.0 / odd))
        cotangent = 1.0 / x - np.sum(2.0 * half / (even - half**2), -1) - 2.0 * x * (1.0 / 6.0 - np.sum(1.0 / even))
        return tangent, cotangent
