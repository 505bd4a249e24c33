"""Sines, exponentials and their kin in 50 digits, for what they judge: arguments of any size lose none of them."""

from decimal import Decimal, localcontext
from typing import TypeAlias

DIGITS = 60
PI = Decimal("3.14159265358979323846264338327950288419716939937510582097494459230781640628620899862803")
Number: TypeAlias = float | int | Decimal


def sin(x: Number) -> Decimal:
    """Of radians."""
    with localcontext() as context:
        context.prec = DIGITS
        turns = (Decimal(x) / PI).to_integral_value()
        left = Decimal(x) - turns * PI
        term, total, square, k = left, left, left * left, 1
        while abs(term) > Decimal(10) ** -DIGITS:
            term *= -square / ((k + 1) * (k + 2))
            total, k = total + term, k + 2
        return total if int(turns) % 2 == 0 else -total


def cos(x: Number) -> Decimal:
    """Of radians."""
    with localcontext() as context:
        context.prec = DIGITS
        return sin(Decimal(x) + PI / 2)


def exp(x: Number) -> Decimal:
    """E^x."""
    with localcontext() as context:
        context.prec = DIGITS
        return Decimal(x).exp()


def sinh(x: Number) -> Decimal:
    """By its series for small arguments."""
    with localcontext() as context:
        context.prec = DIGITS
        term = total = Decimal(x)
        if abs(total) < 1:
            square, k = total * total, 1
            while abs(term) > abs(total) * Decimal(10) ** -DIGITS:
                term *= square / ((k + 1) * (k + 2))
                total, k = total + term, k + 2
            return total
        return (exp(x) - exp(-Decimal(x))) / 2


def asinh(x: Number) -> Decimal:
    """Ln(x + sqrt(x^2 + 1)), odd."""
    with localcontext() as context:
        context.prec = DIGITS
        size = abs(Decimal(x))
        if size < Decimal("1e-12"):
            return Decimal(x) * (1 - Decimal(x) ** 2 / 6)
        found = (size + (size * size + 1).sqrt()).ln()
        return found.copy_sign(Decimal(x))


def cantilever_root(mode: int) -> Decimal:
    """Y with cos y cosh y = -1, by Newton."""
    with localcontext() as context:
        context.prec = DIGITS
        y = (Decimal(mode) - Decimal("0.5")) * PI
        for _ in range(60):
            falling = exp(-y)
            rest = cos(y) * (1 + falling * falling) + 2 * falling
            slope = cos(y) * (1 - falling * falling) - sin(y) * (1 + falling * falling)
            step = rest / slope
            y -= step
            if abs(step) < Decimal(10) ** -45:
                break
        return y


def relative(found: float, exact: Decimal) -> float:
    """|found / exact - 1|."""
    with localcontext() as context:
        context.prec = DIGITS
        return float(abs(Decimal(found) / exact - 1))
