// A spring between two points: drawn as a helical one is seen from the side. The same shape as in movies.
class Zigzag {
  constructor(data) { Object.assign(this, data); }

  end(view, poses, k) {
    const [x, y] = this.points[k];
    return this.bodies[k] < 0 ? [x, y] : view.point(poses, this.bodies[k], x, y);
  }

  // In the movement, from end to end: [x, y] each.
  line(view, poses) {
    const a = this.end(view, poses, 0), b = this.end(view, poses, 1), way = [b[0] - a[0], b[1] - a[1]], length = Math.hypot(...way);
    const side = length > 0 ? [(-this.half * way[1]) / length, (this.half * way[0]) / length] : [0, 0];
    return this.shares.map((share, i) => [0, 1].map((k) => a[k] + share * way[k] + this.sides[i] * side[k]));
  }

  // The same as SVG path data in mm.
  pathData(view, poses) { return `M${this.line(view, poses).flat().map((v) => (1e3 * v).toFixed(4)).join(" ")}`; }

  draw(ctx, view, poses, look) {
    const points = this.line(view, poses).map(([x, y]) => view.screen(x, y)), colour = look.dark ? this.colours[1] : this.colours[0];
    view.plain(ctx);
    ctx.globalAlpha = this.bodies.every((b) => b < 0 || look.faded.has(b)) ? FADED : 1;
    ctx.lineJoin = ctx.lineCap = "round";
    ctx.beginPath();
    for (const point of points) ctx.lineTo(...point);
    for (const [stroke, width] of [[look.paper, 3.8], [colour, 1.8]]) { ctx.strokeStyle = stroke; ctx.lineWidth = width; ctx.stroke(); }
    ctx.fillStyle = colour; ctx.strokeStyle = look.paper; ctx.lineWidth = 0.8;
    for (const [x, y] of [points[0], points[points.length - 1]]) { ctx.beginPath(); ctx.arc(x, y, 3, 0, 2 * Math.PI); ctx.fill(); ctx.stroke(); }
    ctx.globalAlpha = 1;
  }
}
