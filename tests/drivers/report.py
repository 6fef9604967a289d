"""samara report: the page as its readers use it, in a browser without a window."""

import functools
import hashlib
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import unittest

import h5py
import numpy
from selenium import webdriver
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.support.ui import Select, WebDriverWait

sys.path.insert(0, str(pathlib.Path(__file__).parent / "support"))
from program import LONGEST_RUN, PROGRAM, SOURCE  # noqa: E402

sys.path.insert(0, str(SOURCE / "python"))
from samara import report  # noqa: E402

TURBINE = SOURCE / "inputs/lee2002/baseline.yaml"
PARKED = SOURCE / "inputs/nrel5mw/land.yaml"
SPEEDS = "shaft.speed=5.5:6.5:0.5"
MOST_BYTES = 5e6
MOST_BUNDLE = 2e6
LONGEST_WAIT = 60  # seconds, on a machine ten times slower than ours
MOST_ELEMENTS = 600  # of a page without modes, with one result
ELEMENTS_OF_MODE = 12
CHANNELS = "transient={duration: 2, step: 0.02, output: {every: 0.02, channels: [RotSpeed, TTDspFA, Azimuth]}}"
MOVING = "transient={duration: 6, step: 0.01, output: {every: 0.03, places: true}}"
TURBINE_SPEED = 6.02  # rad/s
SINGLE = 1e-5  # m, of single precision at 40 m; of unit vectors
PLACE = 2e-4  # of the size: single precision, and the harmonics that are left out


def run_program(folder, *arguments):
    run = subprocess.run([PROGRAM, *map(str, arguments)], cwd=folder, text=True, capture_output=True, check=False,
                         stdin=subprocess.DEVNULL, timeout=LONGEST_RUN)
    if run.returncode != 0:
        raise RuntimeError(f"{arguments}: {run.stderr}")
    return run.stdout


def open_browser(*more, pictures=True):
    options = webdriver.ChromeOptions()
    options.binary_location = "/usr/bin/chromium"
    # Debian's wrapper of Chromium adds its own options; as root Chromium runs only without a sandbox.
    for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--disable-background-networking",
                     "--window-size=1400,1000", "--force-device-scale-factor=1", *more,
                     *(("--use-angle=swiftshader", "--enable-unsafe-swiftshader") if pictures else
                       ("--disable-3d-apis", "--disable-gpu"))):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    browser = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
    browser.set_script_timeout(LONGEST_WAIT)
    return browser


def wait_for_frame(browser):
    """Until the picture shows every change made so far: two frames of the browser, and no motion left to draw."""
    browser.execute_async_script("""const done = arguments[0];
        const look = () => requestAnimationFrame(() => samara.view?.isMoved ? look() : done());
        requestAnimationFrame(look);""")


@functools.cache
def make_results():
    """A folder with results and pages, and what the program printed."""
    holder = tempfile.TemporaryDirectory(prefix="samara_test_")
    unittest.addModuleCleanup(holder.cleanup)
    folder = pathlib.Path(holder.name)
    printed = {"lee": run_program(folder, "floquet", TURBINE, "--all", "-o", "lee.h5"),
               "parked": run_program(folder, "modes", "--parked", PARKED, "--set", "aero=none", "--all", "-o", "parked.h5")}
    run_program(folder, "campbell", TURBINE, "--sweep", SPEEDS, "-o", "sweep.h5")
    run_program(folder, "transient", PARKED, "--set", "aero=none", "--set", CHANNELS, "-o", "run.h5")
    run_program(folder, "report", "lee.h5", "sweep.h5", "run.h5", "-o", "all.html")
    run_program(folder, "report", "parked.h5", "-o", "parked.html")
    run_program(folder, "transient", TURBINE, "--set", "gravity=9.81", "--set", MOVING, "-o", "gravity.h5")
    run_program(folder, "transient", TURBINE, "--set", MOVING, "-o", "moving.h5")
    run_program(folder, "report", "moving.h5", "gravity.h5", "-o", "moving.html")
    # Sixty modes that move: four times the fifteen of the turbine.
    many = report.open_result(folder / "lee.h5")
    many._datasets["floquet"] = many["floquet"].isel(mode=list(range(15)) * 4)
    (folder / "sixty.html").write_text(report.page_of([many]), encoding="utf-8")
    return folder, printed


class Results(unittest.TestCase):
    """Results and their pages, made once for all tests."""

    @classmethod
    def setUpClass(cls):
        cls.folder, cls.printed = make_results()

    def require_silence(self, browser):
        # Without a graphics card Chromium notes that it draws slowly.
        told = [entry["message"] for entry in browser.get_log("browser") if "GPU stall" not in entry["message"]]
        self.assertEqual(told, [], "the page wrote to the console")

    def open_in(self, browser, name):
        browser.get((self.folder / name).as_uri())


class Page(Results):
    """One browser for all tests; each opens the page anew."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.browser = open_browser()
        cls.addClassCleanup(cls.browser.quit)

    def setUp(self):
        self.open("all.html")

    def tearDown(self):
        self.require_silence(self.browser)

    def open(self, name):
        self.open_in(self.browser, name)

    def js(self, text, *arguments):
        return self.browser.execute_script(text, *arguments)

    def find(self, selector):
        return self.browser.find_element(By.CSS_SELECTOR, selector)

    def control(self, label):
        """The control of a label."""
        found = self.js("return [...document.querySelectorAll('label')].find(l => l.textContent === arguments[0])", label)
        self.assertIsNotNone(found, label)
        return self.find("#" + found.get_attribute("for"))

    def wait(self, text, *arguments):
        """Until an expression of the page is true."""
        try:
            return WebDriverWait(self.browser, LONGEST_WAIT, 0.05).until(lambda _: self.js("return " + text, *arguments))
        except Exception as error:
            raise AssertionError(f"not in {LONGEST_WAIT} s: {text}") from error

    def table(self):
        """Rows of the table of modes: texts by the keys of the columns."""
        return self.js("""return [...document.querySelectorAll('.modes tbody tr')].map(row =>
            Object.fromEntries([...row.cells].map(cell => [cell.dataset.key, cell.textContent])))""")

    def wait_for_frame(self):
        """Until the picture shows every change made so far."""
        wait_for_frame(self.browser)

    def wait_for_picture(self):
        """A turbine that is out of sight does not move."""
        self.js("document.getElementById('view').scrollIntoView()")
        self.wait("samara.view.frames > 0")

    # The file

    def test_the_page_is_one_small_file_that_loads_nothing(self):
        for name in ("all.html", "parked.html", "sixty.html", "moving.html"):
            path = self.folder / name
            self.assertLess(path.stat().st_size, MOST_BYTES)
            text = path.read_text(encoding="utf-8")
            head = text[:text.index('<script type="application/json"')]
            for found in re.findall(r"(?:src|href)\s*=\s*[\"']?([^\"'\s>]+)|url\(([^)]*)\)|@import", head):
                self.assertRegex("".join(found), r"^(data:|#)")
            self.assertIn("default-src 'none'", head)
        self.assertEqual(self.js("return performance.getEntriesByType('resource').map(e => e.name)"), [])

    def test_the_bundle_is_that_of_the_sources(self):
        folder = SOURCE / "python/samara/page"
        hashes = dict(reversed(line.split("  ", 1)) for line in (folder / "hashes.sha256").read_text().splitlines())
        for name, wanted in hashes.items():
            self.assertEqual(hashlib.sha256((SOURCE / name).read_bytes()).hexdigest(), wanted,
                             f"{name} has changed; hint: scripts/report_page")
        sources = {str(path.relative_to(SOURCE)) for path in (SOURCE / "report").rglob("*")
                   if path.is_file() and "node_modules" not in path.parts}
        bundle = {f"python/samara/page/report.{ending}" for ending in ("js", "css", "html")}
        self.assertEqual(set(hashes), sources | bundle)
        self.assertLess((folder / "report.js").stat().st_size, MOST_BUNDLE)
        self.assertNotIn("resolved", (SOURCE / "report/package-lock.json").read_text())

    def test_errors_name_what_is_wrong(self):
        for arguments, words in ((("none.h5", "-o", "x.html"), "none.h5"), (("lee.h5", "-o", "x.txt"), r"\.html"),
                                 (("plain.h5", "-o", "x.html"), "no result of samara")):
            with h5py.File(self.folder / "plain.h5", "w"):
                pass
            run = subprocess.run([PROGRAM, "report", *arguments], cwd=self.folder, text=True, capture_output=True, check=False)
            self.assertEqual(run.returncode, 2, run.stderr)
            self.assertRegex(run.stderr, words)
        self.assertEqual(list(self.folder.glob("x.*")), [])

    def test_a_page_of_another_program_stays(self):
        foreign = self.folder / "foreign.html"
        foreign.write_text("mine", encoding="utf-8")
        for output, words in (("foreign.html", "no page of samara report; hint:"), ("none/x.html", "none: no such folder; hint:")):
            run = subprocess.run([PROGRAM, "report", "lee.h5", "-o", output], cwd=self.folder, text=True, capture_output=True,
                                 check=False)
            self.assertEqual((run.returncode, len(run.stderr.splitlines())), (2, 1), run.stderr)
            self.assertIn(words, run.stderr)
        self.assertEqual(foreign.read_text(encoding="utf-8"), "mine")
        own = ["report", "lee.h5", "-o", "own.html"]
        for _ in range(2):  # a page of its own is written anew
            subprocess.run([PROGRAM, *own], cwd=self.folder, capture_output=True, check=True)
        self.assertEqual(list(self.folder.glob(".own*")), [])

    def test_motions_stay_within_their_room(self):
        result = report.open_result(self.folder / "lee.h5")
        whole = report.motions_of(result, 10**9)
        self.assertEqual((whole["left_out"], len(whole["series"])), (0, 15))
        room = len(json.dumps(whole)) // 3
        small = report.motions_of(result, room)
        self.assertLess(len(json.dumps(small)), 1.02 * room)
        self.assertGreater(small["left_out"], 0)
        kept = [int(m) for m in small["series"]]
        self.assertEqual(kept, sorted(range(15), key=lambda m: result.modes["frequency_hz"].values[m])[:len(kept)])

    # Numbers

    def rows_printed(self, name):
        """Rows of the table that the program prints, as lists of words by their number."""
        rows = {}
        for line in self.printed[name].splitlines():
            match = re.match(r" *(\d+)  (\S.*)", line)
            if match:
                rows[int(match.group(1))] = match.group(2)
        return rows

    def test_the_table_has_the_numbers_of_the_program_and_of_the_file(self):
        for name, group in (("lee", "floquet"), ("parked", "modes")):
            self.open("all.html" if name == "lee" else "parked.html")
            if name == "lee":
                self.control("unresolved modes").click()
            rows = self.table()
            printed = self.rows_printed(name)
            with h5py.File(self.folder / f"{name}.h5") as file:
                data = {key: file[group][key][()] for key in ("frequency_hz", "damping_ratio", "error_growth", "exponents",
                                                             "part_share")}
                labels = file[group]["label"].asstr()[:]
                parts = file[group]["part"].asstr()[:]
                harmonic = file[group]["harmonic"][:] if name == "lee" else None
            self.assertEqual(len(rows), len(labels))
            self.assertEqual(len(rows), len(printed))
            compared = 0
            for m, row in enumerate(rows):
                self.assertEqual((row["number"], row["label"]), (str(m + 1), labels[m]))
                words = printed[m + 1].removeprefix(labels[m].removesuffix(" (unresolved)")).split()
                frequency = [row["per_rev"]] if name == "lee" else []
                own = [*frequency, row["frequency"], row["damping"], row["decrement"], row["growth"],
                       *([row["harmonic"]] if name == "lee" else [])]
                self.assertEqual(words[:len(own)], own, labels[m])
                said = " ".join(words[len(own):])
                self.assertTrue(all(part in row["parts"] for part in re.findall(r"[a-z]+ \d+(?= |$)", said)[:1]), (said, row))
                self.assertIn(row["remark"].replace("unresolved", "unresolved*"), said)
                self.assertEqual(row["error_growth"], f"{data['error_growth'][m]:.1e}")
                if row["damping"] not in ("-", "0.000"):
                    self.assertAlmostEqual(float(row["damping"]), 100 * data["damping_ratio"][m], delta=0.5001e-3)
                    self.assertAlmostEqual(float(row["growth"]), data["exponents"][m, 0],
                                           delta=0.0051 * abs(data["exponents"][m, 0]))
                    compared += 1
                if float(row["frequency"]) > 0:
                    self.assertAlmostEqual(float(row["frequency"]), data["frequency_hz"][m], delta=0.5001e-4)
                for part, share in zip(parts, data["part_share"][m]):
                    if share > 0.0501 and row["parts"].count(" ") < 5:
                        self.assertIn(f"{part} {100 * share:.0f}", row["parts"])
                if name == "lee":
                    self.assertEqual(row["harmonic"], str(harmonic[m]))
            self.assertTrue(compared > 0 or name == "lee")

    def test_the_summary_has_the_masses_and_the_growing_mode(self):
        text = self.find("#results").text
        self.assertIn("1 resolved mode grows by more than the estimated error: 1st teeter (doubles in 2.54 s)", text)
        self.assertIn("unstable: 1 mode grows: 1st teeter doubles in 2.54 s", self.printed["lee"])
        self.assertIn("samara floquet", text)
        with h5py.File(self.folder / "lee.h5") as file:
            masses = {name.replace("_", " "): value[()] for name, value in file["model/mass"].items()}
            self.assertIn(f"{file['model/rotor_speed'][()]:.5f} rad/s", text)
        shown = self.js("""return Object.fromEntries([...document.querySelector('.masses').querySelectorAll('td')]
            .map(cell => [cell.dataset.part, cell.textContent]))""")
        self.assertEqual(set(shown), set(masses))
        for part, mass in masses.items():
            self.assertAlmostEqual(float(shown[part]), mass, delta=1e-6 * mass)
        with h5py.File(self.folder / "sweep.h5") as file:
            for word in set(file["campbell/stability"].asstr()[:]):
                self.assertIn(word, text)

    # The table

    def test_the_table_sorts_and_filters(self):
        with h5py.File(self.folder / "lee.h5") as file:
            labels = file["floquet/label"].asstr()[:]
            resolved = file["floquet/resolved"][:] == 1
            frequency = file["floquet/frequency_hz"][:]
            harmonic = file["floquet/harmonic"][:]
        self.assertEqual([row["label"] for row in self.table()], list(labels[resolved]))
        head = "#modes thead th:nth-child({})"
        self.find(head.format(3) + " button").click()
        self.assertEqual(self.find(head.format(3)).get_attribute("aria-sort"), "ascending")
        self.find(head.format(3) + " button").send_keys(Keys.ENTER)
        self.assertEqual(self.find(head.format(3)).get_attribute("aria-sort"), "descending")
        shown = [float(row["frequency"]) for row in self.table()]
        self.assertEqual(shown, sorted(shown, reverse=True))
        self.assertAlmostEqual(shown[0], frequency[resolved].max(), delta=1e-4)
        by_harmonic = self.js("return [...document.querySelectorAll('#modes thead th')].findIndex("
                              "h => h.textContent.startsWith('harmonic')) + 1")
        self.find(head.format(by_harmonic) + " button").click()
        self.assertEqual([int(row["harmonic"]) for row in self.table()], sorted(harmonic[resolved]))
        self.control("Filter").send_keys("LEAD-lag")
        self.assertEqual({row["label"] for row in self.table()},
                         {label for label in labels[resolved] if "lead-lag" in label})
        self.control("From [Hz]").send_keys("3")
        self.control("to [Hz]").send_keys("19.2")
        wanted = {label for label, value, is_known in zip(labels, frequency, resolved)
                  if is_known and "lead-lag" in label and 3 <= value <= 19.2}
        self.assertEqual({row["label"] for row in self.table()}, wanted)
        self.assertGreater(len(wanted), 0)
        self.assertIn(f"{len(wanted)} of {len(labels)} modes", self.find("#modes").text)

    # The moving turbine

    def positions(self):
        return numpy.array(self.js("return [...samara.view.present.place]"))

    def test_a_chosen_mode_moves_and_stops(self):
        self.wait_for_picture()
        names = self.browser.find_elements(By.CSS_SELECTOR, ".modes tbody button")
        button = next(name for name in names if name.text == "1st tower side-side")
        button.send_keys(Keys.ENTER)
        self.assertEqual(button.get_attribute("aria-pressed"), "true")
        motion = Select(self.control("Motion"))
        self.assertTrue(motion.first_selected_option.text.startswith("1st tower side-side"))
        play = self.find(".controls button.main")
        self.assertEqual(play.text, "Pause")
        canvas = self.find(".stage canvas")
        frames = self.js("return samara.view.frames")
        first, picture = self.positions(), canvas.screenshot_as_png
        self.wait(f"samara.view.frames > {frames + 3}")
        self.assertGreater(abs(self.positions() - first).max(), 1e-3)
        self.assertNotEqual(canvas.screenshot_as_png, picture)
        play.send_keys(Keys.SPACE)
        self.assertEqual(play.text, "Play")
        self.wait_for_frame()
        still, picture = self.positions(), canvas.screenshot_as_png
        time.sleep(0.5)
        numpy.testing.assert_array_equal(self.positions(), still)
        self.assertEqual(canvas.screenshot_as_png, picture)
        canvas.send_keys(Keys.ARROW_LEFT)
        self.wait_for_frame()
        self.assertNotEqual(canvas.screenshot_as_png, picture)
        canvas.send_keys(" ")
        self.assertEqual(play.text, "Pause")
        motion.select_by_visible_text("steady state")
        self.assertTrue(self.control("Magnification").is_displayed())
        self.assertFalse(self.control("Amplitude").is_displayed())
        self.assertEqual(self.browser.find_elements(By.CSS_SELECTOR, ".modes tr.chosen"), [])

    def test_places_of_the_nodes_are_those_of_the_file(self):
        with h5py.File(self.folder / "lee.h5") as file:
            place = file["geometry/place"][:]
            axes = file["geometry/axes"][:]
            times = file["geometry/time"][:]
            exponents = file["floquet/exponents"][:] @ [1, 1j]
            harmonic = file["floquet/harmonic"][:]
            speed = file["floquet"].attrs["rotor_speed"]
            motion = file["floquet/node_motion"][:15, ..., 0] + 1j * file["floquet/node_motion"][:15, ..., 1]
        size = numpy.ptp(place.reshape(-1, 3), axis=0).max()
        for m in range(15):
            found = self.js("""const [m, times, omega, speed] = arguments, motion = samara.view.motion;
                return times.map(t => {
                    const still = motion.moved(m, omega * t, speed * t, 0);
                    return [...still.place, ...still.axes, ...motion.mode(m, omega * t, speed * t)];
                })""", m, list(times), exponents[m].imag, speed)
            found = numpy.array(found)
            count = place.shape[1]
            numpy.testing.assert_allclose(found[:, :3 * count].reshape(place.shape), place, atol=PLACE * size)
            numpy.testing.assert_allclose(found[:, 3 * count:12 * count].reshape(axes.shape), axes, atol=PLACE)
            turn = numpy.exp(1j * (exponents[m].imag - harmonic[m] * speed) * times)
            wanted = (motion[m] * turn[:, None, None]).real
            numpy.testing.assert_allclose(found[:, 12 * count:].reshape(wanted.shape), wanted,
                                          atol=PLACE * abs(motion[m]).max())

    def test_between_the_samples_a_mode_has_its_own_frequency(self):
        # The tower does not turn: it oscillates with the frequency of its mode, twelve times that of the rotor.
        with h5py.File(self.folder / "lee.h5") as file:
            m = list(file["floquet/label"].asstr()[:]).index("2nd tower fore-aft")
            node = list(file["geometry/part"].asstr()[:]).index("tower") + 3
            omega, speed = file["floquet/exponents"][m, 1], file["floquet"].attrs["rotor_speed"]
            self.assertGreater(abs(file["floquet/harmonic"][m]), len(file["geometry/time"]) // 2)
        times = numpy.arange(400) * 40 * numpy.pi / omega / 400
        moved = numpy.array(self.js("""const [m, times, omega, speed, node] = arguments;
            return times.map(t => samara.view.motion.mode(m, omega * t, speed * t)[6 * node])""",
                                    m, list(times), omega, speed, node))
        at_mode = 2 * abs(numpy.mean(moved * numpy.exp(-1j * omega * times))) ** 2
        self.assertGreater(at_mode, 0.8 * numpy.mean(moved**2))

    def test_a_held_rotor_keeps_its_azimuth(self):
        self.wait_for_picture()
        Select(self.control("Motion")).select_by_visible_text("steady state")
        self.control("held at an azimuth").click()
        slider = self.control("Azimuth")
        self.assertTrue(slider.is_displayed())
        self.js("arguments[0].value = 90; arguments[0].dispatchEvent(new Event('input'))", slider)
        self.wait_for_frame()
        with h5py.File(self.folder / "lee.h5") as file:
            tip = [n for n, part in enumerate(file["geometry/part"].asstr()[:]) if part == "blade 1"][-1]
            start = file["geometry/azimuth"][0]
            place = file["geometry/place"][:, tip]
            angles = start + file["floquet"].attrs["rotor_speed"] * file["geometry/time"][:]
        # A turn about the shaft: mean, cosine and sine of the azimuth, at 90 degrees.
        terms = numpy.stack([numpy.ones_like(angles), numpy.cos(angles), numpy.sin(angles)], axis=1)
        wanted = numpy.array([1, 0, 1]) @ numpy.linalg.lstsq(terms, place, rcond=None)[0]
        numpy.testing.assert_allclose(self.positions().reshape(-1, 3)[tip], wanted, atol=0.01)

    # The Campbell diagram

    def test_the_campbell_diagram_names_and_chooses_modes(self):
        self.wait_for_picture()
        with h5py.File(self.folder / "sweep.h5") as file:
            group = file["campbell"]
            modes = group["mode"].asstr()[:]
            label = "2nd tower fore-aft"
            line, point = list(modes).index(label), 1
            frequency, damping = group["frequency_hz"][line, point], group["damping_ratio"][line, point]
            value = group["value"][point]
        self.js("document.getElementById('campbell').scrollIntoView()")
        place = self.js("return samara.diagram.place(arguments[0], arguments[1])", label, point)
        actions = ActionChains(self.browser)
        actions.w3c_actions.pointer_action.move_to_location(round(place["x"]), round(place["y"]))
        actions.perform()
        tip = self.find(".tip")
        self.assertTrue(tip.is_displayed())
        self.assertIn(f"{label}: shaft.speed {value:g} rad/s, {frequency:.4f} Hz", tip.text)
        self.assertRegex(tip.text, rf"damping -?{abs(100 * damping):.3f} %")
        ActionChains(self.browser).click().perform()
        self.assertEqual(self.js("return samara.selection.label"), label)
        self.assertEqual(self.find(".modes tr.chosen th").text, label)
        self.assertTrue(Select(self.control("Motion")).first_selected_option.text.startswith(label))
        buttons = self.browser.find_elements(By.CSS_SELECTOR, ".lines button")
        other = next(button for button in buttons if button.text == "1st blade lead-lag symmetric")
        line = list(modes).index(other.text)
        self.js("arguments[0].focus()", other)
        other.send_keys(Keys.ARROW_RIGHT)
        with h5py.File(self.folder / "sweep.h5") as file:
            wanted = f"{file['campbell/frequency_hz'][line, 1]:.4f} Hz"
        self.assertIn(wanted, self.find("#campbell .told").text)
        other.send_keys(Keys.ENTER)
        self.assertEqual(self.js("return samara.selection.label"), "1st blade lead-lag symmetric")
        numbers = self.js("""return [...document.querySelectorAll('#campbell details table')].map(table =>
            Object.fromEntries([...table.tBodies[0].rows].map(row => [row.cells[0].textContent,
                [...row.cells].slice(1).map(cell => cell.textContent)])))""")
        with h5py.File(self.folder / "sweep.h5") as file:
            for name, cells in numbers[0].items():
                row = list(modes).index(name)
                own, ground = file["campbell/frequency_hz"][row], file["campbell/fixed_frame_frequency_hz"][row]
                drawn = ground if 2 * numpy.isfinite(ground).sum() >= numpy.isfinite(own).sum() else own
                self.assertEqual(cells, ["-" if numpy.isnan(value) else f"{value:.4f}" for value in drawn])
                damping = file["campbell/damping_ratio"][row]
                for cell, value in zip(numbers[1][name], damping):
                    self.assertEqual(cell == "-", bool(numpy.isnan(value)))
                    if cell != "-":
                        self.assertAlmostEqual(float(cell), 100 * value, delta=0.5001e-3)
        self.assertGreaterEqual(len(numbers[0]), 8)

    # Time series

    def test_time_series_have_the_channels_of_the_file(self):
        with h5py.File(self.folder / "run.h5") as file:
            names = list(file["transient/channel_name"].asstr()[:])
            values, times = file["transient/values"][:], file["transient/time"][:]
        drawn = self.js("return samara.series.charts.map(chart => [[...chart.plot.data[0]], [...chart.plot.data[1]]])")
        chosen = self.js("return samara.series.chosen")
        self.assertEqual([names[c] for c in chosen], ["RotSpeed", "TTDspFA"])
        for (x, y), channel in zip(drawn, chosen):
            numpy.testing.assert_allclose(x, times, rtol=1e-12)
            numpy.testing.assert_allclose(y, values[:, channel], rtol=1e-6, atol=1e-6 * abs(values[:, channel]).max())
        self.control("Azimuth [deg]").click()
        self.assertEqual(self.js("return samara.series.charts.length"), 3)

    def test_long_time_series_keep_their_extremes(self):
        times = numpy.arange(10001) * 0.01
        values = numpy.stack([numpy.sin(times), numpy.cos(0.3 * times)], axis=1)
        values[4321, 0] = 7.0
        short, thin = report.thinned(times, values, 100)
        self.assertEqual(len(short), 100)
        self.assertTrue((numpy.diff(short) > 0).all())
        numpy.testing.assert_array_equal(thin.max(axis=0), values.max(axis=0))
        numpy.testing.assert_array_equal(thin.min(axis=0), values.min(axis=0))

    # The turbine in a time series

    def tips_on_a_circle(self, times):
        """Tips of the baseline, which keeps its shape without gravity [time, blade, 3]."""
        angle = TURBINE_SPEED * numpy.asarray(times)[:, None] + numpy.array([0.0, math.pi])
        return numpy.stack([numpy.full_like(angle, 2.388), -10.22 * numpy.sin(angle), 27.0 + 10.22 * numpy.cos(angle)], -1)

    def tips(self):
        with h5py.File(self.folder / "moving.h5") as file:
            parts = list(file["geometry/part"].asstr()[:])
        return [max(n for n, part in enumerate(parts) if part == f"blade {blade}") for blade in (1, 2)]

    def test_the_turbine_of_a_time_series_turns_at_rows_and_between(self):
        self.open("moving.html")
        with h5py.File(self.folder / "moving.h5") as file:
            rows = file["transient/time"][:]
            values = file["transient/values"][:]
            names = list(file["transient/channel_name"].asstr()[:])
            rotation = numpy.radians(file["transient/values"][:, [names.index(f"Node24R{axis}") for axis in "xyz"]])
        self.assertEqual(self.js("return samara.results[0].geometry.time.length"), len(rows))
        times = [*rows, *(rows[:-1] + 0.4 * numpy.diff(rows))]
        found = self.js("""return arguments[0].map(t => {
            const { place, axes } = samara.view.motion.steady(t); return [...place, ...axes]; })""", times)
        places = numpy.array(found)[:, :72].reshape(-1, 24, 3)
        axes = numpy.array(found)[:, 72:].reshape(-1, 24, 3, 3)
        numpy.testing.assert_allclose(places[:, self.tips()], self.tips_on_a_circle(times), atol=SINGLE)
        # Rows of the axes are the columns of the matrix exp(skew(rotation)).
        for row in range(0, len(rows), 17):
            x, y, z = rotation[row]
            skew = numpy.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
            matrix, term = numpy.eye(3), numpy.eye(3)
            for k in range(1, 40):
                term = term @ skew / k
                matrix = matrix + term
            numpy.testing.assert_allclose(axes[row, 23], matrix.T, atol=SINGLE)
        for i in range(3):
            column = [names.index(f"Node{node + 1}P{'xyz'[i]}") for node in range(24)]
            numpy.testing.assert_allclose(places[:len(rows), :, i], values[:, column], atol=SINGLE)
        # Between rows axes turn with the rotor, too: along the blade they point from the root to the tip.
        numpy.testing.assert_allclose(axes[:, 23, 0], (places[:, 23] - [2.388, 0, 27.0]) / 10.22, atol=SINGLE)

    def test_the_time_of_turbine_and_diagram_is_the_same(self):
        self.open("moving.html")
        self.wait_for_picture()
        play = self.find(".controls button.main")
        self.assertTrue(Select(self.control("Motion")).first_selected_option.text.startswith("time series"))
        self.assertEqual(play.text, "Pause")
        self.assertFalse(self.control("Magnification").is_displayed())
        self.assertFalse(self.control("undeformed outline").is_displayed())
        first = self.js("return samara.view.time")
        self.wait("samara.view.time > arguments[0] + 0.05", first)
        play.click()
        slider = self.control("Time")
        self.assertEqual([slider.get_attribute(name) for name in ("min", "max")], ["0", "6"])
        mark = """return samara.series.charts.map(({plot}) => {
            const box = plot.over.getBoundingClientRect(), line = plot.over.querySelector('.mark').getBoundingClientRect();
            return plot.over.querySelector('.mark').hidden ? null : [line.left - box.left, box.width]; })"""
        for wanted in (1.515, 5.25):
            frames = self.js("return samara.view.frames")
            self.js("arguments[0].value = arguments[1]; arguments[0].dispatchEvent(new Event('input'))", slider, wanted)
            self.wait("samara.view.frames > arguments[0]", frames)
            tips = self.positions().reshape(-1, 3)[self.tips()]
            numpy.testing.assert_allclose(tips, self.tips_on_a_circle([wanted])[0], atol=SINGLE)
            marks = self.js(mark)
            self.assertEqual(len(marks), 4)
            for left, width in marks:
                self.assertAlmostEqual(left, width * wanted / 6, delta=1.5)
            self.assertIn(f"{wanted:.3f} s", slider.find_element(By.XPATH, "..").text)
        # A click in a diagram: the turbine goes there.
        area = self.browser.find_elements(By.CSS_SELECTOR, "#series .u-over")[1]
        self.js("arguments[0].scrollIntoView({block: 'center'})", area)
        width = area.size["width"]
        ActionChains(self.browser).move_to_element_with_offset(area, round(width / 4), 0).click().perform()
        shown = self.js("return samara.view.time")
        self.assertAlmostEqual(shown, 6 * (0.5 + round(width / 4) / width), delta=0.02)
        self.assertAlmostEqual(float(slider.get_attribute("value")), shown, places=9)
        self.assertAlmostEqual(self.js(mark)[0][0], width * shown / 6, delta=1.5)
        # A drag zooms and leaves the time.
        ActionChains(self.browser).move_to_element(area).click_and_hold().move_by_offset(40, 0).release().perform()
        self.assertEqual(self.js("return samara.view.time"), shown)
        self.wait("samara.series.charts[1].plot.scales.x.max < 4")
        # At its end the series begins anew.
        self.wait_for_picture()
        self.js("samara.view.setTime(5.9); samara.view.setPlaying(true)")
        self.wait("samara.view.time < 5")
        # The other result: no line in the diagrams of this one.
        Select(self.control("Motion")).select_by_index(1)
        self.assertEqual(self.js(mark), [None] * 4)

    def test_channels_of_the_nodes_are_hidden_until_asked_for(self):
        self.open("moving.html")
        with h5py.File(self.folder / "moving.h5") as file:
            names = list(file["transient/channel_name"].asstr()[:])
            values, times = file["transient/values"][:], file["transient/time"][:]
        count = "return document.querySelectorAll('.picks input').length"
        own = [name for name in names if not name.startswith("Node")]
        self.assertEqual(len(names) - len(own), 24 * 6)
        self.assertEqual(self.js(count), len(own))
        self.assertFalse(any(names[c].startswith("Node") for c in self.js("return samara.series.chosen")))
        self.control("channels of the nodes").click()
        self.assertEqual(self.js(count), len(names))
        self.control("Filter channels").send_keys("node24")
        self.assertEqual(self.js(count), 6)
        for name in ("Node24Py [m]", "Node24Ry [deg]"):
            self.control(name).click()
        drawn = self.js("return samara.series.charts.slice(-2).map(chart => [[...chart.plot.data[0]], [...chart.plot.data[1]]])")
        for (x, y), name in zip(drawn, ("Node24Py", "Node24Ry")):
            numpy.testing.assert_allclose(x, times, rtol=1e-12)
            numpy.testing.assert_allclose(y, values[:, names.index(name)], atol=90 * SINGLE)
        rows = self.js("""return [...document.querySelectorAll('#series details tbody tr')].map(row =>
            [...row.cells].map(cell => cell.textContent))""")
        self.assertEqual(rows[-2][0], "Node24Py")
        self.assertAlmostEqual(float(rows[-2][4]), values[:, names.index("Node24Py")].max(), delta=0.01)
        self.open("all.html")
        self.assertFalse(self.control("channels of the nodes").is_displayed())

    def test_a_long_time_series_stays_within_its_room(self):
        longer = report.open_result(self.folder / "moving.h5")
        data = longer["transient"]
        rows = 60_000
        axis = data["values"].dims[0]
        many = data.isel({axis: numpy.arange(rows) % data.sizes[axis]})
        longer._datasets["transient"] = many.assign(time=(data["time"].dims, 0.03 * numpy.arange(rows)))
        page = report.page_of([longer] * 3)
        self.assertLess(len(page.encode()), MOST_BYTES)
        frames = report.frames_of(longer, 1)
        self.assertEqual(frames["rows"], rows)
        self.assertLess(len(frames["place"]["base64"]) + len(frames["rotation"]["base64"]), 1.01 * report.FRAME_BYTES)
        self.assertFalse(frames["is_even"], "the rotor turns once from frame to frame")

    # Colours, access, time

    def test_the_page_is_accessible_in_light_and_dark(self):
        self.wait_for_picture()
        axe = (SOURCE / "report/axe/axe.min.js").read_text(encoding="utf-8")
        papers = set()
        for theme in ("light", "dark"):
            Select(self.find("#theme")).select_by_value(theme)
            papers.add(self.js("return getComputedStyle(document.body).backgroundColor"))
            self.assertEqual(self.js("return document.documentElement.dataset.theme"), theme)
            time.sleep(0.3)
            self.browser.execute_script(axe)
            found = self.browser.execute_async_script(
                "const done = arguments[0]; axe.run().then(done, e => done({error: String(e)}))")
            self.assertNotIn("error", found)
            self.assertGreater(len(found["passes"]), 15)
            self.assertEqual([(entry["id"], entry["impact"], entry["nodes"][0]["html"]) for entry in found["violations"]], [])
            if theme == "light":
                self.open("moving.html")
                self.wait_for_picture()
        self.assertEqual(len(papers), 2)
        self.open("all.html")
        self.assertEqual(self.js("return document.documentElement.dataset.theme"), "dark", "the choice is kept")
        Select(self.find("#theme")).select_by_value("system")

    def test_the_page_of_many_modes_has_little_to_do_when_it_opens(self):
        """Without a clock: the size of the page, its elements, and the motions that are unpacked. `scripts/bench page` has the
        time."""
        for name, moving in (("sixty.html", 60), ("parked.html", 101)):
            self.open(name)
            self.wait("performance.getEntriesByType('navigation')[0].loadEventEnd > 0")
            self.assertEqual(self.js("return Object.keys(samara.results[0].modes.motions.series).length"), moving)
            self.assertEqual(len(self.table()), moving)
            self.assertLess((self.folder / name).stat().st_size, MOST_BYTES)
            self.assertLess(self.js("return document.querySelectorAll('*').length"), MOST_ELEMENTS + ELEMENTS_OF_MODE * moving)
            # That of the mode that is shown.
            self.assertEqual(self.js("return Object.values(samara.results[0].modes.motions.series)"
                                     ".filter(one => ArrayBuffer.isView(one.values)).length"), 1)

    def test_narrow_windows_need_no_sideways_scrolling(self):
        self.browser.set_window_size(600, 900)
        try:
            self.open("all.html")
            self.assertLessEqual(self.js("return document.documentElement.scrollWidth"), self.js("return innerWidth"))
        finally:
            self.browser.set_window_size(1400, 1000)


class OtherBrowsers(Results):
    """Browsers without WebGL, and readers who want no motion."""

    def test_without_webgl_the_rest_of_the_page_works(self):
        browser = open_browser(pictures=False)
        self.addCleanup(browser.quit)
        self.open_in(browser, "all.html")
        WebDriverWait(browser, LONGEST_WAIT).until(lambda b: b.find_elements(By.CSS_SELECTOR, "#view .warning"))
        self.assertIn("no WebGL", browser.find_element(By.ID, "view").text)
        browser.find_element(By.CSS_SELECTOR, ".modes tbody tr:nth-child(7) button").click()
        self.assertEqual(len(browser.find_elements(By.CSS_SELECTOR, ".modes tr.chosen")), 1)
        errors = [entry["message"] for entry in browser.get_log("browser") if "WebGL" not in entry["message"]]
        self.assertEqual(errors, [])

    def test_the_picture_rests_where_motion_is_not_wanted(self):
        browser = open_browser("--force-prefers-reduced-motion")
        self.addCleanup(browser.quit)
        self.open_in(browser, "all.html")
        browser.execute_script("document.getElementById('view').scrollIntoView()")
        WebDriverWait(browser, LONGEST_WAIT).until(lambda b: b.execute_script("return samara.view.frames > 0"))
        self.assertEqual(browser.find_element(By.CSS_SELECTOR, ".controls button.main").text, "Play")
        wait_for_frame(browser)
        frames = browser.execute_script("return samara.view.frames")
        time.sleep(0.6)
        self.assertEqual(browser.execute_script("return samara.view.frames"), frames)
        browser.find_element(By.CSS_SELECTOR, ".controls button.main").click()
        WebDriverWait(browser, LONGEST_WAIT).until(lambda b: b.execute_script(f"return samara.view.frames > {frames + 2}"))
        self.require_silence(browser)


if __name__ == "__main__":
    unittest.main()
