"""What engines of relative joint angles share: their modes from their own matrices, and mid-span from their angles."""

import numpy as np

from verify.models.arrays import Array
from verify.peers.case import Case, PeerRun, Sled, every


def frequencies(mass: Array, closure: Array, stiffness: Array) -> Array:
    """(n - 1,), Hz, of a tree whose first joint, without a spring, is what keeps the far end on its line.

    `mass` (n, n) over joint angles, `closure` (n,) the far end's height by them, `stiffness` (n,) of the joints. The
    largest eigenvalues of the inverse problem, whose stiffness is diagonal, are the lowest modes, without lost digits.
    """
    from scipy.linalg import eigh

    basis = np.vstack([-closure[1:] / closure[0], np.eye(len(closure) - 1)])
    root = 1.0 / np.sqrt(stiffness[1:])
    values = eigh(root[:, None] * (basis.T @ mass @ basis) * root, eigvals_only=True)
    return np.asarray(1.0 / np.sqrt(values[::-1]) / (2.0 * np.pi))


def mid_span(case: Case, angles: list[Array]) -> Array:
    """(m,), metres: deflections of the middle from the absolute angles of the links up to it, (m, i + 1)."""
    middle, at = case.place(0.5 * case.length)
    reach = np.append(np.full(middle, case.link), at)
    return np.asarray(np.sin(np.array(angles).reshape(-1, middle + 1)) @ reach)


class Track:
    """What is kept of a run in relative angles, at every look; a slider's coordinate follows the angles."""

    def __init__(self, case: Case, sled: Sled | None, steps: int, step: float) -> None:
        self.case, self.sled, self.steps, self.step = case, sled, steps, step
        self.middle = case.place(0.5 * case.length)[0]
        self.look = every(steps)
        self.times: list[float] = []
        self.angles: list[Array] = []
        self.slid: list[tuple[float, float]] = []

    def keep(self, k: int, q: Array, x: float = 0.0, v: float = 0.0) -> None:
        """State after k steps, where it is one to look at."""
        if k % self.look == 0:
            self.times.append(k * self.step)
            self.angles.append(np.cumsum(q[: self.middle + 1]))
            self.slid.append((x, v))

    def run(self, spent: tuple[float, float], set_up_s: float, steps: int, broke: str) -> PeerRun:
        """All of it as a run; `spent` are wall and processor seconds of its steps."""
        slid = np.array(self.slid if self.sled else []).reshape(-1, 2)
        return PeerRun(
            times=np.array(self.times),
            deflection=mid_span(self.case, self.angles),
            distance=slid[:, 0],
            speed=slid[:, 1],
            seconds=spent[0],
            cpu_s=spent[1],
            set_up_s=set_up_s,
            steps=steps,
            broke=broke,
        )
