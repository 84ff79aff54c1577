// The running rig: what came since the last look, drawn over the last seconds.
"use strict";
const live = {
  seconds: 8, least: 0.05, left: 58, seen: {}, rows: {measured: [], simulated: [], voltage: []}, following: false,
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
        this.say("wb-live-said", header.said);
        for (const name of ["error", "recent"]) this.say(`wb-live-${name}`, header[name] === null ? "–" : header[name].toFixed(4));
      } catch (error) { this.say("wb-live-said", error.message); }
      await new Promise(done => setTimeout(done, 60));
    }
    this.looking = false;
  },
  say(place, text) {  // a screen reader reads what is set, changed or not
    const each = document.getElementById(place);
    if (each && each.textContent !== text) each.textContent = text;
  },
  draw() {
    const {pen, width, height} = sized(document.getElementById("wb-live"));
    const newest = Math.max(0, ...["measured", "simulated", "voltage"].map(kind => {
      const rows = this.rows[kind];
      return rows.length ? rows[rows.length - 1][0] : 0;
    }));
    const from = newest - this.seconds, x = t => this.left + (width - this.left - 12) * (t - from) / this.seconds;
    const shown = kind => this.rows[kind].filter(row => row[0] >= from);
    const [low, high] = range([shown("measured").map(row => row[1]), shown("simulated").map(row => row[1])]);
    const upper = panel([Math.min(low, -this.least), Math.max(high, this.least)], 8, 0.62 * height);
    const volts = shown("voltage").flatMap(row => [Math.abs(row[1]), Math.abs(row[2])]).filter(isFinite);
    const lower = panel([0, Math.max(1000, 1.07 * Math.max(0, ...volts))], 0.68 * height, height - 34);
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
    line(this.rows.voltage, 1, lower, colourOf("--wb-upper"), true);
    line(this.rows.voltage, 2, lower, colourOf("--wb-lower"), true);
    line(this.rows.simulated, 1, upper, colourOf("--wb-model"), false);
    pen.fillStyle = colourOf("--wb-dots");
    for (const [t, value] of this.rows.measured) if (t >= from && value === value) pen.fillRect(x(t) - 1.3, upper(value) - 1.3, 2.6, 2.6);
    this.axes(pen, width, height, upper, lower, ago => x(newest + ago));
  },
  axes(pen, width, height, upper, lower, x) {
    pen.fillStyle = pen.strokeStyle = colourOf("--wb-soft"); pen.font = "12px system-ui, sans-serif"; pen.lineWidth = 1;
    pen.textAlign = "right";
    for (const [y, most] of [[upper, 5], [lower, 3]]) {
      pen.strokeRect(this.left + 0.5, y(y.high), width - this.left - 12, y(y.low) - y(y.high));
      for (const value of ticks(y.low, y.high, most)) pen.fillText(+value.toPrecision(3), this.left - 6, y(value) + 4);
    }
    pen.textAlign = "center";
    for (const ago of ticks(-this.seconds, 0, 8)) pen.fillText(+ago.toFixed(3), x(ago), height - 18);
    pen.fillText("time from now [s]", (this.left + width - 12) / 2, height - 3);
    for (const [y, name] of [[upper, "sin θ"], [lower, "drive [V]"]]) {
      pen.save(); pen.translate(12, (y(y.low) + y(y.high)) / 2); pen.rotate(-Math.PI / 2); pen.fillText(name, 0, 0); pen.restore();
    }
  },
};
