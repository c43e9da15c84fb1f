"""The directive that shows what the command line says about itself."""

import contextlib
import io
import os
import re
from unittest import mock

from docutils import nodes
from docutils.parsers.rst import Directive

from ropedyn import cli

ENVIRONMENT = {"COLUMNS": "88", "NO_COLOR": "1"}


class CommandHelp(Directive):
    """The help of every command, each under a heading of its own."""

    def run(self):
        """Return the sections."""
        whole = _help()
        commands = re.findall(r"^    (\w+)(?:  |$)", whole, re.MULTILINE)
        return [_block(whole), *(_section(name) for name in commands)]


def setup(app):
    """Offer it to the pages."""
    app.add_directive("command-help", CommandHelp)
    return {"parallel_read_safe": True}


def _help(*command):
    said = io.StringIO()
    with (
        mock.patch.dict(os.environ, ENVIRONMENT),
        contextlib.redirect_stdout(said),
        contextlib.suppress(SystemExit),
    ):
        cli.main([*command, "--help"])
    return said.getvalue()


def _block(text):
    return nodes.literal_block(text, text, language="text")


def _section(name):
    section = nodes.section(ids=[f"ropedyn-{name}"], names=[f"ropedyn-{name}"])
    section += [nodes.title(text=f"ropedyn {name}"), _block(_help(name))]
    return section
