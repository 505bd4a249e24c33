"""Waves on a strip with patches under its actuators: measured where the strip is itself, refused where it is not."""

import pytest
from msgspec.structs import replace

from verify.attached import PointSpring
from verify.beam import Beam
from verify.errors import WindowError
from verify.section import Section

PATCH = {"bending_stiffness": 0.35, "mass_per_length": 0.11}
SECTIONS = [{"length": 0.03}, {"length": 0.03, **PATCH}, {"length": 0.3}, {"length": 0.03, **PATCH}, {"length": 0.03}]
SCENE = {
    "name": "patches",
    "beam": {
        "length": 0.42,
        "width": 0.018,
        "thickness": 0.0012,
        "youngs_modulus": 70e9,
        "density": 2700.0,
        "supports": ["free", "free"],
        "loss_factor": 1e-3,
        "section": SECTIONS,
        "spring": [{"position": 0.0, "stiffness": 3e5}, {"position": 0.42, "stiffness": 2e5}],
    },
    "drive": {"frequency_hz": 1700.0, "force": [{"position": 0.045}, {"position": 0.372, "phase_deg": 90.0}]},
    "wave": {"count": 40, "counts": [40, 80, 160], "frequency_hz": [1600.0, 1800.0, 9]},
}


def test_a_window_on_another_section_is_told_how_the_beam_can_be_written():
    """The same beam and window are measured where that section is the beam's own; nothing said so."""
    from verify import analytic_modes, travelling_wave
    from verify.beam import PointForce

    sections = (Section(length=0.2, thickness=0.001), Section(length=0.3, thickness=0.002))
    sizes = {"length": 0.5, "width": 0.02, "youngs_modulus": 70e9, "density": 2700.0, "section": sections}
    forces = [PointForce(position=0.22), PointForce(position=0.46, phase_deg=90.0)]
    thin, thick = (analytic_modes.solve_harmonic(Beam(thickness=of, **sizes), forces, 4276.0) for of in (0.001, 0.002))
    with pytest.raises(WindowError, match=r"on the beam's own, or give the beam that section's sizes as its own$"):
        travelling_wave.measure(thin, (0.26, 0.4))
    with pytest.raises(WindowError, match=r"choose a window on the beam's own$"):
        travelling_wave.measure(analytic_modes.solve_harmonic(thin.beam, forces[1:], 4276.0), (0.15, 0.4))
    assert 0.0 < travelling_wave.measure(thick, (0.26, 0.4)).reflection < 1.0


def test_sections_alike_do_not_part_a_wave():
    """Two sections as the beam is: the measure is that of one beam."""
    plain = Beam(length=0.42, width=0.018, thickness=0.0012, youngs_modulus=70e9, density=2700.0, loss_factor=1e-3)
    cut = replace(plain, section=(Section(length=0.17), Section(length=0.25)))
    from verify import analytic_modes, travelling_wave
    from verify.beam import PointForce

    forces = [PointForce(position=0.03), PointForce(position=0.38, phase_deg=80.0)]
    ratios = [
        travelling_wave.measure(analytic_modes.solve_harmonic(beam, forces, 1700.0), (0.1, 0.3)).standing_wave_ratio
        for beam in (plain, cut, replace(cut, spring=(PointSpring(position=0.05, stiffness=1e-9),)))
    ]
    assert ratios[1] == pytest.approx(ratios[0], rel=1e-12)
    assert ratios[2] == pytest.approx(ratios[0], rel=1e-7)
