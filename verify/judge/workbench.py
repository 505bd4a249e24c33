"""Where models are solved: lazily, once for everybody who asks, with a record of what it cost."""

from collections.abc import Callable, Iterable
from time import perf_counter
from typing import TYPE_CHECKING, Any, TypeAlias

import msgspec

from verify.beam import Beam
from verify.errors import InputError, NoBracketError
from verify.models.catalogue import MODELS, bounding, discrete
from verify.models.naming import MEAN

if TYPE_CHECKING:
    from verify.judge.bracket import Bracket
    from verify.models.arrays import Array
    from verify.models.fields import HarmonicField
    from verify.models.modes import Modes
    from verify.models.sweeps import HarmonicSweep
    from verify.motion.result import Motion

EULER = "euler-bernoulli"
Settings: TypeAlias = tuple[tuple[str, str | float], ...]
"""Keyword settings of a model's solve_modes other than their defaults, for instance (("wall", "half"),)."""


class Need(msgspec.Struct, frozen=True):
    """A solve that somebody will ask for."""

    model: str
    count: int
    n_modes: int
    settings: Settings = ()


class Solve(msgspec.Struct, frozen=True):
    """A solve that was done, and what it cost."""

    model: str
    count: int
    settings: Settings
    n_modes: int
    unknowns: int
    method: str
    seconds: float


Key: TypeAlias = tuple[str, int, Settings]


def theory_of(settings: Settings) -> str:
    """Of the beam, among the settings of a model."""
    return str(dict(settings).get("theory", EULER))


def merged(needs: Iterable[Need]) -> dict[Key, int]:
    """(model, count, settings) -> the most modes anybody wants of it."""
    wanted: dict[Key, int] = {}
    for need in needs:
        key = (need.model, need.count, need.settings)
        wanted[key] = max(need.n_modes, wanted.get(key, 0))
    return wanted


def no_such_mode(mode: int, model: str, count: int, available: int) -> str:
    """Why a model at a size does not have a mode."""
    return f"mode = {mode}: the {model} model at count = {count} has {available} elastic modes, raise count"


def for_model(model: str, settings: Settings) -> Settings:
    """The settings that a model knows: walls and joints are the segments' own."""
    known = MODELS.named(model).modal_settings
    return tuple((name, value) for name, value in settings if name in known)


def check_bracket(beam: Beam, settings: Settings) -> None:
    """Raise NoBracketError, with the reason, where segments below and elements above is no theorem."""
    wall = dict(settings).get("wall", "gregory")
    if added := [name for name in beam.added if name != "section"]:
        reason = f"on a beam with beam.{added[0]} neither side is proven"
    elif beam.section:
        reason = "on a stepped beam the chain may lie above the exact frequency"
    elif theory_of(settings) != EULER:
        reason = f"with theory = {theory_of(settings)!r} the chain may lie above the exact frequency"
    elif "grading" in dict(settings):
        reason = (
            f"with grading = {dict(settings)['grading']!r} a chain of unequal links may lie above the exact frequency"
        )
    elif "clamped" in beam.supports and wall != "half":
        reason = (
            f"with wall = {wall!r} at a clamped end the chain may lie above the exact frequency; wall=half bounds it"
        )
    else:
        return
    raise NoBracketError(f"mode.bracket: {reason}")


def bracketed(beam: Beam, asked: Iterable[Settings]) -> Settings:
    """The first of several settings by which a beam has a bracket. Raises NoBracketError, with the first's reason."""
    refused: list[NoBracketError] = []
    for settings in asked:
        try:
            check_bracket(beam, settings)
            return settings
        except NoBracketError as error:
            refused.append(error)
    raise refused[0]


def has_bracket(beam: Beam, settings: Settings = ()) -> bool:
    """Whether segments lie below and elements above for this beam, by default or by other settings."""
    try:
        check_bracket(beam, settings)
    except NoBracketError:
        return False
    return True


def check_size(beam: Beam, model: str, count: int, n_modes: int) -> None:
    """Raise InputError for a size that cannot be solved at all, before any work on it."""
    found = MODELS.named(model)
    found.check(beam, max(min(n_modes, found.n_elastic(beam, count)), 1), count)


def comparable(beam: Beam, counts: Iterable[int], n_modes: int) -> tuple[list[str], dict[str, str]]:
    """(models of parts whose modes can be compared at these sizes, why those of other packages are left out).

    Raises InputError for a size that a model of this package cannot solve.
    """
    names, left_out, sizes = [], {}, tuple(counts)
    for model in discrete():
        try:
            if why := model.refuses(beam):
                raise InputError(why)
            for count in sizes:
                check_size(beam, model.name, count, n_modes)
            if model.name not in MODELS.built_in:  # nobody knows whether it does what it says
                model.solve_modes(beam, max(min(n_modes, model.n_elastic(beam, sizes[0])), 1), sizes[0])
            names.append(model.name)
        except InputError as problem:
            if model.name in MODELS.built_in:
                raise
            left_out[model.name] = f"model {model.name} is left out: {problem}"
    return names, left_out


class Workbench:
    """The models of one beam. Everything is solved when first asked for, and kept."""

    def __init__(self, beam: Beam, needs: Iterable[Need] = ()) -> None:
        """`needs` says what will be asked, so that a size is solved once for all who want it."""
        self.beam = beam
        self.solves: list[Solve] = []
        self.n_fields = 0
        """How many driven fields were solved; a map forgets those it has passed."""
        self.tell: Callable[[float], None] = lambda part: None
        """Hears how much of a long simulation is done."""
        self._wanted = merged(needs)
        self._modes: dict[Key, Modes] = {}
        self._index: dict[tuple[Key, int], int] = {}
        self._exact: dict[tuple[int, str], float] = {}
        self.fields: dict[Any, HarmonicField] = {}
        """Harmonic fields by everything that makes them."""
        self.sweeps: dict[Any, HarmonicSweep] = {}
        """Harmonic fields over frequencies, likewise."""
        self.motions: dict[Any, Motion] = {}
        self.motors: dict[Any, Any] = {}
        """Simulations by everything that makes them."""
        self.others: dict[str, int] = {}
        """Work of other kinds that was done for figures, on other beams, by name in the plural."""
        self.n_unkept_motions = 0
        """How many were done besides, of the nonlinear chain."""

    @property
    def n_motions(self) -> int:
        """How many simulations were done for figures."""
        return len(self.motions) + len(self.motors) + self.n_unkept_motions

    def modes(self, model: str, count: int, n_modes: int, settings: Settings = ()) -> "Modes":
        """At least `n_modes` modes of a discrete model. Raises InputError."""
        key = (model, count, for_model(model, settings))
        held = self._modes.get(key)
        if held is None or held.n_modes < n_modes:
            held = self._modes[key] = self._solve(key, max(n_modes, self._wanted.get(key, 0)), n_modes)
        return held

    def _solve(self, key: Key, n_wanted: int, n_needed: int) -> "Modes":
        model, count, settings = key
        module = MODELS.named(model)
        # what others wish for must not fail the one who asks for less, so theirs is cut to what there is
        available = module.n_elastic(self.beam, count, **dict(settings))
        if n_needed > available:
            raise InputError(no_such_mode(n_needed, model, count, available))
        n_modes = min(n_wanted, available)
        start = perf_counter()
        modes = module.solve_modes(self.beam, n_modes, count, **dict(settings))
        seconds = perf_counter() - start
        unknowns = module.unknowns(self.beam, count, **dict(settings))
        self.solves.append(Solve(model, count, settings, n_modes, unknowns, modes.method, seconds))
        return modes

    def exact_hz(self, mode: int, theory: str = EULER) -> float:
        """The exact frequency by a theory, Hz: in closed form, else by counting. Raises InputError."""
        key = mode, theory
        if key not in self._exact:
            self._exact[key] = self._exact_of(*key)
        return self._exact[key]

    def _exact_of(self, mode: int, theory: str) -> float:
        if self.beam.uniform and theory == EULER:
            from verify.exact.closed_forms import frequency_hz

            return frequency_hz(self.beam, mode)
        from verify.exact.modes import exact_frequency_hz

        return exact_frequency_hz(self.beam, mode, theory)

    def frequency_hz(self, model: str, count: int, mode: int, settings: Settings = ()) -> float:
        """The frequency of mode number `mode` by rank, Hz; model "mean" is the middle of the bracket."""
        if model == MEAN:
            return self.bracket(mode, count, settings).mean
        return float(self.modes(model, count, mode, settings).frequencies_hz[mode - 1])

    def paired_frequency_hz(self, model: str, count: int, mode: int, settings: Settings = ()) -> float:
        """The frequency of the computed mode whose shape is that of exact mode `mode`, Hz.

        By rank where exact shapes are dear: on beams that are not uniform, and by other theories. Raises PairingError.
        """
        if model == MEAN:
            return self.bracket(mode, count, settings).mean
        index = self.paired_index(model, count, mode, settings)
        return float(self.modes(model, count, mode, settings).frequencies_hz[index])

    def paired_index(self, model: str, count: int, mode: int, settings: Settings = ()) -> int:
        """Where among the computed modes the one stands that looks like exact mode `mode`. Raises PairingError."""
        if not self.beam.uniform or theory_of(settings) != EULER:
            return mode - 1
        key = ((model, count, for_model(model, settings)), mode)
        if key not in self._index:
            from verify.exact import modes as analytic_modes
            from verify.judge import compare

            modes = self.modes(model, count, mode, settings)
            stride = max(len(modes.points) // (16 * modes.n_modes + 64), 1)
            exact = analytic_modes.solve_modes(self.beam, modes.n_modes).deflection(modes.points[::stride])
            self._index[key] = compare.paired_index(modes, exact, mode, stride)
        return self._index[key]

    def frequency_error(self, model: str, count: int, mode: int, settings: Settings = ()) -> float:
        """Signed, relative to the exact frequency by the same theory. Raises InputError."""
        from verify.judge import compare

        exact = self.exact_hz(mode, theory_of(settings))
        return compare.relative_error(self.paired_frequency_hz(model, count, mode, settings), exact)

    def error_or_why(self, model: str, count: int, mode: int, settings: Settings = ()) -> tuple[float | None, str]:
        """(signed frequency error, '') or (None, why there is none)."""
        try:
            return self.frequency_error(model, count, mode, settings), ""
        except InputError as error:
            return None, str(error)

    def bracket(self, mode: int, count: int, settings: Settings = ()) -> "Bracket":
        """Segments below and Hermite elements above the exact frequency, Hz. Raises NoBracketError.

        Holds for uniform beams of equal parts without a clamped end (checked on every mode and support for
        N = 2..24), and loosely, with order 2, for clamped ends with the wall joint 2EI/l.
        """
        from verify.exact.error_laws import leading_error
        from verify.judge import compare

        check_bracket(self.beam, settings)
        lower, upper = bounding()
        width = 2.0 * leading_error(upper.name, self.beam.supports, mode, count)
        if width < max(10.0 * compare.EIGENVALUE_FLOOR, 1e-16 * count):
            raise NoBracketError(
                f"mode.bracket: at count = {count} it would be {width:.0e} wide, thinner than the eigenvalue error, "
                "use a smaller count"
            )
        below, above = (self.frequency_hz(model.name, count, mode, settings) for model in (lower, upper))
        return compare.bracket(below, above)

    def shape_error(
        self, model: str, count: int, mode: int, reading: str | None = None, settings: Settings = ()
    ) -> float:
        """Relative L2 error of the mass-normalised deflection at the model's nodes. Raises InputError."""
        from verify.exact import modes as analytic_modes
        from verify.judge import compare

        modes = self.modes(model, count, mode, settings)
        if reading is not None and reading not in modes.readings:
            raise InputError(f"reading = {reading!r} is none of the {model} model's: {', '.join(modes.readings)}")
        read = modes.readings[reading or next(iter(modes.readings))]
        exact = analytic_modes.mode_shape(self.beam, mode, modes.nodes, theory=theory_of(settings))
        shape = read()[self.paired_index(model, count, mode, settings)]
        mass = sum(piece.mass_per_length * piece.length for piece in self.beam.pieces)
        return compare.shape_error(exact, shape, compare.node_weights(modes.nodes), mass**-0.5)

    def curvature_error(self, model: str, count: int, mode: int, settings: Settings = ()) -> float:
        """Relative L2 error of the curvature where the model knows it best. Raises InputError."""
        from verify.exact import modes as analytic_modes
        from verify.judge import compare

        modes = self.modes(model, count, mode, settings)
        exact = analytic_modes.mode_shape(self.beam, mode, modes.curvature_points, 2, theory_of(settings))
        found = modes.curvatures()[self.paired_index(model, count, mode, settings)]
        return compare.shape_error(exact, found, compare.node_weights(modes.curvature_points))

    def shape_at(
        self, model: str, count: int | None, mode: int, x: "Array", derivative: int, settings: Settings = ()
    ) -> float:
        """A derivative of a mass-normalised shape at x, (1,), metres on the beam. Raises InputError."""
        from verify.exact import modes as analytic_modes

        if count is None:
            return float(analytic_modes.mode_shape(self.beam, mode, x, derivative, theory_of(settings))[0])
        modes = self.modes(model, count, mode, settings)
        return float(modes.shapes(x, derivative)[self.paired_index(model, count, mode, settings), 0])

    def node_positions(self, model: str, count: int | None, mode: int, settings: Settings = ()) -> "Array":
        """Where a mode stands still between the ends, (n_nodes,), metres, ascending. Raises InputError."""
        from verify.exact import modes as analytic_modes
        from verify.judge import compare

        if count is None:
            theory = theory_of(settings)
            return compare.zeros(
                lambda x: analytic_modes.mode_shape(self.beam, mode, x, theory=theory), self.beam.length, mode
            )
        modes = self.modes(model, count, mode, settings)
        index = self.paired_index(model, count, mode, settings)
        return compare.zeros(lambda x: modes.deflection(x)[index], self.beam.length, mode)
