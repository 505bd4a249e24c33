"""How far a run in time can be believed: what its assumptions leave out, with sizes."""

import numpy as np

from verify.motion.contact import Margins
from verify.motion.request import Request
from verify.motion.surface import Stage
from verify.motion.validity import axial_inertia_size, discretisation, model_form
from verify.slider import GRAVITY


def margins_of(request: Request, stage: Stage, fall: float | None = None) -> Margins:
    """Of a run whose last stage this is.

    `fall` is the largest downward acceleration of the surface under the slider in the run, m/s^2; without a slider
    the largest of the steady motion along the beam stands for it.
    """
    x = np.linspace(0.0, request.beam.length, 400)
    steady, slopes = stage.drive_shapes(x, 0)[:2], stage.drive_shapes(x, 1)[:2]
    falling = request.omega**2 * float(np.hypot(*steady).max()) if fall is None else fall
    pressing = request.slider.effective_gravity if request.slider else GRAVITY
    square = 0.5 * float((slopes**2).sum(axis=0).mean())
    return Margins(
        lift_off=falling / pressing if pressing else float("inf"),
        nonlinearity=axial_inertia_size(request.beam, request.frequency_hz, square),
        model_form=model_form(request.beam, request.frequency_hz),
        discretisation=discretisation(request.beam, request.model, request.count, request.frequency_hz),
    )
