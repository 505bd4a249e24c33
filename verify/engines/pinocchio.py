"""Pinocchio: a tree of hinges, its articulated-body algorithm. Springs, the roller and the rules are in Python here.

Bending is in the x-y plane, about z. The roller is linear in the angles: its force follows from a second call of the
algorithm with the row of the constraint as torques, which does not drift.
"""

from typing import Any

import numpy as np

from verify.arrays import Array
from verify.engines.base import Chain, Run, centred
from verify.engines.description import small_motion_hz


class Pinocchio:
    """The adapter."""

    def frequencies(self, chain: Chain) -> Array:
        """Natural frequencies from the engine's mass matrix, the constraint and the springs."""
        import pinocchio as pin

        model, springs, roller = build(chain)
        mass = np.triu(pin.crba(model, model.createData(), np.zeros(model.nv)))
        return small_motion_hz(mass + np.triu(mass, 1).T, np.diag(springs), roller[None])

    def run(self, chain: Chain, steps: int, end: float, order: int = 4) -> Run:
        """Motion by Runge and Kutta's rule, or by semi-implicit Euler steps."""
        from pinocchio import aba

        model, springs, roller = build(chain)
        data, h, still = model.createData(), end / steps, np.zeros(model.nv)
        torques = chain.force_values(0.5 * h * np.arange(2 * steps + 1)) @ chain.torques
        states = np.zeros((steps + 1, 2, model.nv))

        def accelerate(q: Array, v: Array, half: int) -> Array:
            free = aba(model, data, q, v, torques[half] - springs * q).copy()
            held = aba(model, data, q, still, roller)
            return np.asarray(free - roller @ free / (roller @ held) * held)

        for k, (q, v) in enumerate(states[:-1]):
            one = accelerate(q, v, 2 * k)
            if order == 2:
                states[k + 1, 1] = v + h * one
                states[k + 1, 0] = q + h * states[k + 1, 1]
                continue
            second = v + 0.5 * h * one
            two = accelerate(q + 0.5 * h * v, second, 2 * k + 1)
            third = v + 0.5 * h * two
            three = accelerate(q + 0.5 * h * second, third, 2 * k + 1)
            last = v + h * three
            four = accelerate(q + h * third, last, 2 * k + 2)
            states[k + 1, 0] = q + h / 6.0 * (v + 2.0 * second + 2.0 * third + last)
            states[k + 1, 1] = v + h / 6.0 * (one + 2.0 * two + 2.0 * three + four)
        finite = np.isfinite(states).all(axis=(1, 2)) & (abs(states[:, 0]) < np.pi).all(axis=1)
        done = steps + 1 if finite.all() else int(finite.argmin())
        failure = "" if finite.all() else f"at t = {done * h:.4g} s its angles are beyond pi"
        angles, rates = np.cumsum(states[:done], axis=2).transpose(1, 0, 2)
        return Run(np.linspace(0.0, (done - 1) * h, done), angles, centred(rates) if order == 2 else rates, failure)


def build(chain: Chain) -> tuple[Any, Array, Array]:
    """(model, joint stiffnesses (N,), row of the roller's constraint (N,))."""
    import pinocchio as pin

    model, parent, offset = pin.Model(), 0, 0.0
    model.gravity = pin.Motion.Zero()
    for j, link in enumerate(chain.rigid.links):
        place = pin.SE3(np.eye(3), np.array([offset, 0.0, 0.0]))
        parent = model.addJoint(parent, pin.JointModelRZ(), place, f"joint{j}")
        body = pin.Inertia(link.mass, np.array([link.centre, 0.0, 0.0]), np.diag(link.inertia))
        model.appendBodyToJoint(parent, body, pin.SE3.Identity())
        offset = link.length
    springs = np.array([stiffness for *_, stiffness in chain.rigid.unknowns("bending")])
    return model, springs, chain.rigid.constraints("bending")[0]
