"""The slider as a scene or a script states it. Data, no numerics."""

from typing import get_args

from verify.beam import Beam
from verify.checks import check_number, settle
from verify.errors import InputError, near_name
from verify.field_docs import Value
from verify.options import CouplingChoice, Kinematics, Law, Line, NormalChoice

GRAVITY = 9.81
_WORDS = {"law": Law, "coupling": CouplingChoice, "line": Line, "kinematics": Kinematics, "normal": NormalChoice}


class Slider(Value, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A point mass that stays on the surface and is carried along by friction.

    Friction is the paper's Eq. (3), F = -mu N tanh(K (v - v_beam)), or Coulomb's law with true sticking. N is
    m g + preload. `v` is the slider's speed along the tangent. Raises InputError.
    """

    mass: float
    """m_s, kg."""
    mu: float
    """Coefficient of (kinetic) friction."""
    slope: float = 1e4
    """K of Eq. (3), s/m."""
    law: Law = "tanh"
    """Friction: tanh is Eq. (3), which never sticks; coulomb sticks."""
    mu_static: float | None = None
    """Of Coulomb's law at rest; as `mu` unless given."""
    position: float | None = None
    """Where it starts, metres from the left end; mid-span unless given."""
    speed: float = 0.0
    """Along +x at the start, m/s."""
    preload: float = 0.0
    """Newton pressing it on, beside its weight."""
    gravity: float = GRAVITY
    """m/s^2."""
    coupling: CouplingChoice = "auto"
    """Whether the beam feels the slider; auto decides by size."""
    line: Line = "spline"
    """Contact line on a chain: the paper's C2 spline, or the links' own straight edges."""
    kinematics: Kinematics = "tangential"
    """tangential: m dv/dt = F and dx/dt = v, as in the paper. following: the path of a point that follows the
    surface exactly, with dx/dt = v - w' dw/dt and the inertia of the turning tangent."""
    normal: NormalChoice = "held"
    """What a slider coupled two-way presses the beam with. held: m g + preload and its inertia across the beam, m times
    the acceleration of the surface under it, convective terms included: a moving mass. massless: nothing, the paper's
    simplification. Friction has N = m g + preload either way."""

    def __post_init__(self) -> None:
        settle(self)
        for name, kind in _WORDS.items():
            word, known = getattr(self, name), get_args(kind)
            if word not in known:
                raise InputError(f"slider.{name} = {word!r} is not known: {near_name(str(word), known)}")
        check_number("slider.mass", self.mass, "kg", above=0)
        check_number("slider.mu", self.mu, "coefficient of friction", above=0)
        check_number("slider.slope", self.slope, "s/m", above=0)
        check_number("slider.speed", self.speed, "m/s")
        check_number("slider.gravity", self.gravity, "m/s^2", at_least=0)
        check_number("slider.preload", self.preload, "newton", at_least=0)
        if self.mu_static is not None:
            check_number("slider.mu_static", self.mu_static, "coefficient of friction", at_least=self.mu)
            if self.law != "coulomb":
                raise InputError(
                    f"slider.mu_static = {self.mu_static!r} is for law = 'coulomb': Eq. (3) never sticks, leave it out"
                )
        if self.position is not None:
            check_number("slider.position", self.position, "metres")
        if self.normal_force == 0.0:
            raise InputError("slider.gravity = 0.0 without slider.preload presses on nothing: give one of the two")

    @property
    def normal_force(self) -> float:
        """N, newton."""
        return self.mass * self.gravity + self.preload

    def start_on(self, beam: Beam) -> float:
        """Where it starts, metres. Raises InputError off the beam."""
        x = 0.5 * beam.length if self.position is None else self.position
        if not 0.0 <= x <= beam.length:
            raise InputError(
                f"slider.position = {x!r} lies off the beam: give a position between 0 and {beam.length!r} m"
            )
        return x
