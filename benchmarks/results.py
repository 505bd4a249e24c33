"""The tables of docs/bench.md and docs/stress.md from the JSON in docs/bench, measured again with --run.

python -m benchmarks.results [--run [paper] [steel-cantilever] [stress]]
"""

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

from verify.bench.work_precision import STAR_NOTE, Row, ratio_cells

DOCS = Path(__file__).parents[1] / "docs"
MARKER = "<!-- results: written by python -m benchmarks.results -->\n"
"""What stands below it in a page is replaced."""
COMMANDS = {
    "paper": ["bench", "--seconds", "3", "--json"],
    "steel-cantilever": ["bench", "modes", "--scene", "steel-cantilever", "--mode", "8", "--json"],
    "stress": ["stress", "--slow", "--json"],
}


def run(names: list[str]) -> None:
    """Write the JSON files, without the tables that repeat the data; each command in a process of its own."""
    for name, words in ((name, COMMANDS[name]) for name in names):
        done = subprocess.run([sys.executable, "-m", "verify", *words], check=False, stdout=subprocess.PIPE, text=True)
        data = {key: value for key, value in json.loads(done.stdout).items() if key != "tables"}
        (DOCS / "bench" / f"{name}.json").write_text(json.dumps(data, indent=1, ensure_ascii=False) + "\n", "utf-8")
        print(f"{name}: exit status {done.returncode}", flush=True)


def number(value: float | None, form: str = ".2g") -> str:
    """A cell."""
    return "" if value is None else format(value, form)


def bench_tables() -> str:
    """Ratios at equal errors, and the finest size of every method."""
    lines: list[str] = []
    for name in (one for one in COMMANDS if one != "stress"):
        data = json.loads((DOCS / "bench" / f"{name}.json").read_text("utf-8"))
        machine = ", ".join(f"{key} {value}" for key, value in data["machine"].items())
        lines += ["", f"## {name}", "", f"`verify {' '.join(COMMANDS[name])}`, {machine}.", ""]
        lines += ["| set | method | order | finest size: error, time | ratio at 1e-2 | 1e-3 | 1e-4 | 1e-5 |"]
        lines += ["|---|---|--:|---|--:|--:|--:|--:|"]
        for question in data["questions"]:
            rows = [Row(**one) for one in question["rows"]]
            for method, ratios in question["ratios"].items():
                row = [one for one in question["rows"] if one["method"] == method][-1]
                size = f"{row['size_name']} {row['size']:.3g}: " if row["size_name"] else ""
                finest = f"{size}{row['error']:.1e}, {1e3 * row['seconds']:.3g} ms"
                marked = (cell or "" for cell in ratio_cells(method, ratios, rows, ".2g"))
                cells = (question["id"], method, number(row["order"], ".2f"), finest, *marked)
                lines.append(f"| {' | '.join(cells)} |")
        known = (f"{one['id']}: {one['title']}; reference {one['reference']}" for one in data["questions"])
        lines += ["", "\\" + STAR_NOTE, "", *(f"- {one}" for one in known)]
    return "\n".join(lines) + "\n"


def stress_table() -> str:
    """One line for each check, both models of a check together."""
    checks = json.loads((DOCS / "bench" / "stress.json").read_text("utf-8"))["checks"]
    groups: dict[str, list[dict[str, Any]]] = {}
    for one in checks:
        groups.setdefault(one["id"].removesuffix("-segments").removesuffix("-elements"), []).append(one)
    lines = ["", "| check | error of | parameter | tolerance | worst | breaks at | standard method |"]
    lines += ["|---|---|---|---|---|---|---|"]
    for name, ones in groups.items():
        worst = max(ones, key=lambda one: one["worst"] / one["tolerance"])
        limits = [f"{one['breaks_at']:.2g} {one['breaks_by']}" for one in ones if one["breaks_at"] is not None]
        method = next((one["baseline_name"] for one in ones), "")
        error = max((one["baseline"] or float("inf") for one in ones), default=0.0)
        cells = [name, worst["title"], f"{worst['parameter']}, {worst['from']:g} to {worst['to']:g}"]
        failed = "" if all(one["passed"] for one in ones) else ", not within it"
        cells += [number(worst["tolerance"], ".3g"), number(worst["worst"]) + failed, ", ".join(dict.fromkeys(limits))]
        lines.append(f"| {' | '.join(cells)} | {f'{method}: {error:.0e}' if method else ''} |")
    return "\n".join(lines).replace("inf |", "fails |") + "\n"


if __name__ == "__main__":
    if sys.argv[1:2] == ["--run"]:
        run(sys.argv[2:] or list(COMMANDS))
    for page, text in (("bench", bench_tables()), ("stress", stress_table())):
        path = DOCS / f"{page}.md"
        path.write_text(path.read_text("utf-8").partition(MARKER)[0] + MARKER + text, "utf-8")
