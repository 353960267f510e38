// Plots under each other with one time axis and one cursor. Drawn by uPlot; here is what they show and how they are moved.
const SIDES = [8, 12, 0, 0], AXIS = 50, FOOT = 24, SHORTEST = 1e-6;
const LEAST = 1e-3; // of the largest torque or force: a smaller range, which may be rounding, does not fill a panel

const decimals = (step) => { for (let k = 0; k < 9; k++) if (Math.abs(step * 10 ** k - Math.round(step * 10 ** k)) < 1e-6) return k; return 9; };

// Time in seconds; of a short stretch in µs from a whole millisecond on.
const timeScale = (from, to) => {
  const length = to - from;
  if (length >= 0.01) return { base: 0, factor: 1, unit: "s" };
  return { base: Math.floor(1e3 * from + 1e-9) / 1e3, factor: 1e6, unit: "µs" };
};

class Plots {
  constructor(host, data, curves, seek) {
    Object.assign(this, { host, curves, seek, phases: data.phases, look: {} });
    [this.start, this.end] = data.window;
    this.range = [this.start, this.end];
    this.panels = [];
  }

  show(b, look) {
    this.look = look;
    for (const panel of this.panels) panel.chart.destroy();
    this.host.textContent = "";
    const body = this.curves.bodies[b];
    this.panels = this.curves.of(b).map((plot) => {
      const box = document.createElement("div"), head = document.createElement("p"), field = document.createElement("div");
      const name = document.createElement("b"), read = document.createElement("span");
      head.append(name, read); box.append(head, field); box.className = "plot"; field.className = "field";
      field.setAttribute("role", "img");
      field.setAttribute("aria-label", `${plot.title} of ${spaced(body.name)} over time`);
      this.host.append(box);
      const panel = { ...plot, field, name, fresh: false, shown: [0, 1] };
      panel.values = panel.lines.map(() => { const value = document.createElement("span"); read.append(value); return value; });
      panel.chart = new uPlot(this.options(panel), [[], ...plot.lines.map(() => [])], field);
      // A dot of each line at the cursor: between the points of a curve, too.
      panel.dots = panel.lines.map(() => { const dot = document.createElement("i"); dot.className = "dot"; panel.chart.over.append(dot); return dot; });
      this.listen(panel);
      return panel;
    });
    this.body = b;
    this.stale();
  }

  stale() { for (const panel of this.panels) panel.fresh = false; this.dirty = true; }

  zoom(factor, about) {
    const [from, to] = this.range, least = Math.max(SHORTEST, (this.end - this.start) * 1e-6);
    const length = clamp((to - from) * factor, least, this.end - this.start), share = (about - from) / (to - from);
    const first = clamp(about - share * length, this.start, this.end - length);
    this.range = [first, first + length];
    this.stale();
  }

  pan(by) {
    const [from, to] = this.range, first = clamp(from + by, this.start, this.end - (to - from));
    this.range = [first, first + to - from];
    this.stale();
  }

  all() { this.range = [this.start, this.end]; this.stale(); }

  // Keep the cursor in sight.
  hold(t) {
    const [from, to] = this.range;
    if (t < from || t > to) this.pan(t - from - 0.1 * (to - from));
  }

  listen(panel) {
    const over = panel.chart.over, held = new Map();
    const at = (x) => { const box = over.getBoundingClientRect(), share = clamp((x - box.left) / box.width, 0, 1); return this.range[0] + share * (this.range[1] - this.range[0]); };
    over.addEventListener("pointerdown", (event) => { held.set(event.pointerId, event.clientX); over.setPointerCapture(event.pointerId); if (held.size === 1) this.seek(at(event.clientX)); });
    over.addEventListener("pointermove", (event) => {
      if (!held.has(event.pointerId)) return;
      const before = [...held.values()];
      held.set(event.pointerId, event.clientX);
      if (held.size === 1) { this.seek(at(event.clientX)); return; }
      const after = [...held.values()], apart = (xs) => Math.max(Math.abs(xs[0] - xs[1]), 8);
      this.zoom(apart(before) / apart(after), at(0.5 * (after[0] + after[1])));
    });
    for (const name of ["pointerup", "pointercancel"]) over.addEventListener(name, (event) => held.delete(event.pointerId));
    over.addEventListener("wheel", (event) => {
      event.preventDefault();
      const sideways = event.shiftKey ? event.deltaY : event.deltaX;
      if (sideways && Math.abs(sideways) > Math.abs(event.shiftKey ? 0 : event.deltaY)) this.pan((sideways / 600) * (this.range[1] - this.range[0]));
      else this.zoom(1.0018 ** event.deltaY, at(event.clientX));
    }, { passive: false });
  }

  // What uPlot gets once: colours are asked for at every drawing, the cursor goes where the player is and nowhere else.
  options(panel) {
    const colour = (name) => () => this.look[name], still = () => null;
    const font = "12px sans-serif", grid = { stroke: colour("grid"), width: 1 }, axis = { stroke: colour("faint"), font, grid };
    const labels = (_, splits, __, ___, step) => splits.map((value) => minus(value.toFixed(decimals(step))));
    // At the ends of the time axis stand its unit and the second that it counts from.
    const times = (chart, splits, _, __, step) => {
      const [from, to] = panel.shown, width = chart.width - AXIS - SIDES[1], x = (value) => ((value - from) / (to - from)) * width;
      return labels(chart, splits, _, __, step).map((text, k) => (x(splits[k]) > width - 34 || (panel.field.dataset.from && x(splits[k]) < 34) ? "" : text));
    };
    return {
      width: 300, height: 132, padding: SIDES, legend: { show: false }, ms: 1,
      cursor: { x: true, y: false, drag: { x: false, y: false }, points: { show: false }, bind: { mousemove: still, mouseenter: still, mouseleave: still, mousedown: still, mouseup: still, dblclick: still } },
      scales: { x: { time: false, range: () => panel.shown }, y: { range: () => panel.limits ?? [0, 1] } },
      axes: [{ ...axis, size: FOOT, gap: 3, space: 70, grid: { show: false }, border: { show: true, stroke: colour("edgeLine"), width: 1 }, ticks: { stroke: colour("edgeLine"), size: 4, width: 1 }, values: times }, { ...axis, size: AXIS, gap: 4, space: 24, ticks: { show: false }, values: labels }],
      series: [{}, ...panel.lines.map((line) => ({ stroke: colour(line.colour), width: 1.7, pxAlign: 0, points: { show: false }, ...(line.area ? { fill: () => `${this.look[line.colour]}40`, fillTo: 0 } : {}) }))],
      hooks: { drawClear: [(chart) => this.shade(chart)] },
    };
  }

  // The phases as bands behind the curves.
  shade(chart) {
    const { ctx, bbox } = chart, [from, to] = this.range, x = (t) => bbox.left + (clamp((t - from) / (to - from), 0, 1)) * bbox.width;
    ctx.save();
    for (const [name, first, last] of this.phases) {
      if (last < from || first > to || !(name in PHASES)) continue;
      ctx.fillStyle = this.look.bands[PHASES[name]];
      ctx.fillRect(x(first), bbox.top, Math.max(x(last) - x(first), 0.5), bbox.height);
    }
    ctx.restore();
  }

  // For the instant t; without `told` the numbers beside the curves stay. All sizes are read before anything is written.
  draw(t, look, told = true) {
    this.look = look;
    const sizes = this.panels.map(({ field }) => [field.clientWidth, field.clientHeight]);
    this.panels.forEach((panel, p) => {
      const { chart } = panel, [width, height] = sizes[p];
      if (!width) return;
      if (chart.width !== width || chart.height !== height) { chart.setSize({ width, height }); panel.fresh = false; }
      if (!panel.fresh) this.fill(panel);
      const [from, to] = this.range;
      const left = ((t - from) / (to - from)) * (width - AXIS - SIDES[1]);
      chart.setCursor({ left, top: 0 }, false, false);
      panel.dots.forEach((dot, k) => {
        const line = panel.lines[k];
        dot.style.background = look[line.colour];
        dot.style.transform = `translate(${left}px, ${(1 - (line.value(t) / panel.factor - panel.limits[0]) / (panel.limits[1] - panel.limits[0])) * (height - FOOT - SIDES[0])}px)`;
        dot.hidden = t < from || t > to;
      });
      if (told) panel.values.forEach((span, k) => {
        const line = panel.lines[k], value = line.value(t);
        write(span, `${line.name ? `${line.name} ` : ""}${panel.metric ? metric(Math.abs(value) < 1e-6 * panel.size ? 0 : value, panel.unit) : `${minus(value.toFixed(panel.digits))} ${panel.unit}`.replace(" °", "°")}`);
        span.style.color = panel.lines.length > 1 ? look[line.colour] : "";
      });
    });
  }

  // The largest size of a plot's curves in all of the window.
  largest(panel) {
    const step = (this.end - this.start) / 500;
    panel.most ??= Math.max(...panel.lines.map((line) => line.points(this.start, this.end, step).reduce((most, [, y]) => Math.max(most, Math.abs(y)), 0)));
    return panel.most;
  }

  // Give uPlot the points of what is shown, in the units of the axes; all of them, it keeps the spikes itself.
  fill(panel) {
    const { chart } = panel, [from, to] = this.range, scale = timeScale(from, to);
    const curves = panel.lines.map((line) => line.points(from, to, (to - from) / Math.max(chart.width - AXIS, 50)));
    let low = Infinity, high = -Infinity;
    for (const curve of curves) for (const [, y] of curve) { low = Math.min(low, y); high = Math.max(high, y); }
    const least = panel.metric ? LEAST * this.largest(panel) : 0;
    if (high - low < least) { const lack = 0.5 * (least - (high - low)); low -= lack; high += lack; }
    const size = Math.max(Math.abs(low), Math.abs(high));
    const [factor, prefix] = panel.metric ? PREFIXES.find(([least]) => size >= least) ?? [1e-12, "p"] : [1, ""];
    panel.factor = factor;
    panel.limits = limits(low / factor, high / factor, panel.lines.some((line) => line.area)); // uPlot takes its own with the next frame only
    panel.size = Math.max(high - low, 1e-12);
    panel.digits = clamp(3 - Math.floor(Math.log10(1.12 * panel.size)), 0, 6);
    panel.shown = [from, to].map((t) => (t - scale.base) * scale.factor);
    panel.name.textContent = `${panel.title} (${prefix}${panel.unit})`;
    panel.field.dataset.from = scale.base ? `${Number(scale.base.toPrecision(9))} s +` : "";
    panel.field.dataset.unit = scale.unit;
    chart.setData([curves[0].map(([t]) => (t - scale.base) * scale.factor), ...curves.map((curve) => curve.map(([, y]) => y / factor))]);
    panel.fresh = true;
  }
}

// Limits of an axis with a little air; a curve that stands still gets some, too.
const limits = (low, high, fromZero) => {
  if (fromZero) { low = Math.min(low, 0); high = Math.max(high, 0); }
  if (!(high - low > 1e-9 * Math.max(Math.abs(low), Math.abs(high)))) { const wide = Math.max(0.01 * Math.abs(low), 1e-12); low -= wide; high += wide; }
  const room = 0.06 * (high - low);
  return [low - room, high + room];
};
