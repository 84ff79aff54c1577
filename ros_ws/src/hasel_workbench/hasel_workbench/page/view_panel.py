"""The moving body and the curves of one run: canvases that the page's own code draws on."""

from nicegui import ui

_BODY = """
<h2>Motion <small id="wb-run-name"></small></h2>
<canvas id="wb-body" role="img" aria-label="The body moving, with simulated and measured markers"></canvas>
<div class="wb-player">
  <button id="wb-play" data-do="play" aria-label="play or pause (space)">▶ play</button>
  <input id="wb-scrub" type="range" min="0" max="1000" value="0" aria-label="time in the run (arrow keys)">
  <span id="wb-clock">0.00 s</span>
  <label>speed <select id="wb-speed" aria-label="speed"><option value="1">1</option><option value="0.5">1/2</option>
    <option value="0.25">1/4</option><option value="0.1">1/10</option></select></label>
  <label>colour <select id="wb-colour" aria-label="colour of the body"><option value="strain">strain</option>
    <option value="contraction">contraction</option></select></label>
</div>
<div class="wb-keys"><span id="wb-legend"></span> <span><i class="ring"></i>simulated markers</span>
<span><i class="full"></i>measured</span></div>
"""
_CURVE = """
<h2>Measured against simulated</h2>
<canvas id="wb-curve" tabindex="0" role="img" aria-label="sin θ over time, measured and simulated, and the residual;
arrow keys move the time"></canvas>
<div class="wb-keys"><span><i class="dot"></i>measured</span><span><i></i>simulated</span>
<span><i class="earlier"></i>before what is tried</span><span>tinted: driven</span>
<button class="wb-small" data-do="whole">whole run</button></div>
<p id="wb-said" role="status"></p>
"""


def view_panel() -> None:
    """Two cards; everything in them follows the run that this page has chosen."""
    ui.html(_BODY, sanitize=False).classes("wb-card wb-of-runs wb-order-1")
    ui.html(_CURVE, sanitize=False).classes("wb-card wb-of-runs wb-order-1")
