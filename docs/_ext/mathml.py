r"""Formulas as MathML, which every browser draws by itself: no script, no font, no LaTeX, no network.

The converter is docutils' own (`docutils.utils.math.tex2mathml`), which Sphinx brings along. It knows the LaTeX of
these pages: fractions, roots, Greek, sub- and superscripts, matrices. A formula that it does not know ends the build.
"""

from docutils.utils.math import MathError
from docutils.utils.math.latex2mathml import tex2mathml


def converted(text, node, *, block):
    """MathML of a formula; what cannot be converted is an error that names it."""
    try:
        return tex2mathml(text, as_block=block)
    except MathError as error:
        raise ValueError(f"{node.source}, line {node.line}: no MathML of {text!r}: {error}") from error


def inline(translator, node):
    """Write a formula within a line."""
    from docutils.nodes import SkipNode

    translator.body.append(converted(node.astext(), node, block=False))
    raise SkipNode


def block(translator, node):
    """Write a formula on a line of its own."""
    from docutils.nodes import SkipNode

    translator.body.append(f'<div class="math">{converted(node.astext(), node, block=True)}</div>')
    raise SkipNode


def setup(app):
    """Give Sphinx a renderer named `mathml`."""
    app.add_html_math_renderer("mathml", (inline, None), (block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
