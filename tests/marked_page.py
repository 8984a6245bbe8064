"""Tables that programs write into pages that people write."""

import pathlib
import sys


def put_between(page, begin, end, lines):
    """Replaces what stands between two marks, each a line of the page; all else stays."""
    page = pathlib.Path(page)
    text = page.read_text()
    if begin not in text or end not in text:
        sys.exit(f"{page}: has no lines {begin} and {end}")
    page.write_text(text[:text.index(begin)] + "\n".join([begin, "", *lines, "", end]) + text[text.index(end) + len(end):])


def table(head, rows):
    return ["| " + " | ".join(row) + " |" for row in (head, ["---"] * len(head), *rows)]
