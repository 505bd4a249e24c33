"""Observed order of mode 2 between 80 and 160 parts for every pair of supports and every wall.

Run: python benchmarks/orders.py
"""

from itertools import combinations_with_replacement
from math import log2

from verify.beam import Beam
from verify.judge.workbench import Workbench
from verify.options import SUPPORTS, WALLS


def main() -> None:
    """Print one row for each pair: orders of segments by wall, of elements, of the mean, and Gregory's error."""
    print(f"{'supports':<16} " + " ".join(f"{w:>11}" for w in WALLS) + f" {'Hermite':>8} {'gregory N=160':>14}")
    for supports in combinations_with_replacement(SUPPORTS, 2):
        beam = Beam(length=0.6, width=0.02, thickness=0.002, youngs_modulus=70e9, density=2700.0, supports=supports)
        bench = Workbench(beam)
        settings = [(("wall", wall),) if wall != "gregory" else () for wall in WALLS]
        pairs = [[bench.frequency_error("segment", n, 2, s) for n in (80, 160)] for s in settings]
        pairs.append([bench.frequency_error("fem", n, 2) for n in (80, 160)])
        orders = [log2(abs(a / b)) for a, b in pairs]
        row = " ".join(f"{order:>11.2f}" for order in orders[:-1])
        print(f"{'-'.join(supports):<16} {row} {orders[-1]:>8.2f} {pairs[0][1]:>+14.1e}")


if __name__ == "__main__":
    main()
