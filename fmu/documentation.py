"""``documentation/index.html`` of an FMU: variables with units, equations, how the binary was made."""

from __future__ import annotations

from html import escape

from ehlcontact import __version__
from fmu.spec import ModelSpec, Variable

_PAGE = """<!DOCTYPE html>
<html lang="en">
<head><meta charset="utf-8"><title>{title}</title>
<style>body {{ font-family: sans-serif; max-width: 60em; margin: 2em auto; line-height: 1.4 }}
table {{ border-collapse: collapse }}
td, th {{ text-align: left; padding: 0.2em 0.8em; border-bottom: 1px solid #ccc }}
pre {{ background: #f4f4f4; padding: 1em; overflow-x: auto }}</style></head>
<body>
<h1>{title}</h1>
<p>{description}.</p>
<table>{notes}</table>
<h2>Variables</h2>
<table>
<tr><th>name</th><th>causality</th><th>unit</th><th>start</th><th>description</th></tr>
{variables}
</table>{references}
<h2>Sources</h2>
<pre>{readme}</pre>
<h2>Build</h2>
<p>Exported by ehlcontact {version} as FMI {fmi}.0 for {uses}; the binary needs
nothing but the C library. It was compiled with <code>{compiler}</code>. To build it for another platform,
compile the files in
<code>sources/</code> and link the maths library.</p>
</body>
</html>
"""
_REFERENCES = """
<h2>Reference results</h2>
<p>In <code>extra/org.fmi-standard.fmi-ls-ref/</code>, for any importer. {about}. Its steps go from each row of the
tables to the next, with the parameters that are given there{alone}.
<code>ehlcontact verify</code> compares this FMU with them.</p>"""


def documentation(spec: ModelSpec, readme: str, compiler: str, fmi: int = 2, references: str = "") -> str:
    """``index.html``, shown to an importer's user: variables with units, equations, how the binary was made.

    With reference results in the FMU, a sentence about them.
    """
    alone = "; the rows for model exchange stand by themselves" if spec.exchange else ""
    return _PAGE.format(
        title=escape(spec.name),
        description=escape(spec.description),
        notes="".join(f"<tr><th>{escape(a)}</th><td>{escape(b)}</td></tr>" for a, b in spec.notes),
        variables="\n".join(_row(variable) for variable in spec.variables),
        readme=escape(readme),
        version=escape(__version__),
        compiler=escape(compiler),
        fmi=fmi,
        uses="co-simulation and model exchange" if spec.exchange else "co-simulation",
        references=references and _REFERENCES.format(about=escape(references), alone=alone),
    )


def _row(variable: Variable) -> str:
    start = "" if variable.declared_start is None else repr(variable.declared_start)
    cells = (variable.name, variable.causality, variable.unit or "", start, variable.description)
    return "<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in cells) + "</tr>"
