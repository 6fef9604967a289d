// Time series: channels that the reader picks, one above the other.

import { Chart, axis } from "./charts.js";
import { fixed, general, labelled, make, section, styleOf } from "./format.js";
import { rowAt } from "./transient.js";

const USUAL = ["RotSpeed", "GenPwr", "RootMyb1", "RootMyc1", "TTDspFA", "TwrBsMyt"];
const MOST = 6;
const STILL = 4; // pixels, the most between press and release of a click
const COMPONENTS = 6; // channels of a node: place and rotation vector

class Series {
  constructor(results, clock) {
    this.results = results;
    this.clock = clock;
    this.charts = [];
    const withRows = [...results.keys()].filter((r) => results[r].transient);
    this.which = make("select", { onchange: () => this.fill() },
      withRows.map((r) => make("option", { value: r }, `${results[r].file}: ${results[r].title}`)));
    this.filter = make("input", { type: "search", autocomplete: "off", oninput: () => this.list() });
    this.ofNodes = make("input", { type: "checkbox", onchange: () => this.list() });
    this.nodes = labelled("channels of the nodes", this.ofNodes);
    this.picks = make("div", { class: "picks scroll", role: "group", "aria-label": "Channels", tabindex: "0" });
    this.plots = make("div", { class: "plots" });
    this.told = make("p", { class: "told", role: "status" });
    this.note = make("p", { class: "note" });
    this.numbers = make("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": "Least, mean and largest values" });
    this.element = section("series", "Time series", withRows.length > 1 ? labelled("Result", this.which, "wide") : null,
      make("div", { class: "beside" }, make("div", { class: "picker" }, labelled("Filter channels", this.filter), this.nodes,
                                             this.picks),
           make("div", {}, this.plots, this.told)), this.note,
      make("details", {}, make("summary", {}, "Numbers of the channels drawn"), this.numbers));
    clock.addEventListener("shown", () => this.mark());
  }

  get result() { return Number(this.which.value); }
  get data() { return this.results[this.result].transient; }

  /** Places and rotations at frames, where the result has them. */
  get frames() {
    const { geometry } = this.results[this.result];
    return geometry?.kind === "transient" ? geometry : null;
  }

  /** Times and values of a channel: those of a node are in the frames of the turbine. */
  rowsOf(channel) {
    const data = this.data;
    if (channel < data.own) {
      const rows = data.time.length;
      return { time: data.time, values: data.values.subarray(channel * rows, (channel + 1) * rows) };
    }
    const { time, place, rotation, part } = this.frames;
    const [, node, kind, axis] = data.name[channel].match(/^Node(\d+)([PR])([xyz])$/);
    const [source, factor] = kind === "P" ? [place, 1] : [rotation, 180 / Math.PI];
    const first = 3 * (Number(node) - 1) + "xyz".indexOf(axis);
    return { time, values: Float64Array.from(time, (_, row) => factor * source[3 * part.length * row + first]) };
  }

  fill() {
    const { name } = this.data;
    const usual = USUAL.map((wanted) => name.indexOf(wanted)).filter((c) => c >= 0).slice(0, 4);
    this.chosen = usual.length > 0 ? usual : [...name.keys()].slice(0, 4);
    this.nodes.hidden = this.frames === null;
    this.note.textContent = `${this.data.rows} rows` +
      (this.data.is_thinned ? "; drawn are the least and the largest value of each of equal groups of rows" : "") +
      (this.data.status && this.data.status !== "complete" ? `; the run is ${this.data.status}` : "") +
      `. At most ${MOST} channels are drawn. Drag in a plot to zoom, double-click to see all.` +
      (this.frames ? ` Click in a plot to see the turbine at that time. Channels of the nodes are drawn at ${this.frames.time.length} rows.`
        : "");
    this.list();
    this.draw();
  }

  list() {
    const { name, unit, description, own } = this.data;
    const most = this.frames && this.ofNodes.checked ? name.length : own;
    const wanted = this.filter.value.trim().toLowerCase();
    this.boxes = [];
    this.picks.replaceChildren(...[...name.keys()].slice(0, most)
      .filter((c) => `${name[c]} ${description[c]}`.toLowerCase().includes(wanted))
      .map((c) => {
        const box = make("input", { type: "checkbox", onchange: () => this.pick(c, box) });
        box.checked = this.chosen.includes(c);
        const field = labelled(`${name[c]} [${unit[c]}]`, box);
        field.title = description[c];
        return field;
      }));
  }

  pick(channel, box) {
    if (!box.checked) this.chosen = this.chosen.filter((c) => c !== channel);
    else if (this.chosen.length < MOST) this.chosen.push(channel);
    else {
      box.checked = false;
      this.told.textContent = `At most ${MOST} channels are drawn.`;
      return;
    }
    this.draw();
  }

  draw() {
    const data = this.data;
    for (const chart of this.charts) chart.destroy();
    this.plots.replaceChildren();
    this.charts = this.chosen.map((channel, number) => {
      const holder = make("div", { class: "plot", role: "img", "aria-label": `${data.name[channel]} over the time, ` +
        `${general(data.least[channel], 4)} to ${general(data.largest[channel], 4)} ${data.unit[channel]}` });
      this.plots.append(holder);
      const style = styleOf(number);
      const { time, values } = this.rowsOf(channel);
      const isLast = number === this.chosen.length - 1;
      const chart = new Chart(holder, 150, {
        scales: { x: { time: false } },
        axes: [isLast ? axis("time [s]", { size: 28 }) : axis(undefined, { size: 28, labelSize: 0 }),
               axis(`${data.name[channel]} [${data.unit[channel]}]`, { size: 70, space: 24 })],
        series: [{}, { stroke: style.colour, width: 1.2, points: { show: false } }],
        cursor: { sync: { key: "series" }, y: false },
        hooks: { setCursor: [(plot) => { if (Number.isInteger(plot.cursor.idx)) this.tell(plot.data[0][plot.cursor.idx]); }],
                 draw: [(plot) => this.markOn(plot)] },
      }, [[...time], [...values]]);
      this.listen(chart.plot);
      return chart;
    });
    this.told.textContent = "";
    const row = (c) => make("tr", {}, make("th", { scope: "row" }, data.name[c]), make("td", {}, data.unit[c]),
      [data.least, data.mean, data.largest].map((values) => make("td", {}, general(values[c], 4))),
      make("td", { class: "text" }, data.description[c]));
    this.numbers.replaceChildren(make("table", {}, make("caption", {}, "Over all rows"),
      make("thead", {}, make("tr", {}, ["channel", "unit", "least", "mean", "largest", "meaning"].map((text) =>
        make("th", { scope: "col" }, text)))), make("tbody", {}, this.chosen.map(row))));
  }

  /** A click in a diagram, and not the end of a zoom, chooses the time. */
  listen(plot) {
    if (!this.frames) return;
    let pressed = 0;
    plot.over.addEventListener("mousedown", (event) => { pressed = event.clientX; });
    plot.over.addEventListener("click", (event) => {
      if (Math.abs(event.clientX - pressed) < STILL)
        this.clock.choose(this.result, plot.posToVal(event.clientX - plot.over.getBoundingClientRect().left, "x"));
    });
  }

  mark() { for (const { plot } of this.charts) this.markOn(plot); }

  /** The line at the time of the turbine. */
  markOn(plot) {
    if (!plot.over) return;
    plot.mark ??= plot.over.appendChild(make("div", { class: "mark", hidden: true }));
    const at = this.clock.result === this.result && this.frames ? plot.valToPos(this.clock.time, "x") : NaN;
    plot.mark.hidden = !(at >= 0 && at <= plot.over.clientWidth);
    if (!plot.mark.hidden) plot.mark.style.transform = `translateX(${at}px)`;
  }

  tell(t) {
    const data = this.data;
    const valueAt = (c) => {
      const { time, values } = this.rowsOf(c);
      return values[rowAt(time, t)];
    };
    this.told.textContent = `t = ${fixed(t, 3)} s: ` + this.chosen.map((c) =>
      `${data.name[c]} ${general(valueAt(c), 4)} ${data.unit[c]}`).join(", ");
  }

  colour() { for (const { plot } of this.charts) plot.redraw(false); }
}

export function timeSeries(results, clock) {
  return results.some(({ transient }) => transient) ? new Series(results, clock) : null;
}
