"""Solutions of one beam by every model: each computed on first use and stored, and the comparisons made from them."""

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, TypeAlias

from verify.errors import InputError, NoBracketError
from verify.linear.catalogue import MODELS, bounding, discrete
from verify.linear.naming import MEAN
from verify.problem.beam import Beam

if TYPE_CHECKING:
    from verify.analysis.bracket import Bracket
    from verify.arrays import Array
    from verify.linear.fields import HarmonicField
    from verify.linear.modes import Modes
    from verify.linear.sweeps import HarmonicSweep
    from verify.motion.result import Motion

EULER = "euler-bernoulli"
Settings: TypeAlias = tuple[tuple[str, str | float], ...]
"""Keyword settings of a model's solve_modes other than their defaults, for instance (("wall", "half"),)."""


def theory_of(settings: Settings) -> str:
    """The beam theory among the settings of a model."""
    return str(dict(settings).get("theory", EULER))


def for_model(model: str, settings: Settings) -> Settings:
    """The settings that a model has: walls and joints are those of segments."""
    known = MODELS.named(model).modal_settings
    return tuple((name, value) for name, value in settings if name in known)


def no_such_mode(mode: int, model: str, count: int, available: int) -> str:
    """Message for a mode number above the number of elastic modes of a model."""
    return f"mode = {mode}: the {model} model at count = {count} has {available} elastic modes, raise count"


def check_bracket(beam: Beam, settings: Settings = ()) -> None:
    """Raise NoBracketError, with the reason, where segments below and elements above is not proven."""
    chosen = dict(settings)
    wall, theory = chosen.get("wall", "gregory"), theory_of(settings)
    added = [name for name in beam.added if name != "section"]
    above = "the chain may lie above the exact frequency"
    if added:
        raise NoBracketError(f"mode.bracket: on a beam with beam.{added[0]} neither side is proven, leave it out")
    if beam.section:
        raise NoBracketError(f"mode.bracket: on a stepped beam {above}, leave beam.section out")
    if theory != EULER:
        raise NoBracketError(f"mode.bracket: with theory = {theory!r} {above}, leave theory out")
    if "grading" in chosen:
        raise NoBracketError(f"mode.bracket: with grading = {chosen['grading']!r} {above}, leave grading out")
    if "clamped" in beam.supports and wall != "half":
        raise NoBracketError(f"mode.bracket: with wall = {wall!r} at a clamped end {above}, wall=half bounds it")


def has_bracket(beam: Beam, settings: Settings = ()) -> bool:
    """Whether segments lie below and elements above the exact frequencies of this beam."""
    try:
        check_bracket(beam, settings)
    except NoBracketError:
        return False
    return True


def comparable(beam: Beam, counts: Iterable[int], n_modes: int) -> tuple[list[str], dict[str, str]]:
    """(discrete models that solve this beam at these sizes, reason by name for models of other packages that do not).

    Raises InputError for a size that a model of this package cannot solve.
    """
    names, skipped, sizes = [], {}, tuple(counts)
    for model in discrete():
        try:
            if why := model.refuses(beam):
                raise InputError(why)
            solvable = [max(min(n_modes, model.n_elastic(beam, count)), 1) for count in sizes]
            for n, count in zip(solvable, sizes, strict=True):
                model.check(beam, n, count)
            if model.name not in MODELS.built_in:
                model.solve_modes(beam, solvable[0], sizes[0])
            names.append(model.name)
        except InputError as problem:
            if model.name in MODELS.built_in:
                raise
            skipped[model.name] = f"model {model.name} is skipped: {problem}"
    return names, skipped


class SolutionCache:
    """The models of one beam. Each solution is computed on first use and stored.

    A request for more modes than are stored solves again: ask for the highest mode first.
    """

    def __init__(self, beam: Beam) -> None:
        self.beam = beam
        self.progress: Callable[[float], None] = lambda fraction: None
        """Called with the completed fraction of a long time integration."""
        self.fields: dict[Any, HarmonicField] = {}
        """Harmonic fields by everything that determines them."""
        self.sweeps: dict[Any, HarmonicSweep] = {}
        """Harmonic fields over frequencies, likewise."""
        self.motions: dict[Any, Motion] = {}
        """Time integrations of a beam, with or without a slider, likewise."""
        self.motors: dict[Any, Any] = {}
        """Steady states and free runs of a motor, likewise."""
        self._modes: dict[tuple[str, int, Settings], Modes] = {}
        self._index: dict[tuple[str, int, Settings, int], int] = {}
        self._exact: dict[tuple[int, str], float] = {}

    def modes(self, model: str, count: int, n_modes: int, settings: Settings = ()) -> "Modes":
        """At least `n_modes` modes of a discrete model. Raises InputError."""
        key = (model, count, for_model(model, settings))
        stored = self._modes.get(key)
        if stored is not None and stored.n_modes >= n_modes:
            return stored
        chosen, solver = dict(key[2]), MODELS.named(model)
        available = solver.n_elastic(self.beam, count, **chosen)
        if n_modes > available:
            raise InputError(no_such_mode(n_modes, model, count, available))
        self._modes[key] = solver.solve_modes(self.beam, n_modes, count, **chosen)
        return self._modes[key]

    def exact_hz(self, mode: int, theory: str = EULER) -> float:
        """The exact frequency by a theory, Hz, in closed form or as a root. Raises InputError."""
        if (mode, theory) not in self._exact:
            if self.beam.uniform and theory == EULER:
                from verify.exact.closed_forms import frequency_hz

                self._exact[mode, theory] = frequency_hz(self.beam, mode)
            else:
                from verify.exact.modes import exact_frequency_hz

                self._exact[mode, theory] = exact_frequency_hz(self.beam, mode, theory)
        return self._exact[mode, theory]

    def frequency_hz(self, model: str, count: int, mode: int, settings: Settings = ()) -> float:
        """The frequency of mode number `mode` by rank, Hz; model "mean" is the middle of the bracket."""
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

        By rank on beams that are not uniform and by other theories, where exact shapes are expensive.
        """
        if not self.beam.uniform or theory_of(settings) != EULER:
            return mode - 1
        key = (model, count, for_model(model, settings), mode)
        if key not in self._index:
            from verify.analysis.compare import paired_index
            from verify.exact.modes import solve_modes

            modes = self.modes(model, count, mode, settings)
            stride = max(len(modes.points) // (16 * modes.n_modes + 64), 1)
            exact = solve_modes(self.beam, modes.n_modes).deflection(modes.points[::stride])
            self._index[key] = paired_index(modes, exact, mode, stride)
        return self._index[key]

    def frequency_error(self, model: str, count: int, mode: int, settings: Settings = ()) -> float:
        """Signed error relative to the exact frequency by the same theory. Raises InputError."""
        from verify.analysis.compare import relative_error

        exact = self.exact_hz(mode, theory_of(settings))
        return relative_error(self.paired_frequency_hz(model, count, mode, settings), exact)

    def error_or_why(self, model: str, count: int, mode: int, settings: Settings = ()) -> tuple[float | None, str]:
        """(signed frequency error, '') or (None, the reason why there is none)."""
        try:
            return self.frequency_error(model, count, mode, settings), ""
        except InputError as error:
            return None, str(error)

    def bracket(self, mode: int, count: int, settings: Settings = ()) -> "Bracket":
        """Segments below and Hermite elements above the exact frequency, Hz. Raises NoBracketError.

        Holds for uniform beams of equal parts without a clamped end (checked on every mode and support for
        N = 2..24), and loosely, with order 2, for clamped ends with the wall joint 2EI/l.
        """
        from verify.analysis.compare import EIGENVALUE_FLOOR, bracket
        from verify.exact.error_laws import leading_error

        check_bracket(self.beam, settings)
        lower, upper = bounding()
        width = 2.0 * leading_error(upper.name, self.beam.supports, mode, count)
        if width < max(10.0 * EIGENVALUE_FLOOR, 1e-16 * count):
            raise NoBracketError(
                f"mode.bracket: at count = {count} its width {width:.0e} is below the eigenvalue error, use a smaller "
                "count"
            )
        return bracket(*(self.frequency_hz(model.name, count, mode, settings) for model in (lower, upper)))

    def shape_error(
        self, model: str, count: int, mode: int, reading: str | None = None, settings: Settings = ()
    ) -> float:
        """Relative L2 error of the mass-normalised deflection at the model's nodes. Raises InputError."""
        from verify.analysis.compare import node_weights, shape_error
        from verify.exact.modes import mode_shape

        modes = self.modes(model, count, mode, settings)
        if reading is not None and reading not in modes.readings:
            raise InputError(f"reading = {reading!r} is none of the {model} model's: {', '.join(modes.readings)}")
        read = modes.readings[reading or next(iter(modes.readings))]
        exact = mode_shape(self.beam, mode, modes.nodes, theory=theory_of(settings))
        shape = read()[self.paired_index(model, count, mode, settings)]
        mass = sum(piece.mass_per_length * piece.length for piece in self.beam.pieces)
        return shape_error(exact, shape, node_weights(modes.nodes), mass**-0.5)

    def curvature_error(self, model: str, count: int, mode: int, settings: Settings = ()) -> float:
        """Relative L2 error of the curvature at joints or Gauss points. Raises InputError."""
        from verify.analysis.compare import node_weights, shape_error
        from verify.exact.modes import mode_shape

        modes = self.modes(model, count, mode, settings)
        exact = mode_shape(self.beam, mode, modes.curvature_points, 2, theory_of(settings))
        computed = modes.curvatures()[self.paired_index(model, count, mode, settings)]
        return shape_error(exact, computed, node_weights(modes.curvature_points))

    def node_positions(self, model: str, count: int | None, mode: int, settings: Settings = ()) -> "Array":
        """Zeros of a mode between the ends, (n_nodes,), metres, ascending. Raises InputError."""
        from verify.analysis.compare import zeros
        from verify.exact.modes import mode_shape

        if count is None:
            theory = theory_of(settings)
            return zeros(lambda x: mode_shape(self.beam, mode, x, theory=theory), self.beam.length, mode)
        modes, index = self.modes(model, count, mode, settings), self.paired_index(model, count, mode, settings)
        return zeros(lambda x: modes.deflection(x)[index], self.beam.length, mode)
