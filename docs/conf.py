"""The documentation's site: Sphinx, with notebooks executed as they are built, and nothing fetched from elsewhere.

    pip install ".[docs]" && sphinx-build -W docs build/docs && python docs/site/links.py build/docs

Equations become MathML by docutils' own translator: no script and no font from a network; they follow the colours.
"""

from __future__ import annotations

import importlib
import inspect
import os
import re
from pathlib import Path
from typing import Any, get_type_hints

from docutils import nodes
from docutils.utils.math import MathError
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx import addnodes
from sphinx.util import logging
from sphinx.util.typing import stringify_annotation

import ehlcontact
import ehlcontact.film
import fmu
import reduced_models
import reduced_models.signals
from ehlcontact.cli.explorer import write_explorer

LOG = logging.getLogger(__name__)
PUBLIC = {
    name: f"{package.__name__}.{name}"
    for package in (ehlcontact, ehlcontact.film, reduced_models, reduced_models.signals, fmu)
    for name, value in vars(package).items()
    if name[0] != "_" and not inspect.ismodule(value)
} | {
    name: f"{module}.{name}"  # in the reference with its module
    for page in (Path(__file__).parent / "api").glob("*.rst")
    for module, name in re.findall(r"^.. auto(?:class|function):: ([\w.]+)\.(\w+)$", page.read_text(), flags=re.M)
}

project = "ehlcontact"
version = release = ehlcontact.__version__
author = "the authors of ehlcontact"

extensions = ["myst_nb", "sphinx.ext.autodoc", "numpydoc"]
nitpicky = True
default_role = "py:obj"  # of docstrings: a link where the name is public, its letters as they are elsewhere

html_theme = "furo"
html_title = f"ehlcontact {version}"
html_static_path = ["site/wide.css"]
html_css_files = ["wide.css"]
html_copy_source = False
html_show_sphinx = html_show_copyright = False
html_math_renderer = "mathml"
highlight_language = "text"  # of blocks that say none: command lines
pygments_style, pygments_dark_style = "friendly", "github-dark"
html_theme_options = {"navigation_with_keys": True}

myst_enable_extensions = ["amsmath", "colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
os.environ.pop("MPLBACKEND", None)  # notebooks choose: with another one there are no pictures
nb_execution_mode = "force"
nb_execution_raise_on_error = True
nb_execution_timeout = 170
nb_merge_streams = True
nb_ipywidgets_js: dict[str, dict[str, str]] = {}  # those of myst-nb would come from a network

autodoc_member_order = "bysource"
autodoc_default_options = {"members": True}
autodoc_typehints_format = "short"
python_use_unqualified_type_names = True
python_maximum_signature_line_length = 80
numpydoc_show_class_members = False
numpydoc_class_members_toctree = False


def public(app: Any, env: Any, node: Any, contnode: Any) -> Any:
    """A name by the file it is defined in, as annotations have it, is that of the package that shows it.

    What is not public, or of another library, stays text: there is no network to look it up.
    """
    if node.get("refdomain") != "py":
        return None
    names = node["reftarget"].split(".")
    for i, name in enumerate(names):
        if name in PUBLIC:
            target = ".".join([PUBLIC[name], *names[i + 1 :]])
            domain = env.get_domain("py")
            return domain.resolve_xref(env, node["refdoc"], app.builder, "obj", target, node, contnode) or contnode
    return contnode


ARRAY = re.compile(r"~?numpy\.ndarray\[.*?dtype\[[\w.~]+\]\]")


def without_units(text: str) -> str:
    """Signature whose `Annotated` types are types alone: units stand in the text."""
    while start := re.search(r"~?(?:\w+\.)*Annotated\[", text):
        depth, comma, end = 0, 0, start.end()
        while depth or text[end] != "]":
            depth += (text[end] in "[(") - (text[end] in "])")
            comma = comma or (end if text[end] == "," and not depth else 0)
            end += 1
        text = text[: start.start()] + text[start.end() : comma] + text[end + 1 :]
    return text


def short(
    app: Any, what: str, name: str, obj: Any, options: Any, signature: str | None, returns: str | None
) -> Any:
    """An array is an array: its shape and what is in it stand in the text."""
    if not signature:
        return None
    return tuple(ARRAY.sub("ndarray", without_units(text)) for text in (signature, returns or ""))


def property_type(app: Any, domain: str, kind: str, content: Any) -> None:
    """A property of a result has its type alone, as arguments have: its unit stands in the text."""
    if (domain, kind) != ("py", "property"):
        return
    for signature in content.parent.findall(addnodes.desc_signature):
        for annotation in signature.findall(addnodes.desc_annotation):
            if "Quantity(" in annotation.astext():
                owner: Any = importlib.import_module(signature["module"])
                for name in signature["fullname"].split("."):
                    owner = getattr(owner, name)
                words = ARRAY.sub("ndarray", stringify_annotation(get_type_hints(owner.fget)["return"]))
                annotation[:] = [
                    addnodes.desc_sig_punctuation("", ":"),
                    addnodes.desc_sig_space(),
                    addnodes.desc_sig_name("", words),
                ]


def mathml(node: Any, *, block: bool) -> str:
    """An equation; what the translator does not know is a warning, and that is an error."""
    try:
        return str(tex2mathml(node.astext(), as_block=block))
    except MathError as error:
        LOG.warning("equation not understood: %s", error, location=node)
        return f"<code>{node.astext()}</code>"


def inline(self: Any, node: Any) -> None:
    """Within a line."""
    self.body.append(mathml(node, block=False))
    raise nodes.SkipNode


def display(self: Any, node: Any) -> None:
    """On its own: as wide as it is, in a box that scrolls."""
    anchor = f' id="{node["ids"][0]}"' if node.get("ids") else ""
    self.body.append(f'<div class="equation" tabindex="0"{anchor}>{mathml(node, block=True)}</div>')
    raise nodes.SkipNode


def explorer(app: Any, error: Exception | None) -> None:
    """The page of `ehlcontact explore`, as it is written now, beside the pages that show it."""
    if error is None and app.builder.format == "html":
        write_explorer(Path(app.outdir) / "explore.html")


def setup(app: Any) -> None:
    """Called by Sphinx."""
    app.add_html_math_renderer("mathml", (inline, None), (display, None))
    app.connect("missing-reference", public)
    app.connect("autodoc-process-signature", short)
    app.connect("object-description-transform", property_type)
    app.connect("build-finished", explorer)
