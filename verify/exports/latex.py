"""Tables in LaTeX: plain tabular, no package, everything escaped, so that any document takes them in."""

from collections.abc import Iterator
from unicodedata import normalize

from verify.studies.told import Table
from verify.words import cell

ROWS, WIDE = 40, 36
"""Rows on a page; characters of words from which on a column is broken into lines."""
LINE, LETTER, BETWEEN, BROKEN = 345.0, 5.0, 12.0, 0.35
"""Points: of an article's line, of a character, between two columns; and the share of the line of a broken column."""
_CHARACTERS = {
    "\\": r"\textbackslash{}", "{": r"\{", "}": r"\}", "$": r"\$", "&": r"\&", "#": r"\#", "_": r"\_", "%": r"\%",
    "~": r"\textasciitilde{}", "^": r"\textasciicircum{}", "<": r"\textless{}", ">": r"\textgreater{}",
    "|": r"\textbar{}", '"': "''", "–": "--", "—": "---", "−": "$-$", "±": r"$\pm$", "×": r"$\times$", "·": r"$\cdot$",
    "°": r"$^\circ$", "²": "$^2$", "³": "$^3$", "⁴": "$^4$", "₁": "$_1$", "₂": "$_2$", "≤": r"$\le$", "≥": r"$\ge$",
    "≈": r"$\approx$", "→": r"$\to$", "√": r"$\surd$", "∞": r"$\infty$", "…": r"\ldots{}", "µ": r"$\mu$",
    "α": r"$\alpha$", "β": r"$\beta$", "γ": r"$\gamma$", "δ": r"$\delta$", "ε": r"$\varepsilon$", "η": r"$\eta$",
    "θ": r"$\theta$", "κ": r"$\kappa$", "λ": r"$\lambda$", "μ": r"$\mu$", "ν": r"$\nu$", "π": r"$\pi$", "ρ": r"$\rho$",
    "σ": r"$\sigma$", "τ": r"$\tau$", "φ": r"$\varphi$", "ω": r"$\omega$", "Δ": r"$\Delta$", "Ω": r"$\Omega$",
    "‘": "`", "’": "'", "“": "``", "”": "''", "\n": " ", "\t": " ",
}  # fmt: skip


def escaped(text: str) -> str:
    """Words as LaTeX takes them, ASCII alone: what has no name there stands as its number, U+2603."""
    return "".join(_CHARACTERS.get(character) or _plain(character) for character in text)


def _plain(character: str) -> str:
    if character.isascii():
        return character if character.isprintable() else " "
    known = normalize("NFKD", character).encode("ascii", "ignore").decode()
    return escaped(known) if known else f"U+{ord(character):04X}"


def document(title: str, tables: tuple[Table, ...]) -> str:
    """All tables, each with its title and its notes."""
    parts = [f"% {escaped(title)}: tables for \\input, no package needed\n"]
    return "\n".join([*parts, *(part for table in tables for part in _told(table))])


def _told(table: Table) -> Iterator[str]:
    if not table.rows:
        return
    title = f"\\par\\medskip\\noindent\\textbf{{{escaped(table.title)}}}" if table.title else "\\par\\medskip"
    before = f"\\par\\noindent {escaped(table.before)}" if table.before else ""
    yield f"{title}{before}\\par\\nobreak\\smallskip\n"
    for first in range(0, len(table.rows), ROWS):
        yield from _tabulars(table, first)
    for note in table.below(range(len(table.columns))):
        yield f"\\par\\noindent\\footnotesize {escaped(note)}\\normalsize\n"


def _tabulars(table: Table, first: int) -> Iterator[str]:
    """At most ROWS rows under their head, so that a page holds them; as many columns in each as a line holds."""
    written = [
        [cell(value, column.form, column.factor, column.unit) for value, column in zip(row, table.columns, strict=True)]
        for row in table.rows[first : first + ROWS]
    ]
    longest = [max(len(column.head), *(len(row[i]) for row in written)) for i, column in enumerate(table.columns)]
    widths = [BETWEEN + (BROKEN * LINE if long > WIDE else LETTER * long) for long in longest]
    for shown in _on_lines(widths):
        sides = [
            f"p{{{BROKEN}\\linewidth}}" if longest[i] > WIDE else "l" if table.columns[i].left else "r" for i in shown
        ]
        lines = [f"\\noindent\\begin{{tabular}}{{{''.join(sides)}}}", "\\hline"]
        if any(column.head for column in table.columns):
            lines += [_row([table.columns[i].head for i in shown]), "\\hline"]
        rows = (_row([row[i] for i in shown]) for row in written)
        yield "\n".join([*lines, *rows, "\\hline", "\\end{tabular}\\par\\smallskip\n"])


def _on_lines(widths: list[float]) -> Iterator[list[int]]:
    """Which columns, of these widths in points, stand on one line: the first, which says of what a row is, on each."""
    shown = [0]
    for i in range(1, len(widths)):
        if len(shown) > 1 and sum(widths[j] for j in shown) + widths[i] > LINE:
            yield shown
            shown = [0]
        shown.append(i)
    yield shown


def _row(cells: list[str]) -> str:
    """One that begins with a bracket would be taken for the row before's own space: braces keep it apart."""
    return " & ".join(f"{{{_signed(one)}}}" for one in cells) + r" \\"


def _signed(one: str) -> str:
    """A negative number has a minus, not a hyphen."""
    return f"$-${escaped(one[1:])}" if one[:1] == "-" and one[1:2].isdigit() else escaped(one)
