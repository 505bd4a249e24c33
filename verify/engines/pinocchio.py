"""Pinocchio: revolute joints in a tree whose far end is held by articulated-body solves; Runge-Kutta steps in Python.

One solve gives the accelerations of the open chain, another those by a unit force on its far end: that force keeps the
end on its line in O(N), where the engine's constrained dynamics factorises the mass matrix in O(N^3). The engine has no
integrator for a closed loop: classical steps of order 4 are ours. Beyond the stability limit the numbers grow and
nothing is raised; a run stops where a joint has turned by half a turn.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from verify.arrays import Array
from verify.engines.base import Chain, Recorder, Run, tree_frequencies

Acceleration = Callable[[float, Array, Array], Array]


class Pinocchio:
    """The adapter."""

    def frequencies(self, chain: Chain) -> Array:
        """From the engine's mass matrix and the Jacobian of the far end."""
        import pinocchio as pin

        model, last = _model(chain)
        tip = pin.SE3(np.eye(3), np.array([chain.link, 0.0, 0.0]))
        frame = model.addFrame(pin.Frame("tip", last, 0, tip, pin.FrameType.OP_FRAME))
        data, straight = model.createData(), np.zeros(model.nv)
        upper = np.triu(pin.crba(model, data, straight))
        pin.computeJointJacobians(model, data, straight)
        world = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
        closure = np.array(pin.computeFrameJacobian(model, data, straight, frame, world)[1])
        return tree_frequencies(upper + np.triu(upper, 1).T, closure, np.full(chain.n, chain.spring))

    def run(self, chain: Chain, steps: int, end: float) -> Run:
        """In steps of order 4."""
        f, h, n = _acceleration(chain), end / steps, chain.n
        recorder = Recorder(chain, steps, h)
        q, v = np.zeros(n), np.zeros(n)
        with np.errstate(all="ignore"):
            for k in range(steps):
                t = k * h
                a1, v1 = f(t, q, v), v
                v2 = v + 0.5 * h * a1
                a2 = f(t + 0.5 * h, q + 0.5 * h * v1, v2)
                v3 = v + 0.5 * h * a2
                a3 = f(t + 0.5 * h, q + 0.5 * h * v2, v3)
                v4 = v + h * a3
                a4 = f(t + h, q + h * v3, v4)
                q, v = q + h / 6 * (v1 + 2 * v2 + 2 * v3 + v4), v + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
                if not float(np.abs(q[1:n]).max()) < np.pi:
                    return recorder.run(k, f"at t = {t + h:.4g} s a joint has turned by half a turn")
                recorder.keep(k + 1, q)
        return recorder.run(steps, "")


def _model(chain: Chain) -> tuple[Any, int]:
    """(the chain pinned at its near end and free at the other, its last joint)."""
    import pinocchio as pin

    model, last = pin.Model(), 0
    model.gravity = pin.Motion.Zero()
    moments = np.diag([chain.inertia / 50, chain.inertia, chain.inertia])
    bar = pin.Inertia(chain.mass, np.array([chain.link / 2, 0.0, 0.0]), moments)
    for i in range(chain.n):
        place = pin.SE3(np.eye(3), np.array([chain.link if i else 0.0, 0.0, 0.0]))
        last = model.addJoint(last, pin.JointModelRZ(), place, f"hinge{i}")
        model.appendBodyToJoint(last, bar, pin.SE3.Identity())
    return model, last


def _acceleration(chain: Chain) -> Acceleration:
    """(t, q, v) -> accelerations of the hinges."""
    import pinocchio as pin

    model, _ = _model(chain)
    open_end, loaded_end, rest = model.createData(), model.createData(), np.zeros(model.nv)
    springs = np.append(0.0, np.full(model.nv - 1, -chain.spring))
    places = [(link, at / chain.link) for link, at in (chain.locate(force.position) for force in chain.forces)]

    def hinges(t: float, q: Array, v: Array) -> Array:
        angles = q.cumsum()
        along = chain.link * np.cos(angles)
        ends = along.cumsum()
        starts = ends - along
        torque = springs * q
        for (link, share), force in zip(places, chain.force_values(t), strict=True):
            torque[: link + 1] += force * (starts[link] + share * along[link] - starts[: link + 1])
        levers = ends[-1] - starts
        free, unit = pin.aba(model, open_end, q, v, torque), pin.aba(model, loaded_end, q, rest, levers)
        inward = chain.link * np.sin(angles) @ np.square(v.cumsum())
        return np.asarray(free - (levers @ free - inward) / (levers @ unit) * unit)

    return hinges
