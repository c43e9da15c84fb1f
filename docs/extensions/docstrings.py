"""What docstrings of the library look like on a page, beside what numpydoc makes of them."""

import re

ATTRIBUTES = "Attributes"

BRIEF = {"column", "of", "plot", "table", "to_csv", "to_records", "value", "verdict", "way"}
"""Methods whose docstring is a line, and which are for users all the same."""


def setup(app):
    """Come before numpydoc, and after it."""
    attributes = {}
    app.connect("autodoc-skip-member", _skip)
    app.connect("autodoc-process-signature", _without_signature)
    app.connect("autodoc-process-docstring", _escape, priority=300)
    app.connect("autodoc-process-docstring", lambda *what: _take(attributes, *what), priority=400)
    app.connect("autodoc-process-docstring", lambda *what: _give(attributes, *what), priority=600)
    return {"parallel_read_safe": True}


def _skip(app, what, name, thing, skip, options):
    """Leave out what is not for users: that has no section in its docstring."""
    is_told = "\n---" in re.sub(r"\n +", "\n", getattr(thing, "__doc__", None) or "")
    return skip or not (is_told or name in BRIEF)


def _without_signature(app, what, name, thing, options, signature, returned):
    """Leave out how answers are made: nobody makes one."""
    if what == "class" and "Parameters\n" not in (thing.__doc__ or ""):
        return "", None
    return None


def _escape(app, what, name, thing, options, lines):
    """Keep the modulus |s| of a formula, which reStructuredText takes for a substitution."""
    last = lines.index("Examples") if "Examples" in lines else len(lines)
    lines[:last] = [line.replace("|", r"\|") for line in lines[:last]]


def _take(attributes, app, what, name, thing, options, lines):
    """Take the section of attributes away from numpydoc, which shortens those that are computed."""
    if what != "class" or ATTRIBUTES not in lines:
        return
    begin = lines.index(ATTRIBUTES)
    end = begin + 2
    while end < len(lines) and lines[end]:
        end += 1
    attributes[name] = lines[begin + 2 : end]
    del lines[begin:end]


def _give(attributes, app, what, name, thing, options, lines):
    """Append it, each attribute as what can be linked to."""
    for line in attributes.pop(name, []):
        if line.startswith(" "):
            lines.append("   " + line.strip())
        else:
            names, _, kind = line.partition(" : ")
            first, *others = names.split(", ")
            lines += ["", f".. attribute:: {first}", *(f"               {one}" for one in others)]
            lines += ["", f"   *{kind}:*"]
