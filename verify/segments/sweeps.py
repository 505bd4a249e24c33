"""Chains over many frequencies or many beams in one call: arrays in, arrays out."""

from collections.abc import Iterable
from functools import partial
from math import pi

import numpy as np

from verify.beam import Beam
from verify.checks import check_whole, several
from verify.models.arrays import Array, ComplexArray
from verify.models.driven_pencil import check_dampings, name_resonance
from verify.models.pencil import FactoredPencil
from verify.models.places import Forces, Numbers, as_forces, as_typed
from verify.models.sweeps import (
    FIELD,
    HarmonicSweep,
    Stacking,
    swept_frequencies,
    swept_modes,
    swept_response,
)
from verify.options import Attachment, Joints, Load, Reading, Theory, Wall
from verify.segments.assembly import build_chain, chain_pencil, check_set_up
from verify.segments.linear import (
    check,
    check_settings,
    damped,
    driven,
    force_loads,
    settings_of,
    solve_modes,
    swept_shapes,
    swept_turns,
)
from verify.segments.links import Chain
from verify.segments.stacks import chain_stack, layout


@as_typed
def sweep_harmonic(
    beam: Beam,
    forces: Forces,
    frequencies_hz: Numbers,
    n_segments: int,
    *,
    load: Load = "reciprocal",
    reading: Reading = "corrected",
    modal_damping: float = 0.0,
    joint_dashpot: float = 0.0,
    wall: Wall = "gregory",
    joints: Joints = "series",
    grading: float = 1.0,
    theory: Theory = "euler-bernoulli",
    attachment: Attachment = "reciprocal",
) -> HarmonicSweep:
    """The steady fields of `solve_harmonic` at many frequencies, in one call and to rounding.

    All modes of the chain are solved once, from singular values, and summed; where damping couples them every
    frequency is solved as a band. Raises InputError as `solve_harmonic` does, by index: of several resonances the
    first.
    """
    forces = as_forces(forces)
    settings = settings_of(wall, joints, grading, theory, attachment)
    check(beam, 1, n_segments, **settings)
    frequencies = swept_frequencies(beam, forces, frequencies_hz, 2 * n_segments)
    check_settings(load, reading, modal_damping, joint_dashpot)
    check_dampings(beam, modal_damping)
    chain, pencil = driven(beam, n_segments, settings)
    omega2 = (2.0 * pi * frequencies / beam.wave_constant) ** 2 * chain.unit**4
    undamped = not (beam.loss_factor or modal_damping or joint_dashpot)

    def refuse(index: int) -> None:
        solve = partial(solve_modes, **settings)
        name_resonance("segment", beam, pencil, float(frequencies[index]), solve, n_segments, f"{FIELD}[{index}]")

    loads = force_loads(chain, forces, load, pencil.n) * (chain.unit**3 / beam.bending_stiffness)
    stiffness = _damped(beam, chain, pencil, frequencies, joint_dashpot)
    free = swept_response(pencil, loads, omega2, stiffness, modal_damping, refuse if undamped else None)
    return HarmonicSweep(
        theory=theory,
        model="segment",
        count=n_segments,
        beam=beam,
        frequencies_hz=frequencies,
        forces=forces,
        shapes=swept_shapes(chain, free, reading),
        turned=swept_turns(chain, free, reading),
    )


def _damped(beam: Beam, chain: Chain, pencil: FactoredPencil, frequencies: Array, dashpot: float) -> ComplexArray:
    """The stiffness with the beam's loss factor, (m,), with dashpots of c, N m s, at every frequency, (n, m)."""
    if not dashpot:
        return damped(beam, chain, pencil, 0.0)
    return np.array([damped(beam, chain, pencil, 2.0 * pi * float(f) * dashpot) for f in frequencies])


@as_typed
def sweep_modes(
    beams: Iterable[Beam],
    n_modes: int,
    n_segments: int,
    *,
    wall: Wall = "gregory",
    joints: Joints = "series",
    grading: float = 1.0,
    theory: Theory = "euler-bernoulli",
    attachment: Attachment = "reciprocal",
) -> Array:
    """Frequencies of the first modes of many beams, (n_beams, n_modes) in Hz, as `solve_modes` has them.

    Plain beams that differ by their scale and by the ground under them share one solve; those that have as many
    sections, masses and springs as others are solved together, on ground, under tension, graded or thick (Rayleigh) as
    well; joints that slip, printed or tensioned, welded walls and compression one by one. Raises InputError as
    `solve_modes` does, naming the beam by its index.
    """
    beams = several("beams", beams, Beam)
    check_whole("n_modes", n_modes, 1)
    check_set_up(n_segments, wall, joints, attachment)
    settings = settings_of(wall, joints, grading, theory, attachment)

    def make(beam: Beam, wanted: int) -> tuple[FactoredPencil, float]:
        check(beam, wanted, n_segments, **settings)
        chain = build_chain(beam, n_segments, **settings)
        return chain_pencil(chain), chain.unit

    alike = partial(layout, **settings)
    stack = partial(chain_stack, n_segments=n_segments, settings=settings)
    return swept_modes(beams, n_modes, theory, Stacking(make=make, layout=alike, stack=stack))
