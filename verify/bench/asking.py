"""What a command line asks of a bench, put on what the scene asks."""

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import msgspec

from verify.bench.request import Bench
from verify.bench.study import BenchStudy
from verify.judge.workbench import Workbench
from verify.scenes.checked import checked
from verify.scenes.given import whole_numbers
from verify.scenes.toml import literal
from verify.studies.kind import Progress

if TYPE_CHECKING:
    from verify.bench.found import BenchFound
    from verify.scenes.scene import Scene


def asked_of(scene: "Scene", given: Mapping[str, str], *, cold: bool = False, push: bool = False) -> Bench:
    """The scene's [bench], or its defaults, with what was typed instead. Raises InputError."""
    plain: dict[str, Any] = msgspec.to_builtins(BenchStudy().asked(scene) or Bench())
    plain |= {name: _typed(name, text) for name, text in given.items()}
    flags = {name: True for name, said in (("cold", cold), ("push", push)) if said}
    return checked(plain | flags, Bench, "bench")


def _typed(name: str, text: str) -> Any:
    """A list of words, of whole numbers, or a number. Raises InputError."""
    if name == "sets":
        return [word.strip() for word in text.split(",")]
    value = literal(text, name)
    if name == "seconds":
        return value
    numbers = whole_numbers(value, name)
    return numbers if isinstance(numbers, list) else [numbers]


def job_of(scene: "Scene", asked: Bench) -> "tuple[int, Callable[[Progress], BenchFound]]":
    """(how often it reports, what runs it). Raises InputError."""
    study = BenchStudy()
    study.check_on(asked, scene)
    if scene.beam.tension < 0.0:
        from verify.exact.buckling import check_stable

        check_stable(scene.beam)

    def run(step: Progress) -> "BenchFound":
        bench = Workbench(scene.beam, study.needs(asked, scene))
        return study.run(asked, scene, bench, {}, step)

    return study.n_steps(asked, scene), run
