"""Every packaged scene's report in a real browser: weight, paint, widths, colours, keyboard, motion, paper."""

import re
import unicodedata
from pathlib import Path

import pytest
from browser import CHROMIUM, MISSING, Browser
from packaged import html_of

from verify.scenes.scene import packaged_scenes

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason=MISSING)
CHECKS = (Path(__file__).parent / "checks.js").read_text("utf-8")
WIDTHS = (390, 800, 1024, 1280)
A4 = (595, 842)
UPRIGHT, LANDSCAPE = 703, 1032
"""What the margins leave of A4, in CSS pixels."""
PAINT = """new Promise(done => new PerformanceObserver(seen => {
  const [first] = seen.getEntriesByName("first-contentful-paint");
  if (first) done(first.startTime);
}).observe({ type: "paint", buffered: true }))"""


@pytest.fixture(scope="module")
def chromium(tmp_path_factory):
    with Browser(tmp_path_factory.mktemp("profile")) as browser:
        yield browser


@pytest.fixture(scope="module", params=packaged_scenes())
def report(request, chromium, tmp_path_factory):
    """A scene's report, opened once for all that is asked of it."""
    path = tmp_path_factory.mktemp("report") / f"{request.param}.html"
    path.write_text(html_of(request.param), "utf-8")
    page = chromium.page()
    page.path = path
    fresh(page)
    yield page
    page.close()


def fresh(page, width=1280):
    """Loaded again, on a lit screen."""
    page.media()
    page.width(width)
    page.open(page.path)
    page.run(CHECKS)


def first_paint(page, path):
    """The lesser of two, in milliseconds."""
    return min(page.open(path).run(PAINT) for _ in range(2))


@pytest.fixture(scope="module")
def nothing(chromium, tmp_path_factory):
    """First paint of a page of one word, here and now, in milliseconds."""
    word = tmp_path_factory.mktemp("word") / "word.html"
    word.write_text("<!doctype html><title>a word</title>word", "utf-8")
    page = chromium.page()
    took = first_paint(page, word)
    page.close()
    return took


def test_a_report_is_light_and_soon_painted(report, nothing):
    """At most 1.5 MB, and half a second to the first paint beyond what a page of one word takes here and now."""
    took = first_paint(report, report.path)
    report.run(CHECKS)
    assert report.path.stat().st_size <= 1_500_000
    assert took - nothing <= 500


def test_nothing_is_broader_than_the_screen_and_what_scrolls_says_so(report):
    for width in WIDTHS:
        report.width(width)
        assert report.run(f"checks.wide({str(width == WIDTHS[-1]).lower()})") == [], width


def test_words_in_pictures_are_whole_and_apart(report):
    for width in (390, 1280):
        report.width(width)
        assert report.run("checks.words()") == [], width


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_text_stands_out_from_what_is_behind_it(report, scheme):
    """WCAG AA: 4.5, large text 3."""
    report.media(prefers_color_scheme=scheme)
    dark = report.run("getComputedStyle(document.body).backgroundColor") == "rgb(20, 23, 27)"
    assert dark == (scheme == "dark")
    assert report.run("checks.contrast()") == []
    report.media()


def test_every_table_has_a_caption_and_its_heads_a_scope(report):
    assert report.run("checks.tables()") == []


def test_the_keyboard_reaches_every_chart_and_reads_its_values(report):
    """A key that is pressed, not an event that is made: the tip shows a name and the value on each axis."""
    for chart in report.run("charts.map(chart => ({ id: chart.id, bars: Boolean(chart.bars) }))"):
        at = f"document.querySelector('#{chart['id']} .plot')"
        report.run(f"{at}.focus({{ preventScroll: true }})")
        assert report.run(f"document.activeElement === {at} && {at}.tabIndex === 0"), chart
        seen = []
        for _ in range(2):
            report.key("ArrowRight")
            seen.append(report.run(f"checks.told(document.getElementById('{chart['id']}'))"))
        name, *values = seen[0]
        assert name, chart
        assert len(values) >= (1 if chart["bars"] else 2), (chart, seen)
        assert all(re.search(r": -?\d", value) for value in values[: 1 if chart["bars"] else 2]), (chart, seen)
        assert seen[0] != seen[1], chart


def test_the_legend_switches_its_lines_and_says_so(report):
    assert report.run("checks.legends()") == []


def test_frames_move_the_shapes_and_weigh_little(report):
    assert report.run("checks.frames()") == []


def test_nothing_moves_by_itself_where_motion_is_not_welcome(report):
    moving = report.run("charts.filter(chart => chart.plays).map(chart => chart.id)")
    if not moving:
        return
    fresh(report)
    assert report.run("checks.playing()") == moving
    report.media(prefers_reduced_motion="reduce")
    report.open(report.path)
    report.run(CHECKS)
    assert report.run("checks.playing()") == []
    report.media()


def test_nothing_is_broader_than_the_paper(report):
    report.run("checks.close()")
    report.media("print")
    for width, landscape in ((UPRIGHT, "false"), (LANDSCAPE, "true")):
        report.width(width)
        assert report.run(f"checks.paper({landscape})") == [], width
    report.width(1280)
    report.media()


def squeezed(text):
    """Without spaces, soft breaks and ligatures: how words are set is the printer's affair."""
    return re.sub(r"[\s\u200b\u00ad]+", "", unicodedata.normalize("NFKC", text))


def test_a_printed_report_is_a4_and_cuts_no_chart_and_no_row(report):
    pypdf = pytest.importorskip("pypdf", reason="no pypdf on this machine: no printed report was read")
    from io import BytesIO

    report.run("checks.close()")
    report.media("print")
    printed = report.run("checks.printed()")
    report.media()
    report.run(
        "document.querySelectorAll('svg.drawn :is(path, use, image)').forEach(one => one.remove())"
    )  # only words
    pages = pypdf.PdfReader(BytesIO(report.pdf())).pages
    for sheet in pages:
        assert sorted((round(float(sheet.mediabox.width)), round(float(sheet.mediabox.height)))) == sorted(A4)
    texts = [squeezed(sheet.extract_text()) for sheet in pages]
    for parts in printed["charts"]:
        together = [all(squeezed(part) in text for part in parts) for text in texts]
        assert sum(together) == 1, parts
    for words in printed["cells"]:
        assert any(squeezed(words) in text for text in texts), words


def test_without_scripts_every_picture_is_still_there(report, tmp_path):
    charts = report.run("charts.length")
    still = tmp_path / "still.html"
    still.write_text(re.sub(r"<script.*?</script>", "", report.path.read_text("utf-8"), flags=re.DOTALL), "utf-8")
    report.open(still)
    assert report.run("document.scripts.length") == 0
    report.run(CHECKS)
    assert report.run("checks.pictures()") == charts
    assert report.run("document.querySelectorAll('.frames:not([hidden]), .csv:not([hidden])').length") == 0
