"""A new attachment is a class of its coefficients and a field of the beam."""

from typing import Annotated

import numpy as np
import pytest
from matplotlib.figure import Figure
from msgspec.structs import replace

from verify.analytic_modes import ExactModel
from verify.engines.describe import describe
from verify.errors import InputError
from verify.fem_beam import HermiteModel
from verify.identify.beam import frequencies
from verify.problem.beam import Beam, PointForce, PointMoment
from verify.problem.point_attachments import Attachment, PointMass, PointSpring
from verify.report.beam_drawing import beam_figure
from verify.segment_model import SegmentModel
from verify.validation import unit


class Pad(Attachment, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A block glued between beam and ground: springs of its modulus, half of its mass moves."""

    where = "beam.pad"
    width: Annotated[float, unit("m", gt=0)]
    area: Annotated[float, unit("m^2", gt=0)]
    thickness: Annotated[float, unit("m", gt=0)]
    modulus: Annotated[float, unit("Pa", gt=0)]
    density: Annotated[float, unit("kg/m^3", gt=0)]

    stiffness = property(lambda self: self.modulus * self.area / self.thickness)
    rotational = property(lambda self: self.stiffness * self.width**2 / 12.0)
    mass = property(lambda self: 0.5 * self.density * self.area * self.thickness)


class PaddedBeam(Beam, frozen=True, kw_only=True, forbid_unknown_fields=True, dict=True):
    """A beam with a field more."""

    pad: tuple[Pad, ...] = ()


BEAM = {"length": 0.71, "width": 0.023, "thickness": 0.0041, "youngs_modulus": 71e9, "density": 2710.0}
BEAM |= {"supports": ("clamped", "free"), "loss_factor": 0.013}
PAD = Pad(position=0.43, width=0.021, area=0.021 * 0.023, thickness=0.012, modulus=0.9e6, density=1130.0)
STIFFNESS, MASS = 0.9e6 * 0.021 * 0.023 / 0.012, 0.5 * 1130.0 * 0.021 * 0.023 * 0.012
SPRING = PointSpring(position=0.43, stiffness=STIFFNESS, rotational=STIFFNESS * 0.021**2 / 12.0)
PADDED = PaddedBeam(**BEAM, pad=(PAD,))
SAME = Beam(**BEAM, mass=(PointMass(position=0.43, mass=MASS),), spring=(SPRING,))
FIELD = ([PointForce(position=0.2), PointMoment(position=0.71, amplitude=0.3)], 137.0)


@pytest.mark.parametrize("model", [ExactModel, lambda b: HermiteModel(b, 30), lambda b: SegmentModel(b, 40)])
def test_all_models_take_the_coefficients_of_a_new_attachment(model):
    padded, same = model(PADDED), model(SAME)
    assert padded.modes(5).frequencies_hz == pytest.approx(same.modes(5).frequencies_hz, rel=1e-9)
    places = np.linspace(0.0, 0.71, 7)
    assert padded.harmonic(*FIELD).deflection(places) == pytest.approx(same.harmonic(*FIELD).deflection(places), 1e-7)
    bare = model(Beam(**BEAM)).modes(1).frequencies_hz[0]
    assert 1.5 < padded.modes(1).frequencies_hz[0] / bare < 8.0


def test_engines_fits_and_mirror_images_take_a_new_attachment():
    chains = [describe(beam, 12) for beam in (PADDED, SAME)]
    assert chains[0].frequencies_hz() == pytest.approx(chains[1].frequencies_hz(), rel=1e-9)
    slopes = []
    for beam in (PADDED, SAME):
        model = frequencies(beam, ("youngs_modulus", "density"), np.array([1, 3]))
        slopes.append(model.predict({"youngs_modulus": 71e9, "density": 2710.0})[1]["youngs_modulus"])
    assert slopes[0] == pytest.approx(slopes[1], rel=1e-6)
    turned = PADDED.mirrored()
    assert turned.pad[0].position == pytest.approx(0.28)
    assert ExactModel(turned).frequency_hz(2) == pytest.approx(ExactModel(SAME).frequency_hz(2), rel=1e-9)
    assert PaddedBeam(**BEAM | {"supports": ("free", "free")}, pad=(PAD,)).rigid_motions == 0


def test_the_drawing_and_the_checks_take_a_new_attachment():
    scene = type(
        "Scene", (), {"beam": PADDED, "drive": None, "forces": (), "devices": (), "shunts": (), "slider": None}
    )
    ax = Figure().subplots()
    beam_figure(scene).draw(ax)
    assert {f"{STIFFNESS:.4g} N/m", f"{MASS:.4g} kg"} <= {text.get_text() for text in ax.texts}
    for position in (0.0, 0.8):  # on the clamp, off the beam
        with pytest.raises(InputError):
            PaddedBeam(**BEAM, pad=(replace(PAD, position=position),))
    with pytest.raises(InputError):
        ExactModel(PADDED).time_basis(modes=4)
