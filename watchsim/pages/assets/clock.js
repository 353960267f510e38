// How fast does the watch run on the screen: evenly, or slowly where things happen and fast where nothing does?
const SPEEDS = [1 / 1000, 1 / 500, 1 / 200, 1 / 100, 1 / 50, 1 / 20, 1 / 10, 1 / 5, 1 / 2, 1];
const HURRY = 12, BINS = 6000, RAMP = 0.004;

const speedText = (speed) => (speed >= 0.995 ? (speed > 1.05 ? `${speed.toPrecision(2)}×` : "true speed") : `1/${Number((1 / speed).toPrecision(2))}`);

class Clock {
  constructor(data) {
    [this.start, this.end] = data.window;
    this.busy = data.busy;
    this.share = data.busy.reduce((sum, [from, to]) => sum + to - from, 0) / (this.end - this.start);
    this.set(1, true);
  }

  // Whether there is anything to adapt to.
  get uneven() { return this.share > 0 && this.share < 0.7; }

  set(speed, adaptive) {
    this.speed = speed;
    const even = !(adaptive && this.uneven), fast = even ? speed : clamp(HURRY * speed, speed, Math.max(1, speed));
    const step = (this.end - this.start) / BINS, rates = new Float64Array(BINS).fill(fast);
    if (!even) {
      for (const [from, to] of this.busy) {
        const first = clamp(Math.floor((from - this.start) / step), 0, BINS - 1), last = clamp(Math.floor((to - this.start) / step), 0, BINS - 1);
        rates.fill(speed, first, last + 1);
      }
      soften(rates, Math.max(2, Math.round(RAMP * BINS)));
    }
    // Seconds on the screen up to the start of each bin: with them any step is exact, however long.
    this.rates = rates;
    this.passed = new Float64Array(BINS + 1);
    for (let i = 0; i < BINS; i++) this.passed[i + 1] = this.passed[i] + step / rates[i];
    this.step = step;
  }

  bin(t) { return clamp(Math.floor((t - this.start) / this.step), 0, BINS - 1); }
  rate(t) { return this.rates[this.bin(t)]; }
  onScreen(t) { const i = this.bin(t); return this.passed[i] + (t - this.start - i * this.step) / this.rates[i]; }

  // The instant that is shown `seconds` after t.
  after(t, seconds) {
    const goal = this.onScreen(t) + seconds, i = clamp(upTo(this.passed, goal) - 1, 0, BINS - 1);
    return this.start + i * this.step + (goal - this.passed[i]) * this.rates[i];
  }

  get length() { return this.passed[BINS]; } // of the whole on the screen, s
}

// Let slow stretches begin a little early, and the speed change smoothly: never above what the neighbours allow.
const soften = (rates, reach) => {
  const most = HURRY ** (1 / reach);
  for (let i = 1; i < rates.length; i++) rates[i] = Math.min(rates[i], rates[i - 1] * most);
  for (let i = rates.length - 2; i >= 0; i--) rates[i] = Math.min(rates[i], rates[i + 1] * most);
};
