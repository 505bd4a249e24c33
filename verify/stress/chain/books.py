"""Books of the nonlinear chain that no scene opens: about rest, over kicks, of held points, of links that stretch."""

from dataclasses import replace as changed
from math import pi, sin

import numpy as np

from verify.beam import PointForce
from verify.chain import warm
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.references.beams import STRIP, held

CLAMPED = held("clamped", "free")
FINE = 0.025
"""Of the longest step of links that stretch: what RK4 takes off their waves is then nothing."""
FEW = 4
"""Of its lowest modes."""
NEAR = 1e-10
"""Of a step: so far from its end the chain has moved by nothing that would be seen."""


def kicks_error(kicks: float) -> float:
    """Error of a scheme of so many kicks as Gauss's quadrature of a step: moments up to 2 kicks - 1."""
    from verify.chain.splitting import SCHEMES

    flows, weights = SCHEMES[int(kicks)]
    at = np.cumsum(flows)
    moments = [abs(float(np.dot(weights, at[:-1] ** p)) - 1.0 / (p + 1)) for p in range(2 * int(kicks))]
    return largest(*moments, abs(float(at[-1]) - 1.0))


def chain_modes_error(n: float) -> float:
    """Of n hinged links, all modes and the lowest alone: frequencies in closed form, and duals of their modes."""
    from verify.chain.splitting import modal_basis
    from verify.chain.system import build_system

    system, worst = build_system(STRIP, int(n)), 0.0
    for basis in (modal_basis(system), modal_basis(system, n_modes=FEW)):
        omega = basis.omega[:-1]  # last stands the motion off the roller's line
        s2 = np.sin(np.arange(1.0, len(omega) + 1.0) * pi / (2.0 * n)) ** 2
        exact = np.sqrt(48.0 * s2 * s2 / (3.0 - 2.0 * s2)) * STRIP.wave_constant * (n / STRIP.length) ** 2
        apart = basis.duals @ basis.modes.T - np.eye(len(basis.omega))
        worst = largest(worst, float(abs(omega[:FEW] / exact[:FEW] - 1.0).max()), float(abs(apart).max()))
    return worst


def bent_rest_error(n: float) -> float:
    """By how much a chain that hangs still by its weight moves by linear flow, over how far it is bent."""
    from verify.chain.splitting import modal_basis, simulate_linear
    from verify.chain.statics import solve_static
    from verify.chain.system import build_system

    system = changed(build_system(held("clamped", "free"), int(n)), gravity=(0.0, -9.81))
    rest = solve_static(system)
    moved = simulate_linear(modal_basis(system, rest), rest, np.linspace(0.0, 0.3, 5))
    return float(abs(moved.angles - rest.angles).max() / abs(rest.angles).max())


def late_books_error(n: float) -> float:
    """What is missing in the books of a driven chain that are opened late, over what was put in, by its tolerance."""
    from verify.chain.dynamics import at_rest
    from verify.chain.stepping import simulate
    from verify.chain.system import build_system

    beam, tolerance = held("clamped", "free"), 1e-9
    system = build_system(beam, int(n), (PointForce(position=0.6, amplitude=0.3),), 9.0, joint_dashpot=1e-3)
    motion = simulate(system, at_rest(system), np.linspace(0.05, 0.2, 4), tolerance=tolerance)
    given = float(np.ptp(motion.work_in)) + float(np.ptp(motion.dissipated))
    return float(abs(motion.residual()).max()) / given / (tolerance * motion.statistics.steps)


def stretching_books_error(n: float) -> float:
    """Energy of links let go from a sine and followed, against its closed form at first.

    Joints bend by 4 sin^2(pi / 2N) A / l sin(pi j / N) each, links stretch by half the square of their slopes,
    2 sin(pi / 2N) A / l cos(pi (j - 1/2) / N); what is left out is the square of the largest slope.
    """
    from verify.chain.stretching import elastic_step_limit, simulate_elastic
    from verify.chain.system import build_system

    links, size, stiffness = int(n), 1e-4 * STRIP.length, 8.05e6
    system = build_system(STRIP, links)
    link = STRIP.length / links
    shape = size * np.sin(pi * np.arange(links + 1.0) / links)
    step = FINE * elastic_step_limit(system, stiffness)
    motion = simulate_elastic(system, stiffness, np.linspace(0.0, 1e-3, 3), step=step, deflected=shape)
    slope = 2.0 * sin(pi / (2.0 * links)) * size / link
    bent = STRIP.bending_stiffness / link * (2.0 * sin(pi / (2.0 * links)) * slope) ** 2 * links / 4.0
    stretched = stiffness * link * slope**4 * 3.0 * links / 64.0
    return largest(abs(float(energy) / (bent + stretched) - 1.0) for energy in motion.energies) / slope**2


def stretching_work_error(n: float) -> float:
    """Energy of heavy links that a constant force pulls both ways and a moment turns, over its work, less one."""
    from verify.chain.stretching import elastic_step_limit, simulate_elastic
    from verify.chain.system import LinkLoad, build_system

    links, stiffness, along, across = int(n), 8.05e6, 300.0, 0.2
    length, moment = STRIP.length / links, 0.02
    end = LinkLoad(link=links, at=length, force=(along, across), moment=moment)
    system = changed(build_system(CLAMPED, links), loads=(end,), gravity=(170.0, -9.81))
    step = FINE * elastic_step_limit(system, stiffness)
    motion = simulate_elastic(system, stiffness, np.linspace(0.0, 1e-3, 4), step=step)
    (x, y), (before, under) = (motion.displacements[1:, joint].T for joint in (-1, -2))
    work = along * x + across * y + moment * np.arctan2(y - under, length + x - before)
    return float(abs((motion.energies[1:] - motion.energies[0]) / work - 1.0).max())


def held_books_error(n: float) -> float:
    """What the books of a chain on a roller miss, shaken at two points, over what it loses, by its tolerance."""
    from verify.chain.dynamics import at_rest, project
    from verify.chain.stepping import simulate
    from verify.chain.system import Actuator, build_system

    links, tolerance = int(n), 1e-9
    shaken = [
        Actuator(link=2, at=0.03, amplitude=0.002, frequency_hz=9.0, phase_deg=-70.0),
        Actuator(link=links - 1, at=0.02, amplitude=0.003, frequency_hz=13.0, phase_deg=40.0),
    ]
    system = changed(build_system(STRIP, links, joint_dashpot=3e-3), actuators=tuple(shaken), gravity=(9.81, 0.0))
    start, _ = project(system, at_rest(system))
    motion = simulate(system, start, np.linspace(0.0, 0.15, 4), tolerance=tolerance)
    return float(abs(motion.residual()).max() / motion.dissipated[-1]) / (tolerance * motion.statistics.steps)


def kept_between_error(n: float) -> float:
    """States kept within steps against a run in steps a tenth as long, over the largest and the tolerance of all."""
    from verify.chain.dynamics import at_rest
    from verify.chain.stepping import simulate
    from verify.chain.system import build_system

    tolerance = 1e-6
    system = build_system(CLAMPED, int(n), (PointForce(position=0.6, amplitude=0.3),), 9.0, joint_dashpot=1e-3)
    times = np.linspace(0.01, 0.05, 37)
    coarse, fine = (simulate(system, at_rest(system), times, tolerance=part * tolerance) for part in (1.0, 1e-5))
    pairs = ((coarse.angles, fine.angles), (coarse.rates, fine.rates))
    worst = max(float(abs(kept - true).max() / abs(true).max()) for kept, true in pairs)
    return worst / (tolerance * coarse.statistics.steps)


def kicks_energy_error(kicks: float) -> float:
    """Drift of energy of a cantilever let go, in steps of so many kicks, at every time kept."""
    from verify.chain.dynamics import at_rest
    from verify.chain.splitting import modal_basis, simulate_modal
    from verify.chain.system import build_system

    system = build_system(CLAMPED, 8)
    start = at_rest(system, np.linspace(0.004, 0.0, 8))
    motion = simulate_modal(modal_basis(system), start, np.linspace(0.0, 0.04, 23), step=1e-4, kicks=int(kicks))
    total = np.sum(motion.energies(), axis=0)
    return float(abs(total / total[0] - 1.0).max())


def kept_over_kicks_error(microseconds: float) -> float:
    """Of states kept within steps of kicks: jumps at the ends of steps, and angles against their rates.

    Over the largest; the second where no mode turns by 2 in a step.
    """
    from verify.chain.dynamics import at_rest
    from verify.chain.splitting import modal_basis, simulate_modal
    from verify.chain.system import build_system

    step, forces = 1e-6 * microseconds, (PointForce(position=0.61, amplitude=800.0),)
    system = build_system(CLAMPED, 8, forces, 37.0)
    basis, begins = modal_basis(system), np.arange(round(0.02 / step))
    times = step * np.append(
        (begins[:, None] + np.array([0.0, NEAR, 0.29, 0.3, 0.31, 1.0 - NEAR])).ravel(), len(begins)
    )
    run = simulate_modal(basis, at_rest(system), times, step=step)
    kept = run.angles, run.rates
    angles, rates = (one[:-1].reshape(len(begins), 6, -1) for one in kept)
    apart = []
    for one, every in zip((angles, rates), kept, strict=True):
        ends = np.concatenate([one[1:, 0], every[-1:]])
        apart += [abs(one[:, 1] - one[:, 0]).max() / abs(every).max(), abs(one[:, 5] - ends).max() / abs(every).max()]
    if step * basis.omega.max() < 2.0:
        mean = (rates[:, 2] + 4.0 * rates[:, 3] + rates[:, 4]) / 6.0
        apart.append(abs((angles[:, 4] - angles[:, 2]) / (0.02 * step) - mean).max() / abs(rates).max())
    return float(np.max(apart))


def thrown_far_error(n: float) -> float:
    """Of hinged links let go far from straight: kicks of two steps, less what falls with their square, by adaptive."""
    from verify.chain.dynamics import at_rest
    from verify.chain.splitting import modal_basis, simulate_modal
    from verify.chain.stepping import simulate
    from verify.chain.system import build_system

    system, times, at = build_system(STRIP, int(n)), np.linspace(0.0, 0.02, 41), (np.arange(n) + 0.5) / n
    start = at_rest(system, 0.6 * np.cos(pi * at) + 0.18 * np.cos(2.0 * pi * at))
    exact = simulate(system, start, times, tolerance=1e-11, ledger=False).angles
    coarse, fine = (simulate_modal(modal_basis(system), start, times, step=step).angles for step in (2e-5, 1e-5))
    return float(abs((4.0 * fine - coarse) / 3.0 - exact).max() / abs(exact).max())


def worst_frequency_error(n: float) -> float:
    """Of how much a chain under two loads feels a slider, against the larger of both alone, either given first."""
    from verify.chain.ride import coupling_on_chain
    from verify.chain.system import LinkLoad, build_system
    from verify.slider import Slider

    link, slider = STRIP.length / n, Slider(mass=0.004, mu=0.3, position=0.37, coupling="one-way")
    system = build_system(STRIP, int(n), joint_dashpot=0.01)
    loads = [
        LinkLoad(link=2, at=0.3 * link, force=(0.0, force), frequency_hz=hertz)
        for force, hertz in ((0.7, 41.0), (0.2, 137.0))
    ]
    sizes = []
    for acting in ([loads[0]], [loads[1]], loads, loads[::-1]):
        found = coupling_on_chain(changed(system, loads=tuple(acting)), STRIP, slider)
        sizes.append((found and found.relative_size) or 0.0)
    return largest(abs(one / max(sizes[:2]) - 1.0) for one in sizes[2:]) + float(sizes[0] == sizes[1])


ROWS: tuple[Row, ...] = (
    Floor(
        id="kick-schemes",
        title="Steps of 1, 2 and 3 kicks as Gauss's quadrature, moments up to twice the kicks less one",
        why="chain/splitting.py: kicks stand and weigh as Gauss's points do.",
        along="kicks",
        at=(1, 2, 3),
        promise=1e-15,
        error=kicks_error,
    ),
    Floor(
        id="chain-modes",
        title="All modes of hinged links, and the lowest alone: frequencies in closed form, duals of their modes",
        why="chain/splitting.py, chain/modes.py: K is assembled, whose rounding grows like N^4.",
        along="links",
        at=(8, 12, 20),
        promise=2e-11,
        error=chain_modes_error,
        kernels=warm.rigid,
    ),
    Floor(
        id="linear-about-bent",
        title="A chain that hangs still by its weight, moved by the linear flow about there",
        why="chain/splitting.py: an equilibrium stands still to rounding.",
        along="links",
        at=(6, 20),
        promise=1e-13,
        error=bent_rest_error,
        kernels=warm.rigid,
    ),
    Floor(
        id="books-opened-late",
        title="Work, loss and energy of a driven chain from a later time on, over the tolerance of all steps",
        why="chain/stepping.py: the error of a step is held to the tolerance; energy is of second degree: twice that.",
        along="links",
        at=(6, 12),
        promise=2.0,
        error=late_books_error,
        kernels=warm.rigid,
    ),
    Floor(
        id="stretching-energy",
        title="Energy of links that stretch, let go from a sine, over the square of its slope",
        why="Half the square of the slope is left out of a link's stretch, and a quarter of its joints' angles.",
        along="links",
        at=(6, 20),
        promise=1.0,
        error=stretching_books_error,
        kernels=warm.stretching,
    ),
    Floor(
        id="stretching-work",
        title="Energy of heavy links that stretch under a constant force along and across, against its work",
        why="Energy is work; RK4 in a fortieth of its limit loses 4e-8.",
        along="links",
        at=(6, 20),
        promise=1e-7,
        error=stretching_work_error,
        kernels=warm.stretching,
    ),
    Floor(
        id="shaken-at-two-points",
        title="Work, loss and energy of a heavy chain shaken at two points, over the tolerance of all steps",
        why="chain/stepping.py: the error of a step is held to the tolerance; energy is of second degree: twice that.",
        along="links",
        at=(6, 9),
        promise=2.0,
        error=held_books_error,
        kernels=warm.rigid,
    ),
    Floor(
        id="kept-between-steps",
        title="States kept within steps against those of steps a tenth as long, over the tolerance of all steps",
        why="chain/kernels.py: quintic between steps, no further off than the steps themselves.",
        along="links",
        at=(6, 9),
        promise=2.0,
        error=kept_between_error,
        kernels=warm.rigid,
    ),
    Floor(
        id="kicks-thrown-far",
        title="Hinged links let go far from straight, over kicks of two steps and extrapolated, by adaptive steps",
        why="chain/splitting.py: the roller is closed afresh along its own force; errors fall with the step's square.",
        along="links",
        at=(5, 6),
        promise=2e-9,
        error=thrown_far_error,
        kernels=warm.modal,
    ),
    Floor(
        id="kept-over-kicks",
        title="States kept within steps of kicks: jumps at the ends of steps, and angles against their rates",
        why="chain/splitting.py: what kicks add is spread by a cubic, in fast modes by a line.",
        along="microseconds",
        at=(700, 1000),
        promise=1e-9,
        error=kept_over_kicks_error,
        kernels=warm.modal,
    ),
    Floor(
        id="felt-at-the-worst-frequency",
        title="How much a chain under two loads feels a slider, against the larger of both alone",
        why="chain/ride.py: the larger of its loads' sizes, whichever is given first.",
        along="links",
        at=(9,),
        promise=1e-12,
        error=worst_frequency_error,
    ),
    Floor(
        id="energy-over-kicks",
        title="Energy of a cantilever let go at a swing of a hundredth, in steps of 1, 2 and 3 kicks",
        why="chain/splitting.py: symmetric steps neither feed nor drain; at this swing and step they leave 3e-8.",
        along="kicks",
        at=(1, 2, 3),
        promise=1e-7,
        error=kicks_energy_error,
        kernels=warm.modal,
    ),
)
