"""Lines of a second kind: their scenes, and the commands that write meshes, pictures, sheets and pages of kept runs."""

import contextlib
import io
import json
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

from drawn import Draw, word
from drawn_further_scenes import Further
from drawn_lines import KEYS, QUICK_ROWS, Line
from drawn_scenes import MODELS, QUANTITIES

from verify.cli import status_of
from verify.errors import InputError
from verify.scenes.scene import load_scene

MAPPED = [
    name
    for name, given in QUANTITIES.items()
    if name.startswith("wave.") and {"phase_deg", "position", "model"} <= {one["name"] for one in given}
]
"""What may be told over frequencies and phases."""


def _mostly_taken(draw):
    """A scene that is taken, after some that are not: of a dozen tables one is wrong more often than not."""
    for _ in range(12):
        scene = Further(draw)
        if _is_taken(scene) or draw.often(10):
            break
    return scene


def _written(scene):
    return scene.text.encode("utf-8", "surrogateescape")


def _is_taken(scene):
    with TemporaryDirectory() as folder:
        path = Path(folder) / "scene.toml"
        path.write_bytes(_written(scene))
        try:
            load_scene(path)
        except InputError:
            return False
    return True


def further_line(seed):
    """The line of a number."""
    draw = Draw(seed)
    line, scene = Line(seed, [], {}), _mostly_taken(draw)
    line.files["scene.toml"] = _written(scene)
    command = draw.choice((*("run",) * 6, "measure", "measure", "plan", "table", "table", *DRAWERS))
    line.words = [command, *map(word, DRAWERS[command](draw, line, scene))]
    return line


def _set(draw, percent=15):
    return ["--set", f"{draw.choice(KEYS)}={word(draw.decade(-2, 3))}"] * draw.often(percent)


def _json(draw):
    return ["--json"] * draw.often(60)


def _run(draw, line, scene):
    reports = draw.one(["--no-report"], ["--no-report"], ["--reports", "out"], ["--keep", "1", "--reports", "out"])
    return ["scene.toml", *_set(draw), *reports, *_json(draw)]


def _plan(draw, line, scene):
    return ["scene.toml", *_set(draw), *_json(draw)]


def _measure(draw, line, scene):
    quantity = scene.quantity()
    given = [f"{name}={word(value)}" for name, value in scene.arguments(quantity).items()]
    return [quantity, *given, "--scene", "scene.toml", *_json(draw)]


def _table(draw, line, scene):
    layout = draw.one("--json", "--csv", "--markdown")
    asked = [name for name in ("motor", "methods", "bench", "stress", "wave", "sensitivity") if name in scene.tables]
    if asked and draw.often(80):
        return ["scene.toml", "--of", draw.choice(asked), layout]
    quantity = draw.choice(MAPPED)
    needed = ["x=0.03"] * any(one["name"] == "x" and one["required"] for one in QUANTITIES[quantity])
    hertz = f"frequency_hz={word(scene.hertz * 3.1)}:{word(scene.hertz * 8.2)}:3"
    second = ["--sweep", draw.one("phase_deg=0:180:3", "count=5:9:3", "loss_factor=0.001:0.1:2")] * draw.often(40)
    model = ["model=segment", *["count=9"] * ("count=5:9:3" not in second)]
    return ["scene.toml", "--quantity", quantity, "--sweep", hertz, *second, *needed, *draw.one(model, []), layout]


def _export(draw, line, scene):
    what = draw.choice(tuple(WRITTEN))
    forms, options = WRITTEN[what]
    form = draw.choice(forms)
    words = [
        "--what",
        draw.value(what),
        "--to",
        draw.value(draw.one(f"new.{form}", f"new.{form}", "out", "scene.toml")),
    ]
    for name in (*options, *draw.one((), (), (), EXPORTED)):
        if draw.often(30):
            words += [f"--{name}", draw.value(draw.choice(EXPORTED[name]))]
    return ["scene.toml", *words, *_set(draw, 5)]


MESHES = ("vtu", "pvd", "xdmf", "csv", "json", "npz")
WRITTEN = {
    "modes": ((*MESHES, "tex"), ("model", "count", "modes")), "field": (MESHES, ("model", "count")),
    "motion": (MESHES, ("model", "count", "samples")), "tables": (("tex", "json"), ()),
}  # fmt: skip
EXPORTED = {
    "format": MESHES, "model": MODELS, "count": (2, 9, 31), "modes": (1, 4, 40), "samples": (2, 5),
    "reading": ("corrected", "raw"),
}  # fmt: skip


def _picture(draw, line, scene):
    what = ["--what", draw.value(draw.one("modes", "wave", "slider", "chain"))] * draw.often(80)
    more = [*["--mode", draw.value(draw.randint(1, 9))] * draw.often(40), "--count", draw.value(draw.randint(2, 20))]
    to = draw.value(draw.one("new.png", "new.gif", "new.txt", "no/new.png"))
    return ["scene.toml", *what, *more, "--flat", "--to", to, *_set(draw)]


def _compare_shapes(draw, line, scene):
    """A mesh as it is, cut short, or none."""
    mesh = MESH % b" ".join(b"%r 0 0" % (scene.length * part / 4) for part in range(5))
    line.files["shapes.vtu"] = draw.one(mesh, mesh, mesh, mesh[: draw.randrange(len(mesh))], draw.randbytes(30))
    more = [*["--count", draw.value(draw.randint(2, 30))] * draw.often(40), *["--within", "1%"] * draw.often(5)]
    return [draw.value("shapes.vtu"), "--scene", "scene.toml", *more, *_set(draw), *_json(draw)]


MESH = b"""<?xml version="1.0"?><VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian">
<UnstructuredGrid><Piece NumberOfPoints="5" NumberOfCells="4">
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">%s</DataArray></Points>
<Cells><DataArray type="Int64" Name="connectivity" format="ascii">0 1 1 2 2 3 3 4</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">2 4 6 8</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">3 3 3 3</DataArray></Cells>
<PointData><DataArray type="Float64" Name="mode 1" NumberOfComponents="1" format="ascii">0 0.7 1 0.7 0</DataArray></PointData>
</Piece></UnstructuredGrid></VTKFile>
"""


def _choose(draw, line, scene):
    error = draw.value(draw.one("1%", "0.01%", "1e-6", "30%"))
    return ["--mode", draw.randint(1, 9), "--error", error, "--scene", "scene.toml", *_set(draw), *_json(draw)]


def _bench(draw, line, scene):
    """A second of work beside an earlier one, whose file somebody has changed."""
    line.files["before.json"] = _changed(draw, benched())
    against = ["--against", draw.value("before.json")] * draw.often(30)
    sets = draw.one("modes", "harmonic", "transient", "chain", "modes,harmonic")
    return ["scene.toml", "--sets", sets, "--seconds", "0.2", "--counts", "5,9", *against, *_set(draw), "--json"]


def _stress(draw, line, scene):
    return [draw.choice(QUICK_ROWS), "--seconds", draw.value(draw.one(1, 0.2, 1e-9)), "--reports", "out", *_json(draw)]


def _catalogue(draw, line, scene):
    return ["scene.toml", *["--run"] * draw.often(50), *["--to", "sheets"] * draw.often(40), *_json(draw)]


def _diff(draw, line, scene):
    line.files["a.json"], line.files["b.json"] = _changed(draw, kept()), _changed(draw, kept())
    return ["a.json", "b.json", *["--to", draw.value(draw.one("new.html", "b.json"))] * draw.often(60), *_json(draw)]


def _report(draw, line, scene):
    line.files["run.json"] = _changed(draw, kept())
    return ["run.json", *["--to", draw.value(draw.one("new.html", "no/new.html"))] * draw.often(80)]


@cache
def kept():
    """A run that was kept, as its file has it."""
    with TemporaryDirectory() as folder:
        _said("run", "taut-strip", "--reports", folder)
        (path,) = Path(folder).rglob("run.json")
        return path.read_text()


@cache
def benched():
    """What a bench printed."""
    return _said("bench", "taut-strip", "--sets", "modes", "--seconds", "0.2", "--counts", "5,9", "--json")


def _said(*words):
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        status_of(list(words))
    return out.getvalue()


def _changed(draw, text):
    """A file of data in which some values are others, or that ends early."""
    data = json.loads(text)
    for _ in range(draw.one(0, 0, 1, 1, 2, 5)):
        _change(draw, data)
    text = json.dumps(data, default=str)
    return text[: draw.randrange(len(text)) if draw.often(5) else None].encode("utf-8", "surrogateescape")


EXTREME = (-5.0, -1, 0, 1e-320, 5e-324, 1e308, -1e308)
"""Numbers of the right kind that no clock and no beam gives."""


def _numbers(data):
    """(whose, name) of every number, wherever it stands."""
    for name, value in list(data.items() if isinstance(data, dict) else enumerate(data)):
        if isinstance(value, dict | list):
            yield from _numbers(value)
        elif isinstance(value, int | float) and not isinstance(value, bool):
            yield data, name


def _change(draw, data):
    """Put an extreme number in the place of one, or walk down and put something else there, or take it away."""
    if draw.often(50) and (numbers := list(_numbers(data))):
        whose, name = draw.choice(numbers)
        whose[name] = draw.choice(EXTREME)
        return
    while True:
        names = list(data) if isinstance(data, dict) else list(range(len(data)))
        if not names:
            return
        name = draw.choice(names)
        if not isinstance(data[name], dict | list) or draw.often(15):
            break
        data = data[name]
    if draw.often(25):
        del data[name]
    else:
        data[name] = draw.one(None, draw.strange(), draw.strange())


DRAWERS = {
    "run": _run, "plan": _plan, "measure": _measure, "table": _table, "export": _export, "picture": _picture,
    "compare-shapes": _compare_shapes, "choose": _choose, "bench": _bench, "stress": _stress, "catalogue": _catalogue,
    "diff": _diff, "report": _report,
}  # fmt: skip
