// Plots under each other with one time axis and one cursor.
const PAD = { left: 58, right: 12, top: 8, bottom: 22 }, SHORTEST = 1e-6;

const roundStep = (least) => {
  const power = 10 ** Math.floor(Math.log10(least));
  return [1, 2, 5, 10].map((k) => k * power).find((step) => step >= least * (1 - 1e-9));
};
const decimals = (step) => clamp(-Math.floor(Math.log10(step) + 1e-9), 0, 9);

// Time in the unit that suits what is shown: after a round number of seconds where that is short.
const timeScale = (from, to) => {
  const length = to - from;
  if (length >= 2) return { base: 0, factor: 1, unit: "s" };
  const factor = length >= 2e-3 ? 1e3 : 1e6, power = 10 ** Math.ceil(Math.log10(length));
  const base = to < 1 && length > 0.05 * to ? 0 : Math.floor(from / power + 1e-9) * power;
  return { base, factor, unit: factor === 1e3 ? "ms" : "µs" };
};

class Plots {
  constructor(host, data, curves, seek) {
    Object.assign(this, { host, curves, seek, phases: data.phases });
    [this.start, this.end] = data.window;
    this.range = [this.start, this.end];
    this.panels = [];
  }

  show(b) {
    this.host.textContent = "";
    const body = this.curves.bodies[b];
    this.panels = this.curves.of(b).map((plot) => {
      const box = document.createElement("div"), head = document.createElement("p"), canvas = document.createElement("canvas");
      const name = document.createElement("b"), read = document.createElement("span");
      name.textContent = plot.title; head.append(name, read); box.append(head, canvas); box.className = "plot";
      canvas.setAttribute("role", "img");
      canvas.setAttribute("aria-label", `${plot.title} of ${body.name} over time`);
      this.host.append(box);
      const panel = { ...plot, canvas, read, layer: document.createElement("canvas"), fresh: false };
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
    if (t < from || t > to) this.pan(t < from ? t - from - 0.1 * (to - from) : t - from - 0.1 * (to - from));
  }

  listen(panel) {
    const at = (event) => { const box = panel.canvas.getBoundingClientRect(); return this.time(clamp(event.clientX - box.left, PAD.left, box.width - PAD.right), box.width); };
    const held = new Map();
    panel.canvas.addEventListener("pointerdown", (event) => { held.set(event.pointerId, event.clientX); panel.canvas.setPointerCapture(event.pointerId); if (held.size === 1) this.seek(at(event)); });
    panel.canvas.addEventListener("pointermove", (event) => {
      if (!held.has(event.pointerId)) return;
      const before = [...held.values()];
      held.set(event.pointerId, event.clientX);
      if (held.size === 1) { this.seek(at(event)); return; }
      const after = [...held.values()], apart = (xs) => Math.max(Math.abs(xs[0] - xs[1]), 8), box = panel.canvas.getBoundingClientRect();
      this.zoom(apart(before) / apart(after), this.time(0.5 * (after[0] + after[1]) - box.left, box.width));
    });
    for (const name of ["pointerup", "pointercancel"]) panel.canvas.addEventListener(name, (event) => held.delete(event.pointerId));
    panel.canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      const sideways = event.shiftKey ? event.deltaY : event.deltaX;
      if (sideways && Math.abs(sideways) > Math.abs(event.shiftKey ? 0 : event.deltaY)) this.pan((sideways / 600) * (this.range[1] - this.range[0]));
      else this.zoom(1.0018 ** event.deltaY, at(event));
    }, { passive: false });
  }

  time(x, width) { return this.range[0] + ((x - PAD.left) / (width - PAD.left - PAD.right)) * (this.range[1] - this.range[0]); }

  draw(t, look) {
    for (const panel of this.panels) {
      const { canvas } = panel, width = canvas.clientWidth, height = canvas.clientHeight, ratio = window.devicePixelRatio || 1;
      if (!width) continue;
      if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) panel.fresh = false;
      if (!panel.fresh) this.ground(panel, width, height, ratio, look);
      const ctx = canvas.getContext("2d");
      ctx.setTransform(1, 0, 0, 1, 0, 0);
      ctx.clearRect(0, 0, canvas.width, canvas.height);
      ctx.drawImage(panel.layer, 0, 0);
      ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
      const x = panel.x(t);
      ctx.strokeStyle = look.cursor; ctx.lineWidth = 1.5;
      ctx.beginPath(); ctx.moveTo(x, PAD.top); ctx.lineTo(x, height - PAD.bottom); ctx.stroke();
      const words = panel.lines.map((line) => {
        const value = line.value(t), y = panel.y(value);
        if (y > PAD.top - 4 && y < height - PAD.bottom + 4) {
          ctx.beginPath(); ctx.arc(x, y, 3.4, 0, 2 * Math.PI); ctx.fillStyle = look[line.colour]; ctx.fill(); ctx.strokeStyle = look.paper; ctx.lineWidth = 1.2; ctx.stroke();
        }
        const span = document.createElement("span");
        span.textContent = `${line.name ? `${line.name} ` : ""}${panel.metric ? metric(Math.abs(value) < 1e-6 * panel.size ? 0 : value, panel.unit) : `${minus(value.toFixed(panel.digits))} ${panel.unit}`.replace(" °", "°")}`;
        span.style.color = panel.lines.length > 1 ? look[line.colour] : "";
        return span;
      });
      panel.read.replaceChildren(...words);
    }
  }

  // All that does not change while the cursor moves.
  ground(panel, width, height, ratio, look) {
    const { canvas, layer } = panel, [from, to] = this.range;
    canvas.width = layer.width = Math.round(width * ratio); canvas.height = layer.height = Math.round(height * ratio);
    const ctx = layer.getContext("2d");
    ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
    ctx.clearRect(0, 0, width, height);
    const inner = width - PAD.left - PAD.right;
    const curves = panel.lines.map((line) => thinned(line.points(from, to, (to - from) / Math.max(inner, 50)), from, to, inner));
    let low = Infinity, high = -Infinity;
    for (const curve of curves) for (const [, y] of curve) { low = Math.min(low, y); high = Math.max(high, y); }
    if (panel.lines.some((line) => line.area)) { low = Math.min(low, 0); high = Math.max(high, 0); }
    if (!(high - low > 1e-9 * Math.max(Math.abs(low), Math.abs(high)))) { const wide = Math.max(0.01 * Math.abs(low), 1e-12); low -= wide; high += wide; }
    const room = 0.06 * (high - low);
    low -= room; high += room;
    panel.x = (t) => PAD.left + ((t - from) / (to - from)) * inner;
    panel.y = (v) => height - PAD.bottom - ((v - low) / (high - low)) * (height - PAD.top - PAD.bottom);
    for (const [name, first, last] of this.phases) {
      if (last < from || first > to || !(name in PHASES)) continue;
      ctx.globalAlpha = 0.17; ctx.fillStyle = look.phases[PHASES[name]];
      ctx.fillRect(panel.x(Math.max(first, from)), PAD.top, Math.max(panel.x(Math.min(last, to)) - panel.x(Math.max(first, from)), 0.5), height - PAD.top - PAD.bottom);
    }
    ctx.globalAlpha = 1;
    this.axes(ctx, panel, low, high, width, height, look);
    ctx.save(); ctx.beginPath(); ctx.rect(PAD.left, 0, inner, height - PAD.bottom); ctx.clip();
    panel.lines.forEach((line, i) => {
      ctx.beginPath();
      curves[i].forEach(([t, v], k) => (k ? ctx.lineTo(panel.x(t), panel.y(v)) : ctx.moveTo(panel.x(t), panel.y(v))));
      ctx.strokeStyle = look[line.colour]; ctx.lineWidth = 1.7; ctx.lineJoin = "round"; ctx.stroke();
      if (line.area) { ctx.lineTo(panel.x(to), panel.y(0)); ctx.lineTo(panel.x(from), panel.y(0)); ctx.closePath(); ctx.globalAlpha = 0.25; ctx.fillStyle = look[line.colour]; ctx.fill(); ctx.globalAlpha = 1; }
    });
    ctx.restore();
    panel.digits = clamp(3 - Math.floor(Math.log10(high - low)), 0, 6);
    panel.size = high - low;
    panel.fresh = true;
  }

  axes(ctx, panel, low, high, width, height, look) {
    const size = Math.max(Math.abs(low), Math.abs(high)), [factor, prefix] = panel.metric ? PREFIXES.find(([least]) => size >= least) ?? [1e-12, "p"] : [1, ""];
    ctx.font = `11.5px ${look.font}`; ctx.fillStyle = look.faint; ctx.strokeStyle = look.grid; ctx.lineWidth = 1;
    ctx.textAlign = "right"; ctx.textBaseline = "middle";
    const step = roundStep((high - low) / factor / Math.max(4, Math.floor(height / 26)));
    for (let k = Math.ceil(low / factor / step); k * step <= high / factor; k++) {
      const y = Math.round(panel.y(k * step * factor)) + 0.5;
      ctx.beginPath(); ctx.moveTo(PAD.left, y); ctx.lineTo(width - PAD.right, y); ctx.stroke();
      ctx.fillText(minus((k * step).toFixed(decimals(step))), PAD.left - 6, y, PAD.left - 8); // squeezed where it is too long
    }
    const scale = timeScale(...this.range), [from, to] = this.range.map((t) => (t - scale.base) * scale.factor);
    const tick = roundStep((to - from) / Math.max(2, Math.floor((width - PAD.left) / 90)));
    ctx.textBaseline = "alphabetic"; ctx.strokeStyle = look.edgeLine;
    ctx.beginPath(); ctx.moveTo(PAD.left, height - PAD.bottom + 0.5); ctx.lineTo(width - PAD.right, height - PAD.bottom + 0.5); ctx.stroke();
    let free = -Infinity;
    for (let k = Math.ceil(from / tick - 1e-9); k * tick <= to * (1 + 1e-12); k++) {
      const x = PAD.left + ((k * tick - from) / (to - from)) * (width - PAD.left - PAD.right), last = (k + 1) * tick > to;
      const text = minus((k * tick).toFixed(decimals(tick))) + (last ? ` ${scale.unit}` : ""), wide = ctx.measureText(text).width, at = Math.min(x, width - 2 - wide / 2);
      ctx.beginPath(); ctx.moveTo(x, height - PAD.bottom); ctx.lineTo(x, height - PAD.bottom + 4); ctx.stroke();
      if (at - wide / 2 < free) continue;
      ctx.textAlign = "center"; ctx.fillText(text, at, height - 5);
      free = at + wide / 2 + 8;
    }
    panel.unitText = `${prefix}${panel.unit}`;
    ctx.textAlign = "left"; ctx.fillText(scale.base ? `${Number(scale.base.toPrecision(9))} s +` : "", 4, height - 5);
    panel.canvas.previousSibling.firstChild.textContent = `${panel.title} (${prefix}${panel.unit})`;
  }
}
