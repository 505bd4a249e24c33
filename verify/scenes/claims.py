"""What somebody published about a scene, and which readings of it to try. Data, no numerics."""

from math import prod
from typing import TYPE_CHECKING, Annotated, Any, Literal

import msgspec
from msgspec import Meta

from verify.beam import check_number
from verify.errors import InputError
from verify.motion.figures import RUN_FIGURES
from verify.options import Kinematics, NormalChoice

if TYPE_CHECKING:
    from verify.scenes.scene import Scene

Sign = Literal["negative", "positive"]
Read = Literal["stated", "figure", "follows"]
READ = {"stated": "stated in the text", "figure": "read off a figure", "follows": "follows from what is stated"}
MOST_READINGS = 10_000
MOST_LINKS = 250
MOST_WORK = 1e10
"""Rows advanced times steps of all readings: about a minute."""


class Claim(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One published statement as a figure that this suite can find. It is shown beside what is found; no gate.

    `value` is a number with a `tolerance`, or a sign; `at_least` and `at_most` bound one side each. A quantity of the
    scene's slider without `arguments` is found on the scene's own run, and on every one of its readings. Raises
    InputError where it is none of these.
    """

    id: Annotated[str, Meta(pattern=r"^[A-Za-z0-9][A-Za-z0-9_-]*$")]
    source: Annotated[str, Meta(min_length=1)]
    """Who says so, and where."""
    quantity: str
    """As `verify quantities` names it."""
    arguments: dict[str, Any] = {}
    value: float | Sign | None = None
    tolerance: float | None = None
    """Half the last digit that is printed, or how well a figure can be read."""
    at_least: float | None = None
    at_most: float | None = None
    read: Read
    """How the claim was read from its source."""

    def __post_init__(self) -> None:
        for name in ("value", "tolerance", "at_least", "at_most"):
            if (value := getattr(self, name)) is not None and not isinstance(value, str):
                check_number(f"claim.{self.id}.{name}", value, "in the quantity's own unit")
        number = isinstance(self.value, float | int)
        if number != (self.tolerance is not None) or (self.tolerance is not None and self.tolerance <= 0):
            raise InputError(
                f"claim.{self.id}.tolerance = {self.tolerance!r}: give one above 0 beside a number as value, and none "
                "beside a sign or a bound"
            )
        bounded = self.at_least is not None or self.at_most is not None
        if bounded == (self.value is not None):
            raise InputError(f"claim.{self.id} claims nothing clear: give value, or at_least, at_most")
        if self.at_least is not None and self.at_most is not None and self.at_least > self.at_most:
            raise InputError(
                f"claim.{self.id}.at_least = {self.at_least!r} is above at_most = {self.at_most!r}: exchange them"
            )

    @property
    def of_run(self) -> bool:
        """Whether it is about the run of the scene's own slider, and so about every reading of it."""
        return self.quantity in RUN_FIGURES and not self.arguments

    @property
    def number(self) -> float | None:
        """What it claims; None for a sign or a bound."""
        return float(self.value) if isinstance(self.value, float | int) else None

    @property
    def in_words(self) -> str:
        """'-0.015 ± 0.0005', 'negative', 'at least 0.02, at most 0.03'."""
        if self.value is not None:
            return self.value if isinstance(self.value, str) else f"{self.value:g} ± {self.tolerance:g}"
        sides = [f"at least {self.at_least:g}"] if self.at_least is not None else []
        return ", ".join(sides + ([f"at most {self.at_most:g}"] if self.at_most is not None else []))

    def holds(self, found: float) -> bool:
        """Whether a figure is what is claimed; one that is not a number never is."""
        if isinstance(self.value, str):
            return found < 0.0 if self.value == "negative" else found > 0.0
        if self.value is not None and self.tolerance is not None:
            return abs(found - self.value) <= self.tolerance
        low = -float("inf") if self.at_least is None else self.at_least
        return low <= found <= (float("inf") if self.at_most is None else self.at_most)


class ReadingsAsk(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask which of the scene's claims about its slider hold, over what its source leaves open. Nothing is tuned.

    Every combination of the lists is run; a list that is left out has the scene's own value alone.
    """

    kinematics: tuple[Kinematics, ...] = ()
    normal: tuple[NormalChoice, ...] = ()
    """Whether the beam carries the slider's weight and inertia."""
    soft_start_periods: tuple[float, ...] = ()
    """From rest; 0 is a step load, because cos(0) = 1."""
    forces: tuple[float, ...] = ()
    """Newton: amplitudes that all forces of the drive take in turn."""
    mu: tuple[float, ...] = ()
    slope: tuple[float, ...] = ()
    """K, s/m."""
    positions: tuple[float, ...] = ()
    """Metres from the left end, where the slider starts."""
    saturation: float | None = None
    """Newton: mu N, if the mass is to follow from every mu; else the mass is the scene's."""
    model: Literal["segment", "fem"] = "segment"
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
                    f"readings.soft_start_periods[{i}] = {periods!r} take longer than the {seconds!r} s of a run: "
                    "shorten them or lengthen readings.duration"
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
        if beam.supports not in (("pinned", "pinned"), ("clamped", "pinned"), ("clamped", "free")) or beam.stepped:
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
        starts = self.soft_start_periods or (scene.motion.soft_start_periods,)
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
        return (self.count or scene.motion.count) * (2 if self.model == "fem" else 1)


def asks_for_turned(claims: tuple[Claim, ...]) -> bool:
    """Whether a claim about the slider's run needs the run with all phases turned round."""
    return any(one.of_run and RUN_FIGURES[one.quantity].turned for one in claims)
