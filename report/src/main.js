// The page: its data, its sections, its colours.

import threeLicence from "../licences/three.txt";
import uplotLicence from "../licences/uplot.txt";
import { campbellDiagram } from "./campbell.js";
import { Clock } from "./clock.js";
import { readData } from "./data.js";
import { make } from "./format.js";
import { player } from "./player.js";
import { Selection } from "./selection.js";
import { timeSeries } from "./series.js";
import { summary } from "./summary.js";
import { firstMode, modeTable } from "./table.js";

const { results } = readData();
const selection = new Selection();
const clock = new Clock();
const content = document.getElementById("content");
document.getElementById("title").textContent = [...new Set(results.map(({ title }) => title))].join("; ");

const table = modeTable(results, selection);
const view = player(results, selection, clock);
const diagram = campbellDiagram(results, selection);
const series = timeSeries(results, clock);
content.append(...[summary(results), table || view ? make("div", { class: "pair" }, table, view?.element) : null,
                   diagram?.element, series?.element].filter(Boolean));
diagram?.build();
series?.fill();
const first = firstMode(results);
if (first) selection.choose(first);
view?.tellTime();

document.getElementById("footer").append(
  make("p", {}, `Made by samara report from ${results.map(({ file }) => file).join(", ")}. The page needs no network. ` +
    "It contains three.js and uPlot, both under the MIT licence."),
  make("details", {}, make("summary", {}, "Licences"),
    [["three.js", threeLicence], ["uPlot", uplotLicence]].map(([name, text]) => [
      make("p", {}, name), make("pre", { tabindex: "0", role: "region", "aria-label": `Licence of ${name}` }, text)])));

const root = document.documentElement;
const theme = document.getElementById("theme");
const dark = matchMedia("(prefers-color-scheme: dark)");
const kept = () => { try { return localStorage.getItem("samara-colours"); } catch { return null; } };

function colour() {
  root.dataset.theme = theme.value === "system" ? (dark.matches ? "dark" : "light") : theme.value;
  view?.colour();
  for (const plot of [diagram?.high?.plot, diagram?.low?.plot]) plot?.redraw(false);
  series?.colour();
}

theme.value = kept() ?? "system";
if (theme.selectedIndex < 0) theme.value = "system";
theme.addEventListener("change", () => {
  try { localStorage.setItem("samara-colours", theme.value); } catch { /* a page without storage forgets the choice */ }
  colour();
});
dark.addEventListener("change", colour);
colour();

/** For scripts on the page: what it shows, and where the nodes are. */
window.samara = { results, selection, clock, view, diagram, series, opened: performance.now() };

// The page is there before the picture: a browser without a graphics card needs some time for it.
if (view) addEventListener("load", () => requestAnimationFrame(() => setTimeout(() => view.start())));
