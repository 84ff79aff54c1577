# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""MkDocs' hook: formulas become MathML, and a link to a file outside the documentation is shown as that file's path."""

import posixpath
import re

from latex2mathml.converter import convert

CODE = re.compile(r"(```.*?```|`[^`\n]*`)", re.DOTALL)
FORMULA = re.compile(r"\$\$(.+?)\$\$|\$([^$\n]+)\$", re.DOTALL)
LINK = re.compile(r"(!?)\[([^\]]*)\]\((?![a-z]+:|#)([^)#\s]+)(#[^)\s]*)?\)")


def on_page_markdown(markdown, page, config, files):
    """The page's text before it is rendered; code is left as it is."""
    folder = posixpath.dirname(page.file.src_uri)

    def shown(link: re.Match) -> str:
        picture, words, target, _ = link.groups()
        path = posixpath.normpath(posixpath.join("docs", folder, target))
        if picture or path.startswith("docs/"):
            return link[0]
        return words if words.strip("`") == path else f"{words} (`{path}`)"

    def formula(found: re.Match) -> str:
        own_line, inline = found.groups()
        return convert(own_line or inline, display="block" if own_line else "inline")

    parts = CODE.split(LINK.sub(shown, markdown))
    return "".join(part if number % 2 else FORMULA.sub(formula, part) for number, part in enumerate(parts))
