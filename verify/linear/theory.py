"""Which theory of a beam is asked for, and whether a beam has what it takes."""

from verify.checks import check_word
from verify.errors import InputError
from verify.options import THEORIES
from verify.problem.beam import Beam

_TAKES = {"rayleigh": ("rotary_inertia",), "timoshenko": ("rotary_inertia", "shear_stiffness")}
"""Figures of a section that a theory takes beside its bending stiffness and its mass."""


def check_theory(beam: Beam, theory: str) -> None:
    """Raise InputError for a theory that is unknown, that a section lacks a figure for, or beside an axial force."""
    check_word("theory", theory, THEORIES)
    if theory == "euler-bernoulli":
        return
    if beam.tension:
        raise InputError(
            f"beam.tension = {beam.tension!r} N with theory = {theory!r}: there is more than one such theory, leave "
            "the axial force out or ask for euler-bernoulli"
        )
    for i, piece in enumerate(beam.pieces):
        where = f"beam.section[{i}]" if beam.section else "beam"
        for figure in _TAKES[theory]:
            if getattr(piece, figure) is None:
                raise InputError(
                    f"{where}.{figure} is missing: theory = {theory!r} takes it, give it beside a plain section, or "
                    "give a shape with its sizes, youngs_modulus and density"
                )
