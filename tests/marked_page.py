"""Tables that programs write into pages that people write."""

import pathlib
import sys


def replace_between(path, begin, end, text):
    """Of a file; the marks and all else stay."""
    path = pathlib.Path(path)
    content = path.read_text()
    if begin not in content or end not in content:
        sys.exit(f"{path}: has no lines {begin} and {end}")
    path.write_text(content[:content.index(begin) + len(begin)] + text + content[content.index(end):])


def put_between(page, begin, end, lines):
    """Of a page of Markdown, which wants empty lines about a table."""
    replace_between(page, begin, end, "\n".join(["", "", *lines, "", ""]))


def table(head, rows):
    return ["| " + " | ".join(row) + " |" for row in (head, ["---"] * len(head), *rows)]
