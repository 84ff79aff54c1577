// Measured and simulated sin θ of one run over time, and below what is left; a cursor where the body is.
"use strict";
class CurveView {
  constructor(canvas, onSeek) {
    this.canvas = canvas; this.data = null; this.span = null; this.mark = null; this.foretold = null;
    const seek = event => this.data && onSeek(this.timeAt(event.offsetX));
    canvas.addEventListener("pointerdown", event => { canvas.setPointerCapture(event.pointerId); seek(event); });
    canvas.addEventListener("pointermove", event => { if (event.buttons) seek(event); });
    canvas.addEventListener("dblclick", () => { this.span = null; this.draw(this.time || 0); });
  }
  show({header, numbers}) {
    const rows = header.rows.map((_, k) => numbers.subarray(k * header.frames, (k + 1) * header.frames));
    this.data = {...header, series: Object.fromEntries(header.rows.map((name, k) => [name, rows[k]]))};
    this.foretold = null;
  }
  get whole() { const time = this.data.series.time; return [time[0], time[time.length - 1]]; }
  timeAt(x) {
    const [from, to] = this.span || this.whole;
    return from + (to - from) * Math.min(1, Math.max(0, (x - 54) / (this.canvas.clientWidth - 66)));
  }
  draw(time) {
    this.time = time;
    const {pen, width, height} = sized(this.canvas);
    if (!this.data) return;
    const {series} = this.data, [from, to] = this.span || this.whole;
    const box = {left: 54, right: width - 12, top: 10, low: Math.round(0.66 * height), gap: 14, bottom: height - 34};
    const x = t => box.left + (box.right - box.left) * (t - from) / (to - from);
    const model = this.foretold ? this.foretold.series : series.simulated;
    const left = residual(series.measured, model), before = series.before && residual(series.measured, series.before);
    const upper = panel(range([series.measured, series.simulated, series.before, model]), box.top, box.low);
    const lower = panel(range([left, before]), box.low + box.gap, box.bottom);
    pen.save();
    pen.beginPath(); pen.rect(box.left, box.top, box.right - box.left, box.bottom - box.top); pen.clip();
    for (const [begin, end, channel] of this.data.driven) {
      pen.fillStyle = channel ? this.tints[1] : this.tints[0];
      pen.fillRect(x(begin), box.top, x(end) - x(begin), box.bottom - box.top);
    }
    if (this.mark) {
      pen.fillStyle = this.marked;
      pen.fillRect(x(this.mark[0]), box.top, x(this.mark[1]) - x(this.mark[0]), box.bottom - box.top);
    }
    this.zero(pen, box, lower);
    if (before) this.line(pen, series.time, before, x, lower, this.earlier, 1.2, [4, 3]);
    this.line(pen, series.time, left, x, lower, this.model, 1.4, this.foretold && !this.foretold.true ? [6, 3] : []);
    this.dots(pen, series.time, series.measured, x, upper);
    if (series.before) this.line(pen, series.time, series.before, x, upper, this.earlier, 1.2, [4, 3]);
    this.line(pen, series.time, model, x, upper, this.model, 1.8, this.foretold && !this.foretold.true ? [6, 3] : []);
    pen.strokeStyle = this.ink; pen.lineWidth = 1.2;
    pen.beginPath(); pen.moveTo(x(time), box.top); pen.lineTo(x(time), box.bottom); pen.stroke();
    pen.restore();
    this.axes(pen, box, x, upper, lower, from, to);
  }
  line(pen, time, values, x, y, colour, thick, dash) {
    pen.strokeStyle = colour; pen.lineWidth = thick; pen.setLineDash(dash); pen.beginPath();
    let drawing = false;
    for (let k = 0; k < time.length; k++) {
      if (values[k] !== values[k]) { drawing = false; continue; }
      drawing ? pen.lineTo(x(time[k]), y(values[k])) : pen.moveTo(x(time[k]), y(values[k]));
      drawing = true;
    }
    pen.stroke(); pen.setLineDash([]);
  }
  dots(pen, time, values, x, y) {
    pen.fillStyle = this.measured;
    for (let k = 0; k < time.length; k++) {
      if (values[k] === values[k]) pen.fillRect(x(time[k]) - 1.4, y(values[k]) - 1.4, 2.8, 2.8);
    }
  }
  zero(pen, box, y) {
    pen.strokeStyle = this.grid; pen.lineWidth = 1;
    pen.beginPath(); pen.moveTo(box.left, y(0)); pen.lineTo(box.right, y(0)); pen.stroke();
  }
  axes(pen, box, x, upper, lower, from, to) {
    pen.fillStyle = pen.strokeStyle = this.soft; pen.font = "12px system-ui, sans-serif"; pen.lineWidth = 1;
    pen.strokeRect(box.left + 0.5, box.top + 0.5, box.right - box.left, box.low - box.top);
    pen.strokeRect(box.left + 0.5, box.low + box.gap + 0.5, box.right - box.left, box.bottom - box.low - box.gap);
    pen.textAlign = "right";
    for (const y of [upper, lower]) for (const value of ticks(y.low, y.high, y === upper ? 5 : 3)) {
      pen.fillText(+value.toPrecision(3), box.left - 6, y(value) + 4);
    }
    pen.textAlign = "center";
    for (const t of ticks(from, to, 8)) pen.fillText(+t.toPrecision(4), x(t), box.bottom + 15);
    pen.fillText("time [s]", (box.left + box.right) / 2, box.bottom + 30);
    pen.save(); pen.translate(12, (box.top + box.low) / 2); pen.rotate(-Math.PI / 2); pen.fillText("sin θ", 0, 0); pen.restore();
    pen.save(); pen.translate(12, (box.low + box.gap + box.bottom) / 2); pen.rotate(-Math.PI / 2); pen.fillText("residual", 0, 0); pen.restore();
  }
  dress() {
    this.ink = colourOf("--wb-ink"); this.soft = colourOf("--wb-soft"); this.grid = colourOf("--wb-line");
    this.model = colourOf("--wb-model"); this.measured = colourOf("--wb-dots"); this.earlier = colourOf("--wb-earlier");
    this.tints = [colourOf("--wb-tint-1"), colourOf("--wb-tint-2")]; this.marked = colourOf("--wb-mark");
  }
}
function residual(measured, simulated) {
  const out = new Float32Array(measured.length);
  let sum = 0, count = 0;
  for (let k = 0; k < out.length; k++) {
    out[k] = measured[k] - simulated[k];
    if (out[k] === out[k]) { sum += out[k]; count++; }
  }
  for (let k = 0; k < out.length; k++) out[k] -= sum / (count || 1);
  return out;
}
function range(all) {
  let low = Infinity, high = -Infinity;
  for (const values of all) if (values) for (const value of values) {
    if (value < low) low = value;
    if (value > high) high = value;
  }
  const margin = 0.07 * (high - low) || 0.01;
  return [low - margin, high + margin];
}
function panel([low, high], top, bottom) {
  const place = value => bottom - (bottom - top) * (value - low) / (high - low);
  place.low = low; place.high = high;
  return place;
}
function ticks(low, high, most) {
  const rough = (high - low) / most, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map(each => each * power).find(each => each >= rough);
  const found = [];
  for (let value = Math.ceil(low / step) * step; value <= high + 1e-9 * step; value += step) found.push(value);
  return found;
}
