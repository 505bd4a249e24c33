"""What a scene leaves open about its slider and asks to be gone through."""

from math import prod
from typing import TYPE_CHECKING, Annotated

import msgspec
from msgspec import Meta

from verify.checks import check_number
from verify.errors import InputError, written
from verify.models.catalogue import MODELS
from verify.models.naming import Among, model_meta
from verify.options import Kinematics, NormalChoice
from verify.scenes.claims import asks_for_turned

if TYPE_CHECKING:
    from verify.scenes.scene import Scene


NAMES = {
    "kinematics": "kinematics",
    "normal": "normal",
    "soft_start_periods": "start",
    "positions": "place",
    "forces": "force",
    "mu": "mu",
    "slope": "slope K",
}
"""Of the lists, in tables."""
MOST_READINGS = 10_000


MOST_LINKS = 250


MOST_WORK = 1e10
"""Rows advanced times steps of all readings: about a minute."""


class ReadingsAsk(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask which of the scene's claims about its slider hold, over what its source leaves open. Nothing is tuned.

    Every combination of the lists is run; a list that is left out has the scene's own value alone.
    """

    kinematics: tuple[Kinematics, ...] = ()
    """How the slider keeps to the surface."""
    normal: tuple[NormalChoice, ...] = ()
    """Whether the beam carries the slider's weight and inertia."""
    soft_start_periods: tuple[float, ...] = ()
    """From rest; 0 is a step load, because cos(0) = 1."""
    forces: tuple[float, ...] = ()
    """Newton: amplitudes that all forces of the drive take in turn."""
    mu: tuple[float, ...] = ()
    """Coefficients of friction."""
    slope: tuple[float, ...] = ()
    """K, s/m."""
    positions: tuple[float, ...] = ()
    """Metres from the left end, where the slider starts."""
    saturation: float | None = None
    """Newton: mu N, if the mass is to follow from every mu; else the mass is the scene's."""
    model: Annotated[str, model_meta("of the readings", "time_basis", sized=True)] = "segment"
    count: Annotated[int, Meta(ge=1)] | None = None
    """Segments or elements; the motion's unless given."""
    duration: float | None = None
    """Seconds; the motion's unless given."""
    chain: bool = False
    """Whether those whose forces act at once are run on the nonlinear chain of as many rigid links as well."""
    shown: Annotated[int, Meta(ge=0, le=50)] = 8
    """On how many rows of the table the best reading is run on the exact beam as well."""

    def __post_init__(self) -> None:
        for name, unit, bound in (
            ("soft_start_periods", "periods", {"at_least": 0}),
            ("forces", "newton", {"above": 0}),
            ("mu", "coefficient of friction", {"above": 0}),
            ("slope", "s/m", {"above": 0}),
            ("positions", "metres", {"at_least": 0}),
        ):
            for i, value in enumerate(getattr(self, name)):
                check_number(f"readings.{name}[{i}]", value, unit, **bound)
        for name in ("kinematics", "normal", "soft_start_periods", "forces", "mu", "slope", "positions"):
            values = getattr(self, name)
            if len(set(values)) < len(values):
                raise InputError(f"readings.{name} = {list(values)!r} holds a value twice: give each once")
        for name, unit in (("saturation", "newton"), ("duration", "seconds")):
            if (value := getattr(self, name)) is not None:
                check_number(f"readings.{name}", value, unit, above=0)

    @property
    def n_readings(self) -> int:
        """Combinations of the lists."""
        return self.n_groups * prod(max(len(values), 1) for values in (self.forces, self.mu, self.slope))

    @property
    def n_groups(self) -> int:
        """Combinations of kinematics, normal, start and place, each a row of the table."""
        lists = (self.kinematics, self.normal, self.soft_start_periods, self.positions)
        return prod(max(len(values), 1) for values in lists)

    def check_on(self, scene: "Scene") -> None:
        """Raise InputError where the scene has nothing to read, or where the search would take too long."""
        Among("time_basis", sized=True).check(self.model, "readings.model")
        slider, motion, drive = scene.slider, scene.motion, scene.drive
        if slider is None or motion is None or drive is None or drive.kind != "force":
            raise InputError(
                "readings: they are runs of a slider under forces, give the scene a [slider], a [motion] and a [drive] "
                "of kind force"
            )
        if self.soft_start_periods and motion.start != "rest":
            raise InputError(
                f"readings.soft_start_periods = {list(self.soft_start_periods)!r} with motion.start = "
                f"{motion.start!r}: a steady beam has no start, leave it out"
            )
        if self.slope and slider.law == "coulomb":
            raise InputError(
                f"readings.slope = {list(self.slope)!r} is of law = 'tanh': Coulomb's has none, leave it out"
            )
        for i, x in enumerate(self.positions):
            if x > scene.beam.length:
                raise InputError(
                    f"readings.positions[{i}] = {x!r} lies off the beam: give a place up to {scene.beam.length!r} m"
                )
        for i, periods in enumerate(self.soft_start_periods):
            if periods / drive.frequency_hz > (seconds := self.duration or motion.duration):
                raise InputError(
                    f"readings.soft_start_periods[{i}] = {periods!r} take longer than the {written(seconds)} s of a "
                    "run: shorten them or lengthen readings.duration"
                )
        if self.chain:
            self._check_chain(scene)
        self._check_masses(slider.preload, slider.gravity, self.mu or (slider.mu,))
        self._check_work(scene)

    def _check_chain(self, scene: "Scene") -> None:
        """Raise InputError for what the nonlinear chain does not know."""
        beam, motion, slider = scene.beam, scene.motion, scene.slider
        assert motion is not None
        assert slider is not None
        beam.check_added("readings.chain")
        if beam.supports not in (("pinned", "pinned"), ("clamped", "pinned"), ("clamped", "free")):
            raise InputError(
                f"readings.chain with beam.supports = {list(beam.supports)!r}: give a uniform beam, pinned or clamped "
                "on the left and pinned, or free behind a clamp, on the right, or leave it out"
            )
        if motion.start != "rest" or beam.loss_factor or motion.modal_damping or slider.coupling == "two-way":
            raise InputError(
                "readings.chain: the chain starts from rest, is undamped and carries a slider one way; leave it out, "
                "or motion.start, damping and slider.coupling"
            )
        if "massless" not in (self.normal or (slider.normal,)):
            raise InputError(
                "readings.chain: the nonlinear chain carries a slider that puts nothing on it, give slider.normal = "
                "'massless', or readings.chain = false"
            )
        if (self.count or motion.count) > MOST_LINKS:
            raise InputError(
                f"readings.chain: {self.count or motion.count} links are more than {MOST_LINKS}, give a smaller count"
            )

    def _check_masses(self, preload: float, gravity: float, mus: tuple[float, ...]) -> None:
        if self.saturation is None:
            return
        for mu in mus:
            if gravity == 0.0 or self.saturation / mu <= preload:
                raise InputError(
                    f"readings.saturation = {self.saturation!r} leaves no weight at mu = {mu!r}: give slider.gravity, "
                    "and a slider.preload below saturation / mu"
                )

    def _check_work(self, scene: "Scene") -> None:
        if self.n_readings > MOST_READINGS:
            raise InputError(
                f"readings: the lists make {self.n_readings} readings, shorten them to at most {MOST_READINGS}"
            )
        runs, steps, rows = self.n_runs(scene), self.n_steps(scene), self.n_rows(scene)
        if runs * steps * rows > MOST_WORK:
            raise InputError(
                f"readings: {runs} runs of about {steps:.3g} steps of {rows} modes, multiplied, are more than the "
                f"{MOST_WORK:g} that are run at most: shorten the lists, the duration or count"
            )

    def n_chain(self, scene: "Scene") -> int:
        """How many readings the nonlinear chain takes: those without a soft start."""
        assert scene.motion is not None
        starts = self.soft_start_periods or (scene.motion.soft_start,)
        return self.n_readings // len(starts) * starts.count(0.0) if self.chain else 0

    def n_runs(self, scene: "Scene") -> int:
        """How many runs of model and chain: each again with its phases turned round where a claim asks for it."""
        return (self.n_readings + self.n_chain(scene)) * (2 if asks_for_turned(scene.claim) else 1)

    def n_steps(self, scene: "Scene") -> float:
        """About how many steps a run takes."""
        assert scene.motion is not None
        assert scene.drive is not None
        seconds = self.duration or scene.motion.duration
        return min(max(seconds * scene.drive.frequency_hz * scene.motion.steps_per_period, 1.0), 1e15)

    def n_rows(self, scene: "Scene") -> int:
        """About how many modes a run advances in a step."""
        assert scene.motion is not None
        return (self.count or scene.motion.count) * MODELS[self.model].unknowns_per_part
