"""Where models are solved: lazily, once for everybody who asks, with a record of what it cost."""

from collections.abc import Iterable
from time import perf_counter
from typing import TYPE_CHECKING, Any, Literal

import msgspec

from verify.beam import Beam
from verify.errors import InputError, NoBracketError

if TYPE_CHECKING:
    from verify.compare import Bracket
    from verify.modes import Modes

Discrete = Literal["fem", "segment"]
_MODULES = {"fem": "verify.fem_beam", "segment": "verify.segment_model"}


class Need(msgspec.Struct, frozen=True):
    """A solve that somebody will ask for."""

    model: str
    count: int
    n_modes: int


class Solve(msgspec.Struct, frozen=True):
    """A solve that was done, and what it cost."""

    model: str
    count: int
    n_modes: int
    unknowns: int
    method: str
    seconds: float


def model_module(model: str) -> Any:
    """The module of a discrete model, imported when first asked for."""
    from importlib import import_module

    return import_module(_MODULES[model])


def merged(needs: Iterable[Need]) -> dict[tuple[str, int], int]:
    """(model, count) -> the most modes anybody wants of it."""
    wanted: dict[tuple[str, int], int] = {}
    for need in needs:
        key = (need.model, need.count)
        wanted[key] = max(need.n_modes, wanted.get(key, 0))
    return wanted


class Workbench:
    """The models of one beam. Everything is solved when first asked for, and kept."""

    def __init__(self, beam: Beam, needs: Iterable[Need] = ()) -> None:
        """`needs` says what will be asked, so that a size is solved once for all who want it."""
        self.beam = beam
        self.solves: list[Solve] = []
        self._wanted = merged(needs)
        self._modes: dict[tuple[str, int], Modes] = {}
        self._index: dict[tuple[str, int, int], int] = {}

    def modes(self, model: str, count: int, n_modes: int) -> "Modes":
        """At least `n_modes` modes of a discrete model. Raises InputError."""
        key = (model, count)
        held = self._modes.get(key)
        if held is None or held.n_modes < n_modes:
            held = self._modes[key] = self._solve(model, count, max(n_modes, self._wanted.get(key, 0)), n_modes)
        return held

    def _solve(self, model: str, count: int, n_wanted: int, n_needed: int) -> "Modes":
        module = model_module(model)
        # what others wish for must not fail the one who asks for less, so theirs is cut to what there is
        available = module.n_elastic(self.beam, count)
        if n_needed > available:
            raise InputError(
                f"mode = {n_needed}: the {model} model at count = {count} has {available} elastic modes, raise count"
            )
        n_modes = min(n_wanted, available)
        start = perf_counter()
        modes: Modes = module.solve_modes(self.beam, n_modes, count)
        seconds = perf_counter() - start
        unknowns = module.unknowns(self.beam, count)
        self.solves.append(Solve(model, count, n_modes, unknowns, modes.method, seconds))
        return modes

    def frequency_hz(self, model: str, count: int, mode: int) -> float:
        """The frequency of mode number `mode` by rank, Hz; model "mean" is the middle of the bracket."""
        if model == "mean":
            return self.bracket(mode, count).mean
        return float(self.modes(model, count, mode).frequencies_hz[mode - 1])

    def paired_frequency_hz(self, model: str, count: int, mode: int) -> float:
        """The frequency of the computed mode whose shape is that of exact mode `mode`, Hz. Raises PairingError."""
        if model == "mean":
            return self.bracket(mode, count).mean
        index = self.paired_index(model, count, mode)
        return float(self.modes(model, count, mode).frequencies_hz[index])

    def paired_index(self, model: str, count: int, mode: int) -> int:
        """Where among the computed modes the one stands that looks like exact mode `mode`. Raises PairingError."""
        key = (model, count, mode)
        if key not in self._index:
            from verify import analytic_modes, compare

            modes = self.modes(model, count, mode)
            stride = max(len(modes.points) // (16 * modes.n_modes + 64), 1)
            exact = analytic_modes.solve_modes(self.beam, modes.n_modes).deflection(modes.points[::stride])
            self._index[key] = compare.paired_index(modes, exact, mode, stride)
        return self._index[key]

    def frequency_error(self, model: str, count: int, mode: int) -> float:
        """Signed, relative to the exact Euler-Bernoulli frequency. Raises InputError."""
        from verify import closed_forms, compare

        exact = closed_forms.frequency_hz(self.beam, mode)
        return compare.relative_error(self.paired_frequency_hz(model, count, mode), exact)

    def bracket(self, mode: int, count: int) -> "Bracket":
        """Segments below and Hermite elements above the exact frequency, Hz.

        Proved by the closed forms for pinned-pinned beams of equal parts. Raises NoBracketError.
        """
        from verify import compare

        if self.beam.supports != ("pinned", "pinned"):
            raise NoBracketError(
                f"beam.supports = {self.beam.supports!r}: the two-sided bound is for pinned-pinned beams"
            )
        return compare.bracket(self.frequency_hz("segment", count, mode), self.frequency_hz("fem", count, mode))

    def shape_error(self, model: str, count: int, mode: int, reading: str | None = None) -> float:
        """Relative L2 error of the mass-normalised deflection at the model's nodes. Raises InputError."""
        from verify import analytic_modes, compare

        modes = self.modes(model, count, mode)
        if reading is not None and reading not in modes.readings:
            raise InputError(f"reading = {reading!r} is none of the {model} model's: {', '.join(modes.readings)}")
        read = modes.readings[reading or next(iter(modes.readings))]
        exact = analytic_modes.mode_shape(self.beam, mode, modes.nodes)
        return compare.shape_error(exact, read()[self.paired_index(model, count, mode)])
