// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The last 30 s of a robot's values, for the plots.

export const SPAN = 30; // [s]
const MAX_SAMPLES = 1500; // samples

export const SERIES = {
  torque: (report) => report.tau_J,
  external: (report) => report.tau_ext,
  force: (report) => report.O_F_ext,
};

export class History {
  constructor() {
    this.times = [];
    this.rows = Object.fromEntries(Object.keys(SERIES).map((name) => [name, []]));
  }

  /** time: of the browser [s]; the simulation's own may stand still. */
  add(time, report) {
    this.times.push(time);
    for (const [name, read] of Object.entries(SERIES)) this.rows[name].push(read(report));
    let old = 0;
    while (old < this.times.length && (this.times[old] < time - SPAN || this.times.length - old > MAX_SAMPLES)) old += 1;
    if (old > 0) {
      this.times.splice(0, old);
      for (const rows of Object.values(this.rows)) rows.splice(0, old);
    }
  }

  /** Columns for uPlot: seconds before now, then `count` lines. */
  columns(name, count) {
    const now = this.times.at(-1) ?? 0;
    const columns = [this.times.map((time) => time - now)];
    for (let i = 0; i < count; i++) columns.push(this.rows[name].map((row) => row[i]));
    return columns;
  }
}
