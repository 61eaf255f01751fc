# Sphinx's configuration of the documentation; python/docs/build.py makes the folder of sources.
#
# Sphinx with MyST, because it reads the pages as GitHub does (CommonMark, GitHub's tables and anchors), warns of links that lead to
# nothing, and its search also works for pages that are opened as files.

project = "Étendue"
copyright = "the authors of Étendue"
extensions = ["myst_parser"]
source_suffix = {".md": "markdown"}
root_doc = "docs/index"
include_patterns = ["*.md", "docs/**", "api/**", "tests/**.md", "benchmarks/**.md", "scenes/**.md"]
myst_heading_anchors = 6
smartquotes = False  # texts have quotation marks of code
# Sources have the highlighting that Pygments has, the description language none.
highlight_language = "none"
suppress_warnings = ["myst.header", "toc.not_included", "misc.highlighting_failure"]

html_theme = "furo"
html_title = "Étendue"
html_show_sourcelink = False
html_copy_source = False
html_static_path = []
