"""Pages that are made when the documentation is built: scene reference, quantities, catalogue of cases.

They are written into `docs/made`, which git ignores, and only where they differ from what stands there.
"""

import re
from pathlib import Path

HERE = Path(__file__).parent.parent
MADE = HERE / "made"
DRAWING = re.compile(r"^<!-- drawing: ([a-z0-9-]+) -->$", re.MULTILINE)

SCENE_HEAD = """# Scene reference

A scene is a TOML file: what exists (`[beam]`, `[drive]`, `[slider]`), what is published about it (`[[claim]]`), and
what is asked (`[[gate]]` and the studies). What is not asked does not run. These tables are made from the types that
read a scene; `verify keys SECTION` prints them, `verify schema --to verify.schema.json` gives them to an editor. Lists
of tables are written `[[beam.mass]]` or as a list of inline tables.

"""
QUANTITIES_HEAD = """# Figures that can be asked for

Every figure has a name, a unit and typed arguments: `verify measure SCENE NAME KEY=VALUE ...` evaluates one,
and a gate holds one. `verify quantities WORD ...` prints those that a word stands in.

"""


def cell(text):
    """A text that stands in a cell of a Markdown table."""
    return str(text).replace("|", r"\|").replace("<", "&lt;").replace("\n", " ")


def table(head, rows):
    """A Markdown table."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(map(cell, line)) + " |" for line in lines) + "\n"


def default_words(key):
    """What stands for a key that is left out."""
    if key.required:
        return "required"
    if key.default in (None, "", [], (), {}):
        return ""
    return f"`{str(key.default).lower() if isinstance(key.default, bool) else key.default}`"


def scene_page():
    """Every section of a scene with its keys."""
    from verify.scenes.described import first_sentence, keys_of, sections

    parts = [SCENE_HEAD]
    for name, kind in sections().items():
        label = "top" if name == "scene" else name.replace(".", "-")
        title = "Top of the file" if name == "scene" else f"`{name}`"
        rows = [(f"`{key.key}`", key.type, default_words(key), key.meaning) for key in keys_of(name)]
        parts.append(f"(scene-{label})=\n## {title}\n\n{first_sentence(kind)}\n")
        parts.append(table(("key", "type", "default", "unit and meaning"), rows))
    return "\n".join(parts)


def quantities_page():
    """Every quantity with its unit, meaning and arguments."""
    from verify.quantities.catalogue import QUANTITIES

    families = {}
    for name in QUANTITIES:
        families.setdefault(name.partition(".")[0], []).append(QUANTITIES[name])
    parts = [QUANTITIES_HEAD]
    for family, found in families.items():
        rows = [
            (f"`{one.name}`", one.unit, one.summary, " ".join(f"`{name}`" for name in one.arguments.__struct_fields__))
            for one in found
        ]
        parts += [f"## {family}\n", table(("figure", "unit", "what it is", "arguments"), rows)]
    return "\n".join(parts)


def catalogue_pages(*, judged):
    """A sheet for each packaged scene, its drawing in it, and the page before them."""
    from verify.report.beam_drawing import beam_drawing
    from verify.report.sheets import index, markdown, sheet_of
    from verify.scenes.scene import load_scene, packaged_scenes, tables_of

    pages, sheets = {}, []
    for name in packaged_scenes():
        scene = load_scene(name)
        verdicts = verdicts_of(scene) if judged else None
        sheet = sheet_of(scene, tables_of(name)) if verdicts is None else sheet_of(scene, tables_of(name), verdicts)
        drawn = f'<div class="beam-drawing">{beam_drawing(scene)}</div>'
        sheets.append(sheet)
        pages[f"catalogue/{name}.md"] = DRAWING.sub(lambda _, drawn=drawn: drawn, markdown(sheet))
    return pages | {"catalogue/index.md": index(sheets)}


def verdicts_of(scene):
    """Every gate of a scene judged, no study."""
    from verify.run.gates import judge
    from verify.run.runner import workbench_for

    bench = workbench_for(scene, gates_only=True)
    return [judge(gate, scene, bench) for gate in scene.gate]


def make(app):
    """Write the pages, each whole: two builds may run at once."""
    from verify.files import write_whole

    pages = {"scenes.md": scene_page(), "quantities.md": quantities_page()}
    for name, text in (pages | catalogue_pages(judged=app.config.verify_judge)).items():
        path = MADE / name
        if not path.exists() or path.read_text("utf-8") != text:
            path.parent.mkdir(parents=True, exist_ok=True)
            write_whole(path, text, "docs/made")


def setup(app):
    """Make the pages before any is read."""
    app.add_config_value("verify_judge", default=True, rebuild="env", types=bool)
    app.connect("builder-inited", make)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
