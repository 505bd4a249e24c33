"""The grid of contact: laws, points, normal forces, coupling, kinematics, surface and motion of a slider, as inputs."""

from itertools import product
from typing import NamedTuple

from msgspec.structs import replace

from verify.problem.beam import Beam, PointForce
from verify.problem.slider import Contact, Foot, Slider

STRIP = Beam(length=0.43, width=0.017, thickness=0.0013, youngs_modulus=113e9, density=4470.0)
HERTZ, DURATION, DAMPING = 1310.0, 2.5e-3, 0.003
FORCES = (
    PointForce(position=0.037, amplitude=3.9, phase_deg=17.0),
    PointForce(position=0.402, amplitude=2.4, phase_deg=101.0),
)
PARTS = {"beam": 4, "chain": 6}
SMALL = 1e-4
"""Motion and loads on the chain over those on the beam: its departure from small angles is as small."""
SPEED = 0.0009
"""Prescribed, m/s; of a fixed slider that of the belt on it."""
AXES = {
    "law": ("tanh", "coulomb", "static", "elastic"),
    "points": ("1", "3", "feet"),
    "normal": ("prescribed", "bilateral", "unilateral", "hard"),
    "coupling": ("one-way", "two-way"),
    "kinematics": ("tangential", "following"),
    "surface": ("beam", "chain"),
    "motion": ("free", "driven", "fixed"),
}
FEET = {
    "1": (Foot(),),
    "3": (Foot(length=0.03, points=3),),
    "feet": (Foot(offset=-0.018, length=0.012, points=2), Foot(offset=0.023, face="lower")),
}


class Cell(NamedTuple):
    """One combination; its name joins the words."""

    law: str
    points: str
    normal: str
    coupling: str
    kinematics: str
    surface: str
    motion: str

    def __str__(self) -> str:
        return " ".join(self)

    @property
    def size(self) -> float:
        """Forces and motion over those on the beam."""
        return SMALL if self.surface == "chain" else 1.0


CELLS = tuple(Cell(*words) for words in product(*AXES.values()))


def refused(cell: Cell) -> bool:
    """Whether the package models no such slider: each raises one sentence."""
    springs = cell.normal == "unilateral"
    return (
        (cell.law == "elastic" and not springs)
        or (cell.points == "feet" and not springs)
        or (cell.normal == "hard" and (cell.points != "1" or cell.coupling != "one-way" or cell.surface == "chain"))
        or (cell.kinematics == "following" and cell.normal in ("unilateral", "hard"))
        or (cell.normal == "bilateral" and cell.coupling == "two-way" and cell.surface == "chain")
    )


def sliders(cell: Cell) -> tuple[Slider, ...]:
    """One slider, or three without feet where a cell has three points. Raises InputError for most refused cells."""
    size = cell.size
    grip = {"tangential_stiffness": 2.3e4} if cell.law == "elastic" else {}
    own: dict[str, object] = {}
    if cell.normal == "unilateral":
        own["contact"] = Contact(stiffness=2.1e5, damping=7.0, **grip)
    elif cell.normal == "hard" or grip:
        own["contact"] = Contact(**grip)
    if cell.normal in ("unilateral", "hard") or cell.points == "feet":
        own["foot"] = FEET[cell.points]
    normal = "massless" if cell.normal == "prescribed" else "bilateral"
    # rigid contact without a flight, whose landings are tests of their own
    preload, mu, static = (90.0, 0.011, 0.017) if cell.normal == "hard" else (0.9, 0.3, 0.5)
    law = {
        "tanh": {"slope": 60.0 / size},
        "coulomb": {"law": "coulomb"},
        "static": {"law": "coulomb", "mu_static": static},
        "elastic": {"law": "coulomb"},
    }[cell.law]
    one = Slider(
        mass=0.004, mu=mu, position=0.19, preload=preload * size, gravity=9.81 * size, coupling=cell.coupling,
        kinematics=cell.kinematics, normal=normal, **law, **own,
    )  # fmt: skip
    if cell.points != "3" or "contact" in own:
        return (one,)
    return one, replace(one, position=0.257, mass=0.007), replace(one, position=0.113, preload=0.5 * size)


def prescribed(cell: Cell) -> tuple[float | None, bool]:
    """(Prescribed speed, whether the position is fixed)."""
    return (None if cell.motion == "free" else SPEED * cell.size), cell.motion == "fixed"


def forces(cell: Cell) -> tuple[PointForce, ...]:
    """Forces of the drive; on the chain at the nearest joints, where no rule of distribution matters."""
    places = (
        [force.position for force in FORCES] if cell.surface == "beam" else [STRIP.length / 6, STRIP.length * 5 / 6]
    )
    return tuple(
        replace(force, position=place, amplitude=force.amplitude * cell.size)
        for force, place in zip(FORCES, places, strict=True)
    )
