// What is shown now: the instant, the speed, the part chosen; everything else asks here.
const PHASES = { unlock: 0, "catch-up": 1, impulse: 2, drop: 3, "run to banking": 4, recoil: 0 };
const FLASH = 0.25; // s on the screen that an impact is seen

class Player {
  constructor(data, parts) {
    Object.assign(this, parts);
    [this.start, this.end] = data.window;
    this.whole = new View(data);
    this.t = data.opening;
    this.events = data.events;
    this.times = Float64Array.from(data.events, ([t]) => t);
    this.phases = data.phases;
    this.edges = [...new Set(data.phases.flatMap(([, from, to]) => [from, to]))].sort((x, y) => x - y);
    this.playing = false;
    this.adaptive = this.clock.uneven;
    this.points = true;
    this.arrows = false;
    this.chosen = -1;
    this.faded = new Set();
    this.note = "";
    this.speedIndex = this.usualSpeed();
    this.clock.set(SPEEDS[this.speedIndex], this.adaptive);
  }

  // The speed at which the whole takes nearest to twenty seconds.
  usualSpeed() {
    const off = SPEEDS.map((speed) => { this.clock.set(speed, this.adaptive); return Math.abs(Math.log(this.clock.length / 20)); });
    return off.indexOf(Math.min(...off));
  }

  setSpeed(index) { this.speedIndex = clamp(index, 0, SPEEDS.length - 1); this.clock.set(SPEEDS[this.speedIndex], this.adaptive); this.changed(); }
  setAdaptive(on) { this.adaptive = on && this.clock.uneven; this.clock.set(SPEEDS[this.speedIndex], this.adaptive); this.changed(); }

  seek(t, note = "") { this.t = clamp(t, this.start, this.end); this.note = note; this.changed(); }

  toggle(on = !this.playing) {
    this.playing = on;
    if (on && this.t >= this.end) this.t = this.start;
    this.note = "";
    this.changed();
  }

  // One frame of `seconds`; true where something moved.
  tick(seconds) {
    if (!this.playing) return false;
    const before = this.t, next = this.clock.after(before, seconds);
    this.sound.play(before, Math.min(next, this.end), seconds);
    this.t = next >= this.end ? this.start : Math.max(next, this.start);
    return true;
  }

  // To the event before (-1) or after (+1), or the like edge of a phase.
  step(way) { this.toggle(false); const i = way > 0 ? upTo(this.times, this.t) : this.before(this.times); if (this.events[i]) this.seek(this.events[i][0], this.events[i][1]); }
  stepPhase(way) { this.toggle(false); const i = way > 0 ? upTo(this.edges, this.t) : this.before(this.edges); if (this.edges[i] !== undefined) this.seek(this.edges[i], this.phase()); }
  before(times) { let i = upTo(times, this.t) - 1; while (i >= 0 && times[i] >= this.t) i--; return i; }

  // The phase that lasts now.
  phase(t = this.t) {
    const found = this.phases.find(([, from, to]) => from <= t && t < to);
    return found ? found[0] : "";
  }

  choose(b, place = null) {
    this.chosen = b;
    this.view.anchor = b >= 0 && place ? [b, ...place] : null;
    this.view.shift = [0, 0];
    this.changed();
  }

  fade(b) { if (this.faded.has(b)) this.faded.delete(b); else this.faded.add(b); this.changed(); }

  // Draw everything for the instant t on a canvas of the view's size; in space `moving` may be coarser.
  draw(ctx, look, moving = false) {
    const poses = this.motion.poses(this.t);
    this.view.aim(poses);
    const own = { ...look, faded: this.faded, chosen: this.chosen };
    ctx.canvas.classList.toggle("above", this.solids.on && this.names.on);
    this.view.plain(ctx);
    if (this.solids.on) {
      this.solids.draw(this.view, poses, own, moving);
      if (this.names.on) { ctx.clearRect(0, 0, this.view.width, this.view.height); this.names.draw(ctx, this.solids.sight(this.view), poses, own, this.playing); }
      return;
    }
    ctx.fillStyle = look.paper;
    ctx.fillRect(0, 0, this.view.width, this.view.height);
    this.scenery.draw(ctx, this.view, poses, own);
    if (this.points || this.arrows) this.contacts.draw(ctx, this.view, poses, this.t, own, this.points, this.arrows);
    if (this.names.on) this.names.draw(ctx, this.view, poses, own, this.playing);
    this.beside(ctx, poses, own);
    this.ruler(ctx, look);
  }

  // The whole, small, with a rectangle around what is shown.
  beside(ctx, poses, look) {
    const box = this.view.corner, { whole, view } = this;
    if (!box) return;
    const [left, top, width, height] = box;
    whole.resize(width, height, view.ratio, 3); whole.origin = [left, top]; whole.turn = view.turn;
    whole.base = whole.fits(view.room); whole.home = view.home; whole.aim(poses);
    ctx.save();
    view.plain(ctx);
    ctx.beginPath(); ctx.rect(left, top, width, height); ctx.clip();
    ctx.fillStyle = look.paper; ctx.fill();
    this.scenery.draw(ctx, whole, poses, { ...look, small: true });
    whole.plain(ctx);
    const [a, b] = [view.world(0, 0), view.world(view.width, view.height)].map((place) => whole.screen(...place));
    ctx.strokeStyle = look.contact; ctx.lineWidth = 1.2; ctx.strokeRect(a[0], a[1], b[0] - a[0], b[1] - a[1]);
    ctx.restore();
    view.plain(ctx);
    ctx.strokeStyle = look.faint; ctx.lineWidth = 1; ctx.strokeRect(left, top, width, height);
  }

  // A bar of a round length.
  ruler(ctx, look) {
    const { view } = this, length = roundDown((0.16 * view.width) / view.scale), wide = length * view.scale, x = view.width - 150 - wide, y = view.height - 18;
    view.plain(ctx);
    ctx.font = `12.5px ${look.font}`; ctx.textAlign = "center"; ctx.textBaseline = "alphabetic"; ctx.fillStyle = look.ink; ctx.lineJoin = "round";
    ctx.beginPath(); ctx.moveTo(x, y - 4); ctx.lineTo(x, y); ctx.lineTo(x + wide, y); ctx.lineTo(x + wide, y - 4);
    for (const [colour, line] of [[look.paper, 5], [look.ink, 1.5]]) { // it may lie on a part
      ctx.strokeStyle = colour; ctx.lineWidth = line; ctx.stroke();
      if (line > 2) ctx.strokeText(metricLength(length), x + wide / 2, y - 6);
    }
    ctx.fillText(metricLength(length), x + wide / 2, y - 6);
  }
}

const metricLength = (length) => (length >= 0.9999 ? `${Number(length.toPrecision(3))} m` : length >= 0.99e-5 ? `${Number((1e3 * length).toPrecision(3))} mm` : length >= 0.99e-6 ? `${Number((1e6 * length).toPrecision(3))} µm` : `${Number((1e9 * length).toPrecision(3))} nm`);
