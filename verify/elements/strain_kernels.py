"""Derivatives of the strain energy of nonlinear elements, compiled."""

import numpy as np

from verify.arrays import Array
from verify.jit import jit


@jit
def differentiate(
    values: Array,
    rows: Array,
    axial: Array,
    bending: Array,
    at_rest: tuple[Array, Array],
    point: Array,
    gradient: Array,
    hessian: Array,
) -> None:
    """Add derivatives by the values (n, 8) of n elements to `gradient`, (n, 8), and `hessian`, (n, 8, 8).

    `rows`, (n, points, 2, 4): r' and r'' by the values of one coordinate; `axial`, `bending`, (n, points): EA ds and
    EI ds; `at_rest`: stretch and curvature, (n, points) each, without strain; `point`, (5, 4): working space for
    derivatives by a = r' and b = r''. With p and t, -b and a turned by 90 degrees, those of kappa = a x b / J^2 are
    p/J^2 - 2 kappa a/J^2 by a and t/J^2 by b.
    """
    for e in range(values.shape[0]):
        for q in range(axial.shape[1]):
            slope, bend, first, second = rows[e, q, 0], rows[e, q, 1], point[0], point[1:]
            ax, ay, bx, by = 0.0, 0.0, 0.0, 0.0
            for k in range(4):
                x, y = values[e, 2 * k], values[e, 2 * k + 1]
                ax, ay, bx, by = ax + slope[k] * x, ay + slope[k] * y, bx + bend[k] * x, by + bend[k] * y
            square = ax * ax + ay * ay
            stretch, kappa = np.sqrt(square), (ax * by - ay * bx) / square
            first[0], first[1] = (by - 2.0 * kappa * ax) / square, (-bx - 2.0 * kappa * ay) / square
            first[2], first[3] = -ay / square, ax / square
            moment = bending[e, q] * (kappa - at_rest[1][e, q])
            for i in range(4):
                for j in range(4):
                    second[i, j] = bending[e, q] * first[i] * first[j]
            length = at_rest[0][e, q]
            # second derivatives of kappa, (8 kappa t t - 2 kappa 1)/J^2 - 2 (p a + a p)/J^4 by a, and those of J
            force, lateral = axial[e, q] * (stretch - length), axial[e, q] * (1.0 - length / stretch)
            curl, along = (8.0 * moment * kappa / square + axial[e, q] - lateral) / square, 2.0 * moment / square**2
            lateral -= 2.0 * moment * kappa / square
            second[0, 0] += curl * ax * ax - 2.0 * along * by * ax + lateral
            second[1, 1] += curl * ay * ay + 2.0 * along * bx * ay + lateral
            shear = curl * ax * ay - along * (by * ay - bx * ax)
            mixed = along * ax * ay, moment / square - along * ax * ax, along * ay * ay - moment / square
            second[0, 1], second[1, 0] = second[0, 1] + shear, second[1, 0] + shear
            second[0, 2], second[2, 0] = second[0, 2] + mixed[0], second[2, 0] + mixed[0]
            second[0, 3], second[3, 0] = second[0, 3] + mixed[1], second[3, 0] + mixed[1]
            second[1, 2], second[2, 1] = second[1, 2] + mixed[2], second[2, 1] + mixed[2]
            second[1, 3], second[3, 1] = second[1, 3] - mixed[0], second[3, 1] - mixed[0]
            for i in range(4):
                first[i] *= moment
            first[0], first[1] = first[0] + force * ax / stretch, first[1] + force * ay / stretch
            for k in range(4):
                for i in range(2):
                    gradient[e, 2 * k + i] += slope[k] * first[i] + bend[k] * first[2 + i]
                    for m in range(4):
                        for j in range(2):
                            upper = slope[m] * second[i, j] + bend[m] * second[i, 2 + j]
                            lower = slope[m] * second[2 + i, j] + bend[m] * second[2 + i, 2 + j]
                            hessian[e, 2 * k + i, 2 * m + j] += slope[k] * upper + bend[k] * lower
