// The table of modes: sorts by its heads, filters by text and frequency, chooses a mode.

import { labelled, make, section } from "./format.js";
import { columnsOf, frequencyOf, grows } from "./modes.js";
import { canMove } from "./selection.js";

class ModeTable {
  constructor(results, selection) {
    this.results = results;
    this.selection = selection;
    this.sorted = { key: "number", falls: false };
    const withModes = [...results.keys()].filter((r) => results[r].modes);
    this.which = make("select", { onchange: () => this.fill() },
      withModes.map((r) => make("option", { value: r }, `${results[r].file}: ${results[r].title}`)));
    const again = () => this.list();
    this.text = make("input", { type: "search", oninput: again, autocomplete: "off", placeholder: "name, part, remark" });
    this.from = make("input", { type: "number", min: 0, step: "any", oninput: again });
    this.to = make("input", { type: "number", min: 0, step: "any", oninput: again });
    this.air = make("input", { type: "checkbox", onchange: again });
    this.unresolved = make("input", { type: "checkbox", onchange: again });
    this.count = make("p", { class: "note", role: "status" });
    this.head = make("tr", {});
    this.body = make("tbody", {});
    this.table = make("table", { class: "modes" }, make("caption", { class: "hidden" }, "Modes"),
                      make("thead", {}, this.head), this.body);
    this.element = section("modes", "Modes",
      withModes.length > 1 ? labelled("Result", this.which, "wide") : null,
      make("div", { class: "fields" }, labelled("Filter", this.text), labelled("From [Hz]", this.from, "short"),
           labelled("to [Hz]", this.to, "short"), labelled("unresolved modes", this.unresolved),
           labelled("modes of the air", this.air)),
      this.count,
      make("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": "Table of modes" }, this.table),
      make("p", { class: "note" }, "A mode is chosen by its name. Its frequency and damping are 0 or - where the " +
           "program prints them so: the exponent counts as zero, or the rate is smaller than its error."));
    selection.addEventListener("change", () => this.mark());
    this.fill();
  }

  get result() { return Number(this.which.value); }

  fill() {
    const { modes } = this.results[this.result];
    this.columns = columnsOf(modes);
    this.air.parentElement.hidden = !modes.air.includes(1);
    this.unresolved.parentElement.hidden = !modes.resolved.includes(0);
    this.heads = new Map();
    this.head.replaceChildren(...this.columns.map((column) => {
      const button = make("button", { type: "button", onclick: () => this.sortBy(column.key) }, column.name,
                          column.unit ? make("span", { class: "unit" }, `[${column.unit}]`) : null);
      const head = make("th", { scope: "col", class: column.isText ? "text" : "" }, button);
      this.heads.set(column.key, head);
      return head;
    }));
    this.rows = modes.label.map((label, m) => {
      const cells = this.columns.map((column) => ({ column, ...column.of(m) }));
      const words = cells.filter(({ column }) => column.isText).map(({ text }) => text).join(" ").toLowerCase();
      return { m, label, cells, words, element: null };
    });
    this.list();
  }

  rowElement(row) {
    if (row.element) return row.element;
    const { modes } = this.results[this.result];
    const choose = () => this.selection.choose({ result: this.result, mode: row.m, label: row.label });
    row.element = make("tr", { "data-mode": row.m, class: grows(modes, row.m) ? "grows" : "" },
      row.cells.map(({ column, text }) => column.key === "label"
        ? make("th", { scope: "row", "data-key": column.key },
               make("button", { type: "button", "aria-pressed": "false", onclick: choose }, text))
        : make("td", { "data-key": column.key, class: column.isText ? "text" : "" }, text)));
    return row.element;
  }

  sortBy(key) {
    this.sorted = { key, falls: this.sorted.key === key && !this.sorted.falls };
    this.list();
  }

  list() {
    const { modes } = this.results[this.result];
    const wanted = this.text.value.trim().toLowerCase();
    const from = this.from.value === "" ? -Infinity : Number(this.from.value);
    const to = this.to.value === "" ? Infinity : Number(this.to.value);
    const isIn = ({ m, words }) => words.includes(wanted) && frequencyOf(modes, m) >= from && frequencyOf(modes, m) <= to &&
      (this.unresolved.checked || modes.resolved[m] === 1) &&
      (this.air.checked || modes.air[m] === 0 || grows(modes, m));
    const column = Math.max(0, this.columns.findIndex(({ key }) => key === this.sorted.key));
    const sign = this.sorted.falls ? -1 : 1;
    const valueOf = (row) => row.cells[column].value;
    const shown = this.rows.filter(isIn).sort((a, b) => {
      const [x, y] = [valueOf(a), valueOf(b)];
      if (this.columns[column].isText) return sign * x.localeCompare(y, "en", { numeric: true }) || a.m - b.m;
      if (Number.isNaN(x) || Number.isNaN(y)) return Number.isNaN(x) - Number.isNaN(y) || a.m - b.m;
      return sign * (x - y) || a.m - b.m;
    });
    for (const [key, head] of this.heads)
      if (key === this.columns[column].key) head.setAttribute("aria-sort", this.sorted.falls ? "descending" : "ascending");
      else head.removeAttribute("aria-sort");
    this.body.replaceChildren(...shown.map((row) => this.rowElement(row)));
    this.count.textContent = `${shown.length} of ${this.rows.length} modes`;
    this.mark();
  }

  mark() {
    const { result, mode } = this.selection;
    for (const element of this.body.children) {
      const isChosen = this.result === result && Number(element.dataset.mode) === mode;
      element.classList.toggle("chosen", isChosen);
      element.querySelector("button").setAttribute("aria-pressed", String(isChosen));
    }
  }
}

export function modeTable(results, selection) {
  return results.some(({ modes }) => modes) ? new ModeTable(results, selection).element : null;
}

/** The first mode that can move: the first one with a frequency, or else any. */
export function firstMode(results) {
  for (const isFine of [(modes, m) => frequencyOf(modes, m) > 0, () => true])
    for (const [result, entry] of results.entries())
      if (entry.modes)
        for (const [mode, label] of entry.modes.label.entries())
          if (canMove(entry, mode) && isFine(entry.modes, mode)) return { result, mode, label };
  return null;
}
