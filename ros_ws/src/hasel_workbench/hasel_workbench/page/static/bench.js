// One page: which run is shown, where it stands, and what is dragged. The session itself is on the server.
"use strict";
const bench = {
  version: -1, run: null, runs: [], time: 0, speed: 1, playing: false, times: {predict: [], truth: []}, shown: 0,
  begin() {
    this.body = new BodyView(document.getElementById("wb-body"));
    this.curve = new CurveView(document.getElementById("wb-curve"), time => { this.pause(); this.seek(time); });
    this.run = sessionStorage.getItem("wb-run");
    this.time = +sessionStorage.getItem("wb-time") || 0;
    this.dress();
    new MutationObserver(() => this.dress()).observe(document.body, {attributes: true, attributeFilter: ["class"]});
    window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.dress());
    new ResizeObserver(() => this.draw()).observe(this.curve.canvas);
    document.addEventListener("click", event => this.clicked(event));
    document.addEventListener("keydown", event => this.pressed(event));
    document.addEventListener("focusin", event => { this.held = event.target; });
    document.addEventListener("pointerdown", () => { this.held = null; });
    document.addEventListener("input", event => this.moved(event.target));
    document.addEventListener("change", event => this.chosen(event.target));
    document.addEventListener("dragover", event => event.preventDefault());
    document.addEventListener("drop", event => this.dropped(event));
    this.ready = true;
  },
  // Files let go of anywhere: else the browser would leave the page for them.
  dropped(event) {
    event.preventDefault();
    const files = event.dataTransfer.files, input = document.querySelector(".wb-upload-fitted input[type=file]");
    if (!files.length || event.target.closest(".q-uploader")) return;
    input.files = files;
    input.dispatchEvent(new Event("change", {bubbles: true}));
  },
  dress() {
    this.body.dress(); this.curve.dress(); this.draw();
  },
  // What was drawn again while it had the keyboard has it still.
  hold() {
    const {name, exact} = this.held?.dataset || {};
    if (this.held?.isConnected || !(name || exact)) return;
    const found = name ? `[data-name="${CSS.escape(name)}"]` : `[data-exact="${CSS.escape(exact)}"]`;
    document.querySelector(found)?.focus({preventScroll: true});
  },
  // A question about a file comes into view, once it is drawn.
  ask() {
    setTimeout(() => {
      const cards = document.querySelectorAll("[data-question]"), card = cards[cards.length - 1];
      if (!card) return;
      card.scrollIntoView({block: "center"});
      card.focus({preventScroll: true});
    });
  },
  // The session has changed: fetch what is shown again.
  async refresh(version, runs) {
    if (!this.ready) this.begin();
    this.version = version;
    setTimeout(() => this.hold());
    this.runs = runs;
    document.body.classList.toggle("wb-empty", !runs.length);
    if (!runs.length) return;
    await this.select(runs.includes(this.run) ? this.run : runs[0], true);
  },
  async select(run, again = false) {
    if (this.run !== run) { this.curve.span = this.curve.mark = null; this.time = 0; }
    this.run = run;
    sessionStorage.setItem("wb-run", run);
    this.highlight();
    const wanted = this.wanted = {};
    this.say("");
    try {
      const curve = unpack(await fetched(`/data/curves/${encodeURIComponent(run)}`));
      if (this.wanted !== wanted) return;
      this.curve.show(curve);
      this.seek(Math.min(Math.max(this.time, this.curve.whole[0]), this.curve.whole[1]));
      const film = unpack(await fetched(`/data/film/${encodeURIComponent(run)}`));
      if (this.wanted !== wanted) return;
      this.body.show(film);
      this.draw();
      this.shown++;
    } catch (error) { this.say(error.message); }
  },
  highlight() {
    document.querySelectorAll("tr[data-row]").forEach(row => row.classList.toggle("chosen", row.dataset.row === this.run));
    document.querySelectorAll("button.run").forEach(each => each.setAttribute("aria-pressed", each.dataset.run === this.run));
    const title = document.getElementById("wb-run-name");
    if (title) title.textContent = this.run || "";
  },
  async stretch(run, cell) {
    if (this.run !== run) await this.select(run);
    const {header} = unpack(await fetched(`/data/stretch/${encodeURIComponent(run)}/${cell}`));
    const [first, last] = this.curve.whole, width = header.end - header.begin;
    this.curve.mark = [header.begin, header.end];
    this.curve.span = [Math.max(first, header.begin - 6 * width), Math.min(last, header.end + 6 * width)];
    this.pause();
    this.seek((header.begin + header.end) / 2);
    document.querySelectorAll("td[data-cell]").forEach(each =>
      each.classList.toggle("chosen", each.dataset.run === run && +each.dataset.cell === cell));
  },
  whole() { this.curve.span = this.curve.mark = null; this.draw(); },
  seek(time) {
    this.time = time;
    sessionStorage.setItem("wb-time", time);
    this.draw();
  },
  draw() {
    if (!this.body) return;
    this.body.draw(this.time);
    this.curve.draw(this.time);
    const scrub = document.getElementById("wb-scrub");
    if (scrub && this.curve.data) {
      const [first, last] = this.curve.whole;
      scrub.value = 1000 * (this.time - first) / (last - first);
      scrub.setAttribute("aria-valuetext", `${this.time.toFixed(2)} s`);
      document.getElementById("wb-clock").textContent = `${this.time.toFixed(2)} s`;
      document.getElementById("wb-legend").textContent = this.body.legend();
    }
  },
  play() {
    if (this.playing || !this.curve.data) return;
    this.playing = true;
    this.button("⏸ pause");
    let last = performance.now(), counted = 0, since = last;
    const step = now => {
      if (!this.playing) return;
      const [from, to] = this.curve.span || this.curve.whole;
      this.time += this.speed * (now - last) / 1000;
      if (this.time > to || this.time < from) this.time = from;
      last = now;
      this.draw();
      counted++;
      if (now - since >= 1000) { this.rate = 1000 * counted / (now - since); counted = 0; since = now; }
      requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  },
  pause() { this.playing = false; this.button("▶ play"); sessionStorage.setItem("wb-time", this.time); },
  toggle() { this.playing ? this.pause() : this.play(); },
  button(text) { const each = document.getElementById("wb-play"); if (each) each.textContent = text; },
  say(text) { const each = document.getElementById("wb-said"); if (each) each.textContent = text; },
  clicked(event) {
    const act = event.target.closest("[data-act]");
    if (act) { emitEvent("wb-act", {act: act.dataset.act, run: act.dataset.of}); return; }
    const target = event.target.closest("[data-run],[data-do]");
    if (!target) return;
    if (target.dataset.do === "play") this.toggle();
    else if (target.dataset.do === "whole") this.whole();
    else if (target.dataset.cell !== undefined) this.stretch(target.dataset.run, +target.dataset.cell);
    else if (target.dataset.run) this.select(target.dataset.run);
  },
  pressed(event) {
    const target = event.target;
    if (target.matches && target.matches("td[data-cell]")) return this.walk(event, target);
    if (target.dataset && target.dataset.name && /^Arrow/.test(event.key)) {
      tuning.step(target, event.key === "ArrowRight" || event.key === "ArrowUp");
      event.preventDefault();
      return;
    }
    if (target.matches && target.matches("input, textarea, select, button, a, [role=tab], [role=combobox]")) return;
    if (event.key === " ") { this.toggle(); event.preventDefault(); }
    else if (event.key === "ArrowRight" || event.key === "ArrowLeft") {
      if (!this.curve || !this.curve.data) return;
      this.pause();
      const [first, last] = this.curve.whole, step = (event.key === "ArrowRight" ? 1 : -1) / 120;
      this.seek(Math.min(last, Math.max(first, this.time + step)));
      event.preventDefault();
    } else if (event.key === "n" || event.key === "p") {
      const next = this.runs.indexOf(this.run) + (event.key === "n" ? 1 : -1);
      if (this.runs[next]) this.select(this.runs[next]);
    }
  },
  walk(event, cell) {
    const row = cell.parentElement, place = [...row.cells].indexOf(cell);
    const next = {
      ArrowRight: row.cells[place + 1], ArrowLeft: place > 1 ? row.cells[place - 1] : null,
      ArrowDown: row.nextElementSibling && row.nextElementSibling.cells[place],
      ArrowUp: row.previousElementSibling && row.previousElementSibling.cells[place],
    }[event.key];
    if (next) { next.focus(); event.preventDefault(); }
    if (event.key === "Enter" || event.key === " ") { this.stretch(cell.dataset.run, +cell.dataset.cell); event.preventDefault(); }
  },
  moved(target) {
    if (target.id === "wb-scrub") {
      const [first, last] = this.curve.whole;
      this.pause();
      this.seek(first + (last - first) * target.value / 1000);
    } else if (target.dataset && target.dataset.name) tuning.drag(target);
  },
  chosen(target) {
    if (target.id === "wb-speed") this.speed = +target.value;
    else if (target.id === "wb-colour") { this.body.colourBy = target.value; this.draw(); }
    else if (target.dataset && target.dataset.name) tuning.drop();
    else if (target.dataset && target.dataset.exact) tuning.enter(target);
  },
};
window.bench = bench;
