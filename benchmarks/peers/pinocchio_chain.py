"""Pinocchio: revolute joints and a light carriage joined by its constrained dynamics; a Runge-Kutta loop in Python."""

from typing import Any

import numpy as np

from benchmarks.peers.case import Array, Case, Run, count, every
from benchmarks.peers.mujoco_chain import SAMPLES, read


def _model(case: Case) -> tuple[Any, Any, list[Any], Any]:
    import pinocchio as pin

    model, last, hinges = pin.Model(), 0, []
    model.gravity = pin.Motion.Zero()
    bar = pin.Inertia(case.mass, np.array([case.link / 2, 0.0, 0.0]), np.diag([case.inertia / 50, *[case.inertia] * 2]))
    for i in range(case.n):
        place = pin.SE3(np.eye(3), np.array([case.link if i else 0.0, 0.0, 0.0]))
        last = model.addJoint(last, pin.JointModelRZ(), place, f"hinge{i}")
        model.appendBodyToJoint(last, bar, pin.SE3.Identity())
        hinges.append(last)
    far = pin.SE3(np.eye(3), np.array([case.length, 0.0, 0.0]))
    carriage = model.addJoint(0, pin.JointModelPX(), far, "carriage")
    model.appendBodyToJoint(carriage, pin.Inertia(case.mass / 1000, np.zeros(3), 1e-12 * np.eye(3)), pin.SE3.Identity())
    tip = pin.SE3(np.eye(3), np.array([case.link, 0.0, 0.0]))
    closure = pin.RigidConstraintModel(
        pin.ContactType.CONTACT_3D, model, last, tip, carriage, pin.SE3.Identity(), pin.ReferenceFrame.LOCAL
    )
    return model, model.createData(), hinges, closure


def prepare(case: Case) -> Run:
    """A run of the chain."""
    import pinocchio as pin

    model, data, _, closure = _model(case)
    closures, scratch = pin.StdVec_RigidConstraintModel(), pin.StdVec_RigidConstraintData()
    closures.append(closure)
    scratch.append(closure.createData())
    settings = pin.ProximalSettings(1e-12, 1e-10, 10)
    pin.initConstraintDynamics(model, data, closures, scratch)
    springs = np.zeros(model.nv)
    springs[1 : case.n] = case.spring
    places = [case.place(x) for x, _, _ in case.forces]
    middle, at = case.place(case.length / 2)

    def levers(q: Array, link: int, where: float) -> Array:
        """Derivatives of a point's y by the joint angles."""
        theta = np.cumsum(q[: link + 1])
        joints = np.concatenate([[0.0], np.cumsum(case.link * np.cos(theta))])
        row = np.zeros(model.nv)
        row[: link + 1] = joints[link] + where * np.cos(theta[-1]) - joints[: link + 1]
        return row

    def rates(t: float, q: Array, v: Array) -> Array:
        torque = -springs * q
        for (link, where), force in zip(places, case.now(t), strict=True):
            torque += force * levers(q, link, where)
        return np.array(pin.constraintDynamics(model, data, q, v, torque, closures, scratch, settings))

    def run(step: float, end: float) -> tuple[Array, Array]:
        steps, h = count(step, end)
        q, v, look, seen = np.zeros(model.nv), np.zeros(model.nv), every(steps, SAMPLES), []
        for k in range(steps):
            t = k * h
            a1, v1 = rates(t, q, v), v
            v2 = v + 0.5 * h * a1
            a2 = rates(t + 0.5 * h, q + 0.5 * h * v1, v2)
            v3 = v + 0.5 * h * a2
            a3 = rates(t + 0.5 * h, q + 0.5 * h * v2, v3)
            v4 = v + h * a3
            a4 = rates(t + h, q + h * v3, v4)
            q, v = q + h / 6 * (v1 + 2 * v2 + 2 * v3 + v4), v + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
            if (k + 1) % look == 0:
                seen.append(((k + 1) * h, np.cumsum(q[: middle + 1])))
        return read(seen, case.link, at)

    return run
