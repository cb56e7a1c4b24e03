"""The page to explore a sweep: what it holds, and what a browser does with it."""

import base64
import gzip
import json
import re
import shutil
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from scipy.spatial import cKDTree

from rom.reconstruct import Basis
from simulate.over_speeds import at_speeds
from simulate.scene import Scene
from workflow.explore import pack
from workflow.explore.motion import motion, surface
from workflow.explore.page import html
from workflow.explore.results import ANGLES, WINDOWS, around, arrays, facts, log10
from workflow.figures.response import Response

ROOT = Path(__file__).parents[2]
SPEEDS = [0.2, 0.3, 0.34, 0.36, 0.38]  # over f1(0)


@pytest.fixture(scope="module")
def basis(coarse_matrices, coarse_reduced):
    rom, T = coarse_reduced
    return Basis.of(coarse_matrices, T, rom.provenance)


@pytest.fixture(scope="module")
def response(coarse_rom):
    """A few speeds of the paper's E = 10, with all that the page can show."""
    record = {"spectrum_rounds": 4, "samples_per_round": 256, "history": {"chord": [0.0625]}}
    scene = Scene.load(ROOT / "workflow/scenes/paper-e10.yaml").but(
        blade="coarse",
        speeds={"over_f1": SPEEDS},
        rounds=8,
        peaks=None,
        record=record | {"states_rounds": 1, "states_mode": 2},
        liner__strips=8,
    )
    speeds = 2 * np.pi * coarse_rom.f1 * np.array(SPEEDS)
    return Response(at_speeds(scene, coarse_rom, speeds), coarse_rom)


@pytest.fixture(scope="module")
def moved(coarse_blade, coarse_mesh, basis, response):
    from workflow.explore.blade import moving

    return moving(coarse_blade, coarse_mesh.mesh, basis, response.sweep, response.rom)


@pytest.fixture(scope="module")
def page(response, moved, tmp_path_factory):
    motion_facts, of_blade = moved
    path = tmp_path_factory.mktemp("explore") / "explore.html"
    told = facts(response, "coarse", "mine") | {"motion": motion_facts}
    path.write_text(html(told, arrays(response) | of_blade))
    return path


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


def moving_along(amplitudes, status="ok"):
    """States of three DoFs at speeds and times: ``amplitudes`` (speeds, times, DoFs)."""
    states = np.asarray(amplitudes, float)
    return xr.Dataset(
        {
            "states": (("speed_over_f1", "time", "dof"), states),
            "status": ("speed_over_f1", [status] * len(states)),
        }
    )


def test_shapes_hold_the_motion_they_are_made_of():
    """Two patterns in four DoFs: two shapes miss nothing, and give every displacement back."""
    rng = np.random.default_rng(2)
    T, patterns = rng.normal(size=(9, 4)), rng.normal(size=(2, 4))
    states = rng.normal(size=(3, 6, 2)) @ patterns * np.array([1.0, 1e-3, 10.0])[:, None, None]
    states[1, 2:4] = np.nan  # recorded at other speeds only
    found = motion(moving_along(states), T, shapes=2)
    assert found.missed.max() < 1e-12
    known = ~np.isnan(states)
    shown = np.where(known, found.a @ found.shapes.T @ T.T @ np.linalg.pinv(T.T), np.nan)
    np.testing.assert_allclose(shown, states, atol=1e-12)
    assert np.isnan(found.a[1, 2:4]).all()


def test_what_shapes_miss_is_told_by_speed():
    """One shape for two speeds that move in different patterns, one of them twice as often."""
    one, other = [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]
    states = [[one, one], [one, one], [other, other]]
    found = motion(moving_along(states), np.eye(3), shapes=1)
    assert found.missed == pytest.approx([0.0, 0.0, 1.0], abs=1e-12)


def test_runs_without_a_result_do_not_move():
    found = motion(moving_along(np.ones((1, 2, 3)), status="diverged"), np.eye(3), shapes=1)
    assert np.isnan(found.a).all()


def test_a_surface_is_closed_and_outside():
    """Every edge of the outer triangles belongs to two of them; two tetrahedra share a face."""
    triangles = surface(np.array([[0, 1, 2, 3], [1, 2, 3, 4]]))
    assert len(triangles) == 6 and [1, 2, 3] not in triangles.tolist()
    edges = np.sort(
        np.concatenate([triangles[:, pair] for pair in ([0, 1], [1, 2], [0, 2])]), axis=1
    )
    _, count = np.unique(edges, axis=0, return_counts=True)
    assert (count == 2).all()


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
    assert found["history"].shape == (len(SPEEDS), WINDOWS * 8, 2)
    assert found["history"][..., 1].max() == response.u_r.max()
    assert found["history"][..., 0].min() == response.u_r.min()
    k4 = response.spectrum[:, 15:18].max(axis=1)  # four rounds: k = 4 is bin 16
    np.testing.assert_allclose(10 ** found["along"][:, 2], k4, rtol=1e-6)
    told = facts(response, "coarse", "mine")
    assert told["energies"]["plastic"][2] == response.sweep["ledger"].sel(energy="plastic")[2]
    assert told["status"] == ["ok"] * len(SPEEDS)


def test_motion_and_stress_are_those_of_the_whole_blade(
    coarse_blade, coarse_mesh, basis, response, moved
):
    """Against the fields of one recorded state: displacement to 1 %, von Mises stress to 2 %."""
    from fem.fields import fields
    from fem.stress import von_mises

    told, of = moved
    assert max(told["missed"]) < 1e-3
    speed, time = 3, 100
    run = response.sweep.isel(speed_over_f1=speed)
    time = int(np.flatnonzero(~np.isnan(run["states"][:, 0]))[-5])
    static, u = basis.static(float(run["speed"])), basis.reconstruct(run["states"][time].values)
    exact = fields(coarse_blade, coarse_mesh.mesh, basis.coordinates, static, u)
    near = cKDTree(exact.points).query(of["points"])[1]
    a = of["a"][speed, time]
    shown = np.tensordot(a, of["shapes"], 1)
    np.testing.assert_allclose(shown, exact.vibration[near], atol=0.01 * abs(exact.vibration).max())
    part = (SPEEDS[speed] / told["Omega_m_over_f1"]) ** 2
    sigma = sum(part**p * c for p, c in enumerate(of["static"])) + np.tensordot(
        a, of["of_shapes"], 1
    )
    stress = von_mises(sigma[:, np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2]])])
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
    with driver.sync_playwright() as playwright:
        launched = playwright.chromium.launch(executable_path=chromium, args=FLAGS)
        yield launched
        launched.close()


FLAGS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
PLOTS = {"orders": 10, "map": 6, "spectrum": 1, "profile": 1, "polar": 3, "history": 2}


def test_a_browser_draws_everything_and_answers(page, browser):
    """No message, no request; every plot drawn; click, slider, keys; the blade moves and stops."""
    opened = browser.new_page(viewport={"width": 1200, "height": 900})
    said, asked = [], []
    opened.on("console", lambda message: said.append(message.text))
    opened.on("pageerror", lambda error: said.append(str(error)))
    opened.on("request", lambda request: asked.append(request.url))
    opened.goto(page.as_uri())
    opened.wait_for_selector("body[data-ready=yes]", state="attached")

    def shown():
        return int(opened.evaluate("document.body.dataset.shown"))

    def at(speed):
        opened.wait_for_function(f"document.body.dataset.shown == {speed}")
        assert f"{SPEEDS[speed]:.4f}" in opened.text_content("#at")

    for name, traces in PLOTS.items():
        assert opened.evaluate(f"document.getElementById('{name}').data.length") == traces, name
        assert opened.query_selector(f"#{name} .main-svg"), name
    opened.keyboard.press("Home")
    at(0)
    opened.keyboard.press("ArrowRight")
    at(1)
    opened.keyboard.press("End")
    at(4)
    worn = opened.evaluate("document.getElementById('profile').data[0].y.join()")
    opened.fill("#speed", "2")
    at(2)
    assert opened.evaluate("document.getElementById('profile').data[0].y.join()") != worn
    box = opened.query_selector("#map .nsewdrag").bounding_box()
    opened.mouse.click(box["x"] + 0.02 * box["width"], box["y"] + box["height"] / 2)
    at(0)

    def frames():
        return int(opened.get_attribute("#blade", "data-frames"))

    opened.select_option("#colour", "stress")
    assert "MPa" in opened.text_content("#range")
    before = frames()
    opened.wait_for_function(f"document.getElementById('blade').dataset.frames > {before + 3}")
    opened.click("#play")
    stopped = frames()
    opened.wait_for_timeout(300)
    assert frames() == stopped
    still = opened.query_selector("#blade").screenshot()
    opened.focus("#blade")
    opened.keyboard.press("ArrowLeft")
    assert frames() == stopped + 1 and shown() == 0  # turned, at the same speed
    assert opened.query_selector("#blade").screenshot() != still
    assert said == [] and [url for url in asked if not url.startswith(("file:", "blob:"))] == []
