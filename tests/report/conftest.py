"""One run of a small scene, with charts and a movie whose data are known."""

from pathlib import Path

import msgspec
import numpy as np
import pytest

from verify.report.result import Column, Figure, Movie, Result, Table
from verify.scene.run import run_scene

SMALL = Path(__file__).with_name("small.toml")
SIZES, ERRORS = (7, 13, 29, 53), (3e-2, 8e-3, 1.7e-3, 5e-4)


def draw_lines(ax):
    ax.loglog(SIZES, ERRORS, "o-", label="segments")
    ax.axhline(1e-3)
    ax.set(xlabel="N", ylabel="error, %")


def draw_map(ax):
    ax.pcolormesh([0.0, 1.0, 3.0], [0.0, 2.0, 5.0], [[1.5, 2.5], [3.5, 4.5]])


def draw_bars(ax):
    ax.barh(["friction", "damping"], [0.31, 0.07], label="loss")


def animate(ax):
    (line,) = ax.plot(np.linspace(0.0, 1.0, 9), np.zeros(9))

    def update(i):
        line.set_ydata(np.linspace(0.0, 0.1 * i, 9))
        return [line]

    return update, range(5)


@pytest.fixture(scope="session")
def figures():
    return [
        Figure("lines", "Error over N", "Solid: segments.", draw_lines),
        Figure("map", "A map", "Colour: ratio.", draw_map),
        Figure("bars", "Losses", "Per period.", draw_bars),
    ]


@pytest.fixture(scope="session")
def movie():
    return Movie("moving", "Moving line", "One period.", animate)


@pytest.fixture(scope="session")
def made_result(figures, movie):
    columns = [Column("mode"), Column("model"), Column("frequency", "Hz", ".8g"), Column("error", percent=True)]
    rows = [(1, "segment", 443.25, -0.0021), (2, "fem", 1436.5, None), (5, "a|b", float("nan"), 0.0173)]
    long = Table("All modes", columns, [(i, "fem", 10.0 * i, 1e-4 * i) for i in range(1, 41)])
    table = Table("Frequencies", columns, rows, ["Against the exact beam."])
    return Result(
        "Mode 5 is 1.73 % off.", [table, long], figures, [movie], ["Mode 5 is not converged."], {"z": 1.5 - 2.5j}
    )


@pytest.fixture(scope="session")
def small_run():
    return run_scene(SMALL)


@pytest.fixture(scope="session")
def full_run(small_run, made_result):
    """The run with a second study and a gate that fails."""
    failed = msgspec.structs.replace(
        small_run.gates[1], passed=False, fraction=3.7, reason="0.037 lies above 0.01 & <more>"
    )
    gates = (small_run.gates[0], failed)
    return msgspec.structs.replace(small_run, gates=gates, results=small_run.results | {"made": made_result})
