"""An implicit method beside the bench's own on the nonlinear chain: midpoint with an O(N) Newton iteration.

The bench of a chain (`verify bench chain --sets chain`) has exact linear flow with kicks, RK4 and adaptive steps. Here
midpoint in absolute coordinates joins it: three to a link, joints and roller held by multipliers, a banded Newton step
with half bandwidth 5, all compiled. It has no step limit, order 2, or order 4 by Suzuki's five steps.

Trap: cos sets in as a step load and rings modes of every frequency. Implicit steps that follow the drive but not those
turn them by wrong phases, and stall at what these modes hold of the deflection.
Run: OMP_NUM_THREADS=1 python -m benchmarks.chain_work [links ...]
"""

import sys
from collections.abc import Callable, Iterator
from functools import partial
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from msgspec.structs import replace
from numba import njit

from verify.bench.chain_set import SAMPLES, Chain, chain_cases, chain_of
from verify.bench.kind import Entry, Line, Told
from verify.bench.measuring import measured
from verify.bench.request import Bench
from verify.bench.sentences import sentences_of
from verify.bench.sets import settled
from verify.chain.splitting import ModalBasis, modal_basis
from verify.models.arrays import Array
from verify.scenes.scene import load_scene

BAND, WIDTH = 5, 16
"""Half bandwidth, and of a row with what pivoting fills in."""
SHARE = 1.0 / (4.0 - 4.0 ** (1.0 / 3.0))
SUZUKI = np.array([SHARE, SHARE, 1.0 - 4.0 * SHARE, SHARE, SHARE])
"""M. Suzuki, Phys. Lett. A 146 (1990) 319: five steps of a symmetric method of order 2 are of order 4."""
NEWTON, MOST = 1e-7, 12
"""Change of the angles, over the largest, after which the next iteration would change nothing; iterations at most."""


class Links(NamedTuple):
    """A uniform chain in absolute coordinates (x, y, theta) of its links' middles."""

    link: float
    mass: float
    inertia: float
    spring: float
    loads: Array
    """(n_loads, 5): link from 0, metres from its middle, amplitude, circular frequency, phase."""


@njit(cache=True)
def forces(s: Links, t: float, q: Array, out: Array) -> None:
    """Springs and loads on every link, (N, 3)."""
    out[:] = 0.0
    for i in range(1, q.shape[0]):
        moment = s.spring * (q[i, 2] - q[i - 1, 2])
        out[i, 2] -= moment
        out[i - 1, 2] += moment
    for k in range(s.loads.shape[0]):
        i, now = int(s.loads[k, 0]), s.loads[k, 2] * np.cos(s.loads[k, 3] * t + s.loads[k, 4])
        out[i, 1] += now
        out[i, 2] += now * s.loads[k, 1] * np.cos(q[i, 2])


@njit(cache=True)
def system(s: Links, h: float, q0: Array, q1: Array, a: Array) -> None:
    """Newton's matrix by rows of its band; unknowns are the two multipliers of a link's near joint, then the link."""
    n, half = q0.shape[0], 0.5 * s.link
    a[:] = 0.0
    for i in range(n):
        r = 5 * i
        for axis in range(2):
            row, x, theta = r + axis, r + 2 + axis, r + 4
            before, now = (
                (-half * np.sin(q0[i, 2]), -half * np.sin(q1[i, 2]))
                if axis == 0
                else (half * np.cos(q0[i, 2]), half * np.cos(q1[i, 2]))
            )
            a[row, x - row + BAND], a[row, theta - row + BAND] = -1.0, now
            a[x, row - x + BAND], a[theta, row - theta + BAND] = -1.0, before
            a[x, BAND] = s.mass / h
            if i + 1 < n:
                after = r + 5 + axis
                a[after, x - after + BAND], a[after, theta - after + BAND] = 1.0, now
                a[x, after - x + BAND], a[theta, after - theta + BAND] = 1.0, before
        joints = min(i, 1) + min(n - 1 - i, 1)
        a[r + 4, BAND] = s.inertia / h + 0.25 * h * s.spring * joints
        if i + 1 < n:
            a[r + 4, BAND + 5] = a[r + 9, BAND - 5] = -0.25 * h * s.spring
    last = 5 * n
    a[last, BAND - 2], a[last, BAND - 1] = 1.0, half * np.cos(q1[n - 1, 2])
    a[last - 2, BAND + 2], a[last - 1, BAND + 1] = 1.0, half * np.cos(q0[n - 1, 2])


@njit(cache=True)
def residual(s: Links, h: float, q0: Array, q1: Array, p: Array, f: Array, b: Array) -> None:
    """What the present iterate leaves of momentum and of the joints, negative; multipliers are solved for whole."""
    n, half = q0.shape[0], 0.5 * s.link
    xe, ye = 0.0, 0.0
    for i in range(n):
        r, c, d = 5 * i, half * np.cos(q1[i, 2]), half * np.sin(q1[i, 2])
        b[r], b[r + 1] = -(xe - q1[i, 0] + c), -(ye - q1[i, 1] + d)
        xe, ye = q1[i, 0] + c, q1[i, 1] + d
        for k in range(3):
            own = s.inertia if k == 2 else s.mass
            b[r + 2 + k] = p[i, k] + 0.5 * h * f[i, k] - own * (q1[i, k] - q0[i, k]) / h
    b[5 * n] = -ye


@njit(cache=True)
def solve(a: Array, b: Array) -> None:
    """Banded elimination with row exchange, in place; the answer in `b`."""
    n = b.size
    for c in range(n):
        end = min(c + BAND, n - 1)
        best = c
        for r in range(c + 1, end + 1):
            if abs(a[r, c - r + BAND]) > abs(a[best, c - best + BAND]):
                best = r
        if best != c:
            b[c], b[best] = b[best], b[c]
            for j in range(2 * BAND + 1):
                a[c, BAND + j], a[best, BAND + c - best + j] = a[best, BAND + c - best + j], a[c, BAND + j]
        for r in range(c + 1, end + 1):
            ratio = a[r, c - r + BAND] / a[c, BAND]
            if ratio != 0.0:
                b[r] -= ratio * b[c]
                for j in range(1, 2 * BAND + 1):
                    a[r, c - r + BAND + j] -= ratio * a[c, BAND + j]
    for c in range(n - 1, -1, -1):
        total = b[c]
        for j in range(1, min(2 * BAND, n - 1 - c) + 1):
            total -= a[c, BAND + j] * b[c + j]
        b[c] = total / a[c, BAND]


@njit(cache=True)
def midpoint(s: Links, t: float, h: float, q: Array, p: Array, moved: Array, work: tuple) -> int:
    """One step of the midpoint rule as a discrete variational principle, joints held at its end; iterations taken.

    `p` are momenta, `moved` the mean velocity of the step before, (N, 3) each.
    """
    q1, middle, f, a, b = work
    q1[:] = q + h * moved
    largest, taken, change = 1e-12, 0, 1.0
    while change > NEWTON * largest and taken < MOST:
        taken += 1
        middle[:] = 0.5 * (q + q1)
        forces(s, t + 0.5 * h, middle, f)
        system(s, h, q, q1, a)
        residual(s, h, q, q1, p, f, b)
        solve(a, b)
        change = 0.0
        for i in range(q.shape[0]):
            for k in range(3):
                q1[i, k] += b[5 * i + 2 + k]
            change, largest = max(change, abs(b[5 * i + 4])), max(largest, abs(q1[i, 2]))
    middle[:] = 0.5 * (q + q1)
    forces(s, t + 0.5 * h, middle, f)
    for i in range(q.shape[0]):
        for k in range(3):
            moved[i, k] = (q1[i, k] - q[i, k]) / h
            p[i, k] = (s.inertia if k == 2 else s.mass) * moved[i, k] + 0.5 * h * f[i, k]
    q[:] = q1
    return taken


@njit(cache=True)
def march(s: Links, h: float, shares: Array, between: int, kept: Array, at: float, q: Array, work: tuple) -> int:
    """`between` steps of shares of h to a sample of mid-span, which lies `at` from the middle of its link."""
    p, moved, t, taken, link = np.zeros_like(q), np.zeros_like(q), 0.0, 0, q.shape[0] // 2
    for k in range(kept.size):
        for step in range(between):
            t = (k * between + step) * h
            for share in shares:
                taken += midpoint(s, t, share * h, q, p, moved, work)
                t += share * h
        kept[k] = q[link, 1] + at * np.sin(q[link, 2])
    return taken


def links_of(chain: Chain) -> Links:
    """The chain for the implicit kernels."""
    system = chain.system
    link = float(system.lengths[0])
    loads = [
        (load.link - 1, load.at - 0.5 * link, load.force[1], 2 * np.pi * load.frequency_hz, np.deg2rad(load.phase_deg))
        for load in system.loads
    ]
    return Links(link, float(system.masses[0]), float(system.inertias[0]), float(system.stiffness[1]), np.array(loads))


def implicit(chain: Chain, name: str, shares: Array, halvings: int) -> Iterator[Entry]:
    """Midpoint steps, composed by `shares` (1 alone is order 2), over halved steps."""
    s, n = links_of(chain), chain.count
    order = 2.0 if len(shares) == 1 else 4.0
    line = Line(name=name, orders=(order, order), refined="step")

    def run(between: int) -> Told:
        q = np.zeros((n, 3))
        q[:, 0] = (np.arange(n) + 0.5) * s.link
        work = (q.copy(), q.copy(), q.copy(), np.zeros((5 * n + 1, WIDTH)), np.zeros(5 * n + 1))
        kept = np.zeros(SAMPLES)
        at = chain.x - (n // 2 + 0.5) * s.link
        march(s, chain.duration / SAMPLES / between, shares, between, kept, at, q, work)
        return Told(kept)

    for between in (2**k for k in range(halvings)):
        step = chain.duration / SAMPLES / between
        prepare: Callable[[], Callable[[], Told]] = partial(partial, run, between)
        yield Entry(line=line, size=step, count=n, estimate_s=0.0, prepare=prepare, settings={"step": step})


def ringing(basis: ModalBasis, x: float, above_hz: float) -> float:
    """Rms that free motion of modes above a frequency holds of the linear chain's mid-span, metres."""
    omega, drives = basis.omega, basis.drives
    moving = omega > 2 * np.pi * above_hz
    reach = np.clip(x - basis.system.nodes[:-1], 0.0, basis.system.lengths)
    weights = np.cumsum(basis.modes, axis=1) @ reach
    place = np.cos(drives[:, 1]) @ basis.shares
    speed = -(drives[:, 0] * np.sin(drives[:, 1])) @ basis.shares
    squares = weights[moving] ** 2 * (place[moving] ** 2 + (speed[moving] / omega[moving]) ** 2)
    return float(np.sqrt(0.5 * squares.sum()))


def compare(n: int) -> None:
    """All integrators on one chain: rows, sentences, and what the step load leaves ringing."""
    scene = load_scene("chain")
    its = settled(Bench(sets=("chain",), counts=(n,), duration=2e-3, peers=False), scene)
    chain, (case,) = chain_of(scene, its, n), chain_cases(scene, its)
    midpoint = [*implicit(chain, "midpoint", np.ones(1), 6), *implicit(chain, "midpoint, order 4", SUZUKI, 5)]
    pairs = (*case.pairs, *(("kicks, 2", one) for one in ("midpoint", "midpoint, order 4")))
    found = measured(replace(case, entries=(*case.entries, *midpoint), pairs=pairs), {}, 9, 60.0)
    for one in found:
        row = one.row
        size = "" if not one.entry.size else f"{one.entry.size:.3g}"
        order = "" if row.order is None else f"{row.order:.2f}"
        took = f"{1e3 * (row.whole_s or 0.0):.3f} ms" if row.rounds else row.left_out
        print(f"  {row.method:<20}{size:>10}{row.error or 0.0:>12.1e}{order:>7}{took:>14}")
    for told in sentences_of(replace(case, pairs=pairs), found, scene.name):
        print(f"- {told.text}")
    _trap(chain, [one.row.error or 0.0 for one in found if one.row.method == "midpoint, order 4"])


def _trap(chain: Chain, errors: list[float]) -> None:
    """What the step load leaves ringing, and what that does to an implicit method of order 4."""
    basis = modal_basis(chain.system)
    all_of_it = ringing(basis, chain.x, 0.0)
    held = {khz: ringing(basis, chain.x, 1e3 * khz) / all_of_it for khz in (6, 10, 20, 40, 80)}
    print(
        "  the step load leaves ringing, over all free motion there: "
        + ", ".join(f"{share:.1e} above {khz} kHz" for khz, share in held.items() if share)
    )
    falls = ", ".join(f"{a / b:.3g}" for a, b in pairwise(errors))
    print(f"  over halved steps the implicit error falls by {falls}, where order 4 says 16")


def main() -> None:
    """Both sizes, or those named."""
    for n in [int(word) for word in sys.argv[1:]] or [49, 199]:
        compare(n)


if __name__ == "__main__":
    main()
