// The sound of a beat as an oscilloscope shows it: each impact rings as in `watchsim sound`, and is named by what met what.
const TONES = [[3400, 0.9e-3, 0.45], [6100, 0.6e-3, 0.35], [11300, 0.3e-3, 0.2]]; // Hz, decay (s), share of the start
const RUNG_OUT = 6e-3; // s, after which nothing of a noise is seen
const SMALLEST = 0.02, NAMES = 2, NAMED = 0.1; // fainter ones (of the loudest) are not named; rows of names; the longest stretch (s) that has any

class Strip {
  constructor(host, data, sound, seek) {
    Object.assign(this, { sound, phases: data.phases });
    this.times = Float64Array.from(data.events, ([t]) => t);
    this.named = data.events.map(([, words]) => words.split(": ")[0]);
    this.box = document.createElement("div"); this.box.className = "plot";
    const head = document.createElement("p"), name = document.createElement("b");
    this.read = document.createElement("span"); this.canvas = document.createElement("canvas"); this.cursor = document.createElement("i");
    const field = document.createElement("div");
    name.textContent = "Sound (relative)"; head.append(name, this.read); field.append(this.canvas, this.cursor); this.box.append(head, field);
    field.className = "noises"; this.cursor.className = "cursor";
    this.canvas.className = "strip"; this.canvas.setAttribute("role", "img"); this.canvas.setAttribute("aria-label", "Noises over time");
    this.canvas.addEventListener("pointerdown", (event) => { const box = this.canvas.getBoundingClientRect(); seek(this.range[0] + clamp((event.clientX - box.left - AXIS) / (box.width - AXIS - SIDES[1]), 0, 1) * (this.range[1] - this.range[0])); });
    if (data.sound.note) { const note = document.createElement("p"); note.className = "note"; note.textContent = data.sound.note; this.box.append(note); }
    host.after(this.box);
    this.box.hidden = !sound.t.length;
  }

  // What met what at a noise: the event of the same instant.
  name(t) { const i = upTo(this.times, t) - 1; return i >= 0 && this.times[i] === t ? this.named[i] : ""; }

  // The sum of all that rings at t; without `waves` only how strongly.
  at(t, waves) {
    const { t: times, loud } = this.sound;
    let sum = 0;
    for (let i = upTo(times, t) - 1; i >= 0 && t - times[i] < RUNG_OUT; i--) {
      for (const [hertz, decay, share] of TONES) sum += loud[i] * share * Math.exp((times[i] - t) / decay) * (waves ? Math.cos(2 * Math.PI * hertz * (t - times[i])) : 1);
    }
    return sum;
  }

  // For the instant t: the noises where their stretch, their size or the colours are new, else the cursor only.
  draw(t, look, range) {
    this.range = range;
    const { canvas, cursor } = this, [from, to] = range, ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight, { t: times } = this.sound, last = upTo(times, t) - 1;
    if (!width || this.box.hidden) return;
    const shown = [look, from, to, ratio, width, height];
    if (!this.shown || shown.some((one, k) => one !== this.shown[k])) { this.shown = shown; this.noises(look, range, ratio, width, height); }
    cursor.hidden = t < from || t > to;
    cursor.style.transform = `translateX(${AXIS + ((t - from) / (to - from)) * (width - AXIS - SIDES[1])}px)`;
    write(this.read, last >= 0 && t - times[last] < RUNG_OUT ? this.name(times[last]) : "");
  }

  noises(look, [from, to], ratio, width, height) {
    const { canvas } = this, ctx = canvas.getContext("2d");
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) { canvas.width = Math.round(width * ratio); canvas.height = Math.round(height * ratio); }
    const left = AXIS, wide = width - AXIS - SIDES[1], x = (time) => left + ((time - from) / (to - from)) * wide, step = (to - from) / wide;
    const top = to - from < NAMED ? 15 * NAMES + 4 : 4, middle = 0.5 * (top + height - 4), half = 0.5 * (height - 4 - top), waves = step < 5e-5;
    ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
    ctx.clearRect(0, 0, width, height);
    for (const [name, first, last] of this.phases) {
      if (last < from || first > to || !(name in PHASES)) continue;
      const a = clamp(x(first), left, left + wide), b = clamp(x(last), left, left + wide);
      ctx.fillStyle = look.bands[PHASES[name]]; ctx.fillRect(a, top, Math.max(b - a, 0.5), height - top);
    }
    ctx.strokeStyle = look.line; ctx.lineWidth = 1; ctx.beginPath();
    const { t: times, loud } = this.sound, parts = waves ? 4 : 1;
    if (waves) for (let k = 0; k <= wide * parts; k++) ctx.lineTo(left + k / parts, middle - half * this.at(from + (step * k) / parts, true));
    else {
      const high = new Float32Array(Math.ceil(wide) + 1); // the loudest of what begins within a pixel, and what still rings
      for (let k = 0; k < high.length; k++) high[k] = this.at(from + step * k, false);
      for (let i = upTo(times, from); i < times.length && times[i] < to; i++) { const k = Math.round((times[i] - from) / step); high[k] = Math.max(high[k], loud[i]); }
      high.forEach((value, k) => { ctx.moveTo(left + k, middle - half * Math.min(value, 1)); ctx.lineTo(left + k, middle + half * Math.max(Math.min(value, 1), 0.5 / half)); });
    }
    ctx.stroke();
    if (to - from < NAMED) this.names(ctx, look, x, from, to, left + wide, top, middle - half);
    this.cursor.style.top = `${top}px`;
  }

  // The loudest first, as many as fit beside each other in the rows above.
  names(ctx, look, x, from, to, right, top, peak) {
    const { t: times, loud } = this.sound, taken = Array.from({ length: NAMES }, () => []), seen = [];
    for (let i = upTo(times, from); i < times.length && times[i] < to; i++) if (loud[i] >= SMALLEST) seen.push(i);
    ctx.font = `11.5px ${look.font}`; ctx.textBaseline = "alphabetic"; ctx.textAlign = "left"; ctx.lineWidth = 0.7;
    for (const i of seen.sort((a, b) => loud[b] - loud[a])) {
      const text = this.name(times[i]);
      if (!text) continue;
      const length = ctx.measureText(text).width, at = x(times[i]), begin = clamp(at - 3, AXIS, right - length), end = begin + length;
      // No name over another, and no line through a name below it.
      const row = taken.findIndex((spans, k) => spans.every(([a, b]) => begin > b + 8 || end < a - 8) && taken.every((others, m) => others.every(([a, b, line]) => (m > k ? at < a - 2 || at > b + 2 : m === k || line < begin - 2 || line > end + 2))));
      if (row < 0) continue;
      taken[row].push([begin, end, at]);
      ctx.fillStyle = look.faint; ctx.fillText(text, begin, 12 + 15 * row);
      ctx.strokeStyle = look.faint; ctx.beginPath(); ctx.moveTo(at, 15 + 15 * row); ctx.lineTo(at, Math.max(top, peak)); ctx.stroke();
    }
  }
}
