"""Pinocchio: revolute joints in a tree, whose far end is held by articulated-body solves; Runge-Kutta steps in Python.

One solve gives the accelerations of the open chain, another what a unit force on its far end adds: that force keeps the
end on its line, in O(N), where the engine's own constrained dynamics factorises the whole mass matrix, in O(N^3). The
engine has no integrator for a loop: classical steps of order 4 are ours, of a slider too.

What it does when it breaks: beyond the explicit limit of the step numbers grow from step to step, and nothing is
raised. A run here stops where a joint has turned by half a turn, or is no number, and says so.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from verify.models.arrays import Array
from verify.peers import tree
from verify.peers.case import Case, PeerRun, Sled, clocks, count, near, since, surface_speed

Rates = Callable[[float, Array, Array], Array]


def _model(case: Case) -> tuple[Any, int]:
    """(the chain pinned at its near end and free at the other, its last hinge)."""
    import pinocchio as pin

    model, last = pin.Model(), 0
    model.gravity = pin.Motion.Zero()
    bar = pin.Inertia(case.mass, np.array([case.link / 2, 0.0, 0.0]), np.diag([case.inertia / 50, *[case.inertia] * 2]))
    for i in range(case.n):
        place = pin.SE3(np.eye(3), np.array([case.link if i else 0.0, 0.0, 0.0]))
        last = model.addJoint(last, pin.JointModelRZ(), place, f"hinge{i}")
        model.appendBodyToJoint(last, bar, pin.SE3.Identity())
    return model, last


def matrices(case: Case) -> tuple[Array, Array]:
    """The engine's own mass (n, n) and closure (n,) over the joint angles; springs are not the engine's."""
    import pinocchio as pin

    model, last = _model(case)
    tip = pin.SE3(np.eye(3), np.array([case.link, 0.0, 0.0]))
    frame = model.addFrame(pin.Frame("tip", last, 0, tip, pin.FrameType.OP_FRAME))
    data, still = model.createData(), np.zeros(model.nv)
    upper = np.triu(pin.crba(model, data, still))
    pin.computeJointJacobians(model, data, still)
    closure = pin.computeFrameJacobian(model, data, still, frame, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED)[1]
    return upper + np.triu(upper, 1).T, np.array(closure)


class Pinocchio:
    """The engine behind the room's interface."""

    def frequencies(self, case: Case) -> Array:
        """From its mass matrix and the Jacobian of the far end."""
        mass, closure = matrices(case)
        return tree.frequencies(mass, closure, np.full(case.n, case.spring))

    def prepare(self, case: Case, sled: Sled | None = None) -> Callable[[float, float], PeerRun]:
        """The model is made once."""
        rates = _rates(case)

        def run(step: float, end: float) -> PeerRun:
            steps, step = count(step, end)
            track = tree.Track(case, sled, steps, step)
            q, v = np.zeros(case.n + 1), np.zeros(case.n + 1)
            if sled:
                v[-1] = sled.speed
            ready = clocks()
            with np.errstate(all="ignore"):
                taken, broke = _march(_with_slider(case, sled, rates) if sled else _alone(rates), q, v, track)
            return track.run(since(ready), 0.0, taken, broke)

        return run


def _rates(case: Case) -> Rates:
    """(t, q, v) -> accelerations of the hinges, (n,), of the chain whose far end stays on its line."""
    import pinocchio as pin

    model, _ = _model(case)
    open_end, pushed_end, still = model.createData(), model.createData(), np.zeros(model.nv)
    springs = np.append(0.0, np.full(model.nv - 1, -case.spring))
    places = [(link, where / case.link) for link, where in (case.place(force.position) for force in case.forces)]

    def rates(t: float, q: Array, v: Array) -> Array:
        angles = q.cumsum()
        along = case.link * np.cos(angles)
        ends = along.cumsum()
        starts = ends - along
        torque = springs * q
        for (link, share), force in zip(places, case.now(t), strict=True):
            torque[: link + 1] += force * (starts[link] + share * along[link] - starts[: link + 1])
        levers = ends[-1] - starts
        free = pin.aba(model, open_end, q, v, torque)
        answer = pin.aba(model, pushed_end, q, still, levers)
        inward = case.link * np.sin(angles) @ np.square(v.cumsum())
        return np.asarray(free - (levers @ free - inward) / (levers @ answer) * answer)

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
