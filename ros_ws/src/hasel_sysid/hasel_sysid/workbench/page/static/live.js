// The running rig: what came since the last look, drawn over the last seconds.
"use strict";
const live = {
  seconds: 8, seen: {}, rows: {measured: [], simulated: [], voltage: []}, following: false,
  follow(on) { this.following = on; if (on && !this.looking) this.look(); },
  async look() {
    this.looking = true;
    while (this.following) {
      try {
        const {header, numbers} = unpack(await fetched("/data/live", this.seen));
        let at = 0;
        for (const kind of ["measured", "simulated", "voltage"]) {
          for (let k = 0; k < header.counts[kind]; k++, at += 3) this.rows[kind].push(numbers.subarray(at, at + 3));
          const rows = this.rows[kind], newest = rows.length ? rows[rows.length - 1][0] : 0;
          while (rows.length && rows[0][0] < newest - 2 * this.seconds) rows.shift();
          this.seen[kind] = header.seen[kind];
        }
        this.draw();
        const error = header.error === null ? "" :
          ` · mean |Δ sin θ| ${header.error.toFixed(4)} in this run, ${header.recent.toFixed(4)} in the last ${header.window} s`;
        document.getElementById("wb-live-said").textContent = header.said + error;
      } catch (error) { document.getElementById("wb-live-said").textContent = error.message; }
      await new Promise(done => setTimeout(done, 60));
    }
    this.looking = false;
  },
  draw() {
    const {pen, width, height} = sized(document.getElementById("wb-live"));
    const newest = Math.max(0, ...["measured", "simulated", "voltage"].map(kind => {
      const rows = this.rows[kind];
      return rows.length ? rows[rows.length - 1][0] : 0;
    }));
    const from = newest - this.seconds, x = t => 50 + (width - 60) * (t - from) / this.seconds;
    const angles = range([this.rows.measured.map(row => row[1]), this.rows.simulated.map(row => row[1])]);
    const upper = panel(isFinite(angles[0]) ? angles : [-0.3, 0.3], 8, 0.7 * height);
    const volts = this.rows.voltage.map(row => Math.max(Math.abs(row[1]), Math.abs(row[2])));
    const lower = panel([0, Math.max(1000, ...volts)], 0.76 * height, height - 18);
    const line = (rows, column, y, colour, steps) => {
      pen.strokeStyle = colour; pen.lineWidth = 1.6; pen.beginPath();
      let last = null;
      for (const row of rows) {
        if (row[0] < from || row[column] !== row[column]) { last = null; continue; }
        if (last && steps) pen.lineTo(x(row[0]), y(Math.abs(last[column])));
        const value = steps ? Math.abs(row[column]) : row[column];
        last && row[0] > last[0] && row[0] - last[0] < 0.5 ? pen.lineTo(x(row[0]), y(value)) : pen.moveTo(x(row[0]), y(value));
        last = row;
      }
      pen.stroke();
    };
    line(this.rows.voltage, 1, lower, colourOf("--wb-fitted"), true);
    line(this.rows.voltage, 2, lower, colourOf("--wb-unseen"), true);
    line(this.rows.simulated, 1, upper, colourOf("--wb-model"), false);
    pen.fillStyle = colourOf("--wb-measured");
    for (const [t, value] of this.rows.measured) if (t >= from && value === value) pen.fillRect(x(t) - 1.3, upper(value) - 1.3, 2.6, 2.6);
    pen.fillStyle = colourOf("--wb-soft"); pen.font = "12px system-ui, sans-serif"; pen.textAlign = "right";
    for (const value of ticks(upper.low, upper.high, 4)) pen.fillText(+value.toPrecision(2), 44, upper(value) + 4);
    for (const value of ticks(lower.low, lower.high, 2)) pen.fillText(`${value} V`, 44, lower(value) + 4);
  },
};
