"""Published claims beside what is found, with the condition under which it was found. They are shown, not judged."""

from collections.abc import Iterator, Mapping
from contextlib import suppress
from itertools import groupby
from typing import TYPE_CHECKING, Any

import msgspec
from msgspec.structs import replace

from verify.errors import InputError
from verify.scenes.claims import READ, Claim
from verify.studies.kind import Progress, Study
from verify.studies.told import Column, Found, Table

if TYPE_CHECKING:
    from verify.judge.workbench import Workbench
    from verify.models.compiling import Call
    from verify.scenes.scene import Scene
    from verify.studies.slider.figures import SliderFound

LEAST_SHOWN = 1e-4


class ClaimResult(msgspec.Struct, frozen=True, kw_only=True):
    """One claim: who says what, what is found, whether it holds, and how it was found."""

    id: str
    source: str
    quantity: str
    unit: str
    claimed: str
    read: str
    """How it was read from its source, in words."""
    found: float | None
    """None where it cannot be evaluated."""
    exact: float | None
    """The same on the exact beam, where the claim is about the slider's run."""
    holds: bool | None
    exact_holds: bool | None
    condition: str
    """Kinematics, start, model and count of a slider's run; the arguments of any other quantity."""
    reason: str = ""
    """Why it cannot be evaluated."""

    @property
    def departure(self) -> float | None:
        """Of what is found from the exact beam's, relative; None without that."""
        if self.found is None or not self.exact:
            return None
        return self.found / self.exact - 1.0


def is_of_study(claim: Claim, scene: "Scene") -> bool:
    """Whether it is found on the runs of the scene's slider study."""
    return claim.of_run and scene.slider is not None and scene.motion is not None


class ClaimsFound(Found, frozen=True, eq=False, kw_only=True):
    """Every claim of a scene."""

    claims: tuple[ClaimResult, ...]

    def under(self, overrides: tuple[str, ...]) -> "ClaimsFound":
        """Each with what was set of what its figure is of: its source states it of the scene as it stands."""
        return replace(self, claims=tuple(_under(claim, overrides) for claim in self.claims))

    def in_short(self) -> str:
        """How many hold, of those that could be evaluated."""
        held, known = sum(c.holds is True for c in self.claims), sum(c.holds is not None for c in self.claims)
        if known == 1:
            return f"The one published figure {'holds' if held else 'fails'} under the condition told below."
        return f"Of {known} published figures {held} hold under the conditions told below." if known else ""

    def tables(self) -> tuple[Table, ...]:
        """A short one for the terminal, a wide one for the page."""
        return (*self._short(), self._wide())

    def _short(self) -> tuple[Table, ...]:
        """One for each condition."""
        return tuple(
            Table(
                title=f"published claims{f', found with {condition}' if condition else ''}",
                columns=(Column("", "verdict", left=True), Column("", left=True)),
                rows=tuple(
                    (c.holds, f"{c.id}: {claimed_words(c)}; found {found_words(c)}\n{c.source} ({c.read})")
                    for c in group
                ),
                shown="terminal",
            )
            for condition, group in groupby(self.claims, key=lambda claim: claim.condition)
        )

    def _wide(self) -> Table:
        return Table(
            columns=(
                Column("", "verdict", left=True),
                Column("claim", left=True),
                Column("claimed", left=True),
                Column("found", left=True),
                Column("exact beam", left=True),
                Column("source", left=True),
            ),
            rows=tuple(_page_cells(claim) for claim in self.claims),
            notes=(
                "Claims are shown beside what is found; the verdict of the run is that of its gates. Each holds or "
                "does not under the condition in its row and no other.",
            ),
        )

    def plain(self) -> Any:
        """Each with its departure from the exact beam's."""
        return [msgspec.to_builtins(one) | {"departure": one.departure} for one in self.claims]

    def records(self) -> list[dict[str, Any]]:
        """The same."""
        found: list[dict[str, Any]] = self.plain()
        return found


def _under(claim: ClaimResult, overrides: tuple[str, ...]) -> ClaimResult:
    about = [text for text in overrides if text.partition(".")[0].strip() in _tables_of(claim)]
    if not about:
        return claim
    tables = " and ".join(dict.fromkeys(text.partition(".")[0].strip() for text in about))
    told = f"another {tables} than the scene's own, --set {' '.join(about)}"
    return replace(claim, condition=", ".join(one for one in (claim.condition, told) if one))


def _tables_of(claim: ClaimResult) -> tuple[str, ...]:
    """What exists that its figure depends on; of a quantity that there is not, nothing."""
    from verify.quantities.catalogue import quantity

    try:
        reads: tuple[str, ...] = quantity(claim.quantity).arguments.reads
    except InputError:
        return ()
    return reads


def _page_cells(claim: ClaimResult) -> tuple[str | bool | None, ...]:
    off, other = off_words(claim), other_verdict(claim)
    beside = [value_words(claim.exact, claim.unit), *([f"found is {off}"] if off else []), *([other] if other else [])]
    source = f"{claim.source} ({claim.read})."
    source += f" Found with {claim.condition}." if claim.condition else ""
    return (
        claim.holds,
        f"{claim.id}, {claim.quantity}",
        claimed_words(claim),
        "–" if claim.found is None else value_words(claim.found, claim.unit),
        "; ".join(beside),
        source + (f" Cannot be evaluated: {claim.reason}" if claim.reason else ""),
    )


class ClaimsStudy(Study[tuple[Claim, ...], ClaimsFound]):
    """Those about the slider's run are found on the runs of its study, others as `verify measure` finds them."""

    name, title = "claims", "What the source says, and what is found"
    of_source = True
    listed = False
    nothing = ()

    def asked(self, scene: "Scene") -> tuple[Claim, ...] | None:
        """The scene's claims."""
        return scene.claim or None

    def skipped(self, scene: "Scene") -> str:
        """Without any."""
        return "the scene has no [[claim]]"

    def takes(self, asked: tuple[Claim, ...], scene: "Scene") -> tuple[str, ...]:
        """The slider's study, of whose run claims are."""
        return ("motion",) if any(is_of_study(claim, scene) for claim in asked) else ()

    def n_steps(self, asked: tuple[Claim, ...], scene: "Scene") -> int:
        """A step for each."""
        return len(asked)

    def kernels(self, asked: tuple[Claim, ...], scene: "Scene") -> "Iterator[Call]":
        """Those of every figure that is not of the slider's study."""
        from verify.quantities.catalogue import arguments_of, quantity

        for claim in asked:
            with suppress(InputError):
                if not is_of_study(claim, scene):
                    found = quantity(claim.quantity)
                    yield from found.kernels(arguments_of(found, claim.arguments), scene)

    def run(
        self, asked: tuple[Claim, ...], scene: "Scene", bench: "Workbench", done: Mapping[str, Found], step: Progress
    ) -> ClaimsFound:
        """Every claim of a scene. One that cannot be evaluated says why."""
        slid = _slider_of(done) if any(is_of_study(claim, scene) for claim in asked) else None
        results = []
        for claim in asked:
            step(f"claim {claim.id}")
            of_run = slid is not None and is_of_study(claim, scene)
            results.append(_on_the_run(claim, slid) if slid and of_run else _alone(claim, scene, bench))
        return ClaimsFound(claims=tuple(results))


def _slider_of(done: Mapping[str, Found]) -> "SliderFound | None":
    from verify.studies.slider.figures import SliderFound

    return next((found for found in done.values() if isinstance(found, SliderFound)), None)


def _on_the_run(claim: Claim, study: "SliderFound") -> ClaimResult:
    """On the scene's own slider: the chain's figure, the exact beam's beside it."""
    from verify.models.catalogue import bounding
    from verify.quantities.catalogue import quantity

    chain, exact = (study.figures[model].get(claim.quantity) for model in (bounding()[0].name, "analytic"))
    ended = chain is not None
    return _result(
        claim,
        quantity(claim.quantity).unit,
        chain,
        exact,
        study.condition.words,
        "" if ended else "the slider did not reach the end of the run",
    )


def _alone(claim: Claim, scene: "Scene", bench: "Workbench") -> ClaimResult:
    """As `verify measure` finds it."""
    from verify.quantities.catalogue import arguments_of, evaluate, needs_of, quantity

    given = ", ".join(f"{name} = {value}" for name, value in claim.arguments.items())
    unit = ""
    try:
        found = quantity(claim.quantity)
        unit = found.unit
        arguments = arguments_of(found, claim.arguments)
        needs_of(found, arguments, scene)  # which refuses what a plan knows will fail, before anything is solved for it
        value = evaluate(found, arguments, scene, bench)
        if not isinstance(value, float | int):
            raise InputError(f"{claim.quantity} is no real number, which a claim compares with: claim another figure")
    except InputError as error:
        return _result(claim, unit, None, None, given, str(error))
    except Exception as error:
        return _result(claim, unit, None, None, given, f"{type(error).__name__}: {error}")
    return _result(claim, unit, float(value), None, given, "")


def _result(
    claim: Claim, unit: str, found: float | None, exact: float | None, condition: str, reason: str
) -> ClaimResult:
    return ClaimResult(
        id=claim.id,
        source=claim.source,
        quantity=claim.quantity,
        unit=unit,
        claimed=claim.in_words,
        read=READ[claim.read],
        found=found,
        exact=exact,
        holds=None if found is None else claim.holds(found),
        exact_holds=None if exact is None else claim.holds(exact),
        condition=condition,
        reason=reason,
    )


def value_words(value: float | None, unit: str) -> str:
    """A figure with its unit."""
    return "–" if value is None else f"{value:+.5g}" + unit_words(unit)


def unit_words(unit: str) -> str:
    """A unit behind a number; nothing where there is none."""
    return "" if unit in ("", "1") else f" {unit}"


def claimed_words(claim: "ClaimResult") -> str:
    """What is claimed, with its unit where it is a number."""
    return claim.claimed + ("" if claim.claimed in ("negative", "positive") else unit_words(claim.unit))


def off_words(claim: "ClaimResult") -> str:
    """How far what is found lies from the exact beam's; nothing where it does not."""
    far = claim.departure is not None and abs(claim.departure) >= LEAST_SHOWN
    return f"{100 * claim.departure:+.2g} % off" if claim.departure is not None and far else ""


def other_verdict(claim: "ClaimResult") -> str:
    """What the exact beam says of a claim, where it says otherwise."""
    if claim.exact_holds is None or claim.exact_holds == claim.holds:
        return ""
    return "there it holds" if claim.exact_holds else "there it does not hold"


def found_words(claim: "ClaimResult") -> str:
    """What was found, with the exact beam's beside it and the distance between them."""
    if claim.found is None:
        return f"cannot be evaluated: {claim.reason}"
    text = value_words(claim.found, claim.unit)
    if claim.exact is None:
        return text
    beside = (value_words(claim.exact, claim.unit), off_words(claim), other_verdict(claim))
    return f"{text} (exact beam {', '.join(part for part in beside if part)})"
