"""Pages of the handbook: what they hold, as text and in a real browser; where they may be put."""

import re
import shutil
from base64 import b64decode
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from derive import Geometry, derive_sheet, parameter, x
from derive.command.folder import replace_folder, with_manifest
from derive.handbook.curves import CONTACTS, pictures
from derive.handbook.page import card, index_of, page
from derive.pipeline import GENERATED
from derive.sheet.built import BuiltBody
from derive.sheet.formulas import FormulaSheet
from derive.sheet.mathml import mathml
from tests.codegen.made import body_of
from tests.commands import done
from tests.derive.bodies import assumed, of_library

pytestmark = pytest.mark.slow

NAMES = ("hertz", "flat_rounded", "hyperbola")
"""Closed both ways; with kinks; integrated."""

OUTSIDE = re.compile(
    r"""(?:src|href)=["'](?!#|data:|[\w-]+\.html)|url\(|@import|<script |<iframe"""
)


@cache
def made(name: str) -> tuple[FormulaSheet, BuiltBody]:
    sheet = assumed(of_library(name))
    return sheet, body_of(sheet, (GENERATED / f"{name}.py").read_text())


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A handbook of three bodies on disk."""
    folder = tmp_path_factory.mktemp("books") / "handbook"
    bodies = [made(name) for name in NAMES]
    texts = {f"{sheet.geometry.name}.html": page(sheet, b, index=True) for sheet, b in bodies}
    texts["index.html"] = index_of([card(sheet, b) for sheet, b in bodies])
    replace_folder(with_manifest(texts), folder)
    return folder


def ids(text: str) -> list[str]:
    return re.findall(r'id="([^"]*)"', text)


def drawn(text: str) -> list[str]:
    """The pictures of a page, as SVG."""
    return [b64decode(each).decode() for each in re.findall(r'svg\+xml;base64,([^"]+)"', text)]


@pytest.mark.parametrize("name", NAMES)
def test_nothing_of_the_sheet_is_missing(pages: Path, name: str) -> None:
    text, (sheet, body) = (pages / f"{name}.html").read_text(), made(name)
    assert set(sheet) <= set(ids(text))
    shown = len(sheet) + len(sheet.definitions) + 1
    assert text.count('display="block"') - text.count('[display="block"]') == shown
    assert text.count("assumed by a test") == len(sheet)
    for function in re.findall(r"^def (\w+)", body.text, re.M):
        assert f'<span class="nf">{function}</span>' in text
    _, pressure = drawn(text)
    assert all(f">{label}</text>" in pressure for _, _, label, _ in CONTACTS)


def test_words_of_a_user_are_escaped() -> None:
    R = parameter("R", 'radius <b>bold</b> & "quoted"', unit="m")
    sheet = assumed(derive_sheet(Geometry("nasty", g=x**2 / R)))
    text = (GENERATED / "hertz.py").read_text()  # what is drawn does not matter here
    book = page(sheet, body_of(sheet, text))
    assert "<b>bold" not in book
    assert "radius &lt;b&gt;bold&lt;/b&gt; &amp;" in book


@pytest.mark.parametrize(("name", "corners"), [("wedge_parabola", 1), ("flat_sloped", 2)])
def test_a_pressure_rises_out_of_the_picture_at_a_corner(name: str, corners: int) -> None:
    """Each of the three curves is cut into one part more than it has corners."""
    found = pictures(*made(name))
    (picture,) = drawn(found["pressure"])
    curves = [
        path for path in re.findall(r'<path d="([^"]+)" clip-path', picture) if "z" not in path
    ]
    parts = sorted(len(path.split("M ")) - 1 for path in curves)
    assert found["has_corner"] and parts[-3:] == [1 + corners] * 3


@pytest.mark.parametrize("latex", ["a & b", r"\unknown{x}", "a $ b"])
def test_latex_that_would_show_is_refused(latex: str) -> None:
    with pytest.raises(ValueError, match="not typeset"):
        mathml(latex)


def test_the_command_writes_a_page(tmp_path: Path, unproven: None) -> None:
    path = tmp_path / "page.html"
    assert done("show", "hertz", "--html", "--out", str(path)).strip() == f"Wrote {path}"
    text, (sheet, _) = path.read_text(), made("hertz")
    assert text.count('class="verdict') >= len(sheet)
    assert set(sheet) <= set(ids(text))


# ---------------------------------------------------------------------- in a browser

CHROMIUM, DRIVER = shutil.which("chromium"), shutil.which("chromedriver")
OPTIONS = (
    *("--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"),
    *("--disable-background-networking", "--disable-component-update", "--disable-sync"),
)


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    if not (CHROMIUM and DRIVER):
        pytest.skip("no browser: install Debian's chromium and chromium-driver")
    from selenium.webdriver import Chrome, ChromeOptions
    from selenium.webdriver.chrome.service import Service

    options = ChromeOptions()
    options.binary_location = CHROMIUM
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    for option in (*OPTIONS, f"--user-data-dir={tmp_path_factory.mktemp('profile')}"):
        options.add_argument(option)
    driver = Chrome(options=options, service=Service(DRIVER))
    yield driver
    driver.quit()


@pytest.mark.enough("flat_rounded-400", "index-400")
@pytest.mark.parametrize("width", [400, 1200])
@pytest.mark.parametrize("name", [*NAMES, "index"])
def test_a_browser_draws_it(browser: Any, pages: Path, name: str, width: int) -> None:
    """A page is no wider than the window, draws every formula, and fetches nothing."""
    size = {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False}
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
    browser.get_log("performance")
    browser.get((pages / f"{name}.html").as_uri())
    wide, boxes, text = browser.execute_script(
        """return [document.documentElement.scrollWidth,
        [...document.querySelectorAll("math")].map(m => m.getBoundingClientRect()).map(
            box => [box.width, box.height]),
        [...document.querySelectorAll("math")].map(m => m.textContent).join(" ")]"""
    )
    assert wide <= width
    assert boxes and all(w > 3 and h > 3 for w, h in boxes)
    assert "\\" not in text
    assert not browser.get_log("browser")
    asked = [log["message"] for log in browser.get_log("performance")]
    urls = re.findall(r'"requestWillBeSent.*?"url":"(.*?)"', " ".join(asked))
    assert all(url.startswith(("file:", "data:")) for url in urls)


@pytest.mark.parametrize("name", [*NAMES, "index"])
def test_a_page_needs_nothing_from_outside_and_its_links_lead_somewhere(
    pages: Path, name: str
) -> None:
    text = (pages / f"{name}.html").read_text()
    assert not OUTSIDE.search(text)
    for file, place in re.findall(r'href="([^"#]*)#?([^"]*)"', text):
        assert (pages / file).is_file() if file else f'id="{place}"' in text
