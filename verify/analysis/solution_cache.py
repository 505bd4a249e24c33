"""Cache of the solutions of one beam by all models, and their errors against the exact beam."""

from collections.abc import Callable, Iterable
from typing import Any, TypeAlias, TypeVar

import msgspec

from verify.analysis import comparison
from verify.analytic_modes import ExactModel
from verify.arrays import Array
from verify.errors import InputError, NoBracketError
from verify.exact.error_laws import leading_error
from verify.linear.modes import Modes
from verify.linear.registry import MEAN, MODELS, bounding, discrete
from verify.problem.beam import Beam, features
from verify.settings import DEFAULT

T = TypeVar("T")
EULER = DEFAULT.theory
Settings: TypeAlias = tuple[tuple[str, str | float], ...]
"""Settings of a model other than their defaults, for instance (("wall", "half"),)."""


class Bracket(msgspec.Struct, frozen=True):
    """Two-sided bound on an exact value."""

    lower: float
    upper: float

    @property
    def mean(self) -> float:
        """The middle, at which leading errors cancel: nearer than a bound unless one error is three times the other."""
        return 0.5 * (self.lower + self.upper)


def theory_of(settings: Settings) -> str:
    """The beam theory among the settings of a model."""
    return str(dict(settings).get("theory", EULER))


def unproven(beam: Beam, settings: Settings = ()) -> str:
    """Reason why segments are not proven to lie below and elements above the exact frequencies; empty if proven."""
    if added := (*features(beam), *("section",) * bool(beam.section)):
        return f"with beam.{added[0]} the exact frequency may lie outside of both models, give a beam without"
    chosen = {"theory": EULER, "grading": 1.0, "wall": DEFAULT.wall, **dict(settings)}
    proven = {"theory": EULER, "grading": 1.0, "wall": "half" if "clamped" in beam.supports else chosen["wall"]}
    for name, value in chosen.items():
        if value != proven.get(name, value):
            instead = "wall=half is a bound" if name == "wall" else f"leave {name} out"
            return f"with {name} = {value!r} the chain may lie above the exact frequency, {instead}"
    return ""


def comparable(beam: Beam, counts: Iterable[int], n_modes: int) -> tuple[list[str], dict[str, str]]:
    """(discrete models that solve this beam at these sizes, reason by name for models of other packages that do not).

    Raises InputError for an invalid size of a model of this package.
    """
    names, skipped, sizes = [], dict[str, str](), tuple(counts)
    for model in discrete():
        try:
            built = [model.build(beam, count) for count in sizes]
            if model.name not in MODELS.built_in:
                built[0].modes(max(min(n_modes, built[0].n_elastic), 1))
            names.append(model.name)
        except InputError as problem:
            if model.name in MODELS.built_in:
                raise
            skipped[model.name] = f"model {model.name} is skipped: {problem}"
    return names, skipped


class SolutionCache:
    """The models of one beam; each solution is computed on first use and stored.

    A request for more modes than stored solves again: request the highest mode first.
    """

    def __init__(self, beam: Beam) -> None:
        self.beam = beam
        self.progress: Callable[[float], None] = lambda fraction: None
        """Called with the completed fraction of a long time integration."""
        self._stored: dict[Any, Any] = {}
        self._modes: dict[tuple[str, int, Settings], Modes] = {}

    def once(self, key: Any, compute: Callable[[], T]) -> T:
        """The value of a key, computed at its first use."""
        if key not in self._stored:
            self._stored[key] = compute()
        value: T = self._stored[key]
        return value

    def call(self, function: Callable[..., T], *arguments: Any) -> T:
        """The value of a function, computed once for equal arguments."""
        return self.once((function, *arguments), lambda: function(*arguments))

    @property
    def runs(self) -> list[Any]:
        """Time integrations with a slider, then those of motors (`dynamics.result.Motion`)."""
        runs = [one for key, one in self._stored.items() if key[0] == "motion"]
        return runs + [one.run for one in self._stored.values() if hasattr(one, "run")]

    def modes(self, model: str, count: int, n_modes: int, settings: Settings = ()) -> Modes:
        """At least `n_modes` modes of a discrete model; settings of other models are ignored. Raises InputError."""
        key = self._key(model, count, settings)
        stored = self._modes.get(key)
        if stored is None or stored.n_modes < n_modes:
            built = MODELS.named(model).build(self.beam, count, **dict(key[2]))
            if n_modes > built.n_elastic:
                raise InputError(
                    f"mode = {n_modes}: the {model} model at count = {count} has {built.n_elastic} elastic modes, "
                    "raise count"
                )
            self._modes[key] = built.modes(n_modes)
        return self._modes[key]

    def _key(self, model: str, count: int, settings: Settings) -> tuple[str, int, Settings]:
        names = MODELS.named(model).settings()
        return model, count, tuple(setting for setting in settings if setting[0] in names)

    def exact_hz(self, mode: int, theory: str = EULER) -> float:
        """The exact frequency by a theory, Hz. Raises InputError."""
        return ExactModel(self.beam, theory).frequency_hz(mode)  # which stores its roots

    def frequency_hz(self, model: str, count: int, mode: int, settings: Settings = ()) -> float:
        """The frequency of rank `mode`, Hz; model "mean" is the middle of the bracket."""
        if model == MEAN:
            return self.bracket(mode, count, settings).mean
        return float(self.modes(model, count, mode, settings).frequencies_hz[mode - 1])

    def paired_frequency_hz(self, model: str, count: int, mode: int, settings: Settings = ()) -> float:
        """The frequency of the computed mode that pairs with exact mode `mode` (`paired_index`), Hz."""
        if model == MEAN:
            return self.bracket(mode, count, settings).mean
        index = self.paired_index(model, count, mode, settings)
        return float(self.modes(model, count, mode, settings).frequencies_hz[index])

    def paired_index(self, model: str, count: int, mode: int, settings: Settings = ()) -> int:
        """Index of the computed mode that pairs by MAC with exact mode `mode`. Raises InputError.

        By rank for non-uniform beams and other theories, whose exact shapes are expensive.
        """
        if not self.beam.uniform or theory_of(settings) != EULER:
            return mode - 1

        def paired() -> int:
            modes = self.modes(model, count, mode, settings)
            stride = max(len(modes.points) // (16 * modes.n_modes + 64), 1)
            exact = ExactModel(self.beam, EULER).modes(modes.n_modes).deflection(modes.points[::stride])
            return comparison.paired_index(modes, exact, mode, stride)

        return self.once(("index", *self._key(model, count, settings), mode), paired)

    def frequency_error(self, model: str, count: int, mode: int, settings: Settings = ()) -> float:
        """Signed error relative to the exact frequency by the same theory. Raises InputError."""
        exact = self.exact_hz(mode, theory_of(settings))
        return comparison.relative_error(self.paired_frequency_hz(model, count, mode, settings), exact)

    def error_or_reason(self, model: str, count: int, mode: int, settings: Settings = ()) -> tuple[float | None, str]:
        """(signed frequency error, '') or (None, reason)."""
        try:
            return self.frequency_error(model, count, mode, settings), ""
        except InputError as error:
            return None, str(error)

    def bracket(self, mode: int, count: int, settings: Settings = ()) -> Bracket:
        """Segments below and Hermite elements above the exact frequency, Hz. Raises NoBracketError.

        Valid for uniform beams of equal parts without a clamped end (checked for all modes and supports, N = 2..24),
        and with order 2 for clamped ends with the wall joint 2EI/l. The error of the dispersion decides whether the
        bound is wider than rounding.
        """
        if why := unproven(self.beam, settings):
            raise NoBracketError(f"mode.bracket: {why}")
        lower, upper = (self.frequency_hz(model.name, count, mode, settings) for model in bounding())
        expected = 2.0 * leading_error(bounding()[1].name, self.beam.supports, mode, count)
        width = min((upper - lower) / upper, expected)
        if not width > max(10.0 * comparison.EIGENVALUE_FLOOR, 1e-16 * count):
            raise NoBracketError(
                f"mode.bracket: at count = {count} its width {width:.0e} is below the eigenvalue error, use a smaller "
                "count"
            )
        return Bracket(lower, upper)

    def shape_error(
        self, model: str, count: int, mode: int, reading: str | None = None, settings: Settings = ()
    ) -> float:
        """Relative L2 error of the mass-normalised deflection at the model's nodes. Raises InputError."""
        modes = self.modes(model, count, mode, settings)
        exact = self.exact_shape(mode, modes.nodes, theory=theory_of(settings))
        shape = modes.at_nodes(reading)[self.paired_index(model, count, mode, settings)]
        mass = sum(piece.mass_per_length * piece.length for piece in self.beam.pieces)
        return comparison.shape_error(exact, shape, comparison.node_weights(modes.nodes), mass**-0.5)

    def exact_shape(self, mode: int, x: Array, derivative: int = 0, theory: str = EULER) -> Array:
        """The exact mass-normalised shape or a derivative at x (m), (len(x),), by a theory. Raises InputError."""
        return ExactModel(self.beam, theory).mode_shape(mode, x, derivative)
