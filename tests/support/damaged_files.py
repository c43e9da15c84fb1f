"""Files with damage: bytes, numbers, lines and pieces of what was right, changed at random."""

import random
import re

NUMBER = re.compile(rb"[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
WORDS = (
    *(b"nan", b"-1", b"0", b"1e999", b"-1e999", b"1e-320", b"3.5", b"99999999999999999999"),
    *(
        b"[]",
        b"{}",
        b'""',
        b'"',
        b"null",
        b"true",
        b"-1\n    -1\n",
        b"\xef\xbb\xbf",
        b"\xff",
        b"\0",
    ),
)
"""What damage likes to write."""


def _flip(draw, content):
    at = draw.randrange(len(content))
    content[at] ^= 1 << draw.randrange(8)


def _byte(draw, content):
    content[draw.randrange(len(content))] = draw.choice(b'\0\xff09-.,"[]={}\n\r eE')


def _cut(draw, content):
    at = draw.randrange(len(content))
    del content[at : at + 1 + int(len(content) ** draw.random() / 2)]


def _repeat(draw, content):
    at, to = draw.randrange(len(content)), draw.randrange(len(content))
    content[to:to] = content[at : at + 1 + int(len(content) ** draw.random() / 2)]


def _end(draw, content):
    del content[draw.randrange(len(content)) :]


def _number(draw, content):
    found = list(NUMBER.finditer(content))
    if found:
        one = draw.choice(found)
        content[one.start() : one.end()] = draw.choice(WORDS)


def _word(draw, content):
    at = draw.randrange(len(content))
    content[at:at] = draw.choice(WORDS)


def _line(draw, content):
    lines = content.split(b"\n")
    one, other = draw.randrange(len(lines)), draw.randrange(len(lines))
    lines[one], lines[other] = lines[other], lines[one]
    content[:] = b"\n".join(lines)


KINDS = (_flip, _flip, _byte, _cut, _repeat, _end, _number, _number, _word, _line)


def mutants(whole, count, seed):
    """Yield so many damaged ones of several contents, one after the other."""
    draw = random.Random(seed)
    for k in range(count):
        content = bytearray(whole[k % len(whole)])
        for _ in range(draw.choice((1, 1, 1, 2, 5))):
            if content:
                draw.choice(KINDS)(draw, content)
        yield bytes(content)
