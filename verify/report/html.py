"""The report page: results in, one file out."""

import json
import os
import platform
import sys
from importlib import metadata
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from verify.errors import InputError
from verify.files import write_whole
from verify.report.axial_charts import NAMES, axial_charts
from verify.report.charts import charts_of
from verify.report.motion_charts import motion_charts
from verify.report.plain import finite
from verify.report.reading_charts import reading_charts
from verify.report.wave_charts import wave_charts
from verify.studies import claim_words
from verify.words import figure, percent, seconds_in_words, work_in_words

if TYPE_CHECKING:
    from verify.run.runner import RunResult

_PACKAGES = ("fem-segment-verify", "numpy", "scipy", "scikit-fem", "plotly")


def write_report(result: "RunResult", path: Path, command: str) -> None:
    """Write the report of a run; `command` is the line that reproduces it. Raises InputError."""
    write_whole(path, page(result, command), "reports")


def page(result: "RunResult", command: str) -> str:
    """The whole HTML page, plotly's script included."""
    from jinja2 import Environment, PackageLoader, StrictUndefined

    from verify.motion.contact import FELT

    loader = PackageLoader("verify", "report")
    templates = Environment(
        loader=loader, autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    templates.filters |= {"figure": figure, "percent": percent, "duration": seconds_in_words}
    charts = charts_of(result) + (wave_charts(result.wave) if result.wave else [])
    charts += motion_charts(result.motion) if result.motion else []
    charts += reading_charts(result.readings) if result.readings else []
    charts += axial_charts(result.axial_inertia) if result.axial_inertia else []
    return templates.get_template("page.html.j2").render(
        result=result,
        work=work_in_words(result),
        failed=[gate for gate in result.gates if not gate.passed],
        charts=charts,
        model_names=NAMES,
        words=claim_words,
        felt=FELT,
        notes=dict.fromkeys(note for row in result.convergence or () for note in row.notes),
        figures=_safe_json({chart["id"]: chart["figure"] for chart in charts}),
        plotly=_plotly_script() if charts else "",
        environment=environment(),
        command=command,
    )


def environment() -> dict[str, str]:
    """What the figures were made with: versions, platform, processors. No paths, no names."""
    versions = {name: metadata.version(name) for name in _PACKAGES}
    return {
        "Python": platform.python_version(),
        **versions,
        "platform": f"{platform.system()} {platform.machine()}",
        "processors": str(len(os.sched_getaffinity(0)) if sys.platform == "linux" else os.cpu_count()),
    }


def _safe_json(data: Any) -> str:
    """JSON that cannot end the script element it stands in."""
    return json.dumps(finite(data), allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")


def _plotly_script() -> str:
    """plotly.js as installed, found without importing plotly."""
    spec = find_spec("plotly")
    for folder in (spec.submodule_search_locations or []) if spec else []:
        script = Path(folder) / "package_data" / "plotly.min.js"
        if script.is_file():
            return script.read_text("utf-8")
    raise InputError("plotly's script plotly.min.js is not installed: reinstall plotly, or use --no-report")
