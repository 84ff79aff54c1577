// Unpack plotly's code and the figures (see packed.py), draw, and follow the page's colours and the printer.
"use strict";
async function unpacked(id) {
  const alphabet = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz!#$%/()*+-;,=.?@^_`{|}~";
  const digit = new Uint8Array(128);
  for (let i = 0; i < 85; i++) digit[alphabet.charCodeAt(i)] = i;
  const text = document.getElementById(id).textContent.trim();
  const bytes = new Uint8Array(text.length / 5 * 4), view = new DataView(bytes.buffer);
  for (let i = 0, j = 0; i < text.length; i += 5, j += 4) {
    let value = 0;
    for (let k = 0; k < 5; k++) value = value * 85 + digit[text.charCodeAt(i + k)];
    view.setUint32(j, value);
  }
  const packed = bytes.subarray(4, 4 + view.getUint32(0));
  return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"))).text();
}
const colour = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
function dressed(layout) {
  const ink = colour("--ink"), grid = colour("--grid"), changed = {"font.color": ink};
  for (const key of Object.keys(layout)) {
    if (!/^[xy]axis\d*$/.test(key)) continue;
    changed[key + ".gridcolor"] = changed[key + ".zerolinecolor"] = grid;
    changed[key + ".linecolor"] = colour("--line");
  }
  changed["hoverlabel.bgcolor"] = colour("--card");
  changed["hoverlabel.font.color"] = ink;
  return changed;
}
function recolour(traces) {
  traces.forEach((trace, number) => {
    if (trace.meta !== "measured") return;
    trace.marker.color = colour("--measured");
  });
  return traces;
}
async function draw() {
  const places = [...document.querySelectorAll("div.figure")];
  if (!places.length) return;
  const script = document.createElement("script");
  script.textContent = await unpacked("plotly");
  document.head.append(script);
  const figures = JSON.parse(await unpacked("figures"));
  const settings = {displaylogo: false, displayModeBar: "hover", responsive: true, modeBarButtons: [["toImage"]],
    toImageButtonOptions: {format: "svg", filename: "figure"}};
  for (const place of places) {
    const figure = figures[place.dataset.figure];
    await Plotly.newPlot(place, recolour(figure.data), figure.layout, settings);
    await Plotly.relayout(place, dressed(figure.layout));
  }
  const dark = window.matchMedia("(prefers-color-scheme: dark)");
  dark.addEventListener("change", () => places.forEach(place => {
    recolour(place.data);
    Plotly.relayout(place, dressed(figures[place.dataset.figure].layout));
  }));
  document.documentElement.dataset.drawn = "yes";
}
const printing = document.documentElement.classList;
function resize(within) {
  if (!window.Plotly) return;
  within.querySelectorAll("div.js-plotly-plot").forEach(each => {
    if (!printing.contains("printing") || !each.closest(".runs")) Plotly.Plots.resize(each);
  });
}
document.querySelectorAll("details").forEach(each => each.addEventListener("toggle", () => resize(each)));
// For the printer the page is as wide as the paper, four runs beside each other, each as it was drawn but smaller.
addEventListener("beforeprint", () => {
  const runs = [...document.querySelectorAll(".runs .figure")], widths = runs.map(each => each.offsetWidth);
  printing.add("printing");
  document.querySelectorAll("details").forEach(each => { each.open = !each.classList.contains("folded"); });
  resize(document);
  runs.forEach((each, number) => { each.style.zoom = each.parentElement.offsetWidth / widths[number]; });
});
addEventListener("afterprint", () => {
  printing.remove("printing");
  document.querySelectorAll(".runs .figure").forEach(each => { each.style.zoom = ""; });
  resize(document);
});
draw().catch(error => {
  document.querySelectorAll("div.figure").forEach(place => {
    place.textContent = "This figure needs a browser of 2023 or later (" + error + "); the numbers are in the tables.";
  });
});
