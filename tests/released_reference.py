"""What gates of motion, of released beams, of loads at rest and of fastest crests expect: modes summed, written out.

Matrices are those of `driven_reference`; time is integrated by DOP853 to 1e-13, loads at rest by Newton's method on a
chain's energy, crests by Green's function of a pinned beam and two waves fitted to it. Nothing of the suite but beams.
"""

from itertools import pairwise

import mpmath as mp
import numpy as np
from carried_reference import GREGORY
from driven_reference import COUNTS, DIGITS, Elements, Links, cuts, equal, field, phasor
from msgspec.structs import replace
from scipy.integrate import solve_ivp
from scipy.linalg import eigh
from scipy.optimize import brentq, minimize_scalar
from states_reference import _FREE, _exponential


def model_of(scene, given):
    model, count = given.get("model", "segment"), given["count"]
    parts = equal(scene.beam, COUNTS.get((scene.name, model, count), (count,)), cut=model == "fem")
    return Elements(scene.beam, parts) if model == "fem" else Links(scene.beam, parts)


class Modal:
    """All modes of dense matrices, mass-normalised, and what reads and loads them at a place."""

    def __init__(self, model):
        self.model, keep = model, np.ix_(model.free, model.free)
        values, self.vectors = eigh((model.bent + model.held)[keep], model.mass[keep])
        self.omegas = np.sqrt(values)

    def loads(self, x):
        row = self.model.row(x) if isinstance(self.model, Elements) else self.model.reciprocal(x)
        return row[self.model.free] @ self.vectors

    def shapes(self, x):
        if isinstance(self.model, Elements):
            return self.model.row(x)[self.model.free] @ self.vectors
        joints = np.zeros((len(self.model.nodes), len(self.omegas)))
        joints[self.model.free] = self.vectors
        return np.array([self.model.line(self.model.corrected(one), x).real for one in joints.T])


def driven(scene, given):
    """(q, dq/dt, work of the forces, what modal damping took) at a time, from rest, by DOP853."""
    modal, omega, zeta = (
        Modal(model_of(scene, given)),
        2 * np.pi * scene.drive.frequency_hz,
        given.get("modal_damping", 0.0),
    )
    p = sum(phasor((f.position, f.amplitude, f.phase_deg)) * modal.loads(f.position) for f in scene.forces)
    n, growth = len(modal.omegas), given["soft_start_periods"] * 2 * np.pi / omega

    def rate(t, y):
        q, v, part = y[:n], y[n : 2 * n], min(t / growth, 1.0) if growth else 1.0
        force = (3 * part**2 - 2 * part**3) * (p * np.exp(1j * omega * t)).real
        lost = 2 * zeta * modal.omegas * v
        return np.concatenate([v, force - lost - modal.omegas**2 * q, [force @ v, lost @ v]])

    y, start = np.zeros(2 * n + 2), 0.0
    for end in (min(growth, given["time"]), given["time"]):
        if end > start:
            y = solve_ivp(rate, (start, end), y, method="DOP853", rtol=1e-13, atol=1e-18).y[:, -1]
            start = end
    return modal, y[:n], y[n : 2 * n], y[2 * n], y[2 * n + 1]


def of_exact_modes(scene, given, modes=1500):
    """The exact cantilever under its forces at once and for ever, every mode for itself; what is left out is 1e-9."""
    shapes, omegas = cantilever_shapes(scene.beam, modes)
    omega, zeta, t = 2 * np.pi * scene.drive.frequency_hz, given.get("modal_damping", 0.0), given["time"]
    p = sum(phasor((f.position, f.amplitude, f.phase_deg)) * shapes(f.position) for f in scene.forces)
    steady = p / (omegas**2 - omega**2 + 2j * zeta * omegas * omega)
    sigma, turning = zeta * omegas, omegas * np.sqrt(1 - zeta**2)
    q, v = -steady.real, (-1j * omega * steady).real
    free = np.exp(-sigma * t) * (q * np.cos(turning * t) + (v + sigma * q) / turning * np.sin(turning * t))
    return float((free + (steady * np.exp(1j * omega * t)).real) @ shapes(given["x"]))


def deflection(scene, given):
    if given.get("model") == "analytic":
        return of_exact_modes(scene, given)
    modal, q, *_ = driven(scene, given)
    return float(q @ modal.shapes(given["x"]))


def energy(scene, given):
    modal, q, v, work, damped = driven(scene, given)
    parts = {
        "kinetic": v @ v / 2,
        "elastic": (modal.omegas * q) @ (modal.omegas * q) / 2,
        "work_in": work,
        "damped": damped,
    }
    return float(parts[given["of"]])


# --- A beam let go from two straight lines ----------------------------------------------------------------------------


def cantilever_shapes(beam, modes):
    """Cosh - cos - s (sinh - sin) of a clamped-free beam, written in what decays, mass-normalised, and omegas."""
    y = np.array([(n - 0.5) * np.pi for n in range(1, modes + 1)])
    for n in range(min(modes, 12)):
        y[n] = float(mp.findroot(lambda y: mp.cos(y) + 1 / mp.cosh(y), max(1.9, y[n])))
    low = np.exp(-y)
    top = (np.sin(y) - np.cos(y) - low) / (1 - low**2 + 2 * np.sin(y) * low)  # (1 - s) e^y / 2
    s = 1 - 2 * top * low

    def shapes(x):
        z = y * x / beam.length
        found = top * np.exp(z - y) + 0.5 * (1 + s) * np.exp(-z) - np.cos(z) + s * np.sin(z)
        return found / np.sqrt(beam.mass_per_length * beam.length)

    return shapes, y**2 * np.sqrt(beam.bending_stiffness / beam.mass_per_length) / beam.length**2


FINE = (18, 30)
"""Elements of the arm up to and from its gear box, where links are held against the beam itself."""


def shares_with_bodies(scene, given):
    """(shares v^T M w of straight lines to 1 at their corner, shapes, omegas) of elements with bodies that turn."""
    beam, place = scene.beam, given["place"]
    counts = COUNTS[scene.name, "fem", given["count"]] if given["model"] == "fem" else FINE
    modal = Modal(Elements(beam, equal(beam, counts)))
    edges = np.union1d(modal.model.nodes, [place])
    z, weights = np.polynomial.legendre.leggauss(6)
    half = np.diff(edges)[:, None] / 2
    x, w = (edges[:-1, None] + half * (1 + z)).ravel(), (half * weights).ravel() * beam.mass_per_length
    corners, ends = [0, place, beam.length], [0, 1, 0]
    load = sum(one * np.interp(at, corners, ends) * modal.model.row(at) for one, at in zip(w, x, strict=True))
    for body in beam.mass:
        slope = 1 / place if body.position < place else -1 / (beam.length - place)
        load = load + body.mass * np.interp(body.position, corners, ends) * modal.model.row(body.position)
        load = load + body.rotary_inertia * slope * modal.model.row(body.position, 1)
    return load[modal.model.free] @ modal.vectors, modal.shapes, modal.omegas


def released(scene, given):
    """(q, dq/dt, shapes, omegas) at a time: the shares of the lines, then every mode for itself."""
    unit, shapes, omegas = (shares_with_bodies if scene.beam.mass else shares_of_lines)(scene, given)
    zeta = given.get("modal_damping", 0.0)
    sigma, turning = zeta * omegas, omegas * np.sqrt(1 - zeta**2)
    q, v, t = given.get("height", 0.0) * unit, given.get("speed", 0.0) * unit, given["time"]
    c, s, decay = np.cos(turning * t), np.sin(turning * t), np.exp(-sigma * t)
    now = decay * (q * c + (v + sigma * q) / turning * s)
    rate = decay * (v * c - (omegas**2 * q + sigma * v) / turning * s)
    return now, rate, shapes, omegas


def shares_of_lines(scene, given):
    """(shares of straight lines to 1 at their corner, shapes, omegas): the least mean square, with nothing on a beam."""
    beam, place = scene.beam, given["place"]
    with mp.workdps(40):
        if given["model"] == "analytic":
            shapes, omegas = cantilever_shapes(beam, given["modes"])
            edges = np.linspace(0, beam.length, 3 * given["modes"] + 1)
        else:
            modal = Modal(model_of(scene, given))
            shapes, omegas, edges = modal.shapes, modal.omegas, modal.model.nodes
        edges = np.union1d(np.union1d(edges, cuts(beam)), [place])
        edges = edges[np.append(True, np.diff(edges) > 1e-12)]
        z, weights = np.polynomial.legendre.leggauss(6)
        half = np.diff(edges)[:, None] / 2
        x, w = (edges[:-1, None] + half * (1 + z)).ravel(), (half * weights).ravel() * beam.mass_per_length
        phi = np.array([shapes(one) for one in x]).T
    lines = np.interp(x, [0, place, beam.length], [0, 1, 0])
    unit = np.linalg.solve(phi * w @ phi.T, phi * w @ lines)
    return unit, shapes, omegas


def released_deflection(scene, given):
    q, _, shapes, _ = released(scene, given)
    with mp.workdps(40):
        return float(q @ shapes(given["x"]))


def released_energy(scene, given):
    q, v, _, omegas = released(scene, given)
    return float(v @ v / 2 if given["of"] == "kinetic" else (omegas * q) @ (omegas * q) / 2)


# --- At rest ----------------------------------------------------------------------------------------------------------


def buckling(scene, given):
    """The compression at which stiffness less its share of the links' or cubics' turns is singular first."""
    beam = scene.beam
    if given["model"] == "analytic":
        return exact_buckling(beam)
    model = model_of(scene, given)
    keep = np.ix_(model.free, model.free)
    if given["model"] == "fem":
        pulled, stiff = np.zeros_like(model.bent), model.bent + model.held
        from carried_reference import hermite

        for i, length in enumerate(model.lengths):
            pulled[2 * i : 2 * i + 4, 2 * i : 2 * i + 4] += hermite(length)[1]
        stiff = stiff - beam.tension * pulled
        return float(1 / eigh(pulled[keep], stiff[keep], eigvals_only=True)[-1])
    pulled = (model.tilt.T * model.lengths) @ model.tilt
    held, load = model.held - beam.tension * pulled, 0.0
    for _ in range(60 if given.get("joints") == "tensioned" else 1):  # joints of a column stiffen as the force grows
        soft = model.soft / (1 + load * model.lengths[0] * model.soft / 12) if load else model.soft
        bent = (model.bend.T / soft) @ model.bend
        load = float(1 / eigh(pulled[keep], (bent + held)[keep], eigvals_only=True)[-1])
    return load


def exact_buckling(beam):
    """Where w, psi, M, S of the compressed beam at rest can keep both ends, in 60 digits."""
    scale = beam.bending_stiffness / beam.length**2

    def determinant(load):
        with mp.workdps(DIGITS):
            states, stiff = mp.zeros(4, 2), mp.mpf(beam.bending_stiffness)
            for column, left in enumerate(_FREE[beam.supports[0]]):
                states[left, column] = 1
            ends = np.cumsum([piece.length for piece in beam.pieces])
            stops = cuts(beam)
            for one in beam.spring:
                if one.position == 0.0:
                    states = sprung(beam, one) * states
            for a, b in pairwise(stops):
                piece = beam.pieces[min(int(np.searchsorted(ends, (a + b) / 2)), len(ends) - 1)]
                bend, ground = stiff / piece.bending_stiffness, beam.foundation * mp.mpf(beam.length) ** 4 / stiff
                law = mp.matrix([[0, 1, 0, 0], [0, 0, bend, 0], [0, -mp.mpf(load), 0, -1], [ground, 0, 0, 0]])
                states = _exponential(law * (mp.mpf(b) - mp.mpf(a)) / beam.length) * states
                for one in beam.spring:
                    if one.position == b:
                        states = sprung(beam, one) * states
            held = [i for i in range(4) if i not in _FREE[beam.supports[1]]]
            return mp.det(mp.matrix([[states[i, j] for j in range(2)] for i in held]))

    load, step = 0.01, 0.9
    while determinant(load) * determinant(load + step) > 0:
        load += step
    with mp.workdps(DIGITS):
        root = mp.findroot(determinant, (load, load + step), solver="anderson", tol=1e-40, verify=False)
    return float(root) * scale


def sprung(beam, one):
    past, length, stiff = mp.eye(4), mp.mpf(beam.length), mp.mpf(beam.bending_stiffness)
    past[3, 0] += one.stiffness * length**3 / stiff
    past[2, 1] += one.rotational * length / stiff
    return past


def bent(scene, given):
    """Turns of a cantilever's joints where its energy is least under a dead load and a moment, and their springs."""
    beam, n = scene.beam, given["count"]
    soft = np.ones(n)
    soft[:3] = GREGORY if given.get("wall", "gregory") == "gregory" else (0.5, 1.0, 1.0)
    springs, length = beam.bending_stiffness * n / beam.length / soft, beam.length / n
    theta = np.zeros(n)
    for part in np.linspace(0.1, 1.0, 10):
        along, across, moment = (part * given.get(name, 0.0) for name in ("along", "across", "moment"))
        for _ in range(60):
            angle = np.cumsum(theta)
            c, s = length * np.cos(angle), length * np.sin(angle)
            after = [np.cumsum(one[::-1])[::-1] for one in (c, s)]
            slope = springs * theta - across * after[0] + along * after[1] - moment
            later = np.maximum.outer(np.arange(n), np.arange(n))
            stiff = np.diag(springs) + (across * after[1] + along * after[0])[later]
            step = np.linalg.solve(stiff, slope)
            theta = theta - step
            if abs(step).max() < 1e-15:
                break
    return theta, springs, length


def bent_tip(scene, given):
    theta, _, length = bent(scene, given)
    angle = np.cumsum(theta)
    if given.get("component", "deflection") == "deflection":
        return float(length * np.sin(angle).sum())
    return float(length * (1 - np.cos(angle)).sum())


def bent_energy(scene, given):
    """Of the joints, and of the half link from the last one's middle to the tip."""
    theta, springs, length = bent(scene, given)
    return float(springs @ theta**2 / 2 + given.get("moment", 0.0) ** 2 * length / (4 * scene.beam.bending_stiffness))


# --- Two waves of a pinned beam under two forces or displacements ------------------------------------------------------


class Crests:
    """Reflection and crest speed in the middle half, undamped, by Green's function and a least mean square."""

    def __init__(self, scene, given):
        self.beam, self.kind = scene.beam, given.get("drive", scene.drive.kind)
        self.forces = [(f.position, f.amplitude, f.phase_deg) for f in scene.forces]
        self.phase = self.forces[1][2]
        z, weights = np.polynomial.legendre.leggauss(400)
        self.x, self.weights = self.beam.length * (0.5 + z / 4), weights

    def green(self, k, source, x):
        length = self.beam.length
        a, b = np.minimum(x, source), length - np.maximum(x, source)
        near = np.exp(k * (a + b - length)) * (1 - np.exp(-2 * k * a)) * (1 - np.exp(-2 * k * b))
        near /= 2 * (1 - np.exp(-2 * k * length))
        return (np.sin(k * a) * np.sin(k * b) / np.sin(k * length) - near) / (2 * self.beam.bending_stiffness * k**3)

    def at(self, hertz, phases):
        """(reflection, crest speed) over phases of the second drive, degrees."""
        beam, omega, (first, second) = self.beam, 2 * np.pi * hertz, self.forces
        k = (beam.mass_per_length * omega**2 / beam.bending_stiffness) ** 0.25
        turned = second[1] * np.exp(1j * np.deg2rad(phases))
        given = np.array([np.full_like(turned, phasor(first)), turned])
        places = np.array([first[0], second[0]])
        if self.kind == "displacement":
            given = np.linalg.solve(np.array([self.green(k, p, places) for p in places]).T, given)
        fields = np.array([self.green(k, p, self.x) for p in places])
        basis = np.exp(np.outer(self.x - 0.5 * beam.length, [-1j * k, 1j * k]))
        adjoint = (basis.conj().T) * self.weights
        plus, minus = abs(np.linalg.solve(adjoint @ basis, adjoint @ fields.T) @ given) ** 2
        speed = -omega * beam.thickness / 2 * k * (plus - minus) / np.sqrt(plus + minus)
        return np.sqrt(np.minimum(plus, minus) / np.maximum(plus, minus)), speed

    def one(self, hertz, phase):
        return [float(value[0]) for value in self.at(hertz, np.array([phase]))]


def fastest_crests(scene, given):
    """By every frequency's best phase: inside the limit, or on it."""
    crests, limit, drive = Crests(scene, given), given.get("limit", 0.1), scene.drive.frequency_hz
    phases = np.linspace(5.0, 175.0, 171)

    def best(hertz):
        gammas, speeds = crests.at(hertz, phases)
        over = np.flatnonzero(np.diff(np.sign(gammas - limit)))
        ends = [brentq(lambda p: crests.one(hertz, p)[0] - limit, phases[i], phases[i + 1], xtol=1e-12) for i in over]
        return max((*(abs(crests.one(hertz, p)[1]) for p in ends), *abs(speeds[gammas <= limit])), default=0.0)

    grid = np.linspace(0.985, 1.015, 121) * drive
    speeds = [best(f) for f in grid]
    top = int(np.argmax(speeds))
    low, high = grid[max(top - 1, 0)], grid[min(top + 1, 120)]
    found = minimize_scalar(lambda f: -best(f), bounds=(low, high), method="bounded", options={"xatol": 1e-9})
    return float(np.copysign(max(-found.fun, speeds[top]), crests.one(drive, crests.phase)[1]))


def per_hertz(scene, given):
    crests, drive = Crests(scene, given), scene.drive.frequency_hz
    here = crests.one(drive, crests.phase)[0]
    return sum(abs(crests.one(drive + s, crests.phase)[0] - here) for s in (-0.5, 0.5))


def per_degree(scene, given):
    crests, drive = Crests(scene, given), scene.drive.frequency_hz
    if "frequency_hz" in given:
        return per_degree_on_resonance(scene, given)
    here = crests.one(drive, crests.phase)[0]
    return sum(abs(crests.one(drive, crests.phase + s)[0] - here) for s in (-0.5, 0.5))


def reflection(scene, given):
    """Of two waves at the wavenumber that theory, tension and ground give, fitted to the states in the mean square."""
    beam, theory = (
        replace(scene.beam, loss_factor=given.get("loss_factor", 0.0)),
        given.get("theory", "euler-bernoulli"),
    )
    hertz, (start, end) = given.get("frequency_hz", scene.drive.frequency_hz), given["window"]
    omega, lossy, (piece,) = 2 * np.pi * hertz, 1 + 1j * beam.loss_factor, beam.pieces
    stiff, mass = piece.bending_stiffness * lossy, piece.mass_per_length * omega**2 - beam.foundation
    if theory == "timoshenko":
        shear, rotary = piece.shear_stiffness * lossy, piece.rotary_inertia * omega**2
        roots = np.roots([shear * stiff, 0, -(mass * stiff + rotary * shear), 0, mass * (rotary - shear)])
    else:
        rotary = piece.rotary_inertia * omega**2 if theory == "rayleigh" else 0.0
        roots = np.roots([stiff, 0, beam.tension - rotary, 0, -mass])
    k = max(roots, key=lambda root: root.real / (1 + abs(root.imag)))
    z, weights = np.polynomial.legendre.leggauss(24)
    x, forces = (
        (start + end) / 2 + (end - start) / 2 * z,
        [(f.position, f.amplitude, f.phase_deg) for f in scene.forces],
    )
    w = np.array([field(beam, theory, hertz, forces, one)[0] for one in x])
    basis = np.exp(np.outer(x - (start + end) / 2, [-1j * k, 1j * k]))
    adjoint = basis.conj().T * weights
    sizes = abs(np.linalg.solve(adjoint @ basis, adjoint @ w))
    return float(min(sizes) / max(sizes))


def fitted_reflection(scene, given):
    """Of the undamped pinned beam's steady field at evenly spaced places, at the wavenumber that leaves least."""
    crests, hertz = Crests(scene, given), scene.drive.frequency_hz
    beam, x = scene.beam, np.linspace(*given["window"], given.get("points", 40))
    exact = (beam.mass_per_length * (2 * np.pi * hertz) ** 2 / beam.bending_stiffness) ** 0.25
    w = sum(phasor(f) * crests.green(exact, f[0], x) for f in crests.forces)

    def fit(k):
        basis = np.exp(np.outer(x - x.mean(), [-1j * k, 1j * k]))
        waves = np.linalg.lstsq(basis, w, rcond=None)[0]
        return abs(waves), float(np.linalg.norm(w - basis @ waves))

    grid = np.linspace(0.97, 1.03, 601) * exact
    near = grid[int(np.argmin([fit(k)[1] for k in grid]))]
    found = minimize_scalar(
        lambda k: fit(k)[1] ** 2, bounds=(near * 0.9999, near * 1.0001), method="bounded", options={"xatol": 1e-10}
    )
    waves = fit(found.x)[0]
    return float(waves.min() / waves.max())


def thickness_at(beam, x):
    """Of the section that stands at x, as it is written down."""
    left = 0.0
    for section in beam.section:
        left += section.length
        if x < left:
            return beam.thickness if section.thickness is None else section.thickness
    return beam.thickness


def axis_ratio(scene, given):
    """Of the ellipse of a surface point: shorter over longer axis of Re((u, w) e^{i omega t}), signed as it turns."""
    beam = replace(scene.beam, loss_factor=given.get("loss_factor", 0.0))
    hertz, forces = scene.drive.frequency_hz, [(f.position, f.amplitude, f.phase_deg) for f in scene.forces]
    w, turn, *_ = field(beam, "euler-bernoulli", hertz, forces, given["x"])
    across = -thickness_at(beam, given["x"]) / 2 * turn
    axes = np.array([[across.real, across.imag], [w.real, w.imag]])
    longer, shorter = np.linalg.svd(axes, compute_uv=False)
    return float(shorter / longer * np.sign(np.linalg.det(axes)))


def per_degree_on_resonance(scene, given):
    """From both sides of a frequency at which the beam without its actuators resonates, held at them it does not."""
    crests, phase = Crests(scene, given), scene.forces[1].phase_deg
    sides = given["frequency_hz"] * (1 + np.array([-1e-6, 1e-6]))
    here, up, down = (np.mean([crests.one(f, phase + turn)[0] for f in sides]) for turn in (0.0, 0.5, -0.5))
    return float(abs(up - here) + abs(down - here))


KNOWN = {
    "motion.deflection": deflection,
    "motion.energy": energy,
    "motion.reflection": fitted_reflection,
    "motion.released_deflection": released_deflection,
    "motion.released_energy": released_energy,
    "beam.buckling_load": buckling,
    "chain.bent_tip": bent_tip,
    "chain.bent_energy": bent_energy,
    "wave.fastest_crests": fastest_crests,
    "wave.axis_ratio": axis_ratio,
    "wave.reflection": reflection,
    "wave.reflection_per_hertz": per_hertz,
    "wave.reflection_per_degree": per_degree,
}
"""By quantity: what takes a scene and arguments."""
