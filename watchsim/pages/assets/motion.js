// Where is every body, and how fast? Quintics through q, u, a of two rows, as the program itself interpolates.
const ROUNDING = 2 ** -22; // of the largest value: single precision, both rows

class Rows {
  constructor(packed) {
    this.t = doubles(packed.t);
    this.base = packed.base;
    this.n = packed.base.length;
    this.rows = floats(packed.rows);
    this.last = 0;
    this.noise = packed.base.map((_, k) => {
      let most = 0;
      for (let i = k; i < this.rows.length; i += 3 * this.n) most = Math.max(most, Math.abs(this.rows[i]));
      return ROUNDING * most;
    });
  }

  // The row from which to interpolate: of two at one instant the second, which is after the impact.
  find(time) {
    const t = this.t, most = Math.max(t.length - 2, 0);
    let i = this.last;
    if (!(t[i] <= time && time < t[i + 1])) i = clamp(upTo(t, time) - 1, 0, most);
    return (this.last = i);
  }

  // q, u or a (what = 0, 1, 2) of coordinate k as stored in row i.
  stored(i, k, what) {
    return this.rows[i * 3 * this.n + what * this.n + k] + (what === 0 ? this.base[k] : 0);
  }

  at(time, k, what) {
    const i = this.find(time), j = Math.min(i + 1, this.t.length - 1), step = this.t[j] - this.t[i];
    if (!(step > 0)) return this.stored(j, k, what);
    const s = clamp((time - this.t[i]) / step, 0, 1), n = this.n, y = this.rows, p = i * 3 * n + k, r = j * 3 * n + k;
    const q0 = y[p], q1 = y[r], u0 = step * y[p + n], u1 = step * y[r + n], a0 = step * step * y[p + 2 * n], a1 = step * step * y[r + 2 * n];
    const d = q1 - q0;
    if (what === 0) {
      const c3 = 10 * d - 6 * u0 - 4 * u1 - 1.5 * a0 + 0.5 * a1, c4 = -15 * d + 8 * u0 + 7 * u1 + 1.5 * a0 - a1, c5 = 6 * d - 3 * (u0 + u1) - 0.5 * (a0 - a1);
      return this.base[k] + q0 + s * (u0 + s * (0.5 * a0 + s * (c3 + s * (c4 + s * c5))));
    }
    if (what === 1) {
      const cubic = u0 + s * (a0 + s * (3 * (u1 - u0) - 2 * a0 - a1 + s * (2 * (u0 - u1) + a0 + a1)));
      const missed = d - 0.5 * (u0 + u1) - (a0 - a1) / 12; // what the cubic falls short of the way between the rows
      return (cubic + (Math.abs(missed) > this.noise[k] ? 30 * missed * (s * (1 - s)) ** 2 : 0)) / step;
    }
    return (a0 + s * (a1 - a0)) / (step * step); // not the slope of u, which takes a jump too small to be kept for a torque
  }
}

class Motion {
  constructor(data) {
    this.bodies = data.bodies;
    this.order = data.order;
    this.rows = data.bodies.map((body) => (body.rows ? new Rows(body.rows) : null));
    this.pose = new Float64Array(3 * data.bodies.length);
  }

  // x, y, angle of every body in the movement, one after the other; carriers come before what they carry.
  poses(time) {
    const out = this.pose;
    for (const b of this.order) {
      const body = this.bodies[b], rows = this.rows[b];
      let [x, y, angle] = body.at;
      if (rows && body.motion === "pivot") angle = rows.at(time, 0, 0);
      else if (rows && body.motion === "slide") { const way = rows.at(time, 0, 0); x += way * body.axis[0]; y += way * body.axis[1]; }
      else if (rows) { x = rows.at(time, 0, 0); y = rows.at(time, 1, 0); angle = rows.at(time, 2, 0); }
      if (body.on >= 0) {
        const o = 3 * body.on, c = Math.cos(out[o + 2]), s = Math.sin(out[o + 2]);
        [x, y, angle] = [out[o] + c * x - s * y, out[o + 1] + s * x + c * y, out[o + 2] + angle];
      }
      out[3 * b] = x; out[3 * b + 1] = y; out[3 * b + 2] = angle;
    }
    return out;
  }
}
