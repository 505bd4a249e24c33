"""The documentation builds without a warning and without a network, and its links lead somewhere."""

import re
import shlex
import socket
import warnings
from html import escape, unescape
from pathlib import Path
from shutil import copy, copytree, ignore_patterns
from urllib.parse import unquote

import numpy as np
import pytest
from PIL import Image

from verify import run_scene
from verify.cli import status_of

DOCS = Path(__file__).parents[2] / "docs"
README = (DOCS.parent / "README.md").read_text("utf-8").replace("\n", " ")
PHRASE = "1 m x 40 x 8 mm steel, clamped-free"


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """(folder of the built pages, warnings)."""
    for package in ("sphinx", "furo", "myst_parser", "sphinx_gallery"):
        pytest.importorskip(package, reason="pip install '.[docs]' installs Sphinx and its extensions")
    from sphinx.application import Sphinx

    def refuse(*_):
        raise OSError("the build used the network")

    target, source = tmp_path_factory.mktemp("pages"), tmp_path_factory.mktemp("source")
    for folder in (DOCS, DOCS.parent / "examples"):  # the build writes pages beside them, and another worker may build
        copytree(folder, source / folder.name, ignore=ignore_patterns("made", "gallery", "_build"))
    copy(DOCS.parent / "CONTRIBUTING.md", source)
    log, docs = target / "warnings.txt", str(source / "docs")
    with pytest.MonkeyPatch.context() as patch, log.open("w") as stream, warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of Sphinx's own Python
        patch.setattr(socket.socket, "connect", refuse)
        Sphinx(docs, docs, str(target), str(target / ".trees"), "html", status=None, warning=stream).build()
    return target, log.read_text("utf-8")


def test_build_has_no_warnings(built):
    assert built[1] == ""


def test_links_are_inside_and_lead_somewhere(built):
    pages = {page: page.read_text("utf-8") for page in built[0].rglob("*.html")}
    places = {page: set(re.findall(r'\bid="([^"]+)"', text)) for page, text in pages.items()}
    lost = []
    for page, text in pages.items():
        assert not re.search(r'<(?:script|img|link)[^>]*?\b(?:src|href)="(?!data:)[^"]*//', text), page.name
        for link in re.findall(r'<a [^>]*?href="([^":]+)"', text):
            path, _, place = unquote(unescape(link)).partition("#")
            goal = (page.parent / path).resolve() if path else page
            if not goal.exists() or (place and place not in places.get(goal, {place})):
                lost.append(f"{page.name}: {link}")
    assert lost == []


def test_the_first_page_shows_the_report_of_this_version(built):
    assert 'src="paper-report.html"' in (built[0] / "index.html").read_text("utf-8")
    run = run_scene("paper")
    assert escape(run.verdict.headline) in (built[0] / "paper-report.html").read_text("utf-8")


def made(line, folder):
    """The picture that a command writes to a folder."""
    words = shlex.split(line.removeprefix("verify "))
    assert status_of([*words, "--charts", str(folder)]) == 0
    return folder


@pytest.mark.parametrize(
    ("name", "line"),
    [
        ("errors-over-size", re.search(r"`(verify table [^`]*) --charts FOLDER`", README)[1]),
        ("motor-force", "verify table preloaded-motor --study motor"),
    ],
)
def test_pictures_are_those_of_this_version(tmp_path, name, line):
    small = [
        np.asarray(Image.open(folder / f"{name}.png").convert("L").resize((108, 70)), dtype=float)
        for folder in (DOCS, made(line.replace("…", PHRASE), tmp_path))
    ]
    assert abs(small[0] - small[1]).mean() < 6.0  # of 255; 3 pixels of another font: 4.4, another legend: 8.8


def test_reference_pages_list_what_the_package_has(built):
    from verify.quantities.base import QUANTITIES
    from verify.scene.file import packaged_scenes
    from verify.scene.load import load_scene

    made = {name: (built[0] / "made" / f"{name}.html").read_text("utf-8") for name in ("quantities", "gates")}
    assert [name for name in QUANTITIES if f">{name}<" not in made["quantities"]] == []
    gates = [gate.id for name in packaged_scenes() for gate in load_scene(name).gate]
    assert [one for one in gates if f">{one}<" not in made["gates"]] == []
