// The outlines of the drawing on a canvas: arcs stay arcs at any zoom.
const MOVE = 0, LINE = 1, ARC = 2;
const FADED = 0.14, THIN = 1.1, RING = 3.4, PALE = 0.55;

const pathOf = (part) => {
  const path = new Path2D(), codes = bytesOf(part.codes), n = floats(part.numbers);
  let at = 0;
  for (const code of codes) {
    if (code === MOVE) { path.moveTo(n[at], n[at + 1]); at += 2; }
    else if (code === LINE) { path.lineTo(n[at], n[at + 1]); at += 2; }
    else if (code === ARC) { path.arc(n[at], n[at + 1], n[at + 2], n[at + 3], n[at + 3] + n[at + 4], n[at + 4] < 0); at += 5; }
    else path.closePath();
  }
  return path;
};
const strokesOf = (text) => {
  const path = new Path2D(), n = floats(text);
  for (let i = 0; i < n.length; i += 4) { path.moveTo(n[i], n[i + 1]); path.lineTo(n[i + 2], n[i + 3]); }
  return path;
};

class Scenery {
  constructor(data) {
    this.bodies = data.bodies;
    this.parts = data.parts.map((part) => ({ ...part, path: pathOf(part), strokes: part.ground ? strokesOf(part.ground) : null }));
    // What never moves lies below what does, but for what cannot touch and is larger than all that can: a balance's rim.
    this.coils = data.coils.map((one) => new Coil(one));
    this.zigzags = data.line_springs.map((one) => new Zigzag(one));
    this.still = this.parts.filter((part) => data.bodies[part.body].still);
    const moving = this.parts.filter((part) => !data.bodies[part.body].still), first = moving.findIndex((part) => !part.pale);
    this.behind = moving.slice(0, first < 0 ? moving.length : first);
    this.moving = moving.slice(this.behind.length);
    this.ghost = []; // outlines of an earlier version: body, path, and how far its body stood from where it stands now
  }

  // Outlines of another version that are not among these, or stand elsewhere.
  haunt(other) {
    const same = (part, one) => part.layer === one.layer && part.codes === one.codes && part.numbers === one.numbers;
    this.ghost = other.parts.flatMap((one) => {
      const then = other.bodies[one.body], b = this.bodies.findIndex((body) => body.name === then.name);
      if (b < 0 || then.on !== this.bodies[b].on) return [];
      const off = then.motion === "free" ? [0, 0] : [0, 1].map((k) => then.at[k] - this.bodies[b].at[k]);
      return Math.hypot(...off) < 1e-12 && this.parts.some((part) => part.body === b && same(part, one)) ? [] : [{ body: b, path: one.path, off }];
    });
  }

  haunted(ctx, view, poses, look) {
    for (const { body, path, off } of this.ghost) {
      const [x, y, angle] = poses.slice(3 * body, 3 * body + 3);
      view.place(ctx, [x + off[0], y + off[1], angle], 0);
      // Light below and dashes above: seen on parts of any colour.
      ctx.strokeStyle = look.paper; ctx.lineWidth = 4 / view.scale; ctx.stroke(path);
      ctx.strokeStyle = look.accent; ctx.lineWidth = 2 / view.scale; ctx.setLineDash([6 / view.scale, 3 / view.scale]);
      ctx.stroke(path); ctx.setLineDash([]);
    }
  }

  // Everything at the poses given; `look` holds colours, what is faded, and the body chosen (or -1).
  draw(ctx, view, poses, look) {
    for (const coil of this.coils) coil.draw(ctx, view, poses, look);
    for (const part of this.behind) { this.shadow(ctx, view, poses, part, look); this.part(ctx, view, poses, part, look); }
    for (const part of this.still) this.part(ctx, view, poses, part, look);
    for (const part of this.moving) this.shadow(ctx, view, poses, part, look);
    for (const part of this.moving) this.part(ctx, view, poses, part, look);
    this.bodies.forEach((body, b) => {
      if (!body.spoke) return;
      view.place(ctx, poses, b);
      ctx.globalAlpha = look.faded.has(b) ? FADED : 1;
      ctx.strokeStyle = look.edge; ctx.lineWidth = 2 / view.scale; ctx.lineCap = "round";
      ctx.beginPath(); ctx.moveTo(body.spoke[0], 0); ctx.lineTo(body.spoke[1], 0); ctx.stroke();
    });
    ctx.globalAlpha = 1;
    if (!look.small) this.bodies.forEach((body, b) => { if (body.motion === "pivot") this.ring(ctx, view, poses, b, look); });
    for (const zigzag of this.zigzags) zigzag.draw(ctx, view, poses, look);
    if (!look.small) this.haunted(ctx, view, poses, look);
  }

  shadow(ctx, view, poses, part, look) {
    if (part.strokes || look.small || look.faded.has(part.body)) return;
    ctx.fillStyle = look.shade;
    view.place(ctx, poses, part.body, 2, 3);
    ctx.fill(part.path);
  }

  part(ctx, view, poses, part, look) {
    const worn = (colour) => (part.pale ? blended(colour, look.paper, PALE) : colour);
    const fixed = part.strokes !== null;
    view.place(ctx, poses, part.body);
    ctx.globalAlpha = look.faded.has(part.body) ? FADED : 1;
    ctx.lineJoin = "round"; ctx.lineCap = "round";
    if (!fixed) { ctx.fillStyle = worn(part.fill); ctx.fill(part.path); }
    if (fixed && part.strokes) { ctx.strokeStyle = look.ground; ctx.lineWidth = 0.9 / view.scale; ctx.stroke(part.strokes); }
    ctx.strokeStyle = fixed ? look.ground : worn(part.edge);
    ctx.lineWidth = ((fixed ? 1.9 : THIN) * (look.small ? 0.5 : 1)) / view.scale;
    ctx.stroke(part.path);
    if (part.body === look.chosen) { ctx.strokeStyle = look.accent; ctx.lineWidth = 2 / view.scale; ctx.stroke(part.path); }
    ctx.globalAlpha = 1;
  }

  ring(ctx, view, poses, b, look) {
    const [x, y] = view.screen(poses[3 * b], poses[3 * b + 1]);
    view.plain(ctx);
    ctx.globalAlpha = look.faded.has(b) ? 0.4 : 1;
    ctx.beginPath(); ctx.arc(x, y, RING, 0, 2 * Math.PI);
    ctx.fillStyle = look.paper; ctx.fill();
    ctx.strokeStyle = look.edge; ctx.lineWidth = 1.3; ctx.stroke();
    ctx.globalAlpha = 1;
  }

  // The body whose face lies uppermost at a place of the screen (CSS pixels), faded ones last; -1 where there is none.
  hit(ctx, view, poses, x, y, faded) {
    const under = [...this.behind, ...this.still, ...this.moving].filter((part) => {
      if (part.strokes) return false;
      view.place(ctx, poses, part.body);
      return ctx.isPointInPath(part.path, x * view.ratio, y * view.ratio);
    }).map((part) => part.body);
    const clear = under.filter((b) => !faded.has(b));
    return (clear.length ? clear : under).pop() ?? -1;
  }
}
