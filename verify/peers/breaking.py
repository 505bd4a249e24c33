"""Each engine pushed until it breaks, and what it did: a value, never silence."""

import msgspec

from verify.errors import InputError
from verify.field_docs import Value
from verify.peers.case import Case
from verify.peers.catalogue import PEERS, adapter
from verify.peers.references import explicit_limit

OVER = 1.2
"""Of the explicit limit of the step."""
IMPLICIT_STEP, PULL = 2e-5, 1e11
"""Seconds, and by how much forces grow, where an engine has no such limit."""


class Break(Value, frozen=True, kw_only=True):
    """What one engine did."""

    engine: str
    """Its name."""
    links: int
    """Of the chain."""
    pushed: str
    """By what."""
    did: str
    """In words, with the time; empty where it did not break."""
    until: float
    """Time of the last sample that it gave, seconds."""
    asked: float
    """To which time it was to go, seconds."""
    steps: int
    """It took, good ones."""
    seconds: float
    """Wall time."""


def pushed(name: str, case: Case, end: float) -> Break:
    """One engine on a chain beyond what it bears: an explicit one in too long a step, an implicit one pulled too hard.

    Raises InputError for an engine that is not known or not installed.
    """
    peer = PEERS.named(name)
    if name not in PEERS.built_in:
        raise InputError(f"peer = {name!r}: how it breaks is known of {', '.join(PEERS.built_in)} alone")
    if peer.implicit:
        pulled = tuple(msgspec.structs.replace(one, amplitude=PULL * one.amplitude) for one in case.forces)
        case, step = msgspec.structs.replace(case, forces=pulled), IMPLICIT_STEP
        by = f"forces of {max(abs(force.amplitude) for force in pulled):.3g} N in steps of {1e6 * step:.3g} µs"
    else:
        step = OVER * explicit_limit(case)
        by = f"steps of {1e6 * step:.3g} µs, {OVER:g} times the explicit limit"
    run = adapter(peer).prepare(case, None)(step, end)
    return Break(
        engine=name,
        links=case.n,
        pushed=by,
        did=run.broke,
        until=float(run.times[-1]) if len(run.times) else 0.0,
        asked=end,
        steps=run.steps,
        seconds=run.seconds,
    )
