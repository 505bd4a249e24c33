"""Passive electrical loads, the damping of one mode by a shunt, and the load of an absorbing actuator.

A mode of angular frequency omega with short-circuited electrodes, sqrt(1 + K^2) omega with open ones, and an actuator
of blocked capacitance C that carries a load of admittance Y has, with s in units of omega, the response to a force

    H = 1 / (s^2 + 1 + K^2 X),   X = s C / (s C + Y),

relative to the static deflection with short-circuited electrodes (N. W. Hagood, A. von Flotow, J. Sound Vib. 146:243
(1991)). In units of C and omega a resistance is r = R C omega and an inductance p = L C omega^2 = 1/delta^2.

Sources of the optima. Resistor and "hagood": Hagood and von Flotow. Series R-L: exact equal peaks of least height,
P. Soltani et al., Smart Mater. Struct. 23:125014 (2014), after T. Asami, O. Nishihara, J. Vib. Acoust. 125:398 (2003).
There 1/|H|^2 = 1/peak^2 + (p x^2 + a x + b)^2/|p s^2 + r s + 1|^2 with x = -s^2, b^2 = 1 - 1/peak^2; a double root of
the relation between p and b is the optimum. The same reduction of the parallel R-L circuit leaves a quartic for b,
which fixed points approximate: p = 2/(2 - K^2), peak sqrt(2)/K (K. Yamada et al., J. Sound Vib. 329:5036 (2010)).
"""

from math import inf, pi, sqrt
from typing import TYPE_CHECKING, Annotated, Any, Literal, get_args

import msgspec

from verify.actuators.port import Port
from verify.errors import InputError
from verify.validation import check_choice, check_number, unit, validate

if TYPE_CHECKING:
    from verify.actuators.patch import Patch
    from verify.linear.modes import Modes

Circuit = Literal["resistor", "resistor-loss", "series", "parallel", "hagood", "negative-parallel"]
"""Shunts with an optimum: least peak by a resistor, a series or parallel R-L circuit, or a resistor in parallel with a
negative capacitance; most loss by a resistor; the transfer-function rule of Hagood and von Flotow."""
Connection = Literal["series", "parallel"]


class Load(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Resistor, inductor and capacitor in series or parallel; what is left out is absent.

    Raises InputError for an invalid value and for a load without parts.
    """

    resistance: Annotated[float, unit("ohm", gt=0)] | None = None
    """R, ohm."""
    inductance: Annotated[float, unit("H", gt=0)] | None = None
    """L, H."""
    capacitance: Annotated[float, unit("F")] | None = None
    """C, F; negative for an active circuit."""
    connection: Connection = "series"
    """Connection of the parts with each other."""

    def __post_init__(self) -> None:
        validate(self, "shunt")
        if self.capacitance == 0.0 or (self.resistance is self.inductance is self.capacitance is None):
            raise InputError("shunt: it has no load, give a resistance, an inductance, or a capacitance other than 0")

    @property
    def rational(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Coefficients of the admittance's numerator and denominator in s = i omega, from the constant one."""
        r, l_, c = self.resistance, self.inductance, self.capacitance
        if self.connection == "series":
            return ((1.0,), (r or 0.0, l_ or 0.0)) if c is None else ((0.0, 1.0), (1.0 / c, r or 0.0, l_ or 0.0))
        total = (1.0 / r if r else 0.0, c or 0.0)
        return (total, (1.0,)) if l_ is None else ((1.0 / l_, *total), (0.0, 1.0))

    def part(self, name: str) -> float:
        """Resistance (ohm), inductance (H) or capacitance (F). Raises InputError where the load has none."""
        value: float | None = getattr(self, name)
        if value is None:
            raise InputError(f"{name}: the load {self!r} has none, choose another circuit")
        return value

    def admittance(self, omega: Any) -> Any:
        """Current over voltage at angular frequencies (rad/s), S."""
        above, below = (sum(c * (1j * omega) ** i for i, c in enumerate(row)) for row in self.rational)
        return above / below


class ShuntedMode(msgspec.Struct, frozen=True, kw_only=True):
    """One undamped mode with an actuator, by default in units of C and omega. Raises InputError."""

    coupling: Annotated[float, unit("dimensionless", gt=0)]
    """K = sqrt((omega_open/omega_short)^2 - 1)."""
    omega: Annotated[float, unit("rad/s", gt=0)] = 1.0
    """Angular frequency with short-circuited electrodes, rad/s."""
    capacitance: Annotated[float, unit("F", gt=0)] = 1.0
    """C without motion of the mode, F: quasi-static contributions of higher modes included."""

    def __post_init__(self) -> None:
        validate(self, "mode")

    @classmethod
    def bonded(cls, modes: "Modes", patch: "Patch", position: float, number: int) -> "ShuntedMode":
        """A mode, from 1, of the beam from `patch.on`, with a patch centred at `position` (m).

        The other modes, which turn its ends by t_m against each other, add B^2 t_m^2/(omega_m^2 - omega^2) to C. The
        neglect of those beyond `modes` falls with 1/n_modes. Raises InputError for a mode without coupling.
        """
        ends = [position - 0.5 * patch.length, position + 0.5 * patch.length]
        turning = patch.moment_per_volt * modes.slope(ends) @ [-1.0, 1.0]
        squares = (2.0 * pi * modes.frequencies_hz) ** 2
        own = squares[number - 1]
        others = squares != own
        c = patch.capacitance.real + float((turning[others] ** 2 / (squares[others] - own)).sum())
        return cls(coupling=abs(turning[number - 1]) / sqrt(c * own), omega=sqrt(own), capacitance=c)

    def stiffness(self, load: Load, omega: Any) -> Any:
        """1 + K^2 X, stiffness over that with short-circuited electrodes, at angular frequencies (rad/s)."""
        own = 1j * omega * self.capacitance
        return 1.0 + self.coupling**2 * own / (own + load.admittance(omega))

    def loss_factor(self, load: Load) -> float:
        """Im/Re of the stiffness at `omega`."""
        stiffness = complex(self.stiffness(load, self.omega))
        return stiffness.imag / stiffness.real

    def response(self, load: Load, omega: Any) -> Any:
        """H at angular frequencies (rad/s): deflection over the static one with short-circuited electrodes."""
        return 1.0 / (self.stiffness(load, omega) - (omega / self.omega) ** 2)

    def peak(self, load: Load) -> float:
        """Largest |H| over all frequencies, infinite without damping. Raises InputError for an unstable load."""
        import numpy as np
        from numpy.polynomial import Polynomial

        own, s = Polynomial([0.0, self.omega * self.capacitance]), Polynomial([0.0, 1.0])  # in s/omega, as all below
        above, below = (Polynomial(one)(self.omega * s) for one in load.rational)
        if above.coef[0] == 0.0:  # a common root, which is no pole
            own, above = (Polynomial(one.coef[1:]) for one in (own, above))
        whole, part = own * below + above, self.coupling**2 * own * below
        denominator = (s**2 + 1.0) * whole + part  # H = whole/denominator
        poles = denominator.roots()
        if (poles.real > 1e-12 * abs(poles)).any() or 0.0 in poles:
            raise InputError(
                f"shunt = {load!r} makes the mode unstable: keep a negative capacitance below the actuator's own in "
                "parallel, and above (1 + K^2) times it in series"
            )
        if (poles.real > -1e-13 * abs(poles)).any():
            return inf
        x = Polynomial([0.0, 1j])
        # over x^2 - 1: the peaks of a weakly coupled mode are within K of 0, and nothing cancels
        squares = [Polynomial((one(x) * one(-x)).coef[::2].real)(s + 1.0) for one in (whole, denominator)]
        stationary: Any = (squares[0].deriv() * squares[1] - squares[0] * squares[1].deriv()).roots()
        # all are lower bounds; poles are those of peaks so narrow that the roots above are lost in rounding
        at = 1j * np.concatenate([[0.0], np.sqrt(abs(1.0 + stationary)), abs(poles.imag)])
        return float(max(abs(1.0 / (at**2 + 1.0 + part(at) / whole(at)))))

    def optimum(self, circuit: Circuit, negative: float | None = None) -> Load:
        """The load of least peak in closed form ("resistor-loss": of largest loss factor at `omega`), ohm and H.

        `negative` is the magnitude of the negative capacitance (F) of "negative-parallel", below the actuator's. Raises
        InputError beyond it, and where K is too large for an optimum of two equal peaks.
        """
        check_choice("circuit", circuit, get_args(Circuit))
        k, squared = self.coupling, self.coupling**2
        if (negative is None) == (circuit == "negative-parallel"):
            raise InputError(f"negative = {negative!r}: give it for negative-parallel, and only there")
        limit = {"series": 1.127, "parallel": 1.414}.get(circuit, inf)  # there the peak falls to the static deflection
        if k > limit:
            raise InputError(f"coupling = {k!r} has no optimum of two equal peaks: give at most {limit}")
        p, left = 0.0, 1.0
        if circuit == "resistor-loss":
            r = 1.0 / sqrt(1.0 + squared)
        elif circuit == "hagood":
            p, r = 1.0 / (1.0 + squared), sqrt(2.0) * k / (1.0 + squared)
        elif circuit == "series":
            root = 64.0 - 16.0 * squared - 26.0 * squared**2
            rest = squared * (32.0 + 27.0 * squared) / (8.0 * (8.0 + squared + sqrt(root)))  # 1 - b
            p = 1.0 / (1.0 + rest + 0.75 * squared)
            r = p * sqrt(6.0 * rest)
        elif circuit == "parallel":
            p, r = self._parallel()
        else:  # the limits 0 and infinity of a resistor have one response at the frequency of the optimum's peak
            if negative is not None:  # the rest of the actuator's capacitance, by whose inverse K^2 grows
                limits = {"above": 0, "below": self.capacitance}
                check_number("negative", negative, "farad, below the actuator's capacitance", **limits)
                left = 1.0 - negative / self.capacitance
            r = 1.0 / (left * sqrt(1.0 + 0.5 * squared / left))
        return Load(
            resistance=r / (self.capacitance * self.omega),
            inductance=p / (self.capacitance * self.omega**2) or None,
            capacitance=-negative if negative else None,
            connection="parallel" if circuit.endswith("parallel") else "series",
        )

    def _parallel(self) -> tuple[float, float]:
        """(p, r) of the parallel R-L circuit, from the quartic for t = (1 - b)/K^2, which is 1/4 at K = 0."""
        import numpy as np

        u = self.coupling**2
        quartic = (
            *(64.0 * u**3, 16.0 * u**2 * (u - 16.0), u * (11.0 * u**2 - 32.0 * u + 320.0)),
            *(-2.0 * (u**3 + u**2 + 8.0 * u + 64.0), 4.0 * u**2 - 13.0 * u + 32.0),
        )
        roots = np.roots(quartic)
        t = roots[np.argmin(abs(roots - 0.25))]
        cubic = (-64.0 * u**2, -64.0 * u * (u - 5.0), -4.0 * (5.0 * u**2 - 42.0 * u + 112.0))
        detuning = u * np.polyval((*cubic, 16.0 + 31.0 * u - 13.0 * u**2), t.real) / 3.0
        detuning /= 13.0 * u**2 - 56.0 * u + 64.0  # delta^2 - 1
        p, rest = 1.0 / float(1.0 + detuning), float(u * t.real)
        half, product = p * (u + detuning), p * rest * (-2.0 * p * detuning - p * rest)
        q = half + sqrt(half**2 - product)  # (p/r)^2/(2 p)
        return p, p / sqrt(2.0 * p * q)


def absorbing_load(port: Port, impedance: complex, omega: float) -> Load:
    """The series load with which an actuator has a mechanical impedance (kg/s) at omega (rad/s).

    Y_el = B^2/(Z_a - Z) - Y; resistor and inductor, or capacitor where the load is capacitive. Raises InputError for
    an active load.
    """
    admittance = complex(port.force_factor**2 / (impedance - port.short_impedance) - port.blocked_admittance)
    z = 1.0 / admittance
    if z.real < 0.0:
        raise InputError(
            f"impedance = {impedance!r} kg/s needs an electrical load of {z.real:.6g} ohm, which is active: give an "
            "impedance with a larger real part"
        )
    return Load(
        resistance=z.real or None,
        inductance=z.imag / omega if z.imag > 0.0 else None,
        capacitance=-1.0 / (omega * z.imag) if z.imag < 0.0 else None,
    )
