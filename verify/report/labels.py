"""Words in a drawing, laid where nothing else stands. Lengths in the picture's units, heights downwards."""

from collections.abc import Iterator
from itertools import count

import msgspec

LETTER, ROW = 7.3, 14.0
"""Width of a letter and height of a row of words at the picture's size of 12."""


class Box(msgspec.Struct, frozen=True):
    """Room that something takes."""

    left: float
    top: float
    right: float
    bottom: float

    def meets(self, other: "Box") -> bool:
        """Whether both take some of the same room."""
        return (
            self.left < other.right and other.left < self.right and self.top < other.bottom and other.top < self.bottom
        )


class Label(msgspec.Struct, frozen=True):
    """Rows of words that belong to a place."""

    x: float
    y: float
    """Their edge nearest to what they name: the lower one, unless they stand below it."""
    rows: tuple[str, ...]
    down: bool = False

    @property
    def width(self) -> float:
        """Of the longest row."""
        return LETTER * max(map(len, self.rows))


def placed(labels: list[Label], taken: list[Box], width: float) -> tuple[list[str], list[Box]]:
    """Every label as SVG, within the width and clear of what is taken and of each other; and all that is taken then."""
    words, boxes = [], list(taken)
    for label in labels:
        box = next(one for one in _places(label, width) if not any(one.meets(other) for other in boxes))
        boxes.append(box)
        middle = 0.5 * (box.left + box.right)
        words += [words_at(middle, box.top + ROW * (k + 0.8), row) for k, row in enumerate(label.rows)]
    return words, boxes


def _places(label: Label, width: float) -> Iterator[Box]:
    """Over (or under) its place, a little to either side, then the same one half row farther away, and so on."""
    tall = ROW * len(label.rows)
    middle = 0.5 * label.width

    for away in count():
        top = label.y + 0.5 * ROW * away if label.down else label.y - tall - 0.5 * ROW * away
        for aside in (0.0, -middle - 4.0, middle + 4.0):
            x = max(min(label.x + aside, width - middle - 2.0), middle + 2.0)
            yield Box(x - middle, top, x + middle, top + tall)


def words_at(x: float, y: float, words: str) -> str:
    """One row, its middle over x, standing on y."""
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="middle" fill="var(--soft)">{words}</text>'
