"""Which sections a scene may have beside what exists: one for every study, each declared with it."""

from typing import TYPE_CHECKING, Any, Protocol

import msgspec

from verify.registry import Registry

if TYPE_CHECKING:
    from verify.scenes.scene import Scene


class Section(Protocol):
    """What reading a scene needs to know of a study."""

    name: str
    section: type[msgspec.Struct] | None

    def asked(self, scene: "Scene") -> Any:
        """What the scene asks of it; None where nothing."""

    def check_on(self, asked: Any, scene: "Scene") -> None:
        """Raise InputError where the scene has not what it takes."""


TAKEN = (
    "name",
    "title",
    "description",
    "beam",
    "drive",
    "slider",
    "claim",
    "gate",
    "gates",
    "scene",
    "passed",
    "solves",
    "seconds",
    "report",
)
"""Names that a scene or its JSON has already."""


def _wrong(study: Section) -> str:
    """What a study from outside cannot be."""
    if study.name in TAKEN:
        return "is a name that scenes or their results have already: choose another"
    return "" if getattr(study, "section", None) is not None else "has no section: give it the type of one"


SECTIONS: Registry[Section] = Registry(
    "study",
    "verify.studies",
    homes={
        "spectrum": "verify.studies.modes.spectrum:SpectrumStudy",
        "convergence": "verify.studies.modes.convergence:ConvergenceStudy",
        "sensitivity": "verify.studies.modes.sensitivity:SensitivityStudy",
        "wave": "verify.studies.wave.study:WaveStudy",
        "methods": "verify.studies.methods.study:MethodsStudy",
        "motion": "verify.studies.slider.study:SliderStudy",
        "motor": "verify.studies.motor.study:MotorStudy",
        "readings": "verify.studies.readings.study:ReadingsStudy",
        "claims": "verify.studies.claims:ClaimsStudy",
        "axial_inertia": "verify.studies.axial_inertia.study:AxialInertiaStudy",
        "bench": "verify.bench.study:BenchStudy",
        "stress": "verify.stress.study:StressStudy",
    },
    refuses=_wrong,
)
"""Run in this order."""
ON_WHAT_EXISTS = ("motion", "claims")
"""Those that stand on what a scene has anyway, and have no section beside it."""
