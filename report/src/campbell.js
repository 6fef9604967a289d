// The Campbell diagram: frequency and damping of the modes over the swept value. Pointing at a line names its mode, a
// click chooses it; the list of modes does the same for the keyboard.

import { Chart, axis } from "./charts.js";
import { colourOf, fixed, general, labelled, make, section, styleOf } from "./format.js";
import { canMove, findMode } from "./selection.js";

const ORDERS = [1, 2, 3, 4, 5, 6, 9, 12];
const LEAST_SHARE = 0.05;
const REACH = 30; // pixels from a point that the pointer finds

class Campbell {
  constructor(results, selection) {
    this.results = results;
    this.selection = selection;
    const withLines = [...results.keys()].filter((r) => results[r].campbell?.mode.length);
    const again = () => this.build();
    this.which = make("select", { onchange: again },
      withLines.map((r) => make("option", { value: r }, `${results[r].file}: ${results[r].title}`)));
    this.frame = make("select", { onchange: again }, make("option", { value: "fixed" }, "fixed frame"),
                      make("option", { value: "own" }, "frame of the part that moves"));
    this.most = make("select", { onchange: again }, ["14", "28", "all"].map((n) => make("option", { value: n }, n)));
    this.ceiling = make("select", { onchange: again }, ["", "50", "20", "10", "5", "2"].map((n) =>
      make("option", { value: n }, n ? `up to ${n} %` : "all")));
    this.above = make("div", { class: "plot", id: "campbell-frequency" });
    this.below = make("div", { class: "plot", id: "campbell-damping" });
    this.list = make("ul", { class: "lines", "aria-label": "Modes of the diagram" });
    this.tip = make("div", { class: "tip", hidden: true });
    this.told = make("p", { class: "told", role: "status" });
    this.note = make("p", { class: "note" });
    this.numbers = make("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": "Numbers of the diagram" });
    this.diagrams = make("div", { class: "diagrams" }, this.above, this.below, this.tip);
    this.element = section("campbell", "Campbell diagram",
      make("div", { class: "fields" }, withLines.length > 1 ? labelled("Result", this.which, "wide") : null,
           labelled("Frequencies in the", this.frame), labelled("Modes", this.most), labelled("Damping", this.ceiling)),
      this.diagrams, this.told, this.list, this.note,
      make("details", {}, make("summary", {}, "Numbers"), this.numbers));
    selection.addEventListener("change", () => this.show(this.lineOf(selection.label)));
  }

  get data() { return this.results[Number(this.which.value)].campbell; }

  /** Values of a line: row of an array [mode, value]. */
  row(array, line) { return array.subarray(line * this.count, (line + 1) * this.count); }

  build() {
    const data = this.data;
    this.count = data.value.length;
    this.values = [...data.value];
    const pointsOf = (line) => this.row(data.frequency_hz, line).filter(Number.isFinite).length;
    const found = data.mode.map((_, line) => line).filter((line) => pointsOf(line) > (this.count > 1 ? 1 : 0));
    this.lines = found.slice(0, this.most.value === "all" ? found.length : Number(this.most.value));
    this.frequencies = this.lines.map((line) => {
      const [own, ground] = [this.row(data.frequency_hz, line), this.row(data.fixed_frame_frequency_hz, line)];
      const isFixed = this.frame.value === "fixed" && 2 * ground.filter(Number.isFinite).length >= pointsOf(line);
      return [...(isFixed ? ground : own)].map((value) => (Number.isFinite(value) ? value : null));
    });
    this.dampings = this.lines.map((line) =>
      [...this.row(data.damping_ratio, line)].map((value) => (Number.isFinite(value) ? 100 * value : null)));
    this.shown = -1;
    this.point = -1;
    this.draw();
    this.fillList();
    this.fillNumbers();
    this.note.textContent = (found.length > this.lines.length ? `${found.length - this.lines.length} more modes are not drawn. ` : "") +
      (data.status && data.status !== "complete" ? `The sweep is ${data.status}. ` : "") +
      "Grey: multiples of the rotor speed. Crosses: a point at which the mode grows by more than its error.";
    this.show(this.lineOf(this.selection.label));
  }

  draw() {
    const data = this.data;
    const key = data.unit ? `${data.key} [${data.unit}]` : data.key;
    // A point that has failed has no speed.
    const turns = [...data.rotor_speed].map((speed) => (Number.isFinite(speed) ? speed / (2 * Math.PI) : null));
    const known = turns.filter((turn) => turn !== null);
    const top = Math.max(...this.frequencies.flat().filter((value) => value !== null)) || 1;
    const orders = ORDERS.filter((order) => order * Math.max(...known) > 0 && order * Math.min(...known) < 1.05 * top);
    const series = this.lines.map((line, number) => {
      const style = styleOf(number);
      return { label: data.mode[line], stroke: style.colour, dash: style.dash, width: 1.8, spanGaps: false,
               points: { show: true, size: 5, fill: style.colour, stroke: style.colour } };
    });
    const grey = orders.map(() => ({ stroke: () => colourOf("--muted"), width: 0.7, points: { show: false } }));
    const branches = this.lines.map(() => ({ stroke: () => colourOf("--ink"), width: 1, dash: [2, 2], points: { show: false } }));
    for (const chart of [this.high, this.low]) chart?.destroy();
    const drawMore = (heights, named) => (plot) => {
      const pixels = devicePixelRatio;
      const { ctx } = plot;
      ctx.save();
      ctx.lineWidth = 2 * pixels;
      ctx.strokeStyle = colourOf("--growing");
      for (const [number, line] of this.lines.entries())
        for (let i = 0; i < this.count; ++i)
          if (this.row(data.is_growing, line)[i] === 1 && heights[number][i] !== null) {
            const [x, y] = [plot.valToPos(this.values[i], "x", true), plot.valToPos(heights[number][i], "y", true)];
            const arm = 4 * pixels;
            ctx.beginPath();
            ctx.moveTo(x - arm, y - arm); ctx.lineTo(x + arm, y + arm);
            ctx.moveTo(x - arm, y + arm); ctx.lineTo(x + arm, y - arm);
            ctx.stroke();
          }
      if (named) {
        ctx.fillStyle = colourOf("--muted");
        ctx.font = `${11 * pixels}px system-ui, sans-serif`;
        ctx.textAlign = "left";
        ctx.textBaseline = "middle";
        const last = this.count - 1;
        for (const order of orders) {
          const height = order * turns[last];
          if (turns[last] !== null && height <= 1.06 * top)
            ctx.fillText(`${order}P`, plot.valToPos(this.values[last], "x", true) + 6 * pixels, plot.valToPos(height, "y", true));
        }
      }
      const point = this.shown >= 0 && this.point >= 0 ? heights[this.shown][this.point] : null;
      if (point !== null) {
        ctx.strokeStyle = colourOf("--ink");
        ctx.beginPath();
        ctx.arc(plot.valToPos(this.values[this.point], "x", true), plot.valToPos(point, "y", true), 7 * pixels, 0, 7);
        ctx.stroke();
      }
      ctx.restore();
    };
    const make = (holder, heights, label, named, range, more, moreData) => new Chart(holder, 380, {
      scales: { x: { time: false, range: this.count > 1 ? undefined : [this.values[0] - 1, this.values[0] + 1] }, y: { range } },
      padding: [12, named ? 34 : 12, 0, 0],
      axes: [axis(key, { size: 28 }), axis(label, { size: 52 })],
      series: [{}, ...series, ...more],
      cursor: { drag: { x: false, y: false }, points: { show: false }, x: true, y: false, focus: { prox: -1 } },
      focus: { alpha: 0.3 },
      hooks: { draw: [drawMore(heights, named)] },
    }, [this.values, ...heights, ...moreData]);
    const blank = this.values.map(() => null);
    this.branches = this.lines.map(() => [...blank]);
    this.high = make(this.above, this.frequencies,
                     `frequency [Hz], ${this.frame.value === "fixed" ? "fixed frame" : "frame of the part"}`, true,
                     [0, 1.08 * top], [...grey, ...branches],
                     [...orders.map((order) => turns.map((turn) => (turn === null ? null : order * turn))), ...this.branches]);
    const dampings = this.dampings.flat().filter((value) => value !== null);
    const [least, largest] = [Math.min(0, ...dampings), Math.max(0, ...dampings)];
    const margin = 0.06 * (largest - least || 1);
    const ceiling = this.ceiling.value === "" ? largest + margin : Number(this.ceiling.value);
    this.low = make(this.below, this.dampings, "damping ratio [%]", false, [least < 0 ? Math.max(least - margin, -ceiling) : 0, ceiling],
                    [{ stroke: () => colourOf("--muted"), width: 1, points: { show: false } }], [this.values.map(() => 0)]);
    for (const [chart, heights] of [[this.high, this.frequencies], [this.low, this.dampings]]) {
      const area = chart.plot.over;
      area.addEventListener("mousemove", (event) => this.pointAt(chart.plot, heights, event));
      area.addEventListener("mouseleave", () => this.leave());
      area.addEventListener("click", (event) => {
        this.pointAt(chart.plot, heights, event);
        if (this.hovered >= 0) this.choose(this.hovered);
      });
    }
  }

  pointAt(plot, heights, event) {
    const box = plot.over.getBoundingClientRect();
    const [x, y] = [event.clientX - box.left, event.clientY - box.top];
    let best = { distance: REACH, number: -1, point: -1 };
    for (const [number, row] of heights.entries())
      for (let i = 0; i < this.count; ++i) {
        if (row[i] === null) continue;
        const here = [plot.valToPos(this.values[i], "x"), plot.valToPos(row[i], "y")];
        const near = (distance, point) => { if (distance < best.distance) best = { distance, number, point }; };
        near(Math.hypot(x - here[0], y - here[1]), i);
        if (i + 1 < this.count && row[i + 1] !== null) {
          const next = [plot.valToPos(this.values[i + 1], "x"), plot.valToPos(row[i + 1], "y")];
          const along = ((x - here[0]) * (next[0] - here[0]) + (y - here[1]) * (next[1] - here[1])) /
                        ((next[0] - here[0]) ** 2 + (next[1] - here[1]) ** 2 || 1);
          if (along > 0 && along < 1)
            near(Math.hypot(x - here[0] - along * (next[0] - here[0]), y - here[1] - along * (next[1] - here[1])),
                 along < 0.5 ? i : i + 1);
        }
      }
    this.hovered = best.number;
    if (best.number < 0) return this.leave();
    this.show(best.number, best.point);
    this.tip.hidden = false;
    this.tip.textContent = this.words(best.number, best.point);
    const frame = this.diagrams.getBoundingClientRect();
    const left = event.clientX - frame.left;
    this.tip.style.left = `${Math.max(4, Math.min(left + 14, frame.width - this.tip.offsetWidth - 4))}px`;
    this.tip.style.top = `${event.clientY - frame.top + 16}px`;
  }

  leave() {
    this.hovered = -1;
    this.tip.hidden = true;
    this.show(this.lineOf(this.selection.label));
  }

  words(number, point) {
    const data = this.data;
    const line = this.lines[number];
    const ground = this.row(data.fixed_frame_frequency_hz, line)[point];
    const unit = data.unit ? ` ${data.unit}` : "";
    return `${data.mode[line]}: ${data.key} ${general(this.values[point], 6)}${unit}, ` +
      `${fixed(this.row(data.frequency_hz, line)[point], 4)} Hz` +
      (Number.isFinite(ground) ? `, fixed frame ${fixed(ground, 4)} Hz` : "") +
      `, damping ${fixed(100 * this.row(data.damping_ratio, line)[point], 3)} %` +
      (this.row(data.is_growing, line)[point] === 1 ? ", grows" : "");
  }

  lineOf(label) { return label === null ? -1 : this.lines?.findIndex((line) => this.data.mode[line] === label) ?? -1; }

  /** Shows a line, and a point of it, before the others; -1: all alike. */
  show(number, point = -1, isPointed = false) {
    if (!this.high) return;
    if (number === this.shown && point === this.point && isPointed === this.isPointed) return;
    this.isPointed = isPointed;
    this.shown = number;
    this.point = point;
    if (point >= 0) this.told.textContent = this.words(number, point);
    else this.told.textContent = number >= 0 ? this.chosenWords(number) : "";
    for (const [n, button] of this.buttons.entries()) button.classList.toggle("shown", n === number);
    this.drawBranches();
    // Pointing puts the others back; a choice alone makes its line wide.
    for (const { plot } of [this.high, this.low]) {
      for (const n of this.lines.keys()) plot.series[n + 1].width = n === number ? 3.4 : 1.8;
      plot.setSeries(number >= 0 && (point >= 0 || isPointed) ? number + 1 : null, { focus: true });
      plot.redraw(false);
    }
  }

  chosenWords(number) {
    const label = this.data.mode[this.lines[number]];
    if (label !== this.selection.label) return label;
    const found = this.selection.mode !== null ? this.selection : null;
    return found && canMove(this.results[found.result], found.mode) ? `${label}: the turbine moves in this mode`
      : `${label}: no result of modes on this page has a shape of this name`;
  }

  /** In its own frame, the further harmonics of the line that is shown. */
  drawBranches() {
    const data = this.data;
    const plot = this.high.plot;
    const first = plot.data.length - this.lines.length;
    const rows = this.lines.map(() => this.values.map(() => null));
    if (this.frame.value === "own" && this.shown >= 0) {
      const line = this.lines[this.shown];
      let used = 0;
      for (const [column, k] of data.harmonic.entries()) {
        const shares = this.values.map((_, i) => data.participation[(line * this.count + i) * data.harmonic.length + column]);
        if (k === 0 || !shares.some((share) => share >= LEAST_SHARE) || used >= rows.length) continue;
        rows[used++] = this.values.map((_, i) => (shares[i] >= LEAST_SHARE && this.frequencies[this.shown][i] !== null
          ? Math.abs(this.frequencies[this.shown][i] + k * data.rotor_speed[i] / (2 * Math.PI)) : null));
      }
    }
    plot.setData([...plot.data.slice(0, first), ...rows], false);
  }

  choose(number) {
    const label = this.data.mode[this.lines[number]];
    const found = findMode(this.results, label);
    this.shown = -2; // shows it anew
    this.selection.choose(found ?? { label });
    this.told.textContent = this.chosenWords(number);
  }

  fillList() {
    const data = this.data;
    this.buttons = this.lines.map((line, number) => {
      const style = styleOf(number);
      const dash = style.dash.length ? style.dash.join(" ") : "none";
      const sample = document.createElementNS("http://www.w3.org/2000/svg", "svg");
      sample.setAttribute("class", "sample");
      sample.setAttribute("aria-hidden", "true");
      sample.setAttribute("viewBox", "0 0 28 8");
      const stroke = document.createElementNS("http://www.w3.org/2000/svg", "line");
      for (const [name, value] of Object.entries({ x1: 0, x2: 28, y1: 4, y2: 4, "stroke-width": 2.5, "stroke-dasharray": dash }))
        stroke.setAttribute(name, value);
      stroke.style.stroke = `var(${style.variable})`;
      sample.append(stroke);
      const points = this.frequencies[number].map((value, i) => (value === null ? -1 : i)).filter((i) => i >= 0);
      let at = 0;
      return make("button", { type: "button", "aria-describedby": "campbell-keys",
        onclick: () => this.choose(number),
        onfocus: () => this.show(number, points[at] ?? -1),
        onblur: () => this.leave(),
        onmouseenter: () => this.show(number, -1, true),
        onmouseleave: () => this.leave(),
        onkeydown: (event) => {
          const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
          if (step === undefined || points.length === 0) return;
          event.preventDefault();
          at = (at + step + points.length) % points.length;
          this.show(number, points[at]);
        } }, sample, data.mode[line]);
    });
    this.list.replaceChildren(...this.buttons.map((button) => make("li", {}, button)));
    this.keys ??= make("p", { class: "note", id: "campbell-keys" },
                       "Keyboard: Tab to a mode, left and right arrows for its points, Enter chooses it.");
    this.list.after(this.keys);
  }

  fillNumbers() {
    const data = this.data;
    const unit = data.unit ? ` [${data.unit}]` : "";
    const table = (caption, rows, digits) => make("table", {}, make("caption", {}, caption),
      make("thead", {}, make("tr", {}, make("th", { scope: "col" }, data.key + unit),
           this.values.map((value) => make("th", { scope: "col" }, general(value, 6))))),
      make("tbody", {}, this.lines.map((line, number) => make("tr", {}, make("th", { scope: "row" }, data.mode[line]),
           rows[number].map((value) => make("td", {}, value === null ? "-" : fixed(value, digits)))))));
    this.numbers.replaceChildren(table("Frequency [Hz], as drawn", this.frequencies, 4), table("Damping ratio [%]", this.dampings, 3));
  }

  /** Place of a point in the window, for those who point at it without eyes. */
  place(label, point) {
    const number = this.lineOf(label);
    const { plot } = this.high;
    const box = plot.over.getBoundingClientRect();
    return { x: box.left + plot.valToPos(this.values[point], "x"), y: box.top + plot.valToPos(this.frequencies[number][point], "y") };
  }
}

export function campbellDiagram(results, selection) {
  return results.some(({ campbell }) => campbell?.mode.length) ? new Campbell(results, selection) : null;
}
