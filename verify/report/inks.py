"""Colours of lines on the page: where one would not stand out on light and on dark pages, each has its own."""

from verify.studies.charting import ON_DARK, ON_LIGHT

DARK = ON_DARK | {colour: colour for colour in ON_LIGHT}
"""What a dark page shows for a chart's colour."""


def ink(colour: str) -> str:
    """A colour of a chart as the page has it: a variable that falls back on what a light page shows."""
    return f"var(--{colour[1:]}, {ON_LIGHT.get(colour, colour)})" if colour in DARK else colour


def inked(text: str) -> str:
    """A picture whose colours follow the page."""
    for colour in DARK:
        text = text.replace(colour, ink(colour))
    return text


def dark_inks() -> str:
    """The variables, for the style of a page."""
    said = " ".join(f"--{colour[1:]}:{dark};" for colour, dark in DARK.items())
    return f"@media screen and (prefers-color-scheme: dark) {{ :root {{ {said} }} }}\n"
