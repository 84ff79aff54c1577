// Dragging a value: at once what the derivatives foretell, and behind it the true simulation of this run.
"use strict";
const KEY = 0.1;
const tuning = {
  values: {}, asking: false, again: false, truths: 0,
  // The scale is asinh((value - centre) / size), see sliders.py; a value is as round as a pixel allows.
  scale(slider) {
    const {low, high, centre, size} = slider.dataset, scaled = value => Math.asinh((value - centre) / size);
    return {first: scaled(low), last: scaled(high), centre: +centre, size: +size};
  },
  value(slider) {
    const {first, last, centre, size} = this.scale(slider), {low, high} = slider.dataset;
    const at = first + (last - first) * slider.value / 1000, pixel = (last - first) / (slider.clientWidth || 1000);
    const grain = 10 ** Math.floor(Math.log10(size * Math.cosh(at) * Math.min(pixel, KEY)));
    const round = Math.round((centre + size * Math.sinh(at)) / grain) * grain;
    return Math.min(+high, Math.max(+low, +round.toPrecision(12)));
  },
  // An arrow key moves it by a tenth of the size near the centre, beyond it by a tenth of itself.
  step(slider, up) {
    const {first, last} = this.scale(slider);
    slider.value = +slider.value + (up ? 1000 : -1000) * KEY / (last - first);
    for (const kind of ["input", "change"]) slider.dispatchEvent(new Event(kind, {bubbles: true}));
  },
  drag(slider) {
    const began = performance.now(), value = this.value(slider);
    this.values[slider.dataset.name] = value;
    slider.setAttribute("aria-valuetext", `${+value.toPrecision(4)}${slider.dataset.unit}`);
    slider.nextElementSibling.value = +value.toPrecision(6);
    this.began = began;
    this.predict(began);
    this.simulate(began);
  },
  async predict(began) {
    if (this.foretelling) { this.latest = began; return; }
    this.foretelling = true;
    try {
      const {header, numbers} = unpack(await fetched(`/data/predict/${encodeURIComponent(bench.run)}`, this.values));
      if (began > (this.lastTruth || 0)) {
        if (!this.beyond) bench.curve.foretold = {series: numbers, true: false};
        bench.draw();
        this.errors(header, this.beyond ? "beyond" : "foretold");
        requestAnimationFrame(() => bench.times.predict.push(performance.now() - began));
      }
    } catch (error) { bench.say(error.message); }
    this.foretelling = false;
    if (this.latest) { const next = this.latest; this.latest = null; this.predict(next); }
  },
  async simulate(began) {
    if (this.asking) { this.again = began; return; }
    this.asking = true;
    try {
      const buffer = await fetched(`/data/truth/${encodeURIComponent(bench.run)}`, this.values);
      const first = unpack(buffer), length = new DataView(buffer).getUint32(0, true);
      const series = first.numbers.slice(0, first.header.film);
      if (!this.again) {
        bench.curve.foretold = {series, true: true};
        bench.body.show(unpack(buffer.slice(4 + length + 4 * first.header.film)));
        this.lastTruth = began;
        this.mark(first.header.beyond);
        bench.draw();
        requestAnimationFrame(() => bench.times.truth.push(performance.now() - began));
        this.truths++;
      }
    } catch (error) { bench.say(error.message); }
    this.asking = false;
    if (this.again) { const next = this.again; this.again = false; this.simulate(next); }
  },
  errors(found, how) {
    for (const [id, value] of [["wb-error", found.error], ["wb-error-unseen", found.errorUnseen]]) {
      const place = document.getElementById(id);
      if (!place || value === null || value === undefined) continue;
      place.textContent = value.toFixed(4);
      place.dataset.how = how;
    }
  },
  // Where derivatives mislead, the true curve stays and the foretold errors are struck through.
  mark(beyond) {
    this.beyond = beyond;
    document.querySelectorAll(".wb-numbers b[data-how]").forEach(each => { each.dataset.how = beyond ? "beyond" : "foretold"; });
    const place = document.getElementById("wb-beyond");
    if (place) place.hidden = !beyond;
  },
  enter(field) {
    if (!field.checkValidity() || field.value === "") return;
    this.values[field.dataset.exact] = +field.value;
    this.drop();
  },
  // The value is let go: the session takes it, and simulates all runs with it.
  drop() {
    emitEvent("wb-values", this.values);
    this.values = {};
    this.mark(false);
  },
};
