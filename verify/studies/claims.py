"""Published claims beside what is found, with the condition under which it was found. They are shown, not judged."""

from collections.abc import Callable
from typing import TYPE_CHECKING

import msgspec

from verify.errors import InputError
from verify.quantities.catalogue import arguments_of, evaluate, needs_of, quantity
from verify.scenes.claims import READ, Claim

if TYPE_CHECKING:
    from verify.judge.workbench import Need, Workbench
    from verify.scenes.scene import Scene
    from verify.studies.slider import MotionStudy


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


def claim_needs(claim: Claim, scene: "Scene") -> "tuple[Need, ...]":
    """The solves a claim will ask for; a run of the slider brings its own. Raises InputError where it is wrong."""
    found = quantity(claim.quantity)
    return () if is_of_study(claim, scene) else needs_of(found, arguments_of(found, claim.arguments), scene)


def is_of_study(claim: Claim, scene: "Scene") -> bool:
    """Whether it is found on the runs of the scene's slider study."""
    return claim.of_run and scene.slider is not None and scene.motion is not None


def claim_results(
    scene: "Scene", bench: "Workbench", study: "MotionStudy | None", progress: Callable[[str], None]
) -> tuple[ClaimResult, ...]:
    """Every claim of a scene. One that cannot be evaluated says why."""
    found = []
    for claim in scene.claim:
        progress(f"claim {claim.id}")
        of_run = study is not None and is_of_study(claim, scene)
        found.append(_on_the_run(claim, study) if study and of_run else _alone(claim, scene, bench))
    return tuple(found)


def _on_the_run(claim: Claim, study: "MotionStudy") -> ClaimResult:
    """On the scene's own slider: the chain's figure, the exact beam's beside it."""
    chain, exact = (study.figures[model].get(claim.quantity) for model in ("segment", "analytic"))
    ended = chain is not None
    return _result(
        claim,
        quantity(claim.quantity).unit,
        chain,
        exact,
        study.conditions["segment"].words,
        "" if ended else "the slider did not reach the end of the run",
    )


def _alone(claim: Claim, scene: "Scene", bench: "Workbench") -> ClaimResult:
    """As `verify measure` finds it."""
    given = ", ".join(f"{name} = {value}" for name, value in claim.arguments.items())
    unit = ""
    try:
        found = quantity(claim.quantity)
        unit = found.unit
        value = evaluate(found, arguments_of(found, claim.arguments), scene, bench)
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
