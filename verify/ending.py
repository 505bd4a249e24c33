"""Requests to end, as exceptions like any other: so nothing half-written is left."""

import signal
import sys
from collections.abc import Callable
from types import FrameType
from typing import NoReturn

TERMINATED = 143
"""The status of who was told to end."""
AGAIN_S = 0.02
"""After how many seconds one that would be lost is heard again."""
Answer = Callable[[int, FrameType | None], object]
Lost = Callable[["sys.UnraisableHookArgs"], object]


def end_tidily() -> None:
    """Hear requests to end, unless somebody else does already."""
    for number in {signal.SIGTERM, getattr(signal, "SIGHUP", signal.SIGTERM)}:
        if signal.getsignal(number) is signal.SIG_DFL:
            signal.signal(number, put_off(_end))
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, put_off(signal.default_int_handler))
    sys.unraisablehook = _asking_again(sys.unraisablehook)


def _asking_again(told: Lost) -> Lost:
    """What hears of exceptions lost where they come up, as in a destructor: a request to end is made again."""

    def heard(lost: "sys.UnraisableHookArgs") -> None:
        if isinstance(lost.exc_value, SystemExit) and lost.exc_value.code == TERMINATED:
            signal.signal(signal.SIGTERM, put_off(_end))
            _again(signal.SIGTERM)
        elif isinstance(lost.exc_value, KeyboardInterrupt):
            _again(signal.SIGINT)
        else:
            told(lost)

    return heard


def _end(number: int, frame: FrameType | None) -> NoReturn:
    signal.signal(number, signal.SIG_IGN)
    sys.exit(TERMINATED)


def put_off(answer: Answer) -> Answer:
    """The answer to a signal, heard again a little later where what it raises would be printed and lost.

    That is where LLVM has what it compiled written down and where its objects are taken down, and where a module that
    sleeps is read because somebody imports it: Python raises nothing through the C that calls it there. The run went on
    as if nobody had asked, and with half a module.
    """

    def heard(number: int, frame: FrameType | None) -> None:
        if not _is_lost(frame):
            answer(number, frame)
            return
        _again(number)

    return heard


def _again(number: int) -> None:
    """Have this thread hear a signal once more, a little later."""
    from threading import Timer, get_ident

    again = Timer(AGAIN_S, _ask, (get_ident(), number))
    again.daemon = True
    again.start()


def _ask(thread: int, number: int) -> None:
    """Send a signal to the thread that hears, which wakes where it waits; raise it here where that cannot be done."""
    if hasattr(signal, "pthread_kill"):
        signal.pthread_kill(thread, number)
    else:
        signal.raise_signal(number)


def _is_lost(frame: FrameType | None) -> bool:
    """Whether LLVM's binding is at work, or the reading of a module that sleeps, here or in who called."""
    while frame is not None:
        of = frame.f_globals
        sleeps = of.get("__name__") == "importlib.util" and frame.f_code.co_name == "__getattribute__"
        if sleeps or of.get("__package__") == "llvmlite.binding":
            return True
        frame = frame.f_back
    return False
