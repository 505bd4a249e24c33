"""Elements over many frequencies or many beams in one call: arrays in, arrays out."""

from collections.abc import Iterable
from functools import partial
from math import pi

from verify.beam import Beam
from verify.checks import check_whole, several
from verify.elements.linear import (
    check_asked,
    check_damping,
    driven,
    force_loads,
    modes_around,
    swept_shapes,
    swept_turns,
)
from verify.elements.mesh import build_elements
from verify.elements.pencil import damped_stiffness, element_pencil
from verify.elements.stacks import element_stack, layout
from verify.models.arrays import Array
from verify.models.driven_pencil import name_resonance
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
from verify.options import Theory


@as_typed
def sweep_harmonic(
    beam: Beam,
    forces: Forces,
    frequencies_hz: Numbers,
    n_elements: int,
    *,
    modal_damping: float = 0.0,
    grading: float = 1.0,
    theory: Theory = "euler-bernoulli",
) -> HarmonicSweep:
    """The steady fields of `solve_harmonic` at many frequencies, in one call and to rounding.

    All modes of the elements are solved once, from singular values, and summed; where damping couples them, and under
    Timoshenko's theory, every frequency is solved as a band. Raises InputError as `solve_harmonic` does, by index: of
    several resonances the first.
    """
    forces = as_forces(forces)
    check_asked(beam, 1, n_elements, grading, theory)
    frequencies = swept_frequencies(beam, forces, frequencies_hz, 2 * n_elements)
    check_damping(beam, modal_damping)
    elements, pencil = driven(beam, n_elements, grading, theory)
    omega2 = (2.0 * pi * frequencies / beam.wave_constant) ** 2 * elements.parts.unit**4
    undamped = not (beam.loss_factor or modal_damping)

    def refuse(index: int) -> None:
        near = partial(modes_around, theory=theory, grading=grading)
        name_resonance("fem", beam, pencil, float(frequencies[index]), near, n_elements, f"{FIELD}[{index}]")

    loads, stiffness = force_loads(elements, forces), damped_stiffness(elements, pencil)
    free = swept_response(pencil, loads, omega2, stiffness, modal_damping, refuse if undamped else None)
    return HarmonicSweep(
        theory=theory,
        model="fem",
        count=n_elements,
        beam=beam,
        frequencies_hz=frequencies,
        forces=forces,
        shapes=swept_shapes(elements, free),
        turned=swept_turns(elements, free),
    )


@as_typed
def sweep_modes(
    beams: Iterable[Beam],
    n_modes: int,
    n_elements: int,
    *,
    grading: float = 1.0,
    theory: Theory = "euler-bernoulli",
) -> Array:
    """Frequencies of the first modes of many beams, (n_beams, n_modes) in Hz, as `solve_modes` has them.

    Plain beams that differ by their scale and by the ground under them share one solve; those that have as many
    sections, masses and springs as others are solved together, on ground, under tension, graded or thick (Rayleigh) as
    well; sheared and compressed ones one by one. Raises InputError as `solve_modes` does, naming the beam by its index.
    """
    beams = several("beams", beams, Beam)
    check_whole("n_modes", n_modes, 1)

    def make(beam: Beam, wanted: int) -> tuple[FactoredPencil, float]:
        check_asked(beam, wanted, n_elements, grading, theory)
        elements = build_elements(beam, n_elements, grading, theory)
        return element_pencil(elements), elements.parts.unit

    alike = partial(layout, n_elements=n_elements, grading=grading, theory=theory)
    stack = partial(element_stack, n_elements=n_elements, grading=grading, theory=theory)
    return swept_modes(beams, n_modes, theory, Stacking(make=make, layout=alike, stack=stack))
