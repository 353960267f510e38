// Which place of the mechanism is seen where on the screen?
const MARGIN = 0.05, QUARTER_GAIN = 1.25, CLOSEST = 4000, FARTHEST = 0.2, BAND = 34;
const WHOLE = 0.2, OVER = 84, UNDER = 56; // of the width that the whole takes beside a part of it; CSS pixels free above and below it

class View {
  constructor(data) {
    this.data = data.view;
    this.width = this.height = 1; this.ratio = 1; this.sized = false;
    this.zoom = 1; this.shift = [0, 0]; // of the picture, in metres of the mechanism
    this.turn = this.data.turn;
    this.centre = [0, 0]; this.base = 1;
    this.origin = [0, 0]; // of the picture on its canvas, CSS pixels
    this.anchor = null; // a point of a body that stays in the middle: [body, x, y]
  }

  get scale() { return this.base * this.zoom; } // CSS pixels per metre

  resize(width, height, ratio, band = BAND) {
    Object.assign(this, { width, height, ratio, band, sized: true });
    if (this.data.follow) { this.base = Math.min(height, width * 0.5625) / this.data.follow.sight; return; }
    const { boxes } = this.data, room = boxes.map((box) => box.slice(1)), shown = this.opens ? this.data.close : room;
    const k = this.turned(shown);
    this.turn = boxes[k][0]; this.room = room[k];
    this.base = this.fits(this.room);
    this.home = this.middle(this.room);
  }

  // CSS pixels per metre that show a box (x, y to x, y of the turned picture), beside what takes `aside` pixels.
  fits(box, aside = 0) { return (1 - 2 * MARGIN) * Math.min((this.width - aside) / Math.max(box[2] - box[0], 1e-12), Math.max(this.height - 2 * this.band, 40) / Math.max(box[3] - box[1], 1e-12)); }

  middle(box) {
    const c = Math.cos(this.turn), s = Math.sin(this.turn), x = 0.5 * (box[0] + box[2]), y = 0.5 * (box[1] + box[3]);
    return [c * x + s * y, -s * x + c * y];
  }

  get aside() { return 14 + WHOLE * this.width; }

  // Which of the boxes of a picture as it is and of one turned by a quarter is worth showing?
  turned(boxes) { return boxes.length > 1 && this.fits(boxes[1]) > QUARTER_GAIN * this.fits(boxes[0]) ? 1 : 0; }

  // Is what touches so small that the page opens with it, and with the whole beside it?
  get opens() {
    const { close, closer, boxes } = this.data;
    if (!close) return false;
    const k = this.turned(close), whole = boxes.map((box) => this.fits(box.slice(1)));
    return this.fits(close[k], this.aside) > closer * Math.max(whole[k], whole[this.turned(boxes.map((box) => box.slice(1)))]);
  }

  // What touches, beside the whole; everything where that is hardly smaller.
  open() {
    this.reset();
    if (!this.opens) return;
    const box = this.data.close[this.data.boxes.findIndex(([turn]) => turn === this.turn)], at = this.middle(box);
    this.zoom = this.fits(box, this.aside) / this.base;
    const c = Math.cos(this.turn), s = Math.sin(this.turn), right = (0.5 * this.aside) / this.scale; // of the picture, which the box on the left moves
    this.shift = [at[0] - c * right - this.home[0], at[1] + s * right - this.home[1]];
  }

  // Where the whole stands small beside a part of it: left, top, width, height; null where all is in sight.
  get corner() {
    if (this.data.follow || this.zoom < this.data.closer) return null;
    const [x0, y0, x1, y1] = this.room, most = this.height - OVER - UNDER, wide = (x1 - x0) / Math.max(y1 - y0, 1e-12);
    const width = Math.min(WHOLE * this.width, wide < 1 ? Math.max(most * wide, 0.5 * WHOLE * this.width) : Infinity), height = Math.min(most, Math.max(width / wide, 24));
    return most < 40 ? null : [14, OVER, width, height];
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
    return [this.origin[0] + 0.5 * this.width + this.c * dx - this.s * dy, this.origin[1] + 0.5 * this.height - this.s * dx - this.c * dy];
  }

  world(px, py) {
    const dx = (px - this.origin[0] - 0.5 * this.width) / this.scale, dy = (this.origin[1] + 0.5 * this.height - py) / this.scale, c = Math.cos(this.turn), s = Math.sin(this.turn);
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
