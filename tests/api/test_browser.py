"""The page in a real browser, with a real run going on."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest
from playwright.sync_api import Page, expect, sync_playwright

from tests.api.conftest import Server

FLAGS = [
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]
COLOURS = """id => {
    const c = document.getElementById(id), d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
    let blue = 0, orange = 0;
    for (let i = 0; i < d.length; i += 4) {
        if (d[i + 3] > 127 && d[i + 2] > d[i] + 60) blue++;
        if (d[i + 3] > 127 && d[i] > d[i + 2] + 60) orange++;
    }
    return [blue, orange];
}"""
NAMELESS = """() => [...document.querySelectorAll('button, input, select, a[href], canvas')].filter(e => e.offsetParent
    && !(e.getAttribute('aria-label') || e.textContent.trim() || e.labels?.length)).map(e => e.outerHTML)"""

pytestmark = [pytest.mark.browser, pytest.mark.timeout(180)]


@pytest.fixture(scope="module")
def complaints() -> list[str]:
    return []


@pytest.fixture(scope="module")
def page(server: Server, complaints: list[str]) -> Iterator[Page]:
    with sync_playwright() as machine:
        browser = machine.chromium.launch(executable_path="/usr/bin/chromium", args=FLAGS)
        page = browser.new_page(viewport={"width": 1440, "height": 1000})
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.on("console", lambda m: complaints.append(m.text) if m.type == "error" else None)
        page.goto(f"{server.url}/?token={server.token}")
        expect(page.locator("#stand-pill")).to_have_text("stand ready", timeout=30_000)
        yield page
        browser.close()


def see(page: Page, selector: str, text: str, seconds: float = 30.0) -> None:
    expect(page.locator(selector)).to_have_text(re.compile(text), timeout=1e3 * seconds)


def fill(page: Page, *, cycles: int) -> None:
    page.get_by_label("Shape").select_option("trapezoidal")
    for label, value in (("Frequency", "2"), ("Stroke", "5"), ("Ramp", "0.15"), ("Cycles", str(cycles))):
        page.get_by_role("spinbutton", name=label).fill(value)


def test_the_token_has_left_the_address(page: Page) -> None:
    assert "token" not in page.url


def test_an_order_beyond_the_limits_can_not_be_started(page: Page) -> None:
    fill(page, cycles=2)
    page.get_by_role("spinbutton", name="Stroke").fill("500")
    see(page, "#verdict", "amplitude")
    expect(page.locator("#start")).to_be_disabled()
    assert page.get_by_role("spinbutton", name="Stroke").get_attribute("aria-invalid") == "true"


def test_an_experiment_started_by_a_click_shows_R_and_ends_in_the_list(page: Page) -> None:
    fill(page, cycles=4)
    expect(page.locator("#start")).to_be_enabled()
    page.locator("#start").click()
    see(page, "#score-u output", r"^0\.9\d+")
    see(page, "#score-F output", r"^0\.\d+")
    see(page, "#now-u", r"mm$")
    expect(page.get_by_role("link", name="report").first).to_be_visible(timeout=60_000)


def test_a_canvas_holds_the_measured_and_the_simulated_curve(page: Page) -> None:
    blue, orange = page.evaluate(COLOURS, "chart-F")
    assert blue > 100
    assert orange > 100


def test_escape_stops_at_once_and_the_stop_holds_until_reset(page: Page) -> None:
    fill(page, cycles=60)
    expect(page.locator("#start")).to_be_enabled()
    page.locator("#start").click()
    see(page, "#phases [aria-current]", "motion")
    page.keyboard.press("Escape")
    see(page, "#banner", "Emergency stop: the stand is stopped", 10.0)
    see(page, "#stand-pill", "stand tripped")
    page.get_by_role("button", name="Understood").click()
    page.get_by_role("button", name="Reset after the stop").click()
    see(page, "#stand-pill", "stand ready")


def test_everything_is_reached_by_keyboard_and_has_a_name(page: Page) -> None:
    assert page.evaluate(NAMELESS) == []


def test_the_page_had_nothing_to_complain_about(page: Page, complaints: list[str]) -> None:
    assert complaints == []
