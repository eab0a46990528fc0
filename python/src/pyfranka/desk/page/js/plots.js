// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Plots of the last 30 s by uPlot, with a legend of buttons, for use by keyboard.
import { el, setText } from "./dom.js";
import { number } from "./format.js";
import { SPAN } from "./history.js";
import { color, onColors } from "./theme.js";

const PERIOD = 200; // [ms] between two drawings
const HEIGHT = 190; // [px]

let library; // of uPlot, or null if it is not installed
async function loadLibrary() {
  if (library === undefined) {
    try {
      library = (await import("../vendor/uplot/uPlot.esm.js")).default;
    } catch {
      library = null;
    }
  }
  return library;
}

export class Plot {
  /** series: names of its lines. read: name of the history's values. */
  constructor({ title, unit, read, series }) {
    Object.assign(this, { title, unit, read, series });
    this.shown = series.map(() => true);
    this.drawn = 0;
    this.values = [];
    this.canvas = el("div", { class: "plot-canvas", role: "img", "aria-label": `${title} of the last ${SPAN} s, as lines` });
    this.element = el(
      "section", { class: "card plot" },
      el("div", { class: "plot-title" }, el("h3", { text: `${title} [${unit}]` }), this.makeLegend()),
      this.canvas,
    );
    this.isSeen = false;
    new IntersectionObserver(([entry]) => (this.isSeen = entry.isIntersecting)).observe(this.element);
    loadLibrary().then((uPlot) => this.begin(uPlot));
  }

  makeLegend() {
    const entries = this.series.map((name, i) => {
      const value = el("span", { class: "value", text: "–" });
      this.values.push(value);
      return el(
        "button",
        { type: "button", class: "legend", "aria-pressed": "true", data: { line: i + 1 }, on: { click: (event) => this.toggle(i, event.currentTarget) } },
        el("span", { class: "swatch" }), name, value,
      );
    });
    return el("div", { class: "legends", role: "group", "aria-label": `Lines of ${this.title}` }, ...entries);
  }

  toggle(i, button) {
    this.shown[i] = !this.shown[i];
    button.setAttribute("aria-pressed", String(this.shown[i]));
    this.plot?.setSeries(i + 1, { show: this.shown[i] });
  }

  begin(uPlot) {
    if (!uPlot) {
      this.canvas.textContent = "The plots need uPlot, which is not installed: run ./franka install.";
      return;
    }
    this.make = () => {
      this.plot?.destroy();
      this.canvas.replaceChildren();
      this.plot = new uPlot(this.options(), [[0], ...this.series.map(() => [0])], this.canvas);
    };
    this.make();
    onColors(() => this.make());
    new ResizeObserver(() => this.plot.setSize({ width: Math.max(200, this.canvas.clientWidth), height: HEIGHT })).observe(this.canvas);
  }

  options() {
    const axis = {
      stroke: color("--muted"), font: "12px system-ui, sans-serif",
      grid: { stroke: color("--line"), width: 1 }, ticks: { show: false },
    };
    return {
      width: Math.max(200, this.canvas.clientWidth),
      height: HEIGHT,
      legend: { show: false },
      cursor: { show: false },
      scales: { x: { time: false, range: [-SPAN, 0] }, y: { range: (plot, low, high) => padded(low, high) } },
      axes: [
        { ...axis, size: 28, values: (plot, ticks) => ticks.map((tick) => (tick ? `${number(tick, 0)} s` : "now")) },
        { ...axis, size: 44, values: (plot, ticks) => ticks.map((tick) => number(tick, Math.abs(tick) < 10 && tick % 1 ? 1 : 0)) },
      ],
      series: [
        {},
        ...this.series.map((name, i) => ({ label: name, stroke: color(`--line-${i + 1}`), width: 1.6, show: this.shown[i], points: { show: false } })),
      ],
    };
  }

  update(robot) {
    const now = performance.now();
    if (!robot.report || now - this.drawn < PERIOD || document.hidden || !this.isSeen) return;
    this.drawn = now;
    const rows = robot.history.rows[this.read];
    this.values.forEach((value, i) => setText(value, number(rows.at(-1)[i], 1)));
    this.plot?.setData(robot.history.columns(this.read, this.series.length));
  }
}

// At least 2 units high, so that noise does not fill the plot.
function padded(low, high) {
  if (!Number.isFinite(low) || !Number.isFinite(high)) return [-1, 1];
  const margin = Math.max(1, 0.1 * (high - low));
  return [low - margin, high + margin];
}

export const torquePlot = () =>
  new Plot({ title: "Joint torques", unit: "Nm", read: "torque", series: [1, 2, 3, 4, 5, 6, 7].map((joint) => `J${joint}`) });
export const externalPlot = () =>
  new Plot({ title: "External torques", unit: "Nm", read: "external", series: [1, 2, 3, 4, 5, 6, 7].map((joint) => `J${joint}`) });
export const forcePlot = () =>
  new Plot({ title: "External force at the hand", unit: "N", read: "force", series: ["x", "y", "z"] });
