"""Tables in LaTeX: plain tabular, no package, everything escaped, so that any document takes them in."""

from collections.abc import Iterator
from unicodedata import normalize

from verify.studies.told import Table
from verify.words import cell

ROWS, WIDE = 40, 36
"""Rows on a page; characters of words from which on a column is broken into lines."""
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
        yield _tabular(table, first)
    for note in table.below(range(len(table.columns))):
        yield f"\\par\\noindent\\footnotesize {escaped(note)}\\normalsize\n"


def _tabular(table: Table, first: int) -> str:
    """At most ROWS rows under their head, so that a page holds them."""
    written = [
        [cell(value, column.form, column.factor, column.unit) for value, column in zip(row, table.columns, strict=True)]
        for row in table.rows[first : first + ROWS]
    ]
    sides = []
    for i, column in enumerate(table.columns):
        longest = max(len(row[i]) for row in written)
        sides.append("p{0.35\\linewidth}" if longest > WIDE else "l" if column.left else "r")
    lines = [f"\\noindent\\begin{{tabular}}{{{''.join(sides)}}}", "\\hline"]
    if any(column.head for column in table.columns):
        lines += [_row([column.head for column in table.columns]), "\\hline"]
    return "\n".join([*lines, *map(_row, written), "\\hline", "\\end{tabular}\\par\n"])


def _row(cells: list[str]) -> str:
    """One that begins with a bracket would be taken for the row before's own space: braces keep it apart."""
    return " & ".join(f"{{{_signed(one)}}}" for one in cells) + r" \\"


def _signed(one: str) -> str:
    """A negative number has a minus, not a hyphen."""
    return f"$-${escaped(one[1:])}" if one[:1] == "-" and one[1:2].isdigit() else escaped(one)
