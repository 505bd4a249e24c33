"""The files of a case for an engine: its sheet, the model, and the script that records its run."""

from pathlib import Path

from verify.answers.chains import engine_chain
from verify.errors import InputError, near_name, shown
from verify.files import read_text, writable_folder, write_whole
from verify.problem.phrase import PREFIX
from verify.sheets.sheet import DATA, load, names

MODELS = {"mujoco": "model.xml", "exudyn": "model_exudyn.py", "sdf": "model.sdf"}
"""Engines and the file of a chain for each."""
BLOCKS = ("belt", "belt-stick-slip", "decay", "ramp-slip", "ramp-stick")
"""Cases that share the scripts of the folder `block`."""


def _script(name: str, engine: str) -> Path:
    """The recording script of a case that no other kind of case has."""
    return DATA / ("block" if name in BLOCKS else name) / f"{engine}_record.py"


def engines(name: str) -> tuple[str, ...]:
    """Engines for which a case has a model or a script that builds it; for others its sheet says what to build."""
    own = tuple(engine for engine in MODELS if _script(name, engine).exists())
    if not load(name).chain:
        return own
    return (*own, "sdf") if own else tuple(MODELS)


def write(name: str, folder: Path, engine: str = "", count: int | None = None) -> list[str]:
    """Write the sheet of a case into a folder, for an engine also model and script; returns the names of the files.

    `count`: links of the model, by default those of the sheet. Raises InputError for an unknown case, an engine that
    the case has no files for, and a folder that cannot be written.
    """
    sheet = load(name)
    if name not in names():
        raise InputError(f"case = {shown(name)}: its sheet is a file already, name a case of the list")
    if engine and engine not in MODELS:
        raise InputError(f"engine = {shown(engine)} is not known: {near_name(engine, tuple(MODELS))}")
    if engine and engine not in engines(name):
        listed = ", ".join(engines(name)) or "none"
        raise InputError(f"engine = {engine!r}: case {name!r} has files for {listed}; build what its sheet says")
    texts = {"sheet.toml": read_text(DATA / name / "sheet.toml", "sheet")}
    for script in (_script(name, engine), DATA / f"{engine}_record.py"):
        if engine and script.name not in texts and script.exists():
            texts[script.name] = read_text(script, "script")
    writable_folder(folder, "to")
    for file, text in texts.items():
        write_whole(folder / file, text, "to")
    if not (engine and sheet.chain):
        return list(texts)
    chain, model = sheet.chain, MODELS[engine]
    engine_chain(
        PREFIX + chain.beam,
        count or chain.count,
        wall=chain.wall,
        in_space=chain.space,
        damping=chain.damping,
        path=folder / model,
    )
    return [*texts, model]
