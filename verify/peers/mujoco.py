"""MuJoCo: hinges in a tree, the far end held by a fixed tendon, which is linear in the angles; its own RK4.

Bending is in its x-z plane, about -y. The tendon is a soft equality as hard as the engine makes one; of its solvers
Gauss and Seidel's is the quickest here, exact for one constraint, 1.7 to 2.6 times as fast as Newton's. A slider is a
body on a slide joint. Runge-Kutta calls the control callback at every stage: forces and friction are put on in it, a C
function, as the engine's manual has it for callbacks, which takes half the time of one in Python at 49 links.

What it does when it breaks: unless its flag `autoreset` is off, it puts the model back to its start, goes on from there
and raises nothing; the time that has gone backwards and a counter of warnings tell. A run here stops there and says so.
"""

import ctypes
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from math import pi, radians
from time import perf_counter
from typing import Any

import numpy as np

from verify.errors import InputError, one_line
from verify.models.arrays import Array
from verify.peers import tree
from verify.peers.case import Case, PeerRun, Sled, clocks, count, since

KEPT = 4
"""Compiled models of so many steps, each with room for its data."""
MOST_FORCES = 64
"""On one chain."""
MARK = -1.2345678e-77
"""No time that a run comes to."""


def model_text(case: Case, step: float, sled: Sled | None = None) -> str:
    """The chain, and a slider beside it, in the engine's XML."""
    link, spin = case.link, case.inertia
    bodies = "".join(
        f'<body name="link{i}" pos="{0.0 if i == 0 else link!r} 0 0">'
        f'<joint name="hinge{i}" type="hinge" axis="0 -1 0" stiffness="{0.0 if i == 0 else case.spring!r}"/>'
        f'<inertial pos="{link / 2!r} 0 0" mass="{case.mass!r}" diaginertia="{spin!r} {spin!r} {spin!r}"/>'
        for i in range(case.n)
    )
    slider = (
        f'<body name="slider" pos="{sled.start!r} 0 0.01"><joint name="slide" type="slide" axis="1 0 0"/>'
        f'<inertial pos="0 0 0" mass="{sled.mass!r}" diaginertia="1e-9 1e-9 1e-9"/></body>'
        if sled
        else ""
    )
    levers = "".join(f'<joint joint="hinge{i}" coef="{link * (case.n - i)!r}"/>' for i in range(case.n))
    return (
        '<mujoco><compiler angle="radian" inertiafromgeom="false" boundmass="0" boundinertia="0"/>'
        f'<option timestep="{step!r}" integrator="RK4" gravity="0 0 0" solver="PGS" jacobian="dense" iterations="20" '
        'tolerance="1e-14">'
        '<flag contact="disable"/></option>'
        f"<size memory='200M'/><worldbody>{bodies}{'</body>' * case.n}{slider}</worldbody>"
        f'<tendon><fixed name="closure">{levers}</fixed></tendon><equality><tendon tendon1="closure" '
        f'solref="{2 * step!r} 1" solimp="0.9999 0.9999 0.001 0.5 2"/></equality></mujoco>'
    )


def matrices(case: Case) -> tuple[Array, Array, Array]:
    """The engine's own mass (n, n), closure (n,) and stiffness (n,) over the joint angles."""
    import mujoco

    text = model_text(case, 1e-6)
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    mass = np.zeros((model.nv, model.nv))
    try:
        mujoco.mj_fullM(model, data, mass)
    except TypeError:  # before version 4
        mujoco.mj_fullM(model, mass, data.qM)
    stiffness = np.asarray(model.jnt_stiffness).reshape(model.nv, -1)[:, 0]
    return mass, np.array(data.efc_J).reshape(-1, model.nv)[0], np.array(stiffness)


class Mujoco:
    """The engine behind the room's interface."""

    def frequencies(self, case: Case) -> Array:
        """From its mass matrix, its closure and its joint stiffnesses."""
        return tree.frequencies(*matrices(case))

    def prepare(self, case: Case, sled: Sled | None = None) -> Callable[[float, float], PeerRun]:
        """Models are compiled once for each step."""
        import mujoco

        models: dict[float, tuple[Any, Any, float]] = {}

        def run(step: float, end: float) -> PeerRun:
            steps, step = count(step, end)
            began = perf_counter()
            if step not in models:
                try:
                    model = mujoco.MjModel.from_xml_string(model_text(case, step, sled))
                except ValueError as error:
                    refused = f"at t = 0 s, before its first step, it refused the model: {one_line(str(error))}"
                    return tree.Track(case, sled, steps, step).run((0.0, 0.0), perf_counter() - began, 0, refused)
                if len(models) >= KEPT:
                    models.pop(next(iter(models)))
                models[step] = model, mujoco.MjData(model), perf_counter() - began
            model, data, set_up_s = models[step]
            mujoco.mj_resetData(model, data)
            if sled:
                data.qvel[case.n] = sled.speed
            track = tree.Track(case, sled, steps, step)
            with _called_back(_pushing(case, sled, data)) as said:
                ready = clocks()
                taken = _march(model, data, track)
                spent = since(ready)
            broke = "" if taken == steps else _broke(data, (taken + 1) * step, said)
            return track.run(spent, set_up_s, taken, broke)

        return run


@cache
def _push() -> tuple[Any, Any, Array]:
    """(the callback as a C function, the whole numbers and the numbers that it reads), made once in a process."""
    from verify.peers.push_kernels import EACH, FORCE, PLACES, pushing

    places, numbers = np.zeros(PLACES, dtype=np.int64), np.zeros(FORCE + EACH * MOST_FORCES)
    return pushing(places, numbers), places, numbers


def _pushing(case: Case, sled: Sled | None, data: Any) -> Any:
    """The callback, told of the run that is about to begin (`push_kernels`). Raises InputError for too many forces."""
    made, places, numbers = _push()
    if len(case.forces) > MOST_FORCES:
        raise InputError(
            f"force: MuJoCo's callback has room for {MOST_FORCES}, {len(case.forces)} are too many: give at "
            f"most {MOST_FORCES}, or leave MuJoCo out"
        )
    arrays = (data.qpos, data.qvel, data.xfrc_applied, data.qfrc_applied)
    addresses = [_time_at(data), *(array.ctypes.data for array in arrays)]
    places[:] = [*addresses, case.n, len(case.forces), sled is not None]
    slider = (sled.friction, sled.slope, sled.half_thickness, sled.start) if sled else (0.0,) * 4
    told = [2.0 * pi * case.frequency, case.link, *slider]
    for force in case.forces:
        link, where = case.place(force.position)
        told += [link + 1, force.amplitude, radians(force.phase_deg), where - case.link / 2]
    numbers[: len(told)] = told
    return made.ctypes


def _time_at(data: Any) -> int:
    """The address of the time, which lies before the energy. Raises AttributeError where it does not."""
    address, before = int(data.energy.ctypes.data) - 8, data.time
    data.time = MARK
    found = ctypes.c_double.from_address(address).value
    data.time = before
    if found != MARK:
        raise AttributeError("MuJoCo's time does not lie before its energy in MjData: another version is needed")
    return address


def _march(model: Any, data: Any, track: tree.Track) -> int:
    """Steps until the end or until the engine's clock has gone backwards; how many were good."""
    import mujoco

    n, step, slides = track.case.n, track.step, track.sled is not None
    for k in range(1, track.steps + 1):
        mujoco.mj_step(model, data)
        if data.time < (k - 0.5) * step:
            return k - 1
        if k % track.look == 0:
            track.keep(k, data.qpos, *((data.qpos[n], data.qvel[n]) if slides else ()))
    return track.steps


def _broke(data: Any, t: float, said: list[str]) -> str:
    """That it went back to its start, when, and what its counters and its warning say."""
    counted = sum(int(warning.number) for warning in data.warning)
    told = f": {said[-1].strip().rstrip('.')}" if said else ""
    return (
        f"at t = {t:.4g} s it put itself back to its start and went on from t = 0 without an exception; its counters "
        f"hold {counted} warning{'s' * (counted != 1)}{told}"
    )


@contextmanager
def _called_back(push: Any) -> Iterator[list[str]]:
    """The callback set for a while; what the engine warns of is kept, and not written to a file beside the caller."""
    import mujoco

    said: list[str] = []
    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(said.append)
    mujoco.set_mjcb_control(push)
    try:
        yield said
    finally:
        mujoco.set_mjcb_control(None)
        mujoco.set_mju_user_warning(before)
