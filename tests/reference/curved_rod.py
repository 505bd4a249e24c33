"""Natural frequencies of a clamped-free rod along a curve, without extension and shear, by Ritz's method.

The rotation about fixed axes is w(s), a polynomial that is zero at the wall. Displacements follow from u' = w x t, bending
and twist from w' in the frame of the section: V = 1/2 int w'.F D F^T w', T = 1/2 int rho A |u|^2 + w.F J F^T w. In a
plane w has one component. Independent of the package.
"""

import numpy as np
from scipy.linalg import eigh


def rod_hz(frame, stiffness, mass, inertia, length, modes, planar=False, terms=16, points=60):
    """Frequencies, (modes,), Hz, by functions of s in SI.

    `frame`: (3, 3), its columns the tangent and the axes of bending; `stiffness`: GJ and EI about these, (3,); `mass`:
    rho A; `inertia`: rho I about the three.
    """
    x, w = np.polynomial.legendre.leggauss(points)
    s, w = 0.5 * length * (1 + x), 0.5 * length * w
    basis = [np.polynomial.legendre.Legendre.basis(k) * np.polynomial.legendre.Legendre([1, 1]) for k in range(terms)]
    values, slopes = (np.array([f(x) for f in each]) for each in (basis, [f.deriv() for f in basis]))
    slopes *= 2 / length
    axes = np.eye(3)[2:] if planar else np.eye(3)
    frames = np.array([frame(one) for one in s])
    shapes = np.cross(axes[:, None], frames[None, :, :, 0])  # e x t, (axes, points, 3)
    speeds = np.einsum("kp,apx->kapx", values, shapes).reshape(-1, points, 3)
    # u = int_0^s: exact for the polynomial through the Gauss points
    legendre = np.polynomial.legendre
    order = points - 1
    fit = legendre.legvander(x, order).T * (w * 2 / length) * (np.arange(points)[:, None] + 0.5)
    integral = legendre.legvander(x, order + 1) @ legendre.legint(np.eye(points), lbnd=-1, axis=0) @ fit * length / 2
    moved = np.einsum("pq,nqx->npx", integral, speeds)
    turned, bent = (np.einsum("kp,ax,pxi->kapi", v, axes, frames).reshape(-1, points, 3) for v in (values, slopes))
    d, j, m = (np.array([f(one) for one in s]) for f in (stiffness, inertia, mass))
    heavy = np.einsum("npx,mpx,p->nm", moved, moved, w * m) + np.einsum("npi,mpi,pi,p->nm", turned, turned, j, w)
    stiff = np.einsum("npi,mpi,pi,p->nm", bent, bent, d, w)
    return np.sqrt(eigh(stiff, heavy, eigvals_only=True)[:modes]) / (2 * np.pi)
