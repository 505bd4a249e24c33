"""How much work a named figure of the nonlinear chain may be: counted first, in accelerations of one link.

One takes some 25 ns, so that the most stands for about ten seconds. Scripts that call the integrators themselves have
no such limit unless they give one.
"""

from math import ceil

from verify.errors import InputError

MOST = 4e8
"""Accelerations of links in one motion."""
OVERHEAD = 12
"""Links as whose accelerations the rest of an evaluation counts: short chains are not as cheap as they are short."""
DENSE_LINKS = 1000
"""Links of a chain whose modes are found by dense matrices: a second or two and 0.1 GiB."""
STATIC_LINKS = 20_000
"""Links of a chain in equilibrium: some seconds where the load has to be raised in parts."""
KEPT = 20_000_000
"""Angles and rates kept of one motion: 0.3 GiB."""
SAMPLES = 100_000
"""Times kept of one motion."""
PER_STRETCHING_STEP = 12
"""Accelerations of links in a step of a link that stretches, by time."""


def check_links(segments: int, least: int, most: int, why: str) -> None:
    """Raise InputError unless a chain has a number of links that suits a figure."""
    if not least <= segments <= most:
        raise InputError(f"segments = {segments}: {why}, give between {least} and {most}")


def check_modes_of(segments: int, least: int = 1) -> None:
    """Raise InputError for more links than dense matrices are for, or fewer than can move."""
    check_links(
        segments,
        least,
        DENSE_LINKS,
        "the modes of such a chain are found by dense matrices"
        if segments > 1
        else "a single link between two held ends cannot move",
    )


def check_kept(samples: float, links: int, field: str) -> None:
    """Raise InputError where a motion would be kept at too many times; `field` is what to change, with its value."""
    if samples > SAMPLES or samples * links > KEPT:
        raise InputError(
            f"{field} would keep {samples:.4g} states of {links} links: give one for at most "
            f"{min(SAMPLES, KEPT // links)} states"
        )


def refuse_work(work: float, most: float, seconds: float) -> None:
    """Raise InputError where a motion of so many seconds takes more accelerations of links than it may."""
    if work > most:
        raise InputError(
            f"time = {seconds:.6g} s takes about {work:.2g} accelerations of links and {most:.2g} are the most: give a "
            "shorter time, fewer segments, or a longer step or a larger tolerance"
        )


def per_evaluation(links: int) -> int:
    """Accelerations of links that one evaluation of a chain takes, by time."""
    return links + OVERHEAD


def fixed_steps(seconds: float, step: float) -> int:
    """How many steps of one length a time takes."""
    return ceil(min(seconds / step, 1e18))


def modal_work(seconds: float, step: float, kicks: int, links: int, modes: int) -> float:
    """Of kicks in modal coordinates, whose sums over modes cost a thirteenth of an acceleration for each, by time."""
    return fixed_steps(seconds, step) * kicks * links * (2.0 + modes / 13.0)
