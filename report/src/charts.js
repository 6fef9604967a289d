// uPlot in the colours of the page.

import uPlot from "uplot";

import { colourOf, general } from "./format.js";

const FONT = "12px system-ui, sans-serif";

export function axis(label, more = {}) {
  return { label, labelSize: 22, size: more.size ?? 46, font: FONT, labelFont: FONT, stroke: () => colourOf("--ink"),
           grid: { stroke: () => colourOf("--grid"), width: 1 }, ticks: { stroke: () => colourOf("--grid"), width: 1, size: 5 },
           values: (plot, splits) => splits.map((value) => (value === null ? "" : general(value, 6))), space: 34, ...more };
}

export class Chart {
  /** A chart that fills the width of its holder. */
  constructor(holder, height, options, data) {
    this.holder = holder;
    this.height = height;
    this.plot = new uPlot({ width: this.width, height, legend: { show: false }, ...options }, data, holder);
    this.observer = new ResizeObserver(() => {
      if (this.width > 0 && this.width !== this.plot.width) this.plot.setSize({ width: this.width, height });
    });
    this.observer.observe(holder);
  }

  get width() { return Math.max(0, Math.floor(this.holder.clientWidth)); }

  destroy() {
    this.observer.disconnect();
    this.plot.destroy();
  }
}
