"""Formulas as MathML, which browsers draw without a script; one that is not TeX is a warning."""

from docutils import nodes
from docutils.utils.math import MathError
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.util import logging

LOGGER = logging.getLogger(__name__)


def setup(app):
    """Offer it as a way to write formulas in HTML, which conf.py takes."""
    app.add_html_math_renderer("mathml", (_inline, None), (_displayed, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def _inline(translator, node):
    translator.body.append(_written(node, as_block=False))
    raise nodes.SkipNode


def _displayed(translator, node):
    translator.body.append(f'<div class="formula">{_written(node, as_block=True)}</div>\n')
    raise nodes.SkipNode


def _written(node, as_block):
    try:
        return tex2mathml(node.astext(), as_block=as_block)
    except MathError as error:
        LOGGER.warning("no formula: %s: %s", error, node.astext(), location=node)
        return ""
