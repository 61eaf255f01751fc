#!/usr/bin/env python3
"""Checks that every relative link in the documentation leads to a file that is there and, with #, to a heading or anchor in it, and
that docs/index.md lists every page of docs and docs/results."""

import pathlib
import re
import sys
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parent.parent
FENCE = re.compile(r"^(```|~~~).*?^\1", re.MULTILINE | re.DOTALL)
CODE = re.compile(r"`[^`\n]*`")
# [text](target "title"), ![text](target), and [name]: target. A text may hold an image with brackets of its own.
LINK = re.compile(r"\]\(\s*<?([^\s()<>]*(?:\([^\s()]*\)[^\s()<>]*)*)>?(?:\s+\"[^\"]*\")?\s*\)|^\[[^\]]+\]:\s*(\S+)", re.MULTILINE)
TAG = re.compile(r"<(?:a|img)\s[^>]*?(?:href|src)=\"([^\"]*)\"")
OWN_ANCHOR = re.compile(r"<\w+\s[^>]*?(?:id|name)=\"([^\"]*)\"")


def documents():
    pages = [p for p in ROOT.glob("*.md")]
    for folder in ("docs", "tests", "benchmarks", "scenes"):
        pages += [p for p in (ROOT / folder).rglob("*.md") if "node_modules" not in p.parts]
    return sorted(pages)


def without_code(text):
    """As long as before, line by line, so that places stay the same."""
    blank = lambda match: re.sub(r"[^\n]", " ", match.group())
    return CODE.sub(blank, FENCE.sub(blank, text))


def anchors(page):
    """Of headings, as GitHub makes them, and of HTML elements."""
    text = FENCE.sub("", page.read_text(encoding="utf-8"))
    found, count = set(OWN_ANCHOR.findall(text)), {}
    for heading in re.findall(r"^#{1,6}\s+(.*?)\s*#*$", text, re.MULTILINE):
        plain = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "").replace("*", "")
        slug = re.sub(r"[^\w\- ]", "", plain.lower()).replace(" ", "-")
        found.add(f"{slug}-{count[slug]}" if slug in count else slug)
        count[slug] = count.get(slug, 0) + 1
    return found


def problems_of(page, known):
    text = without_code(page.read_text(encoding="utf-8"))
    for match in sorted([*LINK.finditer(text), *TAG.finditer(text)], key=lambda m: m.start()):
        link = next(g for g in match.groups() if g is not None)
        if re.match(r"[a-z][a-z0-9+.-]*:", link):
            continue  # elsewhere: a test needs no network
        path, _, anchor = link.partition("#")
        target = (page.parent / urllib.parse.unquote(path)).resolve() if path else page
        at = f"{page.relative_to(ROOT)}:{text.count(chr(10), 0, match.start()) + 1}"
        if not target.is_relative_to(ROOT):
            yield f"{at}: {link} leads out of the repository"
        elif not target.exists():
            yield f"{at}: {link} leads to nothing"
        elif anchor and target.suffix == ".md":
            if target not in known:
                known[target] = anchors(target)
            if urllib.parse.unquote(anchor) not in known[target]:
                yield f"{at}: {link}: there is no such heading"


def main():
    known, problems = {}, []
    pages = documents()
    for page in pages:
        problems += problems_of(page, known)
    index = ROOT / "docs/index.md"
    listed = {
        (index.parent / (link or other).partition("#")[0]).resolve() for link, other in LINK.findall(index.read_text(encoding="utf-8"))
    }
    for page in [*(ROOT / "docs").glob("*.md"), *(ROOT / "docs/results").glob("*.md")]:
        if page != index and page not in listed:
            problems.append(f"docs/index.md does not list {page.relative_to(ROOT)}")
    if not pages or not listed:
        problems.append("no pages were found")
    print("\n".join(problems))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
