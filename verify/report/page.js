"use strict";
// A light layer on pictures that stand without it: the value under the cursor, lines switched, frames, data as CSV.
const SVG = "http://www.w3.org/2000/svg", NEAR = 28;
const charts = JSON.parse(document.getElementById("data").textContent);
const made = (name, marks, parent) => {
  const one = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(marks)) one.setAttribute(key, value);
  if (parent) parent.append(one);
  return one;
};
const place = (ends, log, low, high) => {
  const at = log ? Math.log10 : v => v, [a, b] = ends.map(at);
  return v => (log && v <= 0) ? NaN : low + (at(v) - a) / (b - a) * (high - low);
};
const short = v => {
  if (v === null) return "–";
  const size = Math.abs(v);
  return size !== 0 && (size < 1e-3 || size >= 1e6) ? v.toExponential(3) : String(Number(v.toPrecision(5)));
};
function layered(figure, chart) {
  const plot = figure.querySelector(".plot"), svg = plot.querySelector("svg");
  const [left, top, right, bottom] = chart.box;
  const x = place(chart.x, chart.xlog, left, right), y = place(chart.y, chart.ylog, bottom, top);
  const off = new Set(), layer = made("g", {}, svg), spot = made("circle", { r: 5, fill: "none", stroke: "currentColor", "stroke-width": 1.6, visibility: "hidden" }, svg);
  const tip = document.createElement("div");
  tip.className = "tip"; tip.hidden = true; tip.setAttribute("role", "status"); plot.append(tip);
  let at = null;
  const visible = i => !off.has(chart.lines[i].group) && !chart.lines[i].guide;
  const there = (i, k) => (chart.lines[i].x[k] ?? null) !== null && (chart.lines[i].y[k] ?? null) !== null && point(i, k).every(isFinite);
  const point = (i, k) => [x(chart.lines[i].x[k]), y(chart.lines[i].y[k])];
  function tell(words, px, py) {
    spot.setAttribute("cx", px); spot.setAttribute("cy", py); spot.setAttribute("visibility", "visible");
    tip.replaceChildren(...words.map((text, i) => { const row = document.createElement(i ? "div" : "b"); row.textContent = text; return row; }));
    tip.hidden = false;
    const scale = plot.clientWidth / svg.viewBox.baseVal.width, room = plot.clientWidth - tip.offsetWidth - 4;
    tip.style.left = Math.max(0, Math.min(px * scale + 12, room)) + "px";
    tip.style.top = Math.max(0, py * scale - tip.offsetHeight - 10) + "px";
  }
  function show(i, k) {
    at = [i, k];
    const line = chart.lines[i];
    tell([line.name, `${chart.xtitle}: ${short(line.x[k])}`, `${chart.ytitle}: ${short(line.y[k])}`, ...(line.said ? [line.said[k]] : [])], ...point(i, k));
  }
  const hide = () => { tip.hidden = true; spot.setAttribute("visibility", "hidden"); };
  function nearest(px, py) {
    let best = null, least = NEAR * NEAR;
    chart.lines.forEach((line, i) => {
      if (!visible(i)) return;
      for (let k = 0; k < line.x.length; k++) {
        if (!there(i, k)) continue;
        const [qx, qy] = point(i, k), far = (qx - px) ** 2 + (qy - py) ** 2;
        if (far < least) { least = far; best = [i, k]; }
      }
    });
    return best;
  }
  const cell = (i, j) => { const map = chart.map; at = [i, j]; tell([`${map.name}: ${short(map.values[j][i])}`, `${chart.xtitle}: ${short(map.x[i])}`, `${chart.ytitle}: ${short(map.y[j])}`], x(map.x[i]), y(map.y[j])); };
  function overMap(px, py) {
    const map = chart.map, closest = (values, at, v) => values.reduce((b, one, i) => Math.abs(at(one) - v) < Math.abs(at(values[b]) - v) ? i : b, 0);
    if (px < left || px > right || py < top || py > bottom) return hide();
    cell(closest(map.x, x, px), closest(map.y, y, py));
  }
  const bar = i => { at = [i, i]; tell([chart.bars.names[i], `${chart.xtitle}: ${short(chart.bars.values[i])}`], x(chart.bars.values[i]), y(i)); };
  function overBars(py) {
    const i = Math.round(chart.y[0] + (bottom - py) / (bottom - top) * (chart.y[1] - chart.y[0]));
    if (i in chart.bars.names) bar(i); else hide();
  }
  plot.addEventListener("pointermove", event => {
    const p = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
    const found = nearest(p.x, p.y);
    if (found) show(...found); else if (chart.map) overMap(p.x, p.y); else if (chart.bars) overBars(p.y); else hide();
  });
  plot.addEventListener("pointerleave", hide);
  plot.addEventListener("blur", hide);
  plot.addEventListener("keydown", event => {
    const step = { ArrowRight: [0, 1], ArrowLeft: [0, -1], ArrowUp: [-1, 0], ArrowDown: [1, 0] }[event.key];
    if (event.key === "Escape") return hide();
    if (!step) return;
    event.preventDefault();
    const turn = (k, by, n) => (k + by + n) % n, far = event.shiftKey ? 10 : 1;
    if (chart.map) {
      const n = chart.map.x.length, m = chart.map.y.length, [i, j] = at || [n >> 1, m >> 1];
      return cell(turn(i, far * step[1], n), turn(j, -far * step[0], m));
    }
    if (chart.bars) return bar(turn(at ? at[0] : chart.bars.names.length, -step[0] - step[1], chart.bars.names.length));
    const known = chart.lines.map((_, i) => i).filter(i => visible(i) && chart.lines[i].x.some((_, k) => there(i, k)));
    if (!known.length) return;
    const aside = step[1], leap = step[0];
    let [i, k] = at && known.includes(at[0]) ? at : [known[0], -1];
    const next = by => { i = known[turn(known.indexOf(i), by, known.length)]; return chart.lines[i].x.length; };
    let n = leap ? next(leap) : chart.lines[i].x.length;
    k = leap ? Math.max(Math.min(k, n - 1), 0) : k + aside;
    while (!there(i, k)) {
      if (k >= 0 && k < n) k += aside || 1;
      else { n = next(aside || 1); k = aside < 0 ? n - 1 : 0; }
    }
    show(i, k);
  });
  function reveal() {
    chart.lines.forEach((line, i) => {
      for (const id of [`${chart.id}-${i}`, `${chart.id}-${i}h`]) {
        const own = document.getElementById(id);
        if (own) own.style.display = off.has(line.group) || line.moves ? "none" : "";
      }
    });
    layer.replaceChildren();
    chart.lines.forEach((line, i) => { if (line.moves && !off.has(line.group)) drawLine(line, i); });
    hide();
  }
  function drawLine(line, i) {
    let pen = "M", d = "";
    line.x.forEach((_, k) => { const [px, py] = point(i, k); if (line.y[k] === null || isNaN(py)) pen = "M"; else { d += `${pen}${px.toFixed(1)} ${py.toFixed(1)}`; pen = "L"; } });
    if (line.joined) made("path", { d, fill: "none", stroke: line.colour, "stroke-width": line.width, "stroke-dasharray": line.dash, "stroke-linejoin": "round" }, layer);
    const r = line.size / 2, look = line.hollow ? { fill: "none", stroke: line.colour, "stroke-width": 1.2 } : { fill: line.colour };
    if (r) line.x.forEach((_, k) => {
      const [px, py] = point(i, k);
      if (line.y[k] === null) return;
      if (line.square) made("rect", { x: px - r, y: py - r, width: 2 * r, height: 2 * r, ...look }, layer);
      else made("circle", { cx: px, cy: py, r, ...look }, layer);
    });
  }
  figure.querySelectorAll(".keys button").forEach(button => button.addEventListener("click", () => {
    const group = button.dataset.group, now = off.has(group);
    if (now) off.delete(group); else off.add(group);
    button.setAttribute("aria-pressed", String(now));
    reveal();
  }));
  if (chart.frames.length) framed(figure, chart, reveal);
  const csv = figure.querySelector(".csv");
  csv.hidden = false;
  csv.addEventListener("click", () => save(`${document.body.dataset.scene}-${chart.id}.csv`, rows(chart)));
}
// Frames by hand or as a moving picture: pause, speed; it begins by itself only where it is seen and motion is welcome.
function framed(figure, chart, reveal) {
  const bar = figure.querySelector(".frames"), range = bar.querySelector("input"), told = bar.querySelector("output");
  const n = chart.frames.length, calm = matchMedia("(prefers-reduced-motion: reduce)");
  let at = n - 1, playing = false, then = 0, asked = 0;
  function choose(k) {
    at = Math.floor(k) % n;
    chart.lines.forEach(line => { if (line.moves) { line.y = line.moves[at]; if (line.shifts) line.x = line.shifts[at]; } });
    told.textContent = chart.frames[at]; range.value = at;
    reveal();
  }
  bar.hidden = false;
  range.addEventListener("input", () => { play(false); choose(Number(range.value)); });
  const button = bar.querySelector("button"), speed = bar.querySelector("select");
  function play(on) {
    playing = on;
    if (button) button.textContent = on ? "Pause" : "Play";
    if (on && !asked) { then = 0; asked = requestAnimationFrame(turn); }
  }
  function turn(now) {
    asked = 0;
    if (!playing) return;
    if (!then) then = now - at * 1000 / (24 * speed.value);
    choose((now - then) * 24 * speed.value / 1000);
    asked = requestAnimationFrame(turn);
  }
  choose(n - 1);
  if (!chart.plays) return;
  button.addEventListener("click", () => play(!playing));
  speed.addEventListener("change", () => { then = 0; });
  let touched = false;
  button.addEventListener("click", () => { touched = true; });
  new IntersectionObserver(seen => { if (!touched && !calm.matches) play(seen.some(one => one.isIntersecting)); }, { threshold: .6 }).observe(figure);
}
const quoted = cell => /[",\n]/.test(cell) ? `"${String(cell).replaceAll('"', '""')}"` : String(cell ?? "");
function rows(chart) {
  const told = [["line", chart.xtitle, chart.ytitle, "said"]];
  for (const line of chart.lines) {
    const all = line.moves ? line.moves.map((y, f) => [chart.frames[f], line.shifts ? line.shifts[f] : line.x, y]) : [["", line.x, line.y]];
    for (const [frame, x, y] of all) x.forEach((v, k) => told.push([line.name, v, y[k], line.said ? line.said[k] : frame]));
  }
  if (chart.map) chart.map.values.forEach((row, j) => row.forEach((v, i) => told.push([chart.map.name, chart.map.x[i], chart.map.y[j], v])));
  if (chart.bars) chart.bars.names.forEach((name, i) => told.push([name, chart.bars.values[i], "", ""]));
  return told.map(row => row.map(quoted).join(",")).join("\n") + "\n";
}
function save(name, text) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type: "text/csv" }));
  link.download = name; link.click();
  URL.revokeObjectURL(link.href);
}
for (const chart of charts) layered(document.getElementById(chart.id), chart);
// A table that is broader than its place says so, and the keyboard moves it.
const watched = new ResizeObserver(seen => seen.forEach(({ target }) => {
  const over = target.scrollWidth > target.clientWidth + 1, hint = target.previousElementSibling?.matches(".hint") ? target.previousElementSibling : null;
  if (over === Boolean(hint)) return;
  if (!over) { hint.remove(); target.removeAttribute("tabindex"); target.removeAttribute("role"); return; }
  const told = document.createElement("p");
  told.className = "hint"; told.textContent = "scroll sideways \u2192"; target.before(told);
  target.tabIndex = 0; target.setAttribute("role", "region"); target.setAttribute("aria-label", target.querySelector("caption").textContent);
}));
document.querySelectorAll(".scroll").forEach(one => watched.observe(one));
const opened = () => { const target = location.hash && document.getElementById(decodeURIComponent(location.hash.slice(1))); for (let one = target; one; one = one.parentElement) if (one.tagName === "DETAILS") one.open = true; if (target) target.scrollIntoView(); };
addEventListener("hashchange", opened); opened();
document.querySelectorAll(".copy").forEach(link => link.addEventListener("click", () => navigator.clipboard?.writeText(link.href).catch(() => {})));
document.body.dataset.drawn = String(charts.length);
