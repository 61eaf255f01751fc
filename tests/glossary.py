#!/usr/bin/env python3
"""Every term of docs/glossary.md is in the code where the page says, and no symbol stands for two things.

A row's last cell names an identifier and the header that declares it: `name` in `etendue/header.h`. Exit status 1 with a line for
each row that is wrong.
"""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
SYMBOL = re.compile(r"[A-Za-z]+(_[A-Za-z0-9]+)?(\(d\))?")


def rows(text):
    """The cells of all rows of all tables, with the heading of the second column."""
    heading = None
    for line in text.splitlines():
        cells = [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
        if not cells:
            heading = None
        elif heading is None:
            heading = cells
        elif not set(cells[0]) <= {"-"}:
            yield heading, cells


def wrong(text):
    symbols, terms = {}, set()
    for heading, cells in rows(text):
        term, place = cells[0], cells[-1]
        if term in terms:
            yield f"'{term}' stands there twice"
        terms.add(term)
        found = re.fullmatch(r"`(\w+)` in `([\w/.]+)`", place)
        if not found:
            yield f"'{term}': '{place}' names no identifier and header"
            continue
        header = ROOT / "include" / found[2]
        if not header.exists():
            yield f"'{term}': there is no {found[2]}"
        elif not re.search(rf"\b{found[1]}\b", header.read_text()):
            yield f"'{term}': {found[2]} has no {found[1]}"
        if heading[1] != "symbol":
            continue
        for symbol in re.split(r", | … ?,?", cells[1]):
            if SYMBOL.fullmatch(symbol) and symbols.setdefault(symbol, term) != term:
                yield f"'{symbol}' stands for '{symbols[symbol]}' and for '{term}'"
    if len(terms) < 20:
        yield "the tables were not found"


if __name__ == "__main__":
    found = list(wrong((ROOT / "docs/glossary.md").read_text()))
    print("\n".join(found) or "all terms are where the glossary says")
    sys.exit(1 if found else 0)
