"""The page to explore a sweep: what it holds, and what a browser does with it."""

import base64
import gzip
import json
import re
import shutil

import numpy as np
import pytest
from runs import of_paper, swept
from scipy.spatial import cKDTree

from fem.fatigue import von_mises
from fem.fields import fields
from simulate.signals import leading_gap
from simulate.sweeps.crossings import critical
from simulate.sweeps.dataset import scene_of
from workflow.explore import page as pack
from workflow.explore.blade import moving
from workflow.explore.page import html
from workflow.explore.results import ANGLES, around, arrays, facts, log10, plain
from workflow.figures.response import Response
from workflow.shapes import motion

SPEEDS = [0.2, 0.3, 0.34, 0.36, 0.38]  # over f1(0)
PEAK = {  # four have none
    **{"k": 6, "index": 3, "amplitude": 0.5, "at_end": False},
    **{"name": "EO 6 mode 1", "says": "1.1 times the linear crossing"},
}
ORDERS = [*range(1, 17)]
SOUGHT = {"lines": {}, "modes": 4, "orders": ORDERS, "excited": {}}


@pytest.fixture(scope="module")
def response(coarse_rom):
    """A few speeds of the paper's E = 10, with all that the page can show."""
    more = {"states_rounds": 1, "history": {"chord": [0.0625]}}
    return Response(of_paper(coarse_rom, SPEEDS, 8, predictable=True, **more), coarse_rom)


@pytest.fixture(scope="module")
def moved(coarse_blade, coarse_mesh, coarse_basis, response):
    return moving(coarse_blade, coarse_mesh.mesh, coarse_basis, response.sweep, response.rom)


def facts_of(response):
    return facts(response, "coarse", "mine", critical(response.rom, SOUGHT))


def written(folder, response, motion=None, of_blade=None, **more):
    """The page of a response, with what the blade does."""
    path = folder / "explore.html"
    told = facts_of(response) | {"motion": motion} | more
    path.write_text(html(told, arrays(response) | (of_blade or {})))
    return path


@pytest.fixture(scope="module")
def page(response, moved, tmp_path_factory):
    more = {"peaks": [PEAK], "operating": {"design": 4500.0}}
    return written(tmp_path_factory.mktemp("explore"), response, *moved, **more)


def unpacked(data, name):
    codes = np.frombuffer(gzip.decompress(base64.b64decode(data["codes"])), "<u2")
    of = data["layout"][name]
    code = codes[of["at"] :][: np.prod(of["shape"], dtype=int)].reshape(of["shape"]).astype(float)
    return np.where(code == pack.MISSING, np.nan, of["low"] + of["step"] * code)


def test_arrays_are_read_back_to_half_a_step():
    rng = np.random.default_rng(1)
    arrays = {
        "a": rng.normal(size=(3, 5)),
        "b": np.array([2.0, np.nan, -1.0]),
        "c": np.full(4, 7.0),
    }
    data = pack.packed(arrays)
    for name, values in arrays.items():
        half = data["layout"][name]["step"] / 2
        np.testing.assert_allclose(unpacked(data, name), values, rtol=0, atol=half * (1 + 1e-9))
    assert data["layout"]["a"]["step"] == pytest.approx(np.ptp(arrays["a"]) / 65534)
    assert unpacked(data, "c").tolist() == [7.0] * 4
    assert pack.packed(arrays) == data  # the same bytes


def test_profiles_and_amplitudes_are_those_of_the_sweep():
    depth = np.arange(2039.0)[None]
    assert around(depth, 720)[0, [0, 180, 719]] == pytest.approx([0, 510, 2036], abs=1)
    assert log10(np.array([1e-3, 0.0, np.nan]))[:2].tolist() == [-3.0, -6.0]


def test_shapes_hold_the_motion_they_are_made_of():
    """Two patterns in four DoFs: two shapes miss nothing, and give every displacement back."""
    rng = np.random.default_rng(2)
    root, patterns = rng.normal(size=(4, 4)), rng.normal(size=(2, 4))
    states = rng.normal(size=(3, 6, 2)) @ patterns * np.array([1.0, 1e-3, 10.0])[:, None, None]
    states[1, 2:4] = np.nan  # recorded at other speeds only
    G = root @ root.T
    found = motion(states, G, shapes=2)
    assert found.missed.max() < 1e-12
    np.testing.assert_allclose(found.shapes.T @ G @ found.shapes, np.eye(2), atol=1e-12)
    np.testing.assert_allclose(states @ found.onto @ found.shapes.T, states, atol=1e-11)


def test_what_shapes_miss_is_told_by_speed():
    """One shape for two speeds that move in different patterns, one of them twice as often."""
    one, other = [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]
    states = [[one, one], [one, one], [other, other]]
    found = motion(np.array(states), np.eye(3), shapes=1)
    assert found.missed == pytest.approx([0.0, 0.0, 1.0], abs=1e-12)
    assert motion([np.empty((0, 3))], np.eye(3), shapes=1).missed.tolist() == [0.0]


def test_the_page_asks_for_nothing_and_hides_no_markup():
    facts = {"blade": "mine", "scene": "a<b", "label": "</script>"}
    page = html(facts, {"inward": np.zeros(3)})
    assert "<title>Rub of mine, a&lt;b</title>" in page
    (data,) = re.findall(
        r'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL
    )
    assert json.loads(data)["facts"] == facts
    outside = page.replace(data, "")
    assert not re.search(r"(src|href)\s*=|https?://|url\(|import\s", outside)
    assert len(page) < 3e6


def test_arrays_have_the_values_of_the_sweep(response):
    found = arrays(response)
    assert found["worn"].shape == (len(SPEEDS), ANGLES)
    assert found["worn"].max() == pytest.approx(response.wear.max(), rel=0.05)
    assert found["history"].shape == (len(SPEEDS), 16 * 8, 2)
    low, high = np.moveaxis(found["history"], -1, 0)
    extremes = [response.u_r.min(), response.u_r.max()]
    assert [low.min(), high.max()] == pytest.approx(extremes, rel=1e-6)
    known = ~np.isnan(found["signal"])
    samples = np.rint(response.sweep["motion_time"].values * 256).astype(int) - 1
    np.testing.assert_allclose(
        found["signal"][known], response.u_r[:, samples][known], atol=1e-6 * max(extremes)
    )
    assert known.any(axis=1).all()
    k4 = response.spectrum[:, 15:18].max(axis=1)  # four rounds: k = 4 is bin 16
    np.testing.assert_allclose(10 ** found["along"][:, ORDERS.index(4)], k4, rtol=1e-6)


def test_facts_are_those_of_the_sweep(response):
    told = facts_of(response)
    plastic = response.sweep["ledger"].sel(energy="plastic")
    assert told["tables"][0]["of"]["plastic"] == plastic.values.tolist()
    assert (told["status"], told["travels"]) == (["ok"] * len(SPEEDS), False)
    assert all(peak["k"] in told["orders"] for peak in told["peaks"])
    assert told["norms"] is True  # its speeds are over f1(0)
    speeds, frequencies = (np.array(told["campbell"][name]) for name in ("speeds", "frequencies"))
    for mode, k, speed in told["crossings"]:  # on the lines of the diagram
        assert np.interp(speed, speeds, frequencies[mode - 1]) == pytest.approx(k * speed, rel=1e-4)
    assert {mode for mode, *_ in told["crossings"]} == {1, 2, 3}
    travelling = [{"order": 1, "amplitude_gaps": 1.0, "speed_rad_s": 30.0}]
    scene = response.scene.but(casing__harmonics=travelling).model_dump_json()
    moving = Response(response.sweep.assign_attrs(scene=scene), response.rom)
    assert facts_of(moving)["travels"] is True
    assert not any("casing" in table["says"] for table in told["tables"])


def test_the_page_tells_the_motion_of_the_casing(response):
    bins = response.sweep.sizes["engine_order"]
    spectrum = np.zeros((len(SPEEDS), 2, bins))
    spectrum[:, 0, 0], spectrum[:, 0, 16], spectrum[:, 1, 3] = 9e-6, 3e-6, 1e-6  # its mean is none
    moves = response.sweep.assign(
        casing_motion=("speed_over_f1", np.full(len(SPEEDS), 4e-6)),
        casing_spectrum=(("speed_over_f1", "casing_mode", "engine_order"), spectrum),
    ).assign_coords(
        casing_order=("casing_mode", [2, 0]), casing_frequency=("casing_mode", [400.0, 1200.5])
    )
    told = facts_of(Response(moves, response.rom))["tables"][1]
    assert told["says"] == "radial motion of the casing, µm"
    assert [*told["of"]] == ["largest", "1: order 2, 400 Hz", "2: order 0, 1200.5 Hz"]
    assert [values[0] for values in told["of"].values()] == pytest.approx([4, 3, 1])


def test_numbers_that_are_not_known_are_told_as_such():
    assert plain([1.5, np.nan, np.inf]) == [1.5, None, "ended differently"]


def test_motion_and_stress_are_those_of_the_whole_blade(
    coarse_blade, coarse_mesh, coarse_basis, response, moved
):
    """Against the fields of one recorded state: displacement to 1 %, von Mises stress to 2 %."""
    told, of = moved
    assert max(told["missed"]) < 0.03
    speed = 3
    run = response.sweep.isel(speed_over_f1=speed)
    time = int(np.flatnonzero(~np.isnan(run["motion"][:, 0]))[-5])
    state = run["states"].sel(time=run["motion_time"][time]).values
    static, u = coarse_basis.static(float(run["speed"])), coarse_basis.reconstruct(state)
    exact = fields(coarse_blade, coarse_mesh.mesh, coarse_basis.coordinates, static, u)
    near = cKDTree(exact.points).query(of["points"])[1]
    a = of["a"][speed, time]
    shown = np.tensordot(a, of["shapes"], 1)
    np.testing.assert_allclose(shown, exact.vibration[near], atol=0.01 * abs(exact.vibration).max())
    part = (SPEEDS[speed] / told["Omega_m_over_f1"]) ** 2
    sigma = sum(part**p * c for p, c in enumerate(of["static"]))
    stress = von_mises(sigma + np.tensordot(a, of["of_shapes"], 1))
    largest = 1e-6 * exact.total.von_mises.max()
    np.testing.assert_allclose(stress, 1e-6 * exact.total.von_mises[near], atol=0.02 * largest)
    assert abs(stress - 1e-6 * exact.prestress.von_mises[near]).max() > 0.02 * largest


@pytest.fixture
def browser():
    """Debian's Chromium, or another one on PATH."""
    driver = pytest.importorskip("playwright.sync_api")
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if not chromium:
        pytest.skip("no Chromium on PATH: the page was not opened in a browser")
    given = {"executable_path": chromium, "args": FLAGS}
    with driver.sync_playwright() as playwright, playwright.chromium.launch(**given) as launched:
        yield launched


FLAGS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
PLOTS = {
    "campbell": len(ORDERS) + 4 + 1,
    "orders": len(ORDERS),
    "map": 6,
    "spectrum": 1,
    "profile": 1,
    "polar": 3,
    "history": 2,
    "signal": 1,
}
WIDE, NARROW = {"width": 1200, "height": 900}, {"width": 400, "height": 800}


class Opened:
    """A page in the browser, with all that it said and asked for."""

    def __init__(self, browser, path, size=WIDE):
        self.page = browser.new_page(viewport=size)
        self.said, self.asked = [], []
        self.page.on("console", lambda message: self.said.append(message.text))
        self.page.on("pageerror", lambda error: self.said.append(str(error)))
        self.page.on("request", lambda request: self.asked.append(request.url))
        self.page.goto(path.as_uri())
        try:
            self.page.wait_for_selector("body[data-ready=yes]", state="attached")
        except Exception as late:
            raise AssertionError(f"the page does not start: {self.said}") from late

    def quiet(self):
        outside = [url for url in self.asked if not url.startswith(("file:", "blob:"))]
        return self.said == [] and outside == []

    def data(self, name, what):
        return self.page.evaluate(f"document.getElementById('{name}').{what}")

    def is_at(self, speed):
        self.page.wait_for_function(f"document.body.dataset.shown == {speed}")
        return f"{SPEEDS[speed]:.4f}" in self.page.text_content("#at")

    def click(self, name, across):
        area = self.page.query_selector(f"#{name} .nsewdrag")
        area.scroll_into_view_if_needed()
        box = area.bounding_box()
        self.page.mouse.click(box["x"] + across * box["width"], box["y"] + box["height"] / 2)

    def frames(self):
        return int(self.page.get_attribute("#blade", "data-frames"))

    def picture(self):
        return self.page.query_selector("#blade").screenshot()


@pytest.fixture
def opened(page, browser):
    """The page in the browser; until the end of a test no message, no request."""
    opened = Opened(browser, page)
    yield opened
    assert opened.quiet()


def test_a_browser_draws_everything_and_answers(opened):
    """Every plot drawn; clicks, slider and keys choose the speed."""
    for name, traces in PLOTS.items():
        assert opened.data(name, "data.length") == traces, name
        assert opened.page.query_selector(f"#{name} .main-svg"), name
    opened.click("map", 0.02)
    assert opened.is_at(0)
    opened.page.keyboard.press("ArrowRight")
    assert opened.is_at(1)
    worn = opened.data("profile", "data[0].y.join()")
    opened.page.fill("#speed", "4")
    assert opened.is_at(4) and opened.data("profile", "data[0].y.join()") != worn
    opened.page.evaluate("document.activeElement.blur()")
    opened.click("orders", 0.5)  # 0.29 is in the middle
    assert opened.is_at(1)
    opened.page.keyboard.press("Shift+ArrowRight")
    assert opened.is_at(PEAK["index"])
    opened.page.keyboard.press("Control+ArrowLeft")  # the browser's own
    assert opened.is_at(PEAK["index"])
    assert opened.data("orders", f"data[{ORDERS.index(13)}].visible") is False
    opened.page.get_by_label("13", exact=True).press("Space")
    assert opened.data("orders", f"data[{ORDERS.index(13)}].visible") is True


@pytest.fixture(scope="module")
def staged(coarse_rom):
    """Three blades at two speeds, the second one long."""
    stage = {"count": 3, "longer_um": [0, 4, 0], "frequencies": [0, 0, 0.01]}
    case = scene_of(of_paper(coarse_rom, SPEEDS[:1], 4)).but(
        stage=stage, speeds={"over_f1": [0.34, 0.36]}
    )
    return Response(swept(case, coarse_rom), coarse_rom)


def test_a_blade_of_a_stage_is_chosen(staged, browser, tmp_path):
    """In the list or by its bar; its amplitudes are those of the sweep, the worst one is named."""
    opened = Opened(browser, written(tmp_path, staged))
    sweep, k, gap = staged.sweep, 4, leading_gap(staged.sweep)
    trace = f"data[{staged.orders.index(k)}].y[0]"

    def is_of(blade):
        """Whether the curve of an order is that of the blade."""
        along = sweep["blade_along"].sel(order=k, blade=blade)[0].item() / gap
        return opened.data("orders", trace) == pytest.approx(along, rel=1e-3)

    worst = int(sweep["worst"][0])
    said = opened.page.text_content("#blade_says")
    assert said.startswith(f"blade {worst}, the worst at this speed: length ") and is_of(worst)
    assert opened.data("by_blade", "data[0].y.length") == 3
    other = (worst + 1) % 3
    opened.page.select_option("#of_blade", str(other))
    assert is_of(other)
    said = opened.page.text_content("#blade_says")
    changes = f"length +{[0, 4, 0][other]:.2f} µm, frequencies +{[0, 0, 1][other]:.2f} %"
    assert said.startswith(f"blade {other}: {changes}; rubs, largest displacement ")
    opened.click("by_blade", (worst + 0.5) / 3)
    opened.page.wait_for_function(f"document.getElementById('of_blade').value == '{worst}'")
    assert is_of(worst) and opened.quiet()


def test_the_blade_moves_turns_and_stops(opened):
    opened.page.select_option("#colour", "stress")
    assert "MPa" in opened.page.text_content("#range")
    before = opened.frames()
    opened.page.wait_for_function(f"document.getElementById('blade').dataset.frames > {before + 3}")
    opened.page.focus("#blade")
    opened.page.keyboard.press("Space")
    stopped = opened.frames()
    opened.page.wait_for_timeout(300)
    assert opened.frames() == stopped and opened.page.text_content("#play") == "play"
    still, speed = opened.picture(), opened.page.text_content("#at")
    opened.page.keyboard.press("ArrowLeft")  # turned, at the same speed
    assert opened.frames() == stopped + 1 and opened.page.text_content("#at") == speed
    turned = opened.picture()
    assert turned != still
    box = opened.page.query_selector("#blade").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    opened.page.mouse.move(x, y)
    opened.page.mouse.down()
    opened.page.mouse.move(x + 15, y)  # 0.1 rad to the right: as it was
    opened.page.mouse.up()
    assert opened.picture() == still
    opened.page.focus("#blade")
    opened.page.keyboard.press("+")
    assert opened.picture() != still


def test_units_are_switched_and_numbers_saved(opened, response, tmp_path):
    """In rpm and µm: the peak's speed and amplitude, operating lines, and the files."""
    assert opened.data("orders", "layout.xaxis.title.text") == "Ω / f₁(0)"
    opened.page.select_option("#units", "engine")
    f1, gap = response.rom.f1, 1e6 * leading_gap(response.sweep)
    opened.page.wait_for_function(
        "document.getElementById('map').layout.xaxis.title.text[0] == 's'"
    )
    assert opened.data("orders", "layout.xaxis.title.text") == "speed (rpm)"
    rpm = f"{60 * f1 * SPEEDS[PEAK['index']]:.0f} rpm"
    assert rpm in opened.page.text_content("#orders") and rpm in opened.page.text_content("#at")
    for name in ("campbell", "orders", "map"):
        assert "design 4500 rpm" in opened.page.text_content(f"#{name}")
    assert opened.data("campbell", "layout.shapes[1].x0") == pytest.approx(4500)
    opened.click("map", 0.02)
    assert opened.is_at(0)
    with opened.page.expect_download() as saved:
        opened.page.click("#orders + .save button:has-text('CSV')")
    saved.value.save_as(tmp_path / "orders.csv")
    heads, first, *_ = (tmp_path / "orders.csv").read_text("utf-8-sig").splitlines()
    assert heads == '"curve","speed (rpm)","amplitude ‖Y‖ (µm)"'
    name, speed, amplitude = first.split(",")
    assert name == '"EO 2"' and float(speed) == pytest.approx(60 * f1 * SPEEDS[0], rel=1e-5)
    along = 10 ** arrays(response)["along"][0, response.orders.index(2)]
    assert float(amplitude) == pytest.approx(gap * along, rel=1e-3)  # 16 bits
    for picture in ("#orders + .save button:has-text('PNG')", "#png"):
        with opened.page.expect_download() as saved:
            opened.page.click(picture)
        assert saved.value.suggested_filename.endswith(".png")


def test_no_number_has_an_exponent_and_what_is_for_developers_is_folded(opened):
    text = opened.page.inner_text("body")
    assert not re.search(r"\de[+-]?\d|10\^|10<sup>", text)
    assert not opened.page.is_visible("#numbers")
    ticks = [float(tick) for tick in opened.page.inner_text("#ticks").split()]
    assert ticks[0] == 0 and len(ticks) >= 4


def test_edges_of_the_blade_are_named_and_the_view_is_reset(opened):
    opened.page.click("#play")
    at = {name: opened.page.query_selector(f"#{name}").bounding_box() for name in ("LE", "TE")}
    box = opened.page.query_selector("#blade").bounding_box()
    for of in at.values():
        assert box["x"] < of["x"] < box["x"] + box["width"]
        assert box["y"] <= of["y"] < box["y"] + box["height"] / 3  # at the tip
    still = opened.picture()
    opened.page.focus("#blade")
    opened.page.keyboard.press("ArrowLeft")
    assert opened.picture() != still
    assert opened.page.query_selector("#LE").bounding_box() != at["LE"]
    opened.page.click("#reset")
    assert opened.picture() == still


def test_a_narrow_page_needs_no_scrolling_sideways(page, browser):
    opened = Opened(browser, page, NARROW)
    assert opened.page.evaluate("document.documentElement.scrollWidth") <= NARROW["width"]
    assert opened.quiet()


def test_a_run_without_a_result_is_marked(response, moved, browser, tmp_path):
    """As files hold it: no spectrum, and a twin that ended differently."""
    sweep = response.sweep.copy(deep=True)
    sweep["status"] = sweep["status"].astype("<U20")
    sweep["status"][1] = "unstable"
    sweep["spectrum"][1] = np.nan
    sweep["departure"][1] = np.inf
    told, of_blade = moved
    of_blade = of_blade | {"a": np.where(np.arange(5)[:, None, None] == 1, np.nan, of_blade["a"])}
    opened = Opened(browser, written(tmp_path, Response(sweep, response.rom), told, of_blade))
    assert opened.data("orders", f"data[{len(ORDERS)}].x") == [SPEEDS[1]]
    opened.page.fill("#speed", "1")
    assert opened.is_at(1) and "unstable" in opened.page.text_content("#at")
    assert "ended differently" in opened.page.text_content("#numbers")
    assert opened.page.is_visible("#still") and not opened.page.is_visible("#blade")
    opened.page.fill("#speed", "2")
    assert opened.is_at(2) and opened.page.is_visible("#blade")
    assert opened.quiet()


def test_what_was_not_recorded_is_said(response, browser, tmp_path):
    kept = response.sweep.drop_vars(["spectrum", "wear", "motion", "envelope", "largest"])
    opened = Opened(browser, written(tmp_path, Response(kept, response.rom)))
    for name in PLOTS.keys() - {"campbell"}:
        assert "not recorded" in opened.page.text_content(f"#{name}"), name
    assert "set record: {motion: 3}" in opened.page.text_content("#still")
    opened.page.keyboard.press("ArrowRight")
    assert opened.is_at(1)
    assert opened.quiet()
