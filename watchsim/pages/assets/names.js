// Names on the parts: in two columns beside the mechanism, each with a line to its place; no line crosses another, as in stills.
const ROW = 19, INSET = 14, ABOVE = 66, BELOW = 52; // CSS pixels: between names, from the edges, kept free above and below

class Names {
  constructor(data) { this.all = data.names.map(([text, body, x, y]) => ({ text, body, point: [x, y] })); this.on = false; this.sides = null; }

  get any() { return this.all.length > 0; }

  // Where each name, its line and its place are now; the order of the columns is determined again unless `kept`.
  placed(ctx, view, poses, look, kept) {
    ctx.font = `600 12.5px ${look.font}`;
    const found = this.all.map((one) => {
      const at = view.screen(...(one.body < 0 ? one.point : view.point(poses, one.body, ...one.point)));
      return { ...one, at, width: ctx.measureText(one.text).width };
    }).filter(({ at }) => at[0] > 0 && at[0] < view.width && at[1] > 0 && at[1] < view.height);
    if (!kept || !this.sides || this.sides.flat().length !== found.length) this.arrange(found, view);
    const all = found.map((_, k) => k);
    return this.clear(this.sides.flatMap((side, k) => side.map((number, row) => {
      const one = found[number], y = this.height(side.length, row, view), x = k ? view.width - INSET - one.width : this.left(view);
      return { text: one.text, body: one.body, at: one.at, box: [x, y - 12, x + one.width, y + 4], edge: [k ? x - 5 : x + one.width + 5, y - 4], from: [this.column(found, all, k, view), y - 4] };
    })));
  }

  // Where rows are kept, lines may come to cross: the name with the longer one is left out for as long.
  clear(labels) {
    const long = ({ from, at }) => Math.hypot(from[0] - at[0], from[1] - at[1]), kept = [];
    for (const label of labels.slice().sort((a, b) => long(a) - long(b))) if (!kept.some((other) => crosses(label.from, label.at, other.from, other.at))) kept.push(label);
    return kept;
  }

  // Slanted lines of a side begin at one height above the other, beyond the longest name.
  column(found, side, k, view) { const widest = 8 + Math.max(...side.map((number) => found[number].width)); return k ? view.width - INSET - widest : this.left(view) + widest; }

  left(view) { const box = view.corner; return INSET + (box ? box[0] + box[2] : 0); }

  height(count, row, view) { const room = view.height - ABOVE - BELOW, step = Math.max(room / count, ROW); return ABOVE + step * (row + 0.5); }

  // Half of the names on either side, then exchanged until no exchange makes the lines shorter: such lines do not cross.
  arrange(found, view) {
    const order = found.map((_, k) => k).sort((a, b) => found[a].at[0] - found[b].at[0]), half = Math.ceil(order.length / 2);
    this.sides = [order.slice(0, half), order.slice(half)].map((side) => side.sort((a, b) => found[a].at[1] - found[b].at[1]));
    const slots = this.sides.flatMap((side, k) => side.map((_, row) => [k, row])), widest = order.map((_, k) => k);
    const length = (number, [k, row]) => Math.hypot(this.column(found, widest, k, view) - found[number].at[0], this.height(this.sides[k].length, row, view) - 4 - found[number].at[1]);
    for (let again = true, rounds = 0; again && rounds < 50; rounds++) {
      again = false;
      for (let i = 0; i < slots.length; i++) for (let j = 0; j < i; j++) {
        const [k, row] = slots[i], [m, line] = slots[j], a = this.sides[k][row], b = this.sides[m][line];
        if (length(a, slots[j]) + length(b, slots[i]) < length(a, slots[i]) + length(b, slots[j]) - 1e-6) { this.sides[k][row] = b; this.sides[m][line] = a; again = true; }
      }
    }
  }

  draw(ctx, view, poses, look, kept) {
    view.plain(ctx);
    const found = this.placed(ctx, view, poses, look, kept);
    ctx.textAlign = "left"; ctx.textBaseline = "alphabetic"; ctx.lineWidth = 1;
    for (const { text, body, at, box, edge, from } of found) {
      ctx.globalAlpha = look.faded.has(body) ? 0.35 : 1;
      ctx.strokeStyle = look.ink; ctx.fillStyle = look.ink;
      ctx.beginPath(); ctx.moveTo(...edge); ctx.lineTo(...from); ctx.lineTo(...at); ctx.stroke();
      ctx.beginPath(); ctx.arc(...at, 2.2, 0, 2 * Math.PI); ctx.fill();
      ctx.lineWidth = 4; ctx.lineJoin = "round"; ctx.strokeStyle = look.paper; ctx.strokeText(text, box[0], box[3] - 4); ctx.lineWidth = 1;
      ctx.fillText(text, box[0], box[3] - 4);
    }
    ctx.globalAlpha = 1;
  }
}

const crosses = (a, b, c, d) => {
  const side = (p, q, r) => (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
  return side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0;
};
