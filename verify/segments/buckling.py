"""The compression at which a chain buckles: where its joints, springs and ground no longer hold its links' turns."""

from math import inf
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.beam import Beam
from verify.errors import InputError
from verify.models.arrays import Array
from verify.models.eigen import DENSE_UNKNOWNS, factorised, mixed_matrix
from verify.options import Attachment, Wall
from verify.segments.links import Chain, build_chain
from verify.segments.loaded import link_turns, loaded_pencil, turns


def buckling_load(
    beam: Beam,
    n_segments: int,
    *,
    wall: Wall = "gregory",
    grading: float = 1.0,
    attachment: Attachment = "reciprocal",
) -> float:
    """The compression, N, at which the chain buckles first, whatever the beam's own axial force.

    Pinned ends: (4 EI/l^2) sin^2(pi/(2N)), -mu^2/12. Of joints in series, which hold a chain still as the beam's own
    stiffness does; 0 where nothing keeps it from turning.
    """
    force = beam.bending_stiffness / beam.length**2
    pressed = replace(beam, tension=-force)
    if _falls(beam):
        return 0.0
    chain = build_chain(pressed, n_segments, wall=wall, grading=grading, attachment=attachment)
    return force * _ratio(chain)


def check_loaded(beam: Beam, n_segments: int, wall: Any, joints: Any, grading: float, attachment: Any) -> None:
    """Raise InputError where axial force leaves a tensioned joint no stiffness, or buckles the chain as it is."""
    ratio = 0.0
    if beam.tension > 0.0 or not _falls(beam):
        chain = build_chain(beam, n_segments, wall=wall, joints=joints, grading=grading, attachment=attachment)
        ratio = inf if beam.tension > 0.0 else _ratio(chain)
    if ratio <= 1.0:
        raise InputError(
            f"beam.tension = {beam.tension!r} N compresses the beam beyond its buckling load: the chain of {n_segments} "
            f"segments buckles at {-beam.tension * ratio:.6g} N, lower the compression or hold the beam better"
        )


def _falls(beam: Beam) -> bool:
    """Whether nothing but the axial force keeps the beam from turning as a whole."""
    return any(tilt for _, tilt in replace(beam, tension=0.0).rigid_lines)


def _ratio(chain: Chain) -> float:
    """The smallest factor of its own axial force at which a compressed chain buckles.

    1/nu with nu the largest eigenvalue of C K^{-1} C^T, K without the force and C^T C the force's own matrix.
    """
    pencil = loaded_pencil(replace(chain, tension=0.0))
    mixed, free = mixed_matrix(pencil)
    factor, weights, matrix = factorised(mixed), np.sqrt(-chain.tension * chain.lengths)[:, None], link_turns(chain)

    def softness(pulls: Array) -> Array:
        loads = np.zeros((mixed.shape[0], pulls.shape[1]))
        loads[-len(free) :] = (matrix.T @ (weights * pulls))[free]
        answer = np.zeros((pencil.n, pulls.shape[1]))
        answer[free] = factor.solve(loads)[-len(free) :]
        return np.asarray(weights * turns(chain, answer))

    n = chain.n_segments
    if n <= DENSE_UNKNOWNS:
        flexible = softness(np.eye(n))
        return float(1.0 / np.linalg.eigvalsh(0.5 * (flexible + flexible.T))[-1])
    from scipy.sparse.linalg import LinearOperator, eigsh

    operator = LinearOperator((n, n), matvec=lambda b: softness(b.reshape(-1, 1))[:, 0], dtype=float)
    start = np.random.default_rng(20081).standard_normal(n)
    return float(1.0 / eigsh(operator, k=1, which="LA", v0=start, tol=1e-12, return_eigenvectors=False)[0])
