"""Coverage of the 95 % intervals of records of free vibration, and their width, over random synthetic records.

    python -m benchmarks.records [RECORDS]

One to three modes with ratios of 0.2 to 5 %, 1.2 to 30 periods of the first, 3 to 20 samples a period of the last,
noise of 0.1 to 5 % of the largest amplitude, offset and drift; modes are counted by `ring_down` itself.
"""

import sys
from collections import Counter
from math import pi

import numpy as np

from verify.blas import one_blas_thread
from verify.errors import InputError
from verify.identify.ring_down import ring_down

FIRST = 6.0, 60.0
"""Range of the first frequency, Hz."""


def draw(seed: int) -> tuple[np.ndarray, np.ndarray, list[tuple[float, float]]]:
    """(times, signal, (damped Hz, ratio) of the modes)."""
    rng = np.random.default_rng([63, seed])
    hertz = rng.uniform(*FIRST) * np.cumprod([1.0, *rng.uniform(1.4, 4.0, rng.integers(0, 3))])
    ratios, sizes = 10.0 ** rng.uniform(-2.7, -1.3, len(hertz)), 10.0 ** -rng.uniform(0.0, 1.0, len(hertz))
    times = np.arange(0.0, rng.uniform(1.2, 30.0) / hertz[0], 1.0 / (hertz[-1] * rng.uniform(3.0, 20.0)))
    y = rng.normal() + rng.normal() * times / times[-1]
    for hz, zeta, size in zip(hertz, ratios, sizes, strict=True):
        decay = 2.0 * pi * hz * zeta / np.sqrt(1.0 - zeta**2)
        y = y + size * np.exp(-decay * times) * np.cos(2.0 * pi * hz * times + rng.uniform(0.0, 2.0 * pi))
    noise = sizes.max() * 10.0 ** rng.uniform(-3.0, -1.3)
    return times, y + noise * rng.standard_normal(len(times)), list(zip(hertz.tolist(), ratios.tolist(), strict=True))


@one_blas_thread()
def main(records: int) -> None:
    """Print the table."""
    counts = Counter[str]()
    for seed in range(records):
        times, y, truth = draw(seed)
        if len(times) < 16:
            counts["too short"] += 1
            continue
        try:
            found = ring_down(times, y).modes
        except InputError:
            counts["refused"] += 1
            continue
        counts["records"] += 1
        counts["more modes than there are"] += len(found) > len(truth)
        counts["modes in the noise"] += max(len(truth) - len(found), 0)
        if len(found) != len(truth):
            continue
        for mode, (hz, zeta) in zip(found, truth, strict=True):
            counts["modes"] += 1
            counts["frequency inside"] += mode.hz_interval[0] <= hz <= mode.hz_interval[1]
            counts["ratio inside"] += mode.zeta_interval[0] <= zeta <= mode.zeta_interval[1]
    for name, count in counts.items():
        print(f"{name:30} {count:6}" + f"  {count / counts['modes']:.3f}" * name.endswith("inside"))


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 500)
