"""Command lines drawn by a number, and the files that they name."""

from drawn import STRANGE_WORDS, Draw, toml, word
from drawn_scenes import Drawn
from msgspec import Struct

from verify.cli import COMMANDS
from verify.scenes.scene import load_scene, packaged_scenes

PACKAGED = tuple(name for name in packaged_scenes() if len(load_scene(name).gate) < 25 or name == "paper")
"""The longest take seconds each; their verbs are drawn on other scenes."""
LAYOUTS = ("--json", "--json", "--csv", "--markdown")
KEYS = (
    "beam.length", "beam.thickness", "beam.density", "beam.supports", "beam.tension", "beam.loss_factor",
    "beam.section.0.length", "beam.mass", "drive.frequency_hz", "drive.force.0.position", "slider.mu", "motion.duration",
    "spectrum.modes", "convergence.counts", "wave.counts", "gate.0.expect", "gate.g0.within", "gate", "name", "title",
    "description", "name.x", "..", "beam..mass", "nothing",
)  # fmt: skip


class Line(Struct):
    """A command line with the folder that it is run in."""

    seed: int
    words: list[str]
    files: dict[str, bytes]


def drawn_line(seed):
    """The line of a number."""
    draw = Draw(seed)
    line = Line(seed, [], {})
    known = [name for name in COMMANDS if name in DRAWERS]
    command = draw.choice((*COMMANDS, *("run", "measure", "plan", "table") * 4))
    drawer = DRAWERS[command] if command in known else _refused
    line.words = [command, *map(word, drawer(draw, line))]
    if draw.often(4):
        line.words.insert(draw.randint(0, len(line.words)), word(draw.strange()))
    if command not in ("compare", "schema", "quantities", "keys") and draw.often(3):
        line.words.append(draw.choice(("--help", "--version", "--nonsense")))
    return line


def _scene(draw, line, packaged=25):
    """The name of a scene: a packaged one, or a file that is written for it."""
    if draw.often(packaged):
        return draw.value(draw.choice(PACKAGED))
    text = Drawn(draw).text
    if draw.often(2):
        cut = draw.randrange(len(text))
        text = text[:cut] + draw.choice(STRANGE_WORDS) + text[cut + draw.randint(0, 9) :]
    line.files["scene.toml"] = text.encode("utf-8", "surrogateescape")
    return "scene.toml"


def _set(draw, percent=25):
    """Overrides."""
    words = []
    while draw.often(percent):
        value = draw.strange() if draw.often(50) else draw.decade(-2, 3)
        words += ["--set", f"{draw.choice(KEYS)}={value if isinstance(value, str) else toml(value)}"]
    return words


def _json(draw):
    return ["--json"] * draw.often(60)


def _layout(draw):
    return [draw.choice(LAYOUTS)] * draw.often(85)


def _rules(draw):
    """Options that set models up."""
    return [part for name, value in Drawn(draw).rules().items() for part in (f"--{name}", value)]


def _run(draw, line):
    reports = draw.one([], ["--no-report"], ["--no-report"], ["--reports", "out"], ["--reports", draw.strange()])
    return [_scene(draw, line, 12), *_set(draw), *reports, *_json(draw)]


def _plan(draw, line):
    return [_scene(draw, line, 15), *_set(draw, 40), *_json(draw)]


def _measure(draw, line):
    drawn = Drawn(draw)
    line.files["scene.toml"] = drawn.text.encode("utf-8", "surrogateescape")
    quantity = drawn.quantity()
    given = [f"{name}={word(value)}" for name, value in drawn.arguments(quantity).items()]
    scene = [] if draw.often(10) else ["--scene", "scene.toml"]
    return [draw.value(quantity), *given, *scene, *_set(draw, 10), *_json(draw)]


def _table(draw, line):
    scene, kind = _scene(draw, line), draw.randint(0, 4)
    modes = ["--modes", draw.value(draw.one("1-3", "2", "1,4,9", "1-9:3"))] * draw.often(70)
    counts = ["--counts", draw.value(draw.one("7", "4,9,15", "5-20:5"))] * draw.often(90)
    if kind == 0:
        study = draw.choice(("spectrum", "convergence", "sensitivity", "wave", "readings", "axial_inertia", "claims"))
        more = ["--of", draw.value(study)]
        line.files.pop("scene.toml", None)
        scene = draw.choice(("paper", "taut-strip", "chain")) if draw.often(40) else _scene(draw, line, 0)
    elif kind == 1:
        axis = draw.choice(("frequency_hz", "phase_deg", "position", "loss_factor", "count"))
        span = draw.value(draw.one("0:90:3", "10:300:2", "0.01:0.1:2", "5:9:3", "9:5:2", "1:1:1", "0:180:99999"))
        more = ["--sweep", f"{axis}={word(span)}", "model=segment", "count=9"]
    elif kind == 2:
        more = [draw.choice(("--wave", "--slider")), *counts]
    else:
        more = [*modes, *counts, *_rules(draw)]
    return [scene, *more, *_set(draw, 10), *_layout(draw)]


def _choose(draw, line):
    error = draw.value(draw.one("1%", "0.1%", "0.01", "50%", "150%"))
    return [
        "--mode",
        draw.value(draw.randint(1, 9)),
        "--error",
        error,
        "--scene",
        _scene(draw, line),
        *_rules(draw),
        *_json(draw),
    ]


def _compare(draw, line):
    scene, drawn = _scene(draw, line, 40), Drawn(draw)
    line.files["list.csv"] = _frequencies(draw, drawn.hertz)
    words = [draw.value("list.csv"), "--scene", scene, *_json(draw)]
    for name, values in COMPARED.items():
        if draw.often(60 if name == "count" else 25):
            words += [f"--{name}", draw.value(draw.choice(values))]
    if draw.often(20):
        line.files["shapes.csv"] = b"x,1\n0,0\n0.1,0.7\n0.2,1\n" if draw.often(70) else draw.randbytes(30)
        words += ["--modes", "shapes.csv"]
    return [*words, *_set(draw, 5)]


COMPARED = {
    "count": (1, 9, 30), "unit": ("Hz", "kHz", "rad/s"), "kind": ("segments", "elements"), "error": ("0.1%", "1e-4"),
    "mode": (1, 4), "within": ("1%", "0.2"), "theory": ("timoshenko", "rayleigh"), "reports": ("out", "list.csv"),
    "model": ("json:loads", "os:nothing", "verify.beam:Beam", ":", "no.such:Thing"),
}  # fmt: skip


def _frequencies(draw, first):
    """A list as programs write them: some columns, some head, about the right figures or none."""
    offset, bend = draw.one(0.0, 0.5, 0.25), draw.one(0.0, 1e-3, -1e-3)
    rows = [first * (n + offset) ** 2 * (1.0 + bend * n * n) for n in range(1, draw.one(2, 4, 9, 15))]
    mark = draw.one(",", ";", "\t", " ")
    cells = [word(draw.value(float(f"{value:.{draw.one(4, 9)}g}"))) for value in rows]
    lines = [f"{n}{mark}{cell}" for n, cell in enumerate(cells, 1)] if draw.often(50) else cells
    text = "\n".join(
        [*draw.one([], ["frequency"], [f"mode{mark}f (Hz)"], ["# by hand"]), *lines, *[""] * draw.often(80)]
    )
    data = text.replace("\n", draw.one("\n", "\r\n")).encode("utf-8", "surrogateescape")
    return (
        draw.one(data, data, data, data, draw.randbytes(40), text.encode("utf-16", "surrogatepass"))
        if draw.often(20)
        else data
    )


def _init(draw, line):
    source = ["--from", _scene(draw, line, 60)] if draw.often(60) else []
    line.files["there.toml"] = b"name = 'there'\n"
    path = draw.value(draw.one("new.toml", "there.toml", "no/folder.toml", "."))
    return [path, *source, *["--force"] * draw.often(30), *_json(draw)]


def _show(draw, line):
    return [_scene(draw, line, 40), *_set(draw, 40), *_json(draw)]


def _keys(draw, line):
    return [draw.value(draw.one("beam", "beam.mass", "gate", "gate.expect", "wave", "BEAM", "nothing"))] * draw.often(
        80
    ) + _json(draw)


def _schema(draw, line):
    section = ["--section", draw.value(draw.one("beam", "drive.force", "nothing"))] * draw.often(50)
    return [*section, *(["--to", draw.value(draw.one("schema.json", "no/schema.json"))] * draw.often(40))]


def _quantities(draw, line):
    return [*draw.several(lambda: draw.value(draw.one("mode", "wave", "slider.", "order", "é")), 2), *_json(draw)]


def _scenes(draw, line):
    return [*[draw.strange()] * draw.often(30), *_json(draw)]


def _bench(draw, line):
    """Modes alone and a second of them: the rest takes what a case has no time for."""
    counts = ["--counts", draw.value(draw.one("4,9", "7", "5-20:5"))] * draw.often(90)
    modes = ["--modes", draw.value(draw.one("1", "2,3", "99"))] * draw.often(60)
    layout = draw.one("--json", "--json", "--csv", "--markdown")
    return [_scene(draw, line, 10), "--sets", "modes", "--seconds", "0.2", *counts, *modes, layout]


def _stress(draw, line):
    """Rows that take milliseconds, and words that are no rows."""
    if draw.often(20):
        return ["--list", *_json(draw)]
    rows = draw.several(lambda: draw.value(draw.choice(QUICK_ROWS)), 2) or [QUICK_ROWS[0]]
    return [*rows, "--no-report", *_layout(draw)]


def _catalogue(draw, line):
    """Sheets of a few scenes, or of all."""
    scenes = draw.several(lambda: _scene(draw, line, 10), 2)
    folder = ["--to", draw.value(draw.one("sheets", "."))] * draw.often(40)
    return [*scenes, *folder, *_json(draw)]


QUICK_ROWS = ("modulus", "density", "at-resonance-exact-beam", "beyond-buckling", "rolled-up", "nothing")


def _kept(draw, line):
    """What might be a run that is kept, and is none."""
    head = b'{"layout": 1, "verify": "0.1.0", "report": "mine", "document": {}, "figures": {}}'
    line.files["run.json"] = draw.one(head, head.replace(b"1", b"2", 1), b"{}", b"", draw.randbytes(30))
    return draw.value(draw.one("run.json", "run.json", ".", "nowhere", "scene/run.json"))


def _report(draw, line):
    return [_kept(draw, line), *["--to", draw.value(draw.one("again.html", "no/again.html"))] * draw.often(60)]


def _diff(draw, line):
    return [_kept(draw, line), draw.value(draw.one("run.json", ".", "nowhere")), *_json(draw)]


def _refused(draw, line):
    """A command that does more than a case has time for: words that it has to refuse before it begins."""
    return [*draw.several(draw.strange, 2), "--nonsense", *_json(draw)]


DRAWERS = {
    "run": _run, "plan": _plan, "measure": _measure, "table": _table, "choose": _choose, "compare": _compare,
    "init": _init, "show": _show, "keys": _keys, "schema": _schema, "quantities": _quantities, "scenes": _scenes,
    "bench": _bench, "stress": _stress, "catalogue": _catalogue, "report": _report, "diff": _diff,
}  # fmt: skip
