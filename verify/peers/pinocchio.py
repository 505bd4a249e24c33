"""Pinocchio: revolute joints and a light carriage joined by its constrained dynamics; Runge-Kutta steps in Python.

The engine gives accelerations and has no integrator for a loop: classical steps of order 4 are ours, of a slider too.

What it does when it breaks: beyond the explicit limit of the step numbers grow from step to step, and nothing is
raised. A run here stops where a joint has turned by half a turn, or is no number, and says so.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from verify.models.arrays import Array
from verify.peers import tree
from verify.peers.case import Case, PeerRun, Sled, clocks, count, near, since, surface_speed

LIGHT = 1e-3
"""Of a link's mass: the carriage on which the far end rolls."""
Rates = Callable[[float, Array, Array], Array]


def _model(case: Case) -> tuple[Any, int, int, Any]:
    """(model, its last hinge, its carriage, the place of the far end on the last link)."""
    import pinocchio as pin

    model, last = pin.Model(), 0
    model.gravity = pin.Motion.Zero()
    bar = pin.Inertia(case.mass, np.array([case.link / 2, 0.0, 0.0]), np.diag([case.inertia / 50, *[case.inertia] * 2]))
    for i in range(case.n):
        place = pin.SE3(np.eye(3), np.array([case.link if i else 0.0, 0.0, 0.0]))
        last = model.addJoint(last, pin.JointModelRZ(), place, f"hinge{i}")
        model.appendBodyToJoint(last, bar, pin.SE3.Identity())
    far = pin.SE3(np.eye(3), np.array([case.length, 0.0, 0.0]))
    carriage = model.addJoint(0, pin.JointModelPX(), far, "carriage")
    light = pin.Inertia(LIGHT * case.mass, np.zeros(3), 1e-12 * np.eye(3))
    model.appendBodyToJoint(carriage, light, pin.SE3.Identity())
    return model, last, carriage, pin.SE3(np.eye(3), np.array([case.link, 0.0, 0.0]))


def matrices(case: Case) -> tuple[Array, Array]:
    """The engine's own mass (n, n) and closure (n,) over the joint angles; springs are not the engine's."""
    import pinocchio as pin

    model, last, _, tip = _model(case)
    frame = model.addFrame(pin.Frame("tip", last, 0, tip, pin.FrameType.OP_FRAME))
    data, still = model.createData(), np.zeros(model.nv)
    upper = np.triu(pin.crba(model, data, still))[: case.n, : case.n]
    pin.computeJointJacobians(model, data, still)
    closure = pin.computeFrameJacobian(model, data, still, frame, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED)[1, : case.n]
    return upper + np.triu(upper, 1).T, np.array(closure)


class Pinocchio:
    """The engine behind the room's interface."""

    def frequencies(self, case: Case) -> Array:
        """From its mass matrix and the Jacobian of the far end."""
        mass, closure = matrices(case)
        return tree.frequencies(mass, closure, np.full(case.n, case.spring))

    def prepare(self, case: Case, sled: Sled | None = None) -> Callable[[float, float], PeerRun]:
        """The model is made once."""
        rates, size = _rates(case), case.n + 1

        def run(step: float, end: float) -> PeerRun:
            steps, step = count(step, end)
            track = tree.Track(case, sled, steps, step)
            q, v = np.zeros(size + 1), np.zeros(size + 1)
            if sled:
                v[-1] = sled.speed
            ready = clocks()
            with np.errstate(all="ignore"):
                taken, broke = _march(_with_slider(case, sled, rates) if sled else _alone(rates), q, v, track)
            return track.run(since(ready), 0.0, taken, broke)

        return run


def _rates(case: Case) -> Rates:
    """(t, q, v) -> accelerations of hinges and carriage, (n + 1,)."""
    import pinocchio as pin

    model, last, carriage, tip = _model(case)
    data = model.createData()
    closures, scratch = pin.StdVec_RigidConstraintModel(), pin.StdVec_RigidConstraintData()
    closure = pin.RigidConstraintModel(
        pin.ContactType.CONTACT_3D, model, last, tip, carriage, pin.SE3.Identity(), pin.ReferenceFrame.LOCAL
    )
    closures.append(closure)
    scratch.append(closure.createData())
    settings = pin.ProximalSettings(1e-12, 1e-10, 10)
    pin.initConstraintDynamics(model, data, closures, scratch)
    springs = np.zeros(model.nv)
    springs[1 : case.n] = case.spring
    places = [case.place(force.position) for force in case.forces]

    def levers(q: Array, link: int, where: float) -> Array:
        """Derivatives of a point's y by the joint angles, (link + 1,)."""
        reach = np.cos(np.cumsum(q[: link + 1]))
        joints = np.concatenate([[0.0], np.cumsum(case.link * reach)])
        return np.asarray(joints[link] + where * reach[-1] - joints[: link + 1])

    def rates(t: float, q: Array, v: Array) -> Array:
        torque = -springs * q
        for (link, where), force in zip(places, case.now(t), strict=True):
            torque[: link + 1] += force * levers(q, link, where)
        return np.array(pin.constraintDynamics(model, data, q, v, torque, closures, scratch, settings))

    return rates


def _alone(rates: Rates) -> Rates:
    """With a last coordinate that stays at rest, where there is no slider."""

    def all_rates(t: float, q: Array, v: Array) -> Array:
        return np.append(rates(t, q[:-1], v[:-1]), 0.0)

    return all_rates


def _with_slider(case: Case, sled: Sled, rates: Rates) -> Rates:
    """With the slider as the last coordinate."""

    def all_rates(t: float, q: Array, v: Array) -> Array:
        x = sled.start + float(q[-1])
        first = near(case, x) - 2
        spins = np.cumsum(v[: first + 5])[first:].tolist()
        pulled = sled.force(float(v[-1]) - surface_speed(case, sled, spins, x, first)) / sled.mass
        return np.append(rates(t, q[:-1], v[:-1]), pulled)

    return all_rates


def _march(rates: Rates, q: Array, v: Array, track: tree.Track) -> tuple[int, str]:
    """Steps of order 4 until the end or until the motion is none any more; (how many were good, what broke)."""
    h, n = track.step, track.case.n
    for k in range(track.steps):
        t = k * h
        a1, v1 = rates(t, q, v), v
        v2 = v + 0.5 * h * a1
        a2 = rates(t + 0.5 * h, q + 0.5 * h * v1, v2)
        v3 = v + 0.5 * h * a2
        a3 = rates(t + 0.5 * h, q + 0.5 * h * v2, v3)
        v4 = v + h * a3
        a4 = rates(t + h, q + h * v3, v4)
        q, v = q + h / 6 * (v1 + 2 * v2 + 2 * v3 + v4), v + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
        largest = float(np.abs(q[1:n]).max())
        if not largest < np.pi:
            return k, (
                f"at t = {t + h:.4g} s a joint has turned by {largest:.3g} rad, half a turn or more: the numbers grow "
                "from step to step, and nothing was raised"
            )
        track.keep(k + 1, q, float(q[-1]), float(v[-1]))
    return track.steps, ""
