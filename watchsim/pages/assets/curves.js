// What is plotted of a body, as lists of points that keep jumps and spikes.
const DEGREES = 180 / Math.PI;

class Curves {
  constructor(data, motion, contacts, view) {
    Object.assign(this, { bodies: data.bodies, motion, contacts, view });
    this.torques = new Map();
  }

  // Bodies that can be plotted.
  get movers() { return this.bodies.map((_, b) => b).filter((b) => this.motion.rows[b]); }

  // The plots of a body: each a title, a unit and its lines; a line has a value at any time and its own points in a range.
  of(b) {
    const body = this.bodies[b], rows = this.motion.rows[b];
    const line = (name, k, what, factor, colour) => ({ name, colour, value: (t) => factor * rows.at(t, k, what), points: (from, to, step) => sampled({ t: rows.t, at: (t) => factor * rows.at(t, k, what), stored: (i) => factor * rows.stored(i, k, what) }, from, to, step) });
    const mass = body.inertia;
    if (body.motion === "pivot") {
      const plots = [
        { title: "Angle", unit: "°", lines: [line("", 0, 0, DEGREES, "line")] },
        { title: "Velocity", unit: "°/s", lines: [line("", 0, 1, DEGREES, "line")] },
      ];
      const push = this.torque(b);
      if (push) plots.push({ title: "Torque from contacts", unit: "N·m", metric: true, lines: [{ name: "", colour: "accent", area: true, value: push.value, points: push.points }] });
      if (mass) plots.push({ title: "Net torque", unit: "N·m", metric: true, lines: [line("", 0, 2, mass, "line")] });
      if (!push && !mass) plots.push({ title: "Acceleration", unit: "rad/s²", lines: [line("", 0, 2, 1, "line")] });
      return plots;
    }
    if (body.motion === "slide") return [
      { title: "Travel", unit: "mm", lines: [line("", 0, 0, 1e3, "line")] },
      { title: "Velocity", unit: "mm/s", lines: [line("", 0, 1, 1e3, "line")] },
      mass ? { title: "Net force", unit: "N", metric: true, lines: [line("", 0, 2, mass, "line")] } : { title: "Acceleration", unit: "m/s²", lines: [line("", 0, 2, 1, "line")] },
    ];
    return [
      { title: "Place", unit: "mm", lines: [line("x", 0, 0, 1e3, "line"), line("y", 1, 0, 1e3, "accent")] },
      { title: "Velocity", unit: "mm/s", lines: [line("x", 0, 1, 1e3, "line"), line("y", 1, 1, 1e3, "accent")] },
      { title: "Angle", unit: "°", lines: [line("", 2, 0, DEGREES, "line")] },
    ];
  }

  // The body by whose hinge what presses on `side` reaches body b; negative where it is a part of that one, null where it does not.
  reached(side, b) {
    let hinge = -1;
    for (; side >= 0; side = this.bodies[side].on) {
      if (side === b) return hinge;
      if (this.bodies[side].motion === "pivot") hinge = side;
    }
    return null;
  }

  // The moment of all contact forces about a pivot (N·m), at the instants for which forces are known.
  torque(b) {
    if (this.torques.has(b)) return this.torques.get(b);
    const own = this.contacts.all.filter((one) => one.force && [one.a[0], one.b[0]].some((side) => this.reached(side, b) !== null));
    if (!own.length) { this.torques.set(b, null); return null; }
    const value = (t) => {
      const poses = this.motion.poses(t);
      let sum = 0;
      for (const one of own) {
        if (!one.holds(t)) continue;
        const [x, y, nx, ny] = one.touch(this.view, poses);
        for (const side of [one.a[0], one.b[0]]) {
          const hinge = this.reached(side, b), force = hinge === null ? null : one.on(side, t, nx, ny);
          if (!force) continue;
          const [px, py] = hinge < 0 ? [x, y] : [poses[3 * hinge], poses[3 * hinge + 1]];
          sum += (px - poses[3 * b]) * force[1] - (py - poses[3 * b + 1]) * force[0];
        }
      }
      return sum;
    };
    // At both ends of every closed stretch the moment may jump: it is asked for on both sides.
    const times = [];
    for (const one of own) {
      times.push(...one.t);
      for (let i = 0; i < one.closed.length; i++) { const d = 1e-9 * Math.max(1, Math.abs(one.closed[i])); times.push(one.closed[i] - d, one.closed[i]); }
    }
    const t = Float64Array.from(new Set(times)).sort(), y = Float64Array.from(t, value);
    const known = { t, at: value, stored: (i) => y[i] };
    const points = (from, to, step) => sampled(known, from, to, 4 * step);
    const made = { value, points };
    this.torques.set(b, made);
    return made;
  }
}

// Points of a curve between two times: every one that is stored, and as many between that none are more than `step` apart.
const sampled = (curve, from, to, step) => {
  const { t } = curve, found = [[from, curve.at(from)]];
  let last = from;
  const fill = (until) => {
    const parts = Math.min(Math.ceil((until - last) / step), 4000);
    for (let p = 1; p < parts; p++) { const at = last + ((until - last) * p) / parts; found.push([at, curve.at(at)]); }
  };
  for (let i = upTo(t, from); i < t.length && t[i] < to; i++) {
    fill(t[i]);
    found.push([t[i], curve.stored(i)]);
    last = t[i];
  }
  fill(to);
  found.push([to, curve.at(to)]);
  return found;
};
