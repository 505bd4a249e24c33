"""Values drawn by a number: most are meant well, some are strange."""

import json
import math
from random import Random

STRANGE_NUMBERS = (
    0, -0.0, -1, 3, 0.5, 7.3, 1e-15, 1e15, 1e-308, 5e-324, 1.7e308, -2e299,
    math.inf, -math.inf, math.nan, 10**7, 2**31, 2**63 - 1, 2**64, 10**400,
)  # fmt: skip
STRANGE_WORDS = (
    "", "word", "é", "²", "a\tb", "two\nlines", "nul\0l", "\x1b[2J", "\u202egnp", "\udc80", "w" * 900, "[red]", "[/]",
    "</script><b>", "{{ 7 }}", "%s{}", "../out", "/out", "~", "--json", "1e5", "nan", "12:30", "0x", "10%", "-",
)  # fmt: skip
STRANGE_THINGS = (True, False, (), (1, 2), ("pinned",), ((),), {}, {"a": 1}, ({},), ({"position": 0.1},))


class Draw(Random):
    """A stream of drawn values. `strangeness` is how many of a hundred are replaced by something strange."""

    def __init__(self, seed):
        super().__init__(seed)
        self.strangeness = self.choice((0, 0, 0, 0.3, 1, 10))

    def one(self, *values):
        """One of several."""
        return self.choice(values)

    def often(self, percent):
        """True so many times of a hundred."""
        return 100 * self.random() < percent

    def decade(self, low, high):
        """A number between powers of ten, each as likely as the next."""
        return float(10 ** self.uniform(low, high))

    def strange(self):
        """Something that nobody means."""
        return self.choice(self.choice((STRANGE_NUMBERS, STRANGE_NUMBERS, STRANGE_WORDS, STRANGE_THINGS)))

    def value(self, good):
        """What was meant or, now and then, something strange."""
        return self.strange() if self.often(self.strangeness) else good

    def table(self, **chances):
        """A table of some keys: name = (per cent of tables that have it, its value or what draws it)."""
        return {
            name: self.value(good() if callable(good) else good)
            for name, (percent, good) in chances.items()
            if self.often(percent)
        }

    def several(self, draw, most):
        """A list of up to `most`, each drawn."""
        return [draw() for _ in range(self.randint(1, most))]


def toml(value):
    """A value as TOML writes it; what it cannot hold is written all the same."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False) if value.isprintable() else json.dumps(value)
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(name)} = {toml(one)}" for name, one in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(toml, value)) + "]"
    return digits(value)


def digits(value):
    """A number's digits; Python refuses to print a whole number of thousands of them."""
    return f"1{'0' * 400}" if isinstance(value, int) and value > 2**80 else repr(value)


def word(value):
    """A value as one word of a command line: lists with commas, words bare."""
    if isinstance(value, str):
        return value
    if isinstance(value, list | tuple) and value and all(isinstance(one, int | float | str) for one in value):
        return ",".join(word(one) for one in value)
    return toml(value)
