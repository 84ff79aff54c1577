// The moving body: elements coloured by strain or contraction, simulated and measured markers over it.
"use strict";
class BodyView {
  constructor(canvas) { this.canvas = canvas; this.film = null; this.colourBy = "strain"; }
  show({header, numbers}) {
    const film = this.film = {...header, numbers};
    film.at = {contraction: 1, simulated: 1 + film.muscles, measured: 7 + film.muscles, nodes: 13 + film.muscles};
    film.at.strain = film.at.nodes + 2 * film.nodes;
    const box = film.box = [Infinity, Infinity, -Infinity, -Infinity];
    const sizes = [];
    film.contracted = 1e-9;
    for (let k = 0; k < film.frames; k++) {
      const row = k * film.width;
      for (let i = film.at.simulated; i < film.at.strain; i += 2) {
        const x = numbers[row + i], y = numbers[row + i + 1];
        if (x !== x) continue;
        box[0] = Math.min(box[0], x); box[1] = Math.min(box[1], y);
        box[2] = Math.max(box[2], x); box[3] = Math.max(box[3], y);
      }
      for (let i = film.at.strain; i < film.width; i++) sizes.push(Math.abs(numbers[row + i]));
      for (let m = 0; m < film.muscles; m++) film.contracted = Math.max(film.contracted, numbers[row + 1 + m]);
    }
    sizes.sort((a, b) => a - b);
    film.strained = sizes[Math.floor(0.98 * (sizes.length - 1))] || 1e-9;
    film.now = new Float32Array(film.width);
  }
  // Numbers of the frame at a time, between two frames linearly.
  frame(time) {
    const film = this.film, numbers = film.numbers, width = film.width;
    let low = 0, high = film.frames - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (numbers[middle * width] <= time) low = middle; else high = middle;
    }
    const from = numbers[low * width], to = numbers[high * width];
    const share = to > from ? Math.min(1, Math.max(0, (time - from) / (to - from))) : 0;
    for (let i = 0; i < width; i++) {
      const a = numbers[low * width + i], b = numbers[high * width + i];
      film.now[i] = a + share * (b - a);
    }
    return film.now;
  }
  draw(time) {
    const {pen, width, height} = sized(this.canvas), film = this.film;
    if (!film) return;
    const now = this.frame(time), [left, low, right, top] = film.box, margin = 22;
    const scale = Math.min((width - 2 * margin) / (right - left), (height - 2 * margin) / (top - low));
    const midX = (left + right) / 2, midY = (low + top) / 2;
    const px = (at, node) => width / 2 + scale * (now[at + 2 * node] - midX);
    const py = (at, node) => height / 2 - scale * (now[at + 2 * node + 1] - midY);
    const at = film.at.nodes;
    film.rings.forEach((ring, element) => {
      pen.beginPath();
      ring.forEach((node, corner) => corner ? pen.lineTo(px(at, node), py(at, node)) : pen.moveTo(px(at, node), py(at, node)));
      pen.closePath();
      pen.fillStyle = pen.strokeStyle = this.colour(now, element);
      pen.lineWidth = 0.7;
      pen.fill();
      pen.stroke();
    });
    pen.strokeStyle = this.ink;
    pen.lineWidth = 1.2;
    pen.beginPath();
    for (const [first, middle, last] of film.skin) {
      pen.moveTo(px(at, first), py(at, first));
      pen.lineTo(px(at, middle), py(at, middle));
      pen.lineTo(px(at, last), py(at, last));
    }
    pen.stroke();
    this.markers(pen, px, py, film.at.simulated, this.model, false);
    this.markers(pen, px, py, film.at.measured, this.measured, true);
    this.ruler(pen, scale, width, height);
  }
  colour(now, element) {
    const film = this.film;
    if (this.colourBy === "contraction") {
      const muscle = film.muscle[element];
      if (!muscle) return this.passive;
      const share = Math.max(0, Math.min(1, now[film.at.contraction + muscle - 1] / film.contracted));
      return mixed(this.passive, this.strong, share);
    }
    const strain = now[film.at.strain + element] / film.strained, share = Math.min(1, Math.abs(strain));
    return mixed(this.passive, strain > 0 ? this.hot : this.cold, share);
  }
  markers(pen, px, py, at, colour, filled) {
    if (!(px(at, 0) === px(at, 0))) return;
    pen.strokeStyle = pen.fillStyle = colour;
    pen.lineWidth = 2;
    pen.setLineDash(filled ? [] : [5, 4]);
    pen.beginPath();
    for (let k = 0; k < 3; k++) k ? pen.lineTo(px(at, k), py(at, k)) : pen.moveTo(px(at, k), py(at, k));
    pen.stroke();
    pen.setLineDash([]);
    for (let k = 0; k < 3; k++) {
      pen.beginPath();
      pen.arc(px(at, k), py(at, k), filled ? 4.5 : 6, 0, 2 * Math.PI);
      filled ? pen.fill() : pen.stroke();
    }
  }
  ruler(pen, scale, width, height) {
    const length = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2].filter(each => each * scale < 120).pop() || 0.001;
    pen.strokeStyle = pen.fillStyle = this.soft;
    pen.lineWidth = 2;
    pen.beginPath(); pen.moveTo(14, height - 12); pen.lineTo(14 + length * scale, height - 12); pen.stroke();
    pen.font = "12px system-ui, sans-serif";
    pen.textAlign = "left";
    pen.fillText(`${length * 1e3} mm`, 14, height - 18);
  }
  // What the colours mean, for the legend under the picture.
  legend() {
    if (!this.film) return "";
    return this.colourBy === "contraction"
      ? `contraction of the muscles, 0 to ${(100 * this.film.contracted).toFixed(1)} %`
      : `strain along the body, −${(100 * this.film.strained).toFixed(1)} % (blue) to +${(100 * this.film.strained).toFixed(1)} % (red)`;
  }
  dress() {
    this.ink = colourOf("--wb-ink"); this.soft = colourOf("--wb-soft");
    this.model = colourOf("--wb-model"); this.measured = colourOf("--wb-measured");
    this.passive = rgb(colourOf("--wb-passive")); this.strong = rgb(colourOf("--wb-strong"));
    this.hot = rgb(colourOf("--wb-hot")); this.cold = rgb(colourOf("--wb-cold"));
  }
}
function rgb(hex) { return [1, 3, 5].map(i => parseInt(hex.slice(i, i + 2), 16)); }
function mixed(from, to, share) {
  const mix = i => Math.round(from[i] + share * (to[i] - from[i]));
  return `rgb(${mix(0)},${mix(1)},${mix(2)})`;
}
