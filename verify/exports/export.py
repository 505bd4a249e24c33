"""What is wanted of a scene, in which format, to which file: chosen where nobody says, written whole."""

from collections.abc import Callable
from pathlib import Path

import msgspec

from verify.errors import InputError, near_name, shown
from verify.exports.sheet import Sheet
from verify.exports.sheets import SEGMENTS, Wanted, field_sheet, modes_sheet, motion_sheet
from verify.files import check_no_scene, writable_folder, write_whole
from verify.models.catalogue import MODELS
from verify.options import EXPORTED, FILE_FORMATS, READINGS
from verify.scenes.scene import Scene
from verify.studies.kind import Progress

FORMATS: dict[str, tuple[str, ...]] = {
    "modes": ("vtu", "pvd", "xdmf", "csv", "json", "npz", "tex"),
    "field": ("vtu", "pvd", "xdmf", "csv", "json", "npz"),
    "motion": ("pvd", "xdmf", "csv", "json", "npz"),
    "tables": ("tex", "json"),
}
"""What can be written how."""
_WHY_NOT = {
    ("motion", "vtu"): "one mesh holds one instant, give pvd or xdmf for the series",
    ("tables", "csv"): "one file holds one table, give json or tex, or `verify table SCENE --of STUDY --csv`",
}
_SERIES = ("pvd", "xdmf", "json", "npz")
_SHEETS: dict[str, Callable[[Scene, Wanted], Sheet]] = {
    "modes": modes_sheet,
    "field": field_sheet,
    "motion": motion_sheet,
}


class Asked(msgspec.Struct, frozen=True, kw_only=True):
    """What somebody asks for; None is left to the scene."""

    what: str | None = None
    format: str | None = None
    to: Path | None = None
    wanted: Wanted = Wanted()


class Written(msgspec.Struct, frozen=True, kw_only=True):
    """What was written where."""

    path: Path
    told: str


def export(scene: Scene, asked: Asked, step: Progress = lambda name: None) -> Written:
    """Write what a scene has for other tools. Raises InputError, before anything is solved where it can be told."""
    form = _format_of(asked)
    what = _what_of(scene, asked, form)
    _check_options(asked, what, form)
    path = _path_of(scene, asked, what, form)
    if what == "tables":
        return _tables(scene, path, form, step)
    if form == "tex":
        from verify.exports.latex import document
        from verify.exports.tables import frequency_table

        table = frequency_table(scene, asked.wanted)
        write_whole(path, document(scene.title or scene.name, (table,)), "to")
        return Written(path=path, told=table.title)
    sheet = _SHEETS[what](scene, asked.wanted)
    _writer(form)(sheet, path)
    return Written(path=path, told=f"{sheet.told}, {len(sheet.x)} points")


def _format_of(asked: Asked) -> str:
    """As given, else by the suffix, else vtu. Raises InputError for one unknown or two that differ."""
    if asked.format is not None and asked.format not in FILE_FORMATS:
        raise InputError(f"format = {asked.format!r} is not known: {near_name(asked.format, FILE_FORMATS)}")
    suffix = asked.to.suffix.lower().removeprefix(".") if asked.to is not None and not asked.to.is_dir() else ""
    if asked.format is not None:
        if suffix in FILE_FORMATS and suffix != asked.format:
            raise InputError(f"format = {asked.format!r} and to = {shown(str(asked.to))} say two formats: give one")
        return asked.format
    if asked.to is None or asked.to.is_dir():
        return "vtu"
    if suffix not in FILE_FORMATS:
        raise InputError(
            f"to = {shown(str(asked.to))} has no suffix that is known: give --format or one of "
            f"{', '.join(f'.{name}' for name in FILE_FORMATS)}"
        )
    return suffix


def _what_of(scene: Scene, asked: Asked, form: str) -> str:
    """As given; else the most that the scene has and the format holds: motion, field under a [wave], modes."""
    if asked.what is not None:
        if asked.what not in EXPORTED:
            raise InputError(f"what = {asked.what!r} is not known: {near_name(asked.what, EXPORTED)}")
        if form not in FORMATS[asked.what]:
            why = _WHY_NOT.get((asked.what, form), f"give {' or '.join(FORMATS[asked.what])}")
            raise InputError(f"format = {form!r} holds no {asked.what}: {why}")
        return asked.what
    if form == "tex":
        return "tables"
    if scene.motion is not None and form in FORMATS["motion"]:
        return "motion"
    driven = bool(scene.forces) and (getattr(scene, "wave", None) is not None or scene.motion is not None)
    return "field" if driven else "modes"


def _check_options(asked: Asked, what: str, form: str) -> None:
    """Raise InputError for an option that would change nothing."""
    wanted = asked.wanted
    MODELS.named(wanted.model)
    if what == "tables" and wanted != Wanted():
        given = next(name for name in Wanted.__struct_fields__ if getattr(wanted, name) != getattr(Wanted(), name))
        raise InputError(f"{given} = {getattr(wanted, given)!r}: tables are those of the scene's own run, leave it out")
    if wanted.modes is not None and what != "modes":
        raise InputError(f"modes = {wanted.modes}: {what} has no number of modes, leave it out")
    if wanted.samples is not None and (what == "modes" or (what == "field" and form not in _SERIES)):
        raise InputError(f"samples = {wanted.samples}: {what} in {form} is no series, leave it out")
    if wanted.reading is not None:
        if wanted.reading not in READINGS:
            raise InputError(f"reading = {wanted.reading!r} is not known: {near_name(wanted.reading, READINGS)}")
        if what != "modes" or wanted.model != SEGMENTS or form == "tex":
            raise InputError(f"reading = {wanted.reading!r} is for shapes of segments: leave it out")


def _path_of(scene: Scene, asked: Asked, what: str, form: str) -> Path:
    """The file, in a folder that takes it. Raises InputError."""
    default = Path(f"{scene.name}-{what}.{form}")
    path = default if asked.to is None else asked.to / default if asked.to.is_dir() else asked.to
    check_no_scene(path, "to")
    writable_folder(path.parent, "to")
    if path.is_dir():
        raise InputError(f"to = {shown(str(path))} is a folder: name a file in it")
    return path


def _writer(form: str) -> Callable[[Sheet, Path], None]:
    if form in ("vtu", "pvd", "xdmf"):
        from verify.exports import meshes

        return {"vtu": meshes.write_vtu, "pvd": meshes.write_pvd, "xdmf": meshes.write_xdmf}[form]
    from verify.exports import plainly

    return {"csv": plainly.write_csv, "json": plainly.write_json, "npz": plainly.write_npz}[form]


def _tables(scene: Scene, path: Path, form: str, step: Progress) -> Written:
    from verify.exports.tables import as_plain, tables_of
    from verify.run.runner import run_scene

    tables = tables_of(run_scene(scene, step))
    if form == "tex":
        from verify.exports.latex import document

        write_whole(path, document(scene.title or scene.name, tables), "to")
    else:
        import json

        from verify.report.plain import finite

        write_whole(path, json.dumps(finite(as_plain(tables)), indent=2, allow_nan=False) + "\n", "to")
    return Written(path=path, told=f"{len(tables)} tables of the run of {scene.name}")
