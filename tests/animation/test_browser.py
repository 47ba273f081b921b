"""A page in a browser: it plays, pauses, turns both birds, and asks nothing of the network."""

import base64
import io
import itertools
import json
import shutil

import numpy as np
import pytest
from PIL import Image

pytestmark = pytest.mark.long
BROWSERS = ("chromium", "chromium-browser", "google-chrome", "chrome")
FLAGS = (
    *("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"),
    *("--disable-background-networking", "--disable-component-update", "--disable-sync"),
    *("--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"),
    *("--window-size=900,600", "--host-resolver-rules=MAP * ~NOTFOUND"),
)
# Only a browser that hangs takes as long, s.
HANGS = 300


def found(*names):
    return next(filter(None, map(shutil.which, names)), None)


@pytest.fixture(scope="module")
def browser(tail_cycle, tmp_path_factory):
    """The page of a flight beside itself, in a browser that reaches no host."""
    webdriver = pytest.importorskip("selenium.webdriver")
    binary, driver = found(*BROWSERS), found("chromedriver")
    if binary is None or driver is None:
        pytest.skip("no Chromium with its driver (chromedriver) on this machine")
    directory = tmp_path_factory.mktemp("page")
    moving = tail_cycle.animate(tail_cycle, beats=1, frames=8)
    (page,) = moving.save(directory / "flight.html")
    options = webdriver.ChromeOptions()
    options.binary_location = binary
    for flag in (*FLAGS, f"--user-data-dir={tmp_path_factory.mktemp('profile')}"):
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    service = webdriver.ChromeService(executable_path=driver)
    opened = webdriver.Chrome(options=options, service=service)
    opened.set_page_load_timeout(HANGS)
    opened.set_script_timeout(HANGS)
    try:
        opened.get(page.as_uri())
        yield opened
    finally:
        opened.quit()


def waited(browser, script):
    """What a script hands to `done`, however long that takes."""
    return browser.execute_async_script(
        "const done = arguments[arguments.length - 1];"
        "const flight = document.getElementById('flight');" + script
    )


def shown(browser, frame):
    """Picture (H, W, 3) of a frame, as a click on the slider shows it."""
    address = waited(
        browser,
        f"Plotly.animate(flight, ['{frame}'], {{mode: 'immediate', frame: {{duration: 0, redraw: "
        "true}, transition: {duration: 0}}).then(() => Plotly.toImage(flight, {format: 'png', "
        "width: 600, height: 400})).then(done);",
    )
    content = base64.b64decode(address.partition(",")[2])
    return np.asarray(Image.open(io.BytesIO(content)).convert("RGB"), dtype=int)


def test_it_plays_by_itself_over_and_over(browser):
    seen = waited(
        browser,
        """
        const seen = [];
        flight.on("plotly_animatingframe", ({ name }) => {
          seen.push(name);
          if (seen.filter((each) => each === "8").length > 1 && name === "0") done(seen);
        });
        """,
    )
    numbers = [int(name) for name in seen]
    start = numbers.index(0)
    assert numbers[start : start + 10] == [*range(9), 0]


def test_the_buttons_pause_and_play(browser):
    pressed = """
        const buttons = document.querySelectorAll(".updatemenu-button");
        const press = (k) => buttons[k].dispatchEvent(new MouseEvent("click", {bubbles: true}));
        const frame = () => flight._fullLayout._currentFrame;
    """
    # Ten pictures of the browser's own, in which a flight that plays would go on.
    kept = waited(
        browser,
        pressed
        + """
        press(1);
        let left = 10, before = null;
        function later() {
          if (left === 10) before = frame();
          if (left-- === 0) done([before, frame()]);
          else setTimeout(() => requestAnimationFrame(later), 50);
        }
        setTimeout(later, 500);
        """,
    )
    assert kept[0] == kept[1]
    assert waited(
        browser,
        pressed + "flight.on('plotly_animatingframe', () => done(true)); press(0);",
    )


def test_frames_differ(browser):
    browser.execute_script(
        "document.querySelectorAll('.updatemenu-button')[1]"
        ".dispatchEvent(new MouseEvent('click', {bubbles: true}))"
    )
    pictures = [shown(browser, frame) for frame in (0, 3, 6)]
    for one, other in itertools.pairwise(pictures):
        changed = np.abs(one - other).max(axis=2) > 30
        assert changed.mean() > 5e-3
        # In both birds' halves.
        assert changed[:, :300].any()
        assert changed[:, 300:560].any()


def test_a_drag_turns_both_birds(browser):
    chains = pytest.importorskip("selenium.webdriver").ActionChains

    def eyes():
        return browser.execute_script(
            "const all = document.getElementById('flight')._fullLayout;"
            "return ['scene', 'scene2'].map((name) => all[name]._scene.getCamera().eye);"
        )

    before = eyes()
    assert before[0] == pytest.approx(before[1])
    canvas = browser.find_element("css selector", "#scene")
    drag = chains(browser).move_to_element(canvas).click_and_hold()
    for _ in range(5):
        drag = drag.move_by_offset(12, 4)
    drag.release().perform()
    one, other = waited(
        browser,
        f"const before = {json.dumps(before[0])};"
        """
        const all = flight._fullLayout;
        const eyes = () => ["scene", "scene2"].map((name) => all[name]._scene.getCamera().eye);
        const apart = (a, b) => Math.hypot(a.x - b.x, a.y - b.y, a.z - b.z);
        function look() {
          const now = eyes();
          if (apart(now[0], before) > 0.05 && apart(...now) < 1e-6) done(now);
          else setTimeout(look, 50);
        }
        look();
        """,
    )
    assert one == pytest.approx(other)
    assert np.hypot(one["x"] - before[0]["x"], one["y"] - before[0]["y"]) > 0.05


def test_nothing_is_fetched_and_nothing_fails(browser):
    """The last of this file: all that the tests before it did is in the logs."""
    events = [json.loads(each["message"])["message"] for each in browser.get_log("performance")]
    asked = [
        event["params"]["request"]["url"]
        for event in events
        # Not the browser's own, before the page.
        if event["method"] == "Network.requestWillBeSent"
        and event["params"]["documentURL"].startswith("file:")
    ]
    assert any(address.startswith("file:") for address in asked)
    assert [a for a in asked if not a.startswith(("file:", "data:", "blob:"))] == []
    errors = [each for each in browser.get_log("browser") if each["level"] == "SEVERE"]
    assert errors == []
    shaped = browser.execute_script("return document.querySelectorAll('canvas').length")
    assert shaped > 0
