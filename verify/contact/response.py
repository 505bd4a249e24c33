"""Response of the beam to contact forces that are constant over a step.

The Delassus operator is never formed: `rates` holds what all forces add to the mean rates of the columns, so that a
visit to a point costs two products over the columns.
"""

from verify.arrays import Array
from verify.contact.state import Response
from verify.jit import FAST, inline

TANGENTIAL, NORMAL = 0, 1  # Directions, rows of `shapes`; the responses to them are two rows further


@inline(fastmath=FAST)
def product(i: int, direction: int, response: Response) -> float:
    """Mean speed of the surface at point i in a direction by the mean rates of the columns, m/s."""
    total, shapes, rates = 0.0, response.shapes, response.rates
    for j in range(shapes.shape[2]):
        total += shapes[direction, i, j] * rates[j]
    return total


@inline(fastmath=FAST)
def own_product(i: int, direction: int, shapes: Array) -> float:
    """The same by a unit force of the point itself, m/s/N."""
    total = 0.0
    for j in range(shapes.shape[2]):
        total += shapes[direction, i, j] * shapes[2 + direction, i, j]
    return total


@inline(fastmath=FAST)
def add_response(i: int, direction: int, force: float, response: Response) -> None:
    """Add a force of point i on the beam to the mean rates of the columns; friction on a slider acts on it by -1."""
    shapes, rates = response.shapes, response.rates
    for j in range(shapes.shape[2]):
        rates[j] -= force * shapes[2 + direction, i, j]
