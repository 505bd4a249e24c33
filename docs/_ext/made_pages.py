"""Pages made from the package into `docs/made` (scenes, quantities, gates), a report, docstrings as plain text."""

import re
from dataclasses import replace
from pathlib import Path

MADE = Path(__file__).parent.parent / "made"
SCENES = """# Scene reference

Reference, generated from the package. A scene is a TOML file with a beam, its drive and slider (`[beam]`, `[drive]`,
`[slider]`), acceptance criteria (`[[gate]]`), published statements (`[[claim]]`) and studies, each a section. Only the
sections of a scene run. A list of tables is written as `[[beam.mass]]` or as a list of inline tables.
`verify schema SECTION` prints the same tables.
"""
QUANTITIES = """# Quantities

Reference, generated from the package. A quantity has a name, a unit and typed arguments.
`verify measure SCENE NAME KEY=VALUE ...` evaluates one, a gate states its tolerance, and `verify sweep` varies its
arguments. `verify quantities NAME` lists the arguments.
"""
GATES = """# Gates

Reference, generated from the package: all gates of the packaged scenes. `verify run SCENE` evaluates those of a scene,
`verify run` all of them.
"""
CASES = """# Cases

Reference, generated from the package: the sheets that `verify cases NAME --to FOLDER` writes and `verify judge` reads
([how](../cases.md)). SI; errors are relative, absolute where the exact value is 0. Sheets and scripts are CC0. Names
are stable.
"""


def table(head, rows):
    """A Markdown table."""
    cells = [[str(cell).replace("|", r"\|").replace("<", "&lt;").replace("\n", " ") for cell in row] for row in rows]
    return "".join("| " + " | ".join(line) + " |\n" for line in [head, ["---"] * len(head), *cells])


def scenes():
    """Every section of a scene with its keys."""
    from verify.commands.schema import type_text
    from verify.scene.schema import scene_schema, sections

    yield SCENES
    for name in sections():
        schema = scene_schema(name)
        defaults = {key: one.get("default", "") for key, one in schema["properties"].items()}
        defaults |= dict.fromkeys(schema.get("required", ()), "required")
        rows = [
            (f"`{k}`", type_text(v), defaults[k], v.get("description", "")) for k, v in schema["properties"].items()
        ]
        yield f"## `{name}`\n\n{schema['description']}\n"
        yield table(("key", "type", "default", "meaning"), rows)


def quantities():
    """Every quantity with its arguments, by family."""
    from verify.quantities.base import QUANTITIES as REGISTERED

    families = {}
    for one in REGISTERED.values():
        row = (f"`{one.name}`", one.unit, one.summary, " ".join(f"`{argument['name']}`" for argument in one.arguments))
        families.setdefault(one.name.partition(".")[0], []).append(row)
    yield QUANTITIES
    for name, rows in families.items():
        yield f"## {name}\n\n{table(('quantity', 'unit', 'meaning', 'arguments'), rows)}"


def gates():
    """Every packaged scene with its drawing and its gates."""
    from verify.report.beam_drawing import NARROW, WIDTH, beam_figure
    from verify.report.plotting import figure_files
    from verify.report.summary import expected
    from verify.scene.file import packaged_scenes
    from verify.scene.load import load_scene

    yield GATES
    for scene in map(load_scene, packaged_scenes()):
        sizes = {"wide": WIDTH, "narrow": NARROW}
        figures = {kind: replace(beam_figure(scene, width), id=f"{scene.name}-{kind}") for kind, width in sizes.items()}
        svg = {kind: "".join(figure_files(figure, 0.0)[0].splitlines()) for kind, figure in figures.items()}
        drawings = "".join(f'<div class="beam-drawing {kind}">{drawing}</div>' for kind, drawing in svg.items())
        arguments = [" ".join(f"{key}={value}" for key, value in gate.arguments.items()) for gate in scene.gate]
        rows = [
            (f"`{one.id}`", f"{one.quantity} {words}", expected(one), f"{one.reference}: {one.why}")
            for one, words in zip(scene.gate, arguments, strict=True)
        ]
        yield f"## {scene.name}\n\n{scene.title}. {scene.description}\n\n{drawings}\n"
        yield table(("gate", "quantity", "expected", "reference and why"), rows)


def cases():
    """Every sheet of a case with its figures."""
    from verify.sheets.sheet import load, names
    from verify.sheets.write import engines

    yield CASES
    for name in names():
        sheet = load(name)
        exact = [f"{x.exact:.10g} {x.unit}".removesuffix(" 1") for x in sheet.figures]
        rows = [
            (f"`{x.name}`", x.meaning, value, f"{x.within:g}", x.order or "", x.source)
            for x, value in zip(sheet.figures, exact, strict=True)
        ]
        files = ", ".join(engines(name)) or "none: the sheet says what to build"
        yield f"({name})=\n## {name}\n\n{sheet.title}. Columns: {', '.join(sheet.columns)}. Files for: {files}.\n"
        yield "\n".join(f"{word}: {' '.join(getattr(sheet, word.lower()).split())}\n" for word in ("Build", "Record"))
        if sheet.blind:
            yield f"The record cannot tell {sheet.blind}.\n"
        yield table(("figure", "meaning", "exact", "passes within", "order", "source"), rows)


def plain(_app, _what, _name, _obj, _options, lines):
    """Escape characters that are markup in reStructuredText, outside of `code` and underlines of headings."""
    for i, line in enumerate(lines):
        if line.strip(" -"):
            parts = re.split(r"(`[^`]+`)", line)
            lines[i] = "".join(re.sub(r"([\\*|]|(?<=\w)_(?!\w))", r"\\\1", p) if p[:1] != "`" else p for p in parts)


def make(_app):
    """Write the pages."""
    MADE.mkdir(exist_ok=True)
    for page in (scenes, quantities, gates, cases):
        (MADE / f"{page.__name__}.md").write_text("\n".join(page()), "utf-8")


def report(app, error):
    """Run the paper's scene and write its report, which the first page shows."""
    from verify.report.page import run_page
    from verify.scene.run import run_scene

    if error is None and app.builder.format == "html":
        (Path(app.outdir) / "paper-report.html").write_text(run_page(run_scene("paper"), "verify run paper"), "utf-8")


def setup(app):
    """Write the generated pages before Sphinx reads any, and a report beside the pages."""
    app.connect("build-finished", report)
    app.connect("builder-inited", make)
    app.connect("autodoc-process-docstring", plain, priority=400)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
