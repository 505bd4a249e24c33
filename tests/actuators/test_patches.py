"""Patches on beams against an energy minimum over the section, Smits and Choi's closed forms, and finite elements.

Smits, Choi, IEEE Trans. UFFC 38:256 (1991): unimorph cantilever under a voltage and a tip force.
Smits, Dalke, Cooney, Sensors and Actuators A 28:41 (1991): bimorph of two equal layers.
"""

from types import SimpleNamespace

import numpy as np
import pytest
from msgspec.structs import replace
from scipy.linalg import eigh

from tests.reference.dense import Elements
from verify import Beam, ExactModel, HermiteModel, InputError, PointForce
from verify.actuators.materials import PIEZO
from verify.actuators.on_beam import Mounted, on_beam
from verify.actuators.patch import Patch
from verify.actuators.shunt import ShuntedMode
from verify.quantities import evaluate

STRIP = Beam(length=0.173, width=0.013, thickness=0.0011, youngs_modulus=71e9, density=2710.0)
ARM = replace(STRIP, supports=("clamped", "free"))
PZT = PIEZO["pzt-4"].derived
ONE = Patch(length=0.047, thickness=0.0004, width=0.009, sides=1)
BOTH = replace(ONE, sides=2, material="pzt-8")


def enthalpy(patch, beam):
    """Second derivatives of the electric enthalpy per length by (curvature, voltage); moments of the mass.

    The axial strain is free. The field along the poling is V/t in the layer on +w and -V/t in the other.
    """
    material, (h, t) = PIEZO[patch.material], (beam.thickness, patch.thickness)
    bar = material.derived
    y, e, permittivity = 1.0 / bar.s11, bar.d31 / bar.s11, bar.eps33 - bar.d31**2 / bar.s11
    nodes, weights = np.polynomial.legendre.leggauss(4)
    total, rho = np.zeros((3, 3)), np.zeros(3)  # curvature, voltage, strain
    layers = [(0.0, h, beam.width, 0.0)] + [(s * 0.5 * (h + t), t, patch.width, s) for s in (1.0, -1.0)[: patch.sides]]
    for middle, thick, width, sign in layers:
        for node, weight in zip(nodes, weights, strict=True):
            z, da = middle + 0.5 * thick * node, 0.5 * thick * weight * width
            strain, field = np.array([-z, 0.0, 1.0]), np.array([0.0, sign / t, 0.0])
            modulus, density = (y, material.density) if sign else (beam.youngs_modulus, beam.density)
            mixed = e * np.outer(strain, field)  # the beam has no field
            total += da * (modulus * np.outer(strain, strain) - mixed - mixed.T - permittivity * np.outer(field, field))
            rho += da * density * np.array([1.0, z, z**2])
    return total[:2, :2] - np.outer(total[:2, 2], total[2, :2]) / total[2, 2], rho


@pytest.mark.parametrize("design", [ONE, BOTH, replace(ONE, width=None, thickness=0.0013)])
def test_section_minimises_the_electric_enthalpy(design):
    patch = design.bonded(ARM)
    ((stiffness, moment), (_, charge)), rho = enthalpy(replace(patch, width=patch.width or ARM.width), ARM)
    section = patch.laminate
    electric = [section.bending_stiffness, patch.moment_per_volt, patch.capacitance]
    assert electric == pytest.approx([stiffness, -moment, -charge * patch.length], rel=1e-13)
    about = rho[2] - 2.0 * section.neutral_axis * rho[1] + section.neutral_axis**2 * rho[0]
    assert [section.mass_per_length, section.rotary_inertia] == pytest.approx([rho[0], about], rel=1e-13)


def smits_and_choi(h, t, width):
    """(curvature per volt, curvature per moment) of a laminate of one width, by their determinant K."""
    sm, sp = 1.0 / ARM.youngs_modulus, PZT.s11
    k = sm**2 * t**4 + 4 * sm * sp * h * t**3 + 6 * sm * sp * h**2 * t**2 + 4 * sm * sp * h**3 * t + sp**2 * h**4
    return -6.0 * PZT.d31 * sm * sp * h * (h + t) / k, 12.0 * sm * sp * (sm * t + sp * h) / (k * width)


@pytest.mark.parametrize(("length", "centre"), [(ARM.length, 0.5 * ARM.length), (0.047, 0.061), (0.047, 0.0235)])
def test_unimorph_cantilever_bends_as_smits_and_choi_state(length, centre):
    patch = replace(ONE, length=length, width=None).bonded(ARM)
    tip = HermiteModel(patch.on(ARM, centre), 12).harmonic([PointForce(position=ARM.length)], 1e-3)
    ends = np.array([centre - 0.5 * length, centre + 0.5 * length])
    per_volt = patch.moment_per_volt.real * np.diff(tip.slope(ends).real)[0]  # by reciprocity
    driven = on_beam(ExactModel(patch.on(ARM, centre)), Mounted(actuator=patch, position=centre, voltage=1.0), 1e-3)
    assert driven.field.deflection(ARM.length)[0] == pytest.approx(per_volt, rel=1e-8)
    curvature, compliance = smits_and_choi(ARM.thickness, patch.thickness, ARM.width)
    assert per_volt == pytest.approx(curvature * length * (ARM.length - centre), rel=1e-8)
    lever = ARM.length - ends
    bare = 12.0 / (ARM.youngs_modulus * ARM.width * ARM.thickness**3)
    deflection = (bare * ARM.length**3 + (compliance - bare) * (lever[0] ** 3 - lever[1] ** 3)) / 3.0
    assert tip.deflection(ARM.length)[0].real == pytest.approx(deflection, rel=1e-8)


def test_bimorph_without_a_beam_is_that_of_smits_dalke_and_cooney():
    patch = replace(BOTH, width=None, material="pzt-4").bonded(replace(ARM, thickness=1e-10))
    stiffness = patch.laminate.bending_stiffness
    assert patch.moment_per_volt / stiffness == pytest.approx(-1.5 * PZT.d31 / patch.thickness**2, rel=1e-6)
    free = patch.capacitance + patch.moment_per_volt**2 * patch.length / stiffness
    plates = 2.0 * PZT.eps33 * ARM.width * patch.length / patch.thickness
    assert free == pytest.approx(plates * (1.0 - 0.25 * PZT.k31**2), rel=1e-6)
    assert replace(patch, sides=1).capacitance == pytest.approx(0.5 * plates, rel=1e-5)  # a layer alone extends freely


def test_shunted_patch_damps_the_mode_of_a_cantilever():
    patch = ONE.bonded(ARM)
    beam = patch.on(ARM, 0.031)
    fem = Elements(beam, np.unique([*np.linspace(0.0, ARM.length, 20), 0.0075, 0.0545]))
    turn = fem.row(0.0545, 1) - fem.row(0.0075, 1)
    b, c = patch.moment_per_volt.real, patch.capacitance.real
    stiffness, mass = fem.reduced(fem.bending), fem.reduced(fem.mass)
    bend = turn[fem.free]
    opened = patch.port(1.0).loaded_impedance() * 1j  # i omega Z, a stiffness against the difference of the slopes
    assert opened == pytest.approx(b**2 / c, rel=1e-13)
    short, shapes = eigh(stiffness, mass)
    opens = eigh(stiffness + opened.real * np.outer(bend, bend), mass, eigvals_only=True)
    gains = (b * bend @ shapes) ** 2
    mode = ShuntedMode(coupling=np.sqrt(opens[0] / short[0] - 1.0), omega=np.sqrt(short[0]),
                       capacitance=c + sum(gains[1:] / (short[1:] - short[0])))  # fmt: skip
    modal = ShuntedMode.bonded(ExactModel(beam).modes(200), patch, 0.031, 1)
    assert [modal.coupling, modal.capacitance] == pytest.approx([mode.coupling, mode.capacitance], rel=2e-3)
    scene = SimpleNamespace(beam=ARM, drive=SimpleNamespace(actuator=ONE), beside="")
    peak = evaluate("shunt.optimum", {"mode": 1, "position": 0.031, "circuit": "resistor"}, scene, None)
    assert peak == pytest.approx(2.0 / modal.coupling**2, rel=2e-3)
    load, omegas = mode.optimum("series"), mode.omega * np.linspace(0.8, 1.2, 1201)
    unit = shapes[:, 0] @ mass  # the force of the mode's own shape, and its coordinate
    shunted = 1j * omegas * patch.port(omegas).loaded_impedance(load.admittance(omegas))
    square, turned = omegas[:, None, None] ** 2, shunted[:, None, None] * np.outer(bend, bend)
    response = abs(np.linalg.solve(stiffness + turned - square * mass, unit[:, None])[..., 0] @ unit) * short[0]
    assert response.max() == pytest.approx(mode.peak(load), rel=0.02)
    assert response == pytest.approx(abs(mode.response(load, omegas)), rel=0.02)


def test_patches_add_their_mass_to_the_beam():
    beam = BOTH.on(ARM, (0.1, 0.0235))
    assert [piece.length for piece in beam.pieces] == pytest.approx([0.047, 0.0295, 0.047, 0.0495])
    mass = sum(piece.length * piece.mass_per_length for piece in beam.pieces)
    layers = 4.0 * 0.047 * 0.0004 * 0.009 * PIEZO["pzt-8"].density
    figures = [mass, beam.pieces[0].extreme_fibre]
    assert figures == pytest.approx([ARM.length * ARM.mass_per_length + layers, 0.00055 + 0.0004], rel=1e-13)
    assert ONE.bonded(beam).laminate == ONE.bonded(ARM).laminate


@pytest.mark.parametrize(
    ("action", "sentence"),
    [
        (lambda: ONE.port(1.0), r"patch\.substrate is missing: bond the patch"),
        (lambda: replace(ONE, width=0.014).bonded(ARM), r"patch\.width = 0\.014"),
        (lambda: ONE.on(ARM, (0.04, 0.08)), r"position = 0\.08 m: the patch overlaps"),
        (lambda: ONE.on(ONE.on(ARM, 0.04), 0.1), r"beam\.section: a beam under patches"),
        (lambda: ONE.bonded(Beam(length=1.0, bending_stiffness=1.0, mass_per_length=1.0)), "rectangular section"),
    ],
)
def test_refused_with_field_and_remedy(action, sentence):
    with pytest.raises(InputError, match=sentence):
        action()
