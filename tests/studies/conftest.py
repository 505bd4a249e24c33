"""What every study has in common: a run on a scene, and a result that renders in every form."""

import json

import pytest

from verify.analysis.solution_cache import SolutionCache
from verify.report.result import to_json
from verify.scene.load import load_scene


@pytest.fixture(scope="session")
def run():
    """Run a study on a packaged scene, or a scene; results of equal requests are shared."""
    results = []

    def run_study(scene, study):
        loaded = load_scene(scene) if isinstance(scene, str) else scene
        for known, asked, result in results:
            if known == loaded and asked == study:
                return result
        study.check(loaded)
        steps = []
        results.append((loaded, study, study.run(loaded, SolutionCache(loaded.beam), steps.append)))
        assert steps
        return results[-1][2]

    return run_study


@pytest.fixture(scope="session")
def renders():
    """Draw every figure, a frame of every movie, and every table in all forms; returns the drawn axes by figure."""
    pytest.importorskip("matplotlib")
    from matplotlib.figure import Figure as Canvas
    from rich.console import Console

    from verify.report.plotting import drawn, figure_files, style

    def render(result):
        axes = {}
        for figure in result.figures:
            assert figure_files(figure, 0.0)[0].endswith("</svg>\n")
            with style():
                axes[figure.id] = drawn(figure).axes[0]
            assert axes[figure.id].get_xlabel() or axes[figure.id].get_yticklabels()
            assert figure.title
            assert figure.caption
        for movie in result.movies:
            with style():
                update, frames = movie.animate(Canvas().subplots())
                assert update(list(frames)[-1])
        console = Console(width=100, record=True, quiet=True)
        result.print(console)
        for table in result.tables:
            assert len(table.csv().splitlines()) == len(table.rows) + 1
            assert len({column.name for column in table.columns}) == len(table.columns)
            assert all(len(row) == len(table.columns) for row in table.rows)
            assert table.markdown()
        json.loads(to_json(result.to_dict()))
        return axes

    return render
