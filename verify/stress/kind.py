"""What a row of the stress table is: a promise, a way to measure it, and what comes of it."""

from collections.abc import Callable, Iterable
from math import exp, inf, isfinite, isnan, log
from time import perf_counter
from typing import ClassVar, Literal, TypeAlias

import msgspec

from verify.errors import InputError
from verify.models.compiling import Call

Kind: TypeAlias = Literal["floor", "refusal", "growth"]
Figure: TypeAlias = Callable[[float], float]
"""A value it is pushed to -> an error, a cost."""
Points: TypeAlias = tuple[tuple[float, float], ...]
HALVINGS = 8
"""Of the gap between a value that holds and one that breaks."""


class Outcome(msgspec.Struct, frozen=True, kw_only=True):
    """What became of a row."""

    id: str
    title: str
    kind: Kind
    promise: float | str
    """The most that is allowed, or who is named when it is refused."""
    measured: float | str | None
    """The worst figure, the sentence of the refusal; None where there is none."""
    held: bool
    unit: str
    margin: float | None
    """Promise over measured."""
    value: float | None
    """Where it breaks, else what it was pushed to."""
    along: str
    """What that value is of."""
    breaks: bool
    """Whether it breaks at the value, or is refused from there on."""
    seconds: float
    beside: float | None
    """The textbook way's figure."""
    textbook: str
    """Which way that is."""
    why: str
    """Where the promise comes from."""
    reason: str = ""
    """Why it is not held."""
    points: Points = ()
    beside_points: Points = ()
    said: tuple[str, ...] = ()
    """Sentences of a row of several refusals."""

    @property
    def share(self) -> float:
        """Measured over promised; 0 of a refusal that came, infinite where nothing was measured."""
        if self.kind == "refusal":
            return 0.0 if self.held else inf
        if isinstance(self.measured, float) and isinstance(self.promise, float):
            return self.measured / self.promise
        return inf


class Row(msgspec.Struct, frozen=True, kw_only=True, eq=False):
    """One promise: `run` keeps it or shows where it breaks."""

    kind: ClassVar[Kind]
    id: str
    title: str
    why: str
    """Where the promise comes from."""
    along: str
    """What is pushed, in its unit: 'segments', 'm'."""
    at: tuple[float, ...]
    """Values for which it is promised, ascending towards what is hard."""
    unit: str = "1"
    """Of promise and figure."""
    beside: Figure | None = None
    """The textbook way measured the same."""
    textbook: str = ""
    beside_at: tuple[float, ...] = ()
    """Where that is measured; at the same values unless given."""
    seconds: float = 1.0
    """An estimate from above."""
    quick: bool = True
    """Whether a scene takes it unless it names rows."""
    kernels: Callable[[], Iterable[Call]] = tuple
    """Compiled loops that it runs, called with values of the right kinds."""

    def run(self) -> Outcome:
        """Measure it. Never raises for what it measures."""
        raise NotImplementedError

    @property
    def promised(self) -> float | str:
        """The figure or the words."""
        raise NotImplementedError

    def _outcome(
        self,
        began: float,
        promise: float | str,
        measured: float | str | None,
        reason: str,
        points: Points = (),
        broken: float | None = None,
        beside: float | None = None,
        beside_points: Points = (),
    ) -> Outcome:
        margin = promise / measured if isinstance(measured, float) and isinstance(promise, float) and measured else None
        return Outcome(
            id=self.id,
            title=self.title,
            kind=self.kind,
            promise=promise,
            measured=measured,
            held=not reason,
            unit=self.unit,
            margin=margin,
            value=self.at[-1] if broken is None else broken,
            along=self.along,
            breaks=broken is not None,
            seconds=perf_counter() - began,
            beside=beside,
            textbook=self.textbook,
            why=self.why,
            reason=reason,
            points=points,
            beside_points=beside_points,
        )

    def _beside(self) -> Points:
        """The textbook way's figures; what it raises or is no number counts as endless."""
        return tuple((v, _tried(self.beside, v)) for v in self.beside_at or self.at) if self.beside else ()


def _tried(figure: Figure, value: float) -> float:
    import warnings

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            found = float(figure(value))
        except Exception:  # it is the textbook's, which breaks as it likes
            return inf
    return inf if isnan(found) else found


class Floor(Row, frozen=True, kw_only=True, eq=False):
    """An error that stays below a promise for all values, and where it leaves it beyond them."""

    kind: ClassVar[Kind] = "floor"
    promise: float
    error: Figure
    """Raises InputError where the value is refused."""
    beyond: tuple[float, ...] = ()
    """Values past the promise, to find where it breaks or is refused."""

    @property
    def promised(self) -> float:
        """The largest error."""
        return self.promise

    def run(self) -> Outcome:
        """The worst error where it is promised, and the value at which it leaves the promise."""
        began, points, reason, broken = perf_counter(), [], "", None
        for value in self.at:
            found, why = self._at(value)
            points.append((value, found))
            if found > self.promise and not reason:
                reason = why or f"{found:.3g} at {value:g} {self.along}, and at most {self.promise:g} is promised"
                broken = self._edge(points[-2][0], value) if len(points) > 1 else value
        last = self.at[-1]
        for value in self.beyond if not reason else ():
            if self._at(value)[0] > self.promise:
                broken = self._edge(last, value)
                break
            last = value
        worst = max(found for _, found in points)
        beside = self._beside()
        return self._outcome(
            began,
            self.promise,
            worst if isfinite(worst) else None,
            reason,
            tuple(points),
            broken,
            max((found for _, found in beside), default=None),
            beside,
        )

    def _at(self, value: float) -> tuple[float, str]:
        """(the error, endless where it is none, why)."""
        try:
            found = float(self.error(value))
        except InputError as error:
            return inf, f"refused at {value:g} {self.along}: {error}"
        return (found, "") if isfinite(found) else (inf, f"no number at {value:g} {self.along}")

    def _edge(self, good: float, bad: float) -> float:
        """The least value found to break between two of one sign; the second where they are not."""
        whole = float(good).is_integer() and float(bad).is_integer() and abs(bad) > 1.0
        for _ in range(HALVINGS if good * bad > 0.0 else 0):
            middle = exp(0.5 * (log(abs(good)) + log(abs(bad)))) * (1.0 if bad > 0.0 else -1.0)
            middle = float(round(middle)) if whole else middle
            if self._at(middle)[0] > self.promise:
                bad = middle
            else:
                good = middle
        return bad


class Refusal(Row, frozen=True, kw_only=True, eq=False):
    """Values refused in a sentence that says certain words, and values beside them that are not refused."""

    kind: ClassVar[Kind] = "refusal"
    names: tuple[str, ...]
    """Words of the sentence, the field first."""
    ask: Callable[[float], object]
    """Raises InputError."""
    taken: tuple[float, ...] = ()
    """Values that are not refused."""

    @property
    def promised(self) -> str:
        """What the sentence says."""
        return f"InputError names {' and '.join(self.names)}"

    def run(self) -> Outcome:
        """The last sentence, or why the promise is not held."""
        began, said, reason, broken = perf_counter(), "", "", None
        for value in self.at:
            said, why = self._refused(value)
            if why and not reason:
                reason, broken = why, value
        for value in self.taken:
            found, _ = self._refused(value)
            if found and not reason:
                reason, broken = f"refused at {value:g} {self.along}, where it is promised: {found}", value
        beside = self._beside()
        worst = max((found for _, found in beside), default=None)
        return self._outcome(began, self.promised, said or None, reason, (), broken, worst, beside)

    def _refused(self, value: float) -> tuple[str, str]:
        """(the sentence or '', what is wrong with it)."""
        try:
            self.ask(value)
        except InputError as error:
            missing = [word for word in self.names if word not in str(error)]
            return str(error), f"{error} does not name {missing[0]}" if missing else ""
        except Exception as error:  # whatever else comes is the traceback that was promised away
            return "", f"{type(error).__name__} at {value:g} {self.along} in place of a sentence: {error}"
        return "", f"not refused at {value:g} {self.along}"


class Growth(Row, frozen=True, kw_only=True, eq=False):
    """A cost over sizes, with the exponent fitted to it."""

    kind: ClassVar[Kind] = "growth"
    promise: float
    """Of the exponent."""
    cost: Figure
    of: str
    """The unit of the cost."""
    rounds: int = 1
    """In which all sizes take turns; the least of each is kept."""

    @property
    def promised(self) -> float:
        """The largest exponent."""
        return self.promise

    def run(self) -> Outcome:
        """The exponent over all sizes."""
        began = perf_counter()
        try:
            points = self._least(self.cost, self.at)
        except InputError as error:
            return self._outcome(began, self.promise, None, f"refused: {error}")
        found = exponent(points)
        beside = self._least(self.beside, self.beside_at or self.at) if self.beside else ()
        reason = "" if found <= self.promise else f"grows like N^{found:.3g}, and N^{self.promise:g} is promised"
        worst = exponent(beside) if beside else None
        return self._outcome(began, self.promise, found, reason, points, None, worst, beside)

    def _least(self, cost: Figure, sizes: Iterable[float]) -> Points:
        sizes = tuple(sizes)
        rows = [[cost(size) for size in sizes] for _ in range(self.rounds)]
        return tuple((size, min(column)) for size, column in zip(sizes, zip(*rows, strict=True), strict=True))


def exponent(points: Points) -> float:
    """The slope of ln cost over ln size by least squares."""
    x, y = [log(size) for size, _ in points], [log(cost) for _, cost in points]
    middle, level = sum(x) / len(x), sum(y) / len(y)
    rise = sum((a - middle) * (b - level) for a, b in zip(x, y, strict=True))
    return rise / sum((a - middle) ** 2 for a in x)
