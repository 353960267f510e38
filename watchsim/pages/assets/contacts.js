// Where do parts touch, and how hard?
class Contact {
  constructor(data) {
    Object.assign(this, data);
    this.closed = doubles(data.closed);
    this.t = data.t ? doubles(data.t) : null;
    this.force = data.force ? floats(data.force) : null;
  }

  holds(time) { return upTo(this.closed, time) % 2 === 1; }

  // Where it touches and the normal out of the second side's material, for these poses.
  touch(view, poses) {
    const [a, ax, ay, radius] = this.a, [b, bx, by, side] = this.b, [x, y] = view.point(poses, a, ax, ay);
    let nx, ny;
    if (this.normal) {
      const c = Math.cos(poses[3 * b + 2]), s = Math.sin(poses[3 * b + 2]);
      [nx, ny] = [c * this.normal[0] - s * this.normal[1], s * this.normal[0] + c * this.normal[1]];
    } else {
      const [px, py] = view.point(poses, b, bx, by), apart = side * Math.hypot(x - px, y - py) || 1;
      [nx, ny] = [(x - px) / apart, (y - py) / apart];
    }
    return [x - radius * nx, y - radius * ny, nx, ny];
  }

  // Normal and tangential force on the first side (N); null where they are not known.
  press(time) {
    if (!this.t || !this.t.length || !this.holds(time)) return null;
    const since = this.closed[upTo(this.closed, time) - 1], i = clamp(upTo(this.t, time) - 1, 0, this.t.length - 1), j = Math.min(i + 1, this.t.length - 1);
    const first = this.t[i] < since ? j : i, step = this.t[j] - this.t[first];
    const until = this.closed[upTo(this.closed, time)];
    const s = step > 0 && this.t[j] < until ? clamp((time - this.t[first]) / step, 0, 1) : 0;
    const f = this.force;
    return [f[2 * first] + s * (f[2 * j] - f[2 * first]), f[2 * first + 1] + s * (f[2 * j + 1] - f[2 * first + 1])];
  }

  // Force on body `on`, one of its two (N), as x, y.
  on(body, time, nx, ny) {
    const force = this.press(time);
    if (!force) return null;
    const sign = body === this.a[0] ? 1 : -1;
    return [sign * (force[0] * nx - force[1] * ny), sign * (force[0] * ny + force[1] * nx)];
  }
}

const LONG_ARROW = 0.22, USUAL = 0.97, NO_FORCE = 1e-13; // N; less is rounding

class Contacts {
  constructor(data) {
    this.all = data.contacts.map((one) => new Contact(one));
    this.ranks = data.ranks;
    const sizes = this.all.flatMap((one) => (one.force ? Array.from({ length: one.t.length }, (_, i) => Math.hypot(one.force[2 * i], one.force[2 * i + 1])) : []));
    sizes.sort((x, y) => x - y);
    this.usual = sizes.length ? sizes[Math.floor(USUAL * (sizes.length - 1))] || sizes[sizes.length - 1] : 0;
    this.known = this.usual > NO_FORCE;
  }

  // On which of its two bodies a force is drawn: the one chosen, else the one nearer to the balance.
  shownOn(one, chosen) {
    const [a, b] = [one.a[0], one.b[0]], rank = (body) => (body === chosen ? -1 : (this.ranks.indexOf(body) + 1 || 99));
    return rank(b) < rank(a) ? b : a;
  }

  draw(ctx, view, poses, time, look, points, arrows) {
    view.plain(ctx);
    const scale = arrows && this.known ? (LONG_ARROW * Math.min(view.width, view.height)) / this.usual : 0;
    const shown = [];
    for (const one of this.all) {
      if (!one.holds(time)) continue;
      const [x, y, nx, ny] = one.touch(view, poses), [px, py] = view.screen(x, y);
      if (points) {
        ctx.beginPath(); ctx.arc(px, py, clamp(view.width / 110, 3.5, 5.5), 0, 2 * Math.PI);
        ctx.strokeStyle = look.paper; ctx.lineWidth = 4.5; ctx.stroke();
        ctx.strokeStyle = look.contact; ctx.lineWidth = 2.2; ctx.stroke();
      }
      if (!scale) continue;
      const force = one.on(this.shownOn(one, look.chosen), time, nx, ny);
      if (force) shown.push([px, py, force]);
    }
    for (const [px, py, force] of shown) arrow(ctx, view, px, py, force, scale, look);
    if (scale) this.bar(ctx, view, scale, look);
  }

  bar(ctx, view, scale, look) {
    const most = roundDown((0.25 * view.width) / scale), length = most * scale, x = 16, y = view.height - 18;
    ctx.strokeStyle = ctx.fillStyle = look.force; ctx.lineWidth = 2.4;
    ctx.beginPath(); ctx.moveTo(x, y); ctx.lineTo(x + length, y); ctx.moveTo(x, y - 4); ctx.lineTo(x, y + 4); ctx.moveTo(x + length, y - 4); ctx.lineTo(x + length, y + 4); ctx.stroke();
    label(ctx, `force ${metric(most, "N")}`, x, y - 9, look, "left");
  }
}

const arrow = (ctx, view, x, y, force, scale, look) => {
  const c = Math.cos(view.turn), s = Math.sin(view.turn);
  const dx = scale * (c * force[0] - s * force[1]), dy = -scale * (s * force[0] + c * force[1]), length = Math.hypot(dx, dy);
  if (length < 1.5) return;
  const ux = dx / length, uy = dy / length, head = Math.min(11, 0.6 * length), ex = x + dx, ey = y + dy;
  for (const [colour, width] of [[look.paper, 6], [look.force, 2.8]]) {
    ctx.strokeStyle = ctx.fillStyle = colour; ctx.lineWidth = width; ctx.lineCap = "butt"; ctx.lineJoin = "round";
    ctx.beginPath(); ctx.moveTo(x, y); ctx.lineTo(ex - 0.8 * head * ux, ey - 0.8 * head * uy); ctx.stroke();
    ctx.beginPath(); ctx.moveTo(ex, ey); ctx.lineTo(ex - head * ux - 0.45 * head * uy, ey - head * uy + 0.45 * head * ux); ctx.lineTo(ex - head * ux + 0.45 * head * uy, ey - head * uy - 0.45 * head * ux); ctx.closePath();
    ctx.fill(); if (width > 3) { ctx.lineWidth = 3; ctx.stroke(); }
  }
  if (length > 26) label(ctx, metric(Math.hypot(...force), "N"), ex + 12 * ux, ey + 12 * uy, look, ux > 0.3 ? "left" : ux < -0.3 ? "right" : "center");
};

const label = (ctx, text, x, y, look, align) => {
  ctx.font = `600 12.5px ${look.font}`; ctx.textAlign = align; ctx.textBaseline = "middle"; ctx.lineJoin = "round";
  ctx.strokeStyle = look.paper; ctx.lineWidth = 4; ctx.strokeText(text, x, y);
  ctx.fillStyle = look.force; ctx.fillText(text, x, y);
};

// Numbers for people.
const PREFIXES = [[1e9, "G"], [1e6, "M"], [1e3, "k"], [1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"], [1e-12, "p"]];
const metric = (value, unit) => {
  const size = Math.abs(value);
  if (!(size > 0)) return `0 ${unit}`;
  const [factor, prefix] = PREFIXES.find(([least]) => size >= 0.9995 * least) ?? PREFIXES[PREFIXES.length - 1];
  return `${minus((value / factor).toPrecision(3))} ${prefix}${unit}`;
};
const minus = (text) => text.replace(/^-(?=[0.]*$)/, "").replace("-", "\u2212");
const roundDown = (most) => {
  const power = 10 ** Math.floor(Math.log10(most));
  return [5, 2, 1].find((step) => step * power <= most * (1 + 1e-9)) * power;
};
