// A hairspring between collet and stud: drawn, not simulated. The same shape as in movies.
const LEAST_TURNS = 0.25, STEEPEST = 0.95, STRAYS = 0.25, CHORDS = [24, 180];

class Coil {
  constructor(data) { Object.assign(this, data); }

  // Its middle from collet to stud, the collet turned by so many radians from rest; x, y one after the other.
  line(turned, scale) {
    const rest = 2 * Math.PI * this.turns, swept = Math.max(rest - turned, 2 * Math.PI * LEAST_TURNS), way = this.outer - this.inner;
    const bulge = clamp(3 * (this.inner + this.outer) * (rest / swept - 1), -STEEPEST * way, STEEPEST * way);
    const fitting = (2 * Math.PI) / Math.sqrt((8 * STRAYS) / (scale * this.outer)), n = Math.ceil(clamp(fitting, ...CHORDS) * this.turns);
    const out = new Float64Array(2 * n + 2);
    for (let i = 0; i <= n; i++) {
      const s = i / n, angle = this.stud - swept * (1 - s), radius = this.inner + s * way + bulge * s * (1 - s);
      out[2 * i] = radius * Math.cos(angle); out[2 * i + 1] = radius * Math.sin(angle);
    }
    return out;
  }

  // The same in the movement, as SVG path data in mm.
  pathData(poses) {
    const b = 3 * this.body, base = this.on < 0 ? 0 : poses[3 * this.on + 2], c = Math.cos(base), s = Math.sin(base);
    const points = this.line(poses[b + 2] - base - this.rest, 100 / this.outer), out = [];
    for (let i = 0; i < points.length; i += 2) {
      const x = points[i], y = points[i + 1];
      out.push((1e3 * (poses[b] + c * x - s * y)).toFixed(4), (1e3 * (poses[b + 1] + s * x + c * y)).toFixed(4));
    }
    return `M${out.join(" ")}`;
  }

  draw(ctx, view, poses, look) {
    const b = 3 * this.body, base = this.on < 0 ? 0 : poses[3 * this.on + 2], faded = look.faded.has(this.body);
    view.place(ctx, [poses[b], poses[b + 1], base], 0);
    ctx.globalAlpha = faded ? FADED : 1;
    ctx.lineJoin = ctx.lineCap = "round";
    ctx.strokeStyle = blended(look.dark ? this.colours[1] : this.colours[0], look.paper, PALE);
    ctx.lineWidth = Math.max(this.width, 1.1 / view.scale);
    const points = this.line(poses[b + 2] - base - this.rest, view.scale * view.ratio);
    ctx.beginPath();
    for (let i = 0; i < points.length; i += 2) ctx.lineTo(points[i], points[i + 1]);
    ctx.stroke();
    ctx.lineWidth *= 2;
    ctx.beginPath(); ctx.arc(0, 0, this.inner, 0, 2 * Math.PI); ctx.stroke();
    const half = this.block * this.outer;
    ctx.rotate(this.stud);
    ctx.fillStyle = this.held;
    ctx.fillRect(this.outer - half, -half, 2 * half, 2 * half);
    ctx.globalAlpha = 1;
  }
}

// A colour (#rrggbb) with that share of another in it.
const blended = (colour, ground, share) => {
  const of = (text) => [1, 3, 5].map((k) => parseInt(text.slice(k, k + 2), 16)), [a, b] = [of(colour), of(ground)];
  return `#${a.map((v, k) => Math.round(v + share * (b[k] - v)).toString(16).padStart(2, "0")).join("")}`;
};
