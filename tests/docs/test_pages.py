"""The documentation builds without a warning and without a network, and what its pages link to is there."""

import re
import socket
from html import unescape
from pathlib import Path
from urllib.parse import unquote

import pytest

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """The built pages: the folder, and every warning."""
    pytest.importorskip("sphinx", reason="the documentation is built where pip install '.[docs]' brought Sphinx")
    pytest.importorskip("furo", reason="the documentation is built where pip install '.[docs]' brought furo")
    pytest.importorskip(
        "myst_parser", reason="the documentation is built where pip install '.[docs]' brought myst-parser"
    )
    import warnings

    from sphinx.application import Sphinx

    target, said = tmp_path_factory.mktemp("pages"), tmp_path_factory.mktemp("said") / "warnings.txt"
    with pytest.MonkeyPatch.context() as patched, said.open("w") as heard, warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of Sphinx's own Python; its warnings about pages are heard below
        patched.setattr(socket.socket, "connect", refuse)
        paths, told = (str(DOCS), str(DOCS), str(target), str(target / ".trees")), {"status": None, "warning": heard}
        Sphinx(*paths, "html", {"verify_judge": False}, **told).build()
    return target, said.read_text("utf-8")


def refuse(*_):
    raise OSError("the documentation asked for a network")


def pages_of(folder):
    return {page: page.read_text("utf-8") for page in sorted(folder.rglob("*.html"))}


def without_code(text):
    return re.sub(r"<(pre|code|script|style)\b.*?</\1>", "", text, flags=re.DOTALL)


def test_the_documentation_builds_without_a_warning(built):
    target, warnings = built
    assert warnings == ""
    names = {str(page.relative_to(target)) for page in pages_of(target)}
    assert {"index.html", "theory.html", "api.html", "made/scenes.html", "made/catalogue/paper.html"} <= names


def test_every_link_inside_leads_to_a_place_that_there_is(built):
    target, _ = built
    pages = pages_of(target)
    places = {page: set(re.findall(r'\bid="([^"]+)"', text)) for page, text in pages.items()}
    lost, seen = [], 0
    for page, text in pages.items():
        for link in re.findall(r'<a [^>]*?href="([^"]+)"', text):
            path, _, place = unquote(unescape(link)).partition("#")
            if re.match(r"[a-z]+:", path):
                continue
            goal, seen = (page.parent / path).resolve() if path else page, seen + 1
            if not goal.exists() or (place and goal.suffix == ".html" and place not in places[goal]):
                lost.append(f"{page.relative_to(target)}: {link}")
    assert not lost
    assert seen > 3000


def test_pages_fetch_nothing_from_elsewhere(built):
    target, _ = built
    for page, text in pages_of(target).items():
        fetched = re.findall(r'<(?:script|img|source|iframe)[^>]*?\bsrc="([^"]+)"', text)
        fetched += re.findall(r'<link[^>]*?rel="(?:stylesheet|preload|icon|preconnect)"[^>]*?href="([^"]+)"', text)
        assert fetched
        assert [one for one in fetched if "//" in one] == [], page.name
        assert "@import" not in text


def test_formulas_are_drawn_by_the_browser_and_none_is_left_as_latex(built):
    target, _ = built
    text = (target / "theory.html").read_text("utf-8")
    assert text.count("<math") >= 60
    assert not re.search(r"\\(frac|sqrt|mu|omega)", without_code(text))


def test_every_packaged_case_has_a_sheet_with_its_drawing(built):
    from verify.scenes.scene import packaged_scenes

    target, _ = built
    for name in packaged_scenes():
        text = (target / "made" / "catalogue" / f"{name}.html").read_text("utf-8")
        assert '<div class="beam-drawing"><svg' in text
        assert "<!-- drawing" not in text


def test_the_scene_reference_has_every_key_of_every_section(built):
    from verify.scenes.described import keys_of, sections

    target, _ = built
    text = re.sub(r"<[^>]+>", "", (target / "made" / "scenes.html").read_text("utf-8"))
    for name in sections():
        assert {key.key for key in keys_of(name) if key.key not in text} == set(), name


def test_what_is_public_stands_in_the_api(built):
    import verify

    target, _ = built
    text = (target / "api.html").read_text("utf-8")
    modules = {"analytic_modes", "fem_beam", "segment_model", "travelling_wave", "simulate"}
    assert {name for name in verify.__all__ if f'id="verify.{name}"' not in text} <= modules | {"__version__"}
    assert all(f'id="module-verify.{name}"' in text or f'id="verify.{name}' in text for name in modules)


def links_of(page):
    return [link for link in re.findall(r"\]\(([^)\s]+)\)", page.read_text("utf-8")) if ":" not in link]


@pytest.mark.parametrize("page", [ROOT / "README.md", ROOT / "CONTRIBUTING.md"], ids=lambda page: page.name)
def test_the_readmes_links_lead_somewhere(page):
    assert all((ROOT / link.partition("#")[0]).exists() for link in links_of(page))


def test_the_readme_is_short_has_one_picture_and_two_commands_to_begin_with():
    text = (ROOT / "README.md").read_text("utf-8")
    assert len(text.splitlines()) <= 100
    assert text.count("![") == 1
    begin = text.partition("\n## ")[0]
    assert len(re.findall(r"^```sh\n(.*)\n```$", begin, re.MULTILINE)) == 2
    assert (DOCS / "paper-report.png").stat().st_size < 200_000
