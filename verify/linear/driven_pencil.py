"""Linear algebra of driven pencils, the same for whoever brings one: direct, modal, and the refusal of resonances."""

from collections.abc import Callable

import numpy as np

from verify.arrays import Array, ComplexArray
from verify.errors import InputError
from verify.linear.eigen import has_unlike_parts, modal_basis
from verify.linear.fields import RESONANCE, refuse_resonance
from verify.linear.modes import Modes
from verify.linear.pencil import DENSE_UNKNOWNS, FactoredPencil
from verify.linear.response import distance_answered, forced_response, probe
from verify.problem.beam import Beam

FEW = 4
"""Frequencies up to which each is solved by itself."""


def harmonic_response(
    pencil: FactoredPencil,
    loads: ComplexArray,
    omega2: Array,
    stiffness: ComplexArray,
    modal_damping: float = 0.0,
    refuse: Callable[[int], None] | None = None,
) -> ComplexArray:
    """Responses (n, n_frequencies) to loads (n, 1) at omega^2 (n_frequencies,).

    `stiffness` is (m,), or (n_frequencies, m) where it depends on the frequency; `modal_damping` is the damping ratio
    of every mode. Many frequencies are summed over all modes where damping leaves them uncoupled; else each is solved
    as a band. `refuse`, of an undamped pencil, is called with the index of the first frequency at a resonance. Raises
    InputError for both dampings together where they couple modes, and for modal damping beyond the dense size.
    """
    over = np.broadcast_to(stiffness, (len(omega2), len(pencil.stiffness)))
    factors = over / pencil.stiffness
    if modal_damping:
        if (np.ptp(factors.imag, axis=1) > 1e-9 * abs(factors).max(axis=1)).any():
            raise InputError("joint_dashpot and modal_damping together: dashpots couple the modes, give one of the two")
        check_dense(pencil, "modal_damping")
    coupled = np.ptp(factors.imag, axis=1) > 1e-15 * abs(factors).max(axis=1)
    if not modal_damping and (coupled.any() or len(omega2) <= FEW or not takes_all_modes(pencil)):
        known = bool(pencil.bases) and refuse is not None  # which tell resonances
        probed = loads if refuse is None or known else np.hstack([loads, probe(pencil)])
        found = [forced_response(pencil, probed, float(w2), d) for w2, d in zip(omega2, over, strict=True)]
        if known:
            distances = abs(pencil.bases[0][0] / omega2[:, None] - 1.0).min(axis=1)
        elif refuse is not None:
            answers = zip(found, omega2, strict=True)
            distances = np.array([distance_answered(pencil, one[:, 1].real, float(w2)) for one, w2 in answers])
        response = np.hstack([one[:, :1] for one in found]).astype(complex)
    else:
        values, vectors = receptance_basis(pencil)
        distances = abs(values / omega2[:, None] - 1.0).min(axis=1)
        denominators = values * factors[:, :1] - omega2[:, None]
        if modal_damping:
            denominators = denominators + 2j * modal_damping * np.sqrt(values * omega2[:, None])
        response = _combined(vectors, _combined(vectors.T, loads) / denominators.T)
    if refuse is not None:
        for index in np.flatnonzero(abs(distances) <= 2.0 * RESONANCE):
            refuse(int(index))
    return response


def _combined(columns: Array, shares: ComplexArray) -> ComplexArray:
    """Real columns by complex shares, in half of the time of columns made complex."""
    flat = np.ascontiguousarray(shares, dtype=complex).view(float)
    return np.asarray((columns @ flat).view(complex))


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
