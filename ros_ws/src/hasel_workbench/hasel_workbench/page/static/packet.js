// What the server sends: a header and 32-bit numbers (see packet.py).
"use strict";
function unpack(buffer, at = 0) {
  const length = new DataView(buffer).getUint32(at, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, at + 4, length)));
  return {header, numbers: new Float32Array(buffer, at + 4 + length)};
}
async function fetched(address, values) {
  const asked = values === undefined ? {} : {
    method: "POST", headers: {"Content-Type": "application/json"}, body: JSON.stringify(values),
  };
  const answer = await fetch(address, asked);
  if (!answer.ok) throw new Error(await answer.text());
  return answer.arrayBuffer();
}
const colourOf = name => getComputedStyle(document.body).getPropertyValue(name).trim();
function sized(canvas) {
  const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  const pen = canvas.getContext("2d");
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, width, height);
  return {pen, width, height};
}
