"""Programs that run the JavaScript of ``ehlcontact explore``: a Chromium without window, or node."""

import html
import json
import re
import shutil
import subprocess
import tempfile
from pathlib import Path

import pytest

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
FLAGS = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--hide-scrollbars",
]
SECONDS = 120


def browser():
    """Path of a browser; skips where there is none."""
    found = next((path for name in BROWSERS if (path := shutil.which(name))), None)
    if found is None:
        pytest.skip(f"no browser: none of {', '.join(BROWSERS)} is installed")
    return found


def dom(page, address="", width=1280, flags=()):
    """The document that a browser makes of a file, and what the browser says (its console too)."""
    with tempfile.TemporaryDirectory() as profile:
        command = [browser(), *FLAGS, f"--user-data-dir={profile}", f"--window-size={width},2000"]
        command += ["--enable-logging=stderr", "--v=0", "--dump-dom", *flags, f"file://{page}{address}"]
        done = subprocess.run(command, capture_output=True, text=True, timeout=SECONDS, check=True)
    return done.stdout, done.stderr


def in_browser(script, folder):
    """What the expression at the end of `script` is worth there: it is called ``answer``."""
    page = Path(folder) / "asked.html"
    tell = 'document.body.innerHTML = "<pre></pre>"; document.querySelector("pre").textContent = answer;'
    text = f'<!DOCTYPE html><meta charset="utf-8"><body><script>{script}\n{tell}</script>'
    page.write_text(text, encoding="utf-8")
    out, said = dom(page)
    found = re.search(r"<pre>(.*)</pre>", out, flags=re.S)
    assert found, said[-2000:]
    return json.loads(html.unescape(found[1]))


def in_node(script, folder):
    """The same in node; skips where there is none."""
    if shutil.which("node") is None:
        pytest.skip("no node is installed")
    file = Path(folder) / "asked.js"
    file.write_text(f"{script}\nconsole.log(answer);", encoding="utf-8")
    done = subprocess.run(["node", file], capture_output=True, text=True, timeout=SECONDS, check=False)
    assert done.returncode == 0, done.stderr[-2000:]
    return json.loads(done.stdout)


ENGINES = {"chromium": in_browser, "node": in_node}
