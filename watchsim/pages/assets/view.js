// Which place of the mechanism is seen where on the screen?
const MARGIN = 0.05, QUARTER_GAIN = 1.25, CLOSEST = 4000, FARTHEST = 0.2, BAND = 34;

class View {
  constructor(data) {
    this.data = data.view;
    this.width = this.height = 1; this.ratio = 1;
    this.zoom = 1; this.shift = [0, 0]; // of the picture, in metres of the mechanism
    this.turn = this.data.turn;
    this.centre = [0, 0]; this.base = 1;
    this.anchor = null; // a point of a body that stays in the middle: [body, x, y]
  }

  get scale() { return this.base * this.zoom; } // CSS pixels per metre

  resize(width, height, ratio) {
    Object.assign(this, { width, height, ratio });
    const high = Math.max(height - 2 * BAND, 40);
    const fits = (box) => (1 - 2 * MARGIN) * Math.min(width / Math.max(box[3] - box[1], 1e-12), high / Math.max(box[4] - box[2], 1e-12));
    if (this.data.follow) { this.base = Math.min(height, width * 0.5625) / this.data.follow.sight; return; }
    let box = this.data.boxes[0];
    if (this.data.boxes.length > 1 && fits(this.data.boxes[1]) > QUARTER_GAIN * fits(box)) box = this.data.boxes[1];
    this.turn = box[0];
    this.base = fits(box);
    const c = Math.cos(this.turn), s = Math.sin(this.turn), x = 0.5 * (box[1] + box[3]), y = 0.5 * (box[2] + box[4]);
    this.home = [c * x + s * y, -s * x + c * y];
  }

  // Put the middle of the picture where it belongs for these poses.
  aim(poses) {
    const follow = this.data.follow;
    let middle = this.home;
    if (this.anchor) middle = this.point(poses, ...this.anchor);
    else if (follow) {
      const [x, y] = follow.centre, [tx, ty] = follow.track, b = 3 * follow.body;
      const way = tx * (poses[b] - x) + ty * (poses[b + 1] - y);
      middle = [x + way * tx, y + way * ty];
    }
    this.centre = [middle[0] + this.shift[0], middle[1] + this.shift[1]];
    this.c = this.scale * Math.cos(this.turn); this.s = this.scale * Math.sin(this.turn);
  }

  point(poses, b, x, y) {
    const c = Math.cos(poses[3 * b + 2]), s = Math.sin(poses[3 * b + 2]);
    return [poses[3 * b] + c * x - s * y, poses[3 * b + 1] + s * x + c * y];
  }

  within(poses, b, [x, y]) { // the same place in the frame of a body
    const c = Math.cos(poses[3 * b + 2]), s = Math.sin(poses[3 * b + 2]), dx = x - poses[3 * b], dy = y - poses[3 * b + 1];
    return [c * dx + s * dy, -s * dx + c * dy];
  }

  screen(x, y) {
    const dx = x - this.centre[0], dy = y - this.centre[1];
    return [0.5 * this.width + this.c * dx - this.s * dy, 0.5 * this.height - this.s * dx - this.c * dy];
  }

  world(px, py) {
    const dx = (px - 0.5 * this.width) / this.scale, dy = (0.5 * this.height - py) / this.scale, c = Math.cos(this.turn), s = Math.sin(this.turn);
    return [this.centre[0] + c * dx + s * dy, this.centre[1] - s * dx + c * dy];
  }

  // Let a canvas draw in the frame of body b, in metres; `right` and `down` shift by pixels.
  place(ctx, poses, b, right = 0, down = 0) {
    const [x, y] = this.screen(poses[3 * b], poses[3 * b + 1]), c = Math.cos(poses[3 * b + 2]), s = Math.sin(poses[3 * b + 2]), k = this.ratio;
    const along = this.c * c - this.s * s, across = this.s * c + this.c * s; // scale times cosine and sine of both turns
    ctx.setTransform(k * along, -k * across, -k * across, -k * along, k * (x + right), k * (y + down));
  }

  plain(ctx) { ctx.setTransform(this.ratio, 0, 0, this.ratio, 0, 0); }

  // Zoom so that what lies at a place of the screen stays there.
  zoomAt(factor, px, py) {
    const before = this.world(px, py);
    this.zoom = clamp(this.zoom * factor, FARTHEST, CLOSEST);
    const after = this.world(px, py);
    this.shift[0] += before[0] - after[0]; this.shift[1] += before[1] - after[1];
    this.centre[0] += before[0] - after[0]; this.centre[1] += before[1] - after[1];
  }

  pan(dx, dy) {
    const [x0, y0] = this.world(0, 0), [x1, y1] = this.world(dx, dy);
    this.shift[0] -= x1 - x0; this.shift[1] -= y1 - y0;
  }

  reset() { this.zoom = 1; this.shift = [0, 0]; this.anchor = null; }
}
