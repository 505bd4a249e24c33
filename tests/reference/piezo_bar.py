"""A chain of piezoelectric and passive layers by one-dimensional finite elements of degree 6. Nothing of verify.

Displacement and potential are unknowns of every layer, electrodes are its faces (field along) or its sides (field
across). Weak form of T = c S - e E, D = e S + eps E with E = -phi' (along) or V/gap (across).
"""

from typing import NamedTuple

import numpy as np

P, ELEMENTS = 6, 3  # degree, elements of a layer


class Layer(NamedTuple):
    """A layer by its strain-charge constants; d = 0 is passive; gap is the distance of electrodes on the sides."""

    length: float
    area: float
    density: float
    s: complex
    d: complex = 0.0
    eps: complex = 0.0
    gap: float | None = None


class Answer(NamedTuple):
    """Force, current and dissipated power."""

    force: complex  # on the structure at the tip
    current: complex
    loss: float  # dissipated power, integrated over the volume


def bar_constants(c11, c12, c13, c33, e31, e33, eps33, along):
    """(s, d, eps) of a bar without lateral stress, by elimination of its lateral strains from the stress-charge form."""
    # unknowns S1, S2, S3, D3 for unit T3 or T1, and for unit E3, T being zero on the other sides
    stiffness = np.array([[c11, c12, c13], [c12, c11, c13], [c13, c13, c33]])
    e, axis = np.array([e31, e31, e33]), 2 if along else 0
    of_stress, of_field = np.linalg.solve(stiffness, np.eye(3)[axis]), np.linalg.solve(stiffness, e)
    return of_stress[axis], e @ of_stress, eps33 + e @ of_field


_X, _W = (0.5 * (one + shift) for one, shift in zip(np.polynomial.legendre.leggauss(P + 1), (1.0, 0.0), strict=True))
_C = np.linalg.inv(np.vander(np.linspace(0.0, 1.0, P + 1), increasing=True))
_N = np.vander(_X, P + 1, increasing=True) @ _C
_DN = (np.arange(1, P + 1) * np.vander(_X, P, increasing=True)) @ _C[1:]


def respond(layers, omega, *, base, voltage, tip):
    """The tip moves at velocity `tip` (outward), the electrodes have `voltage`; base is a stiffness, inf is fixed."""
    total = len(layers) * ELEMENTS * P + 1
    k = np.zeros((2 * total + 1, 2 * total + 1), complex)  # u, phi, V
    active, known, parts = 0, {2 * total: voltage, total - 1: tip / (1j * omega)}, []
    for number, layer in enumerate(layers):
        if layer.d and layer.gap is None:  # alternating polarity, electrodes 0 and V in turn: all layers act together
            ends = total + number * ELEMENTS * P, total + (number + 1) * ELEMENTS * P
            known |= {ends[0]: voltage * (active % 2), ends[1]: voltage * ((active + 1) % 2)}
        d = layer.d * (1.0 if active % 2 or layer.gap else -1.0)
        active += bool(layer.d)
        c, e, eps = 1.0 / layer.s, d / layer.s, layer.eps - d**2 / layer.s
        h = layer.length / ELEMENTS
        weight = layer.area * h * _W[:, None]
        for element in range(ELEMENTS):
            u = (number * ELEMENTS + element) * P + np.arange(P + 1)
            own = np.concatenate([u, total + u, [2 * total]])
            strain, field = np.zeros((P + 1, own.size)), np.zeros((P + 1, own.size))
            strain[:, : P + 1] = _DN / h
            if layer.gap:
                field[:, -1] = 1.0 / layer.gap
            elif layer.d:
                field[:, P + 1 : -1] = -_DN / h
            k[np.ix_(own, own)] += strain.T @ (weight * (c * strain - e * field))
            k[np.ix_(own, own)] -= field.T @ (weight * (e * strain + eps * field))
            k[np.ix_(u, u)] -= omega**2 * layer.density * _N.T @ (weight * _N)
            parts.append((own, layer.s, d, layer.eps, weight[:, 0], c * strain - e * field, field))
    passive = [i for i in range(total, 2 * total) if not k[i, i]]
    known |= dict.fromkeys(passive, 0.0) | ({0: 0.0} if np.isinf(base) else {})
    k[0, 0] += 0.0 if np.isinf(base) else base
    fixed = np.array(sorted(known))
    free = np.setdiff1d(np.arange(k.shape[0]), fixed)
    x = np.zeros(k.shape[0], complex)
    x[fixed] = [known[i] for i in fixed]
    x[free] = np.linalg.solve(k[np.ix_(free, free)], -k[np.ix_(free, fixed)] @ x[fixed])
    reaction, loss = k @ x, 0.0
    for own, s, d, eps, weight, stress, field in parts:
        t, f = stress @ x[own], field @ x[own]
        density = -s.imag * abs(t) ** 2 - 2.0 * np.imag(d) * (t * f.conj()).real - np.imag(eps) * abs(f) ** 2
        loss += 0.5 * omega * np.sum(weight * density)
    charged = [i for i in known if i >= total and known[i] == voltage and i not in passive]
    return Answer(-reaction[total - 1], -1j * omega * sum(reaction[i] for i in charged), float(loss))
