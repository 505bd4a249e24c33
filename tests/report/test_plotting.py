"""Charts and movies: the data that were drawn, colours that follow the page, images that open."""

import csv
import re
from io import BytesIO, StringIO
from xml.etree import ElementTree

from PIL import Image

from verify.report.plotting import figure_csv, figure_files, figure_png, figure_svg, movie_image


def rows_of(figure):
    return list(csv.reader(StringIO(figure_csv(figure))))


def test_csv_has_the_drawn_line(figures, points):
    head, *rows = rows_of(figures[0])
    assert head[:3] == ["series", "N", "error, %"]
    assert [(row[0], float(row[1]), float(row[2])) for row in rows] == [
        ("segments", n, e) for n, e in zip(*points, strict=True)
    ]


def test_csv_has_the_map_at_cell_centres(figures):
    rows = [tuple(map(float, row[1:])) for row in rows_of(figures[1])[1:]]
    assert rows == [(0.5, 1.0, 1.5), (2.0, 1.0, 2.5), (0.5, 3.5, 3.5), (2.0, 3.5, 4.5)]


def test_csv_has_the_bars(figures):
    assert [row[:3] for row in rows_of(figures[2])[1:]] == [["loss", "0.31", "friction"], ["loss", "0.07", "damping"]]


def test_svg_follows_the_page(figures):
    svg = figure_svg(figures[0])
    root = ElementTree.fromstring(svg)
    assert root.get("role") == "img"
    assert root.get("aria-label") == "Error over N. Solid: segments."
    assert "currentColor" in svg
    assert "#010203" not in svg
    assert "<style" not in svg
    ids = re.findall(r'\bid="([^"]+)"', svg)
    assert len(ids) == len(set(ids))
    assert all(one.startswith("lines-") for one in ids)


def test_files_of_one_drawing_agree(figures):
    svg, table, png = figure_files(figures[0])
    assert svg == figure_svg(figures[0])
    assert table == figure_csv(figures[0])
    assert Image.open(BytesIO(png)).size == Image.open(BytesIO(figure_png(figures[0], 110.0))).size


def test_movie_has_every_frame(movie):
    moving, still = (Image.open(BytesIO(image)) for image in movie_image(movie))
    assert moving.n_frames == 5
    assert getattr(still, "n_frames", 1) == 1
    assert still.size == moving.size
