"""Linear algebra of driven pencils, the same for whoever brings one: direct, modal, and the refusal of resonances."""

from collections.abc import Callable
from typing import Any

import numpy as np

from verify.beam import Beam
from verify.errors import InputError
from verify.models.arrays import Array, ComplexArray
from verify.models.eigen import has_unlike_parts, modal_basis
from verify.models.fields import RESONANCE, refuse_resonance
from verify.models.modes import Modes
from verify.models.pencil import DENSE_UNKNOWNS, FactoredPencil
from verify.models.response import distance_answered, forced_response, probe


def damped_response(
    pencil: FactoredPencil, loads: Any, omega2: float, stiffness: ComplexArray, modal_damping: float
) -> ComplexArray:
    """The response (n, 1) with complex stiffnesses (m,), or with the same damping ratio in every mode.

    Modal damping takes all modes of the pencil. Raises InputError where it is asked for beyond the dense size
    or together with dashpots that couple the modes.
    """
    if not modal_damping:
        return forced_response(pencil, loads, omega2, stiffness)
    factors = stiffness / pencil.stiffness
    check_couples(factors)
    check_dense(pencil, "modal_damping")
    values, vectors = receptance_basis(pencil)
    denominators = values * factors[0] - omega2 + 2j * modal_damping * np.sqrt(values * omega2)
    return np.asarray(vectors @ ((vectors.T @ loads) / denominators[:, None]))


def modal_receptance(
    pencil: FactoredPencil, weights: Array, omega2: Array, loss_factor: float
) -> tuple[Array, ComplexArray]:
    """(modes (n, n), their share in the response to each load at each frequency (n_frequencies, n_loads, n)).

    Exact with a loss factor, which leaves the modes as they are. NaN at the frequencies of undamped resonances.
    Raises InputError beyond the dense size.
    """
    check_dense(pencil, "a map over frequency")
    values, vectors = receptance_basis(pencil)
    denominators = values * (1.0 + 1j * loss_factor) - omega2[:, None]
    near = abs(denominators) <= 2.0 * RESONANCE * omega2[:, None]
    known = np.full(len(omega2), True) if loss_factor else ~near.any(axis=1)
    shares = np.full((len(omega2), weights.shape[1], len(values)), np.nan, dtype=complex)
    shares[known] = (vectors.T @ weights).T / denominators[known, None, :]
    return vectors, shares


def check_dampings(beam: Beam, modal_damping: float) -> None:
    """Raise InputError for a ratio of every mode beside a loss factor where the two couple the modes.

    They do not where all that resists is the beam's own (1 + i eta) K, whatever it carries: masses do not resist.
    """
    if modal_damping and beam.loss_factor and beam.lossless:
        raise InputError(
            f"beam.loss_factor = {beam.loss_factor!r} and modal_damping = {modal_damping!r} together couple the modes "
            f"beside {' and '.join(f'beam.{name}' for name in beam.lossless)}, where nothing is lost: give one of the "
            "two"
        )


def check_couples(factors: ComplexArray) -> None:
    """Raise InputError where dashpots, by their share (..., m) in every stiffness, couple modes of one ratio."""
    if (np.ptp(factors.imag, axis=-1) > 1e-9 * abs(factors).max(axis=-1)).any():
        raise InputError("joint_dashpot and modal_damping together: dashpots couple the modes, give one of the two")


def receptance_basis(pencil: FactoredPencil) -> tuple[Array, Array]:
    """All eigenvalues and vectors as `modal_basis`, for sums over modes, which lose what the vectors lose.

    Of a small even pencil from singular values, conditioned like n^2 where K is like n^4. Kept with the pencil.
    """
    sharp = takes_all_modes(pencil)
    kept = pencil.bases if sharp else pencil.rough_bases
    if not kept:
        kept.append(modal_basis(pencil, sharp=sharp))
    return kept[0]


def takes_all_modes(pencil: FactoredPencil) -> bool:
    """Whether all modes of a pencil are soon found, and sharp enough to be summed: not those of unlike parts."""
    if pencil.bases:
        return True
    return pencil.n <= DENSE_UNKNOWNS and not pencil.uneven and not has_unlike_parts(pencil)


def check_dense(pencil: FactoredPencil, what: str) -> None:
    """Raise InputError where all modes of a pencil would be too many."""
    if pencil.n > 4 * DENSE_UNKNOWNS:
        raise InputError(f"{what} takes all {pencil.n} modes of the model: lower count to {DENSE_UNKNOWNS} or less")


def probed(pencil: FactoredPencil, loads: ComplexArray) -> ComplexArray:
    """Loads (n, 1) with one beside them whose answer tells how far a resonance is, where no kept modes do."""
    return loads if pencil.bases else np.hstack([loads, probe(pencil)])


def refuse_near_resonance(
    model: str,
    beam: Beam,
    pencil: FactoredPencil,
    omega2: float,
    frequency_hz: float,
    solve_modes: Callable[[Beam, int, int], Modes],
    count: int,
    answer: ComplexArray,
) -> None:
    """Raise InputError where an undamped pencil is driven at one of its own frequencies, which kept modes tell.

    `answer` is what `probed` loads are answered with, (n, 2) where no modes are kept: one factorisation for both.
    """
    if pencil.bases:
        distance = abs(pencil.bases[0][0] / omega2 - 1.0).min()
    else:
        distance = distance_answered(pencil, answer[:, 1].real, omega2)
    if abs(distance) <= 2.0 * RESONANCE:
        name_resonance(model, beam, pencil, frequency_hz, solve_modes, count)


def name_resonance(
    model: str,
    beam: Beam,
    pencil: FactoredPencil,
    frequency_hz: float,
    solve_modes: Callable[[Beam, int, int], Modes],
    count: int,
    field: str = "frequency_hz",
) -> None:
    """Raise ResonanceError for a frequency, named `field`, on a resonance: with the mode that lies nearest."""
    n_modes = pencil.n - pencil.rigid_modes
    guess = int(np.sqrt(2.0 * np.pi * frequency_hz / beam.wave_constant) * beam.length / np.pi) + 4
    frequencies = solve_modes(beam, min(guess, n_modes), count).frequencies_hz
    nearest = int(abs(frequencies - frequency_hz).argmin())
    refuse_resonance(model, frequency_hz, nearest + 1, float(frequencies[nearest]), field)
