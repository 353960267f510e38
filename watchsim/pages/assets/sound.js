// The tick: short noises through a filter, as loud as the energy of the impact says.
const SOONEST = 0.012; // s between two noises: closer ones melt into one

class Sound {
  constructor(data) {
    this.t = doubles(data.sound.t);
    this.loud = floats(data.sound.loud);
    this.on = false;
    this.context = null;
    this.latest = 0;
  }

  get any() { return this.t.length > 0 && (window.AudioContext || window.webkitAudioContext) !== undefined; }

  turn(on) {
    this.on = on;
    if (on && !this.context) {
      const Context = window.AudioContext || window.webkitAudioContext;
      this.context = new Context();
      const length = Math.round(0.05 * this.context.sampleRate), data = new Float32Array(length);
      this.noise = this.context.createBuffer(1, length, this.context.sampleRate);
      for (let i = 0; i < length; i++) data[i] = (2 * Math.random() - 1) * Math.exp((-9 * i) / length);
      this.noise.copyToChannel(data, 0);
    }
    if (this.context && this.context.state === "suspended") this.context.resume().catch(() => {});
  }

  // Let be heard what happens from `from` to `to`, which the screen shows during the next `seconds`.
  play(from, to, seconds) {
    if (!this.on || !this.context || to <= from) return;
    const first = upTo(this.t, from), last = upTo(this.t, to), now = this.context.currentTime;
    for (let i = first; i < last; i++) {
      const when = now + 0.02 + (seconds * (this.t[i] - from)) / (to - from);
      if (when - this.latest < SOONEST && this.loud[i] < 0.5) continue;
      this.latest = when;
      const source = this.context.createBufferSource(), filter = this.context.createBiquadFilter(), gain = this.context.createGain();
      source.buffer = this.noise;
      filter.type = "bandpass"; filter.frequency.value = 3200 + 2600 * this.loud[i]; filter.Q.value = 2.2;
      gain.gain.value = 0.9 * this.loud[i];
      source.connect(filter).connect(gain).connect(this.context.destination);
      source.start(when);
    }
  }
}
