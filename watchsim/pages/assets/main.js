// Everything together: what is on the page, and what keys and fingers do.
const $ = (id) => document.getElementById(id);
const root = document.documentElement;
root.classList.add("scripted");
let data, motion, view, scenery, contacts, clock, sound, solids, names, player, curves, plots, strip, span;
const stage = $("stage"), ctx = stage.getContext("2d");
let look = {}, dirty = true, fps = 0, drawn = 0; // frames a second, and ms that the last one took to draw

// Colours come from the style sheet, so that page and pictures change together.
const readLook = () => {
  const style = getComputedStyle(root), colour = (name) => style.getPropertyValue(`--${name}`).trim(), dark = root.dataset.theme === "dark";
  const body = data && data.bodies[plots.body ?? 0];
  look = {
    dark, paper: colour("card"), ink: colour("ink"), faint: colour("faint"), grid: colour("line"), edgeLine: colour("edge"), accent: colour("accent"), cursor: colour("cursor"),
    contact: colour("contact"), force: colour("force"), shade: colour("shade"), ground: dark ? "#a9a498" : "#55524b", edge: dark ? "#d9d6cf" : "#23272c",
    line: body ? (dark ? body.fill : body.line) : colour("ink"), phases: [0, 1, 2, 3, 4].map((k) => colour(`s${k}`)), bands: [0, 1, 2, 3, 4].map((k) => colour(`b${k}`)), font: style.fontFamily || "sans-serif",
  };
};
const setTheme = (name) => {
  root.dataset.theme = name;
  $("theme").setAttribute("aria-pressed", String(name === "dark"));
  readLook();
  if (plots) plots.stale();
  dirty = true;
};

// Time as the plots tell it.
const timeText = (t) => {
  const visible = plots.range[1] - plots.range[0], { times } = player, i = upTo(times, t);
  let digits = clamp(3 - Math.floor(Math.log10(visible)), 0, 9);
  // Stepping from event to event, the time is read finely enough to tell one from the next.
  if (!player.playing && times[i - 1] === t) for (const near of [times[i - 2], times[i]]) if (near !== undefined && near !== t) digits = Math.max(digits, Math.min(1 - Math.floor(Math.log10(Math.abs(near - t))), 9));
  const [whole, part] = t.toFixed(digits).split(".");
  return `${minus(whole)}${part ? `.${part.replace(/(\d{3})(?=\d)/g, "$1\u202f")}` : ""} s`;
};

const drawTrack = () => {
  const track = $("track"), width = track.clientWidth, height = track.clientHeight, ratio = window.devicePixelRatio || 1, inset = 6;
  if (!width) return;
  track.width = Math.round(width * ratio); track.height = Math.round(height * ratio);
  const c = track.getContext("2d"), x = (t) => inset + ((t - player.start) / span) * (width - 2 * inset);
  c.setTransform(ratio, 0, 0, ratio, 0, 0);
  const [from, to] = plots.range;
  if (to - from < span * 0.999) { c.fillStyle = look.grid; c.fillRect(x(from), 0, Math.max(x(to) - x(from), 2), height); }
  for (const [name, first, last] of data.phases) {
    if (!(name in PHASES)) continue;
    c.fillStyle = look.phases[PHASES[name]];
    c.fillRect(x(Math.max(first, player.start)), 6, Math.max(x(Math.min(last, player.end)) - x(Math.max(first, player.start)), 0.6), height - 20);
  }
  c.fillStyle = look.faint; c.globalAlpha = 0.75;
  for (const t of player.times) c.fillRect(x(t) - 0.4, height - 12, 0.8, 9);
  c.globalAlpha = 1;
};

// The words beside the picture.
let shownAt = "", announced = "";
const words = () => {
  const time = timeText(player.t), pace = speedText(clock.rate(player.t));
  write($("time"), time);
  write($("pace"), pace.startsWith("1/") ? `${pace} of true speed` : pace);
  const phase = player.phase(), line = `${phase}|${player.note}`;
  if (line !== shownAt) {
    shownAt = line;
    const strong = document.createElement("b"), note = document.createElement("span");
    strong.textContent = phase; note.textContent = player.note;
    $("said").replaceChildren(...(phase ? [strong, document.createElement("br")] : []), ...(player.note && player.note !== phase ? [note] : []));
  }
  if (!player.playing) {
    const spoken = [time, phase, player.note === phase ? "" : player.note].filter(Boolean).join(", ");
    if (spoken !== announced) { announced = spoken; $("now").textContent = spoken; }
  }
  $("scrub").value = String(Math.round((10000 * (player.t - player.start)) / span));
  put($("scrub"), "aria-valuetext", time);
  put($("play"), "aria-label", player.playing ? "Pause" : "Play");
  put($("sign"), "d", player.playing ? "M4 3h4v14H4zM12 3h4v14h-4z" : "M5 3v14l12-7z");
  $("speed").value = String(player.speedIndex);
  for (const [id, on] of [["space", solids.on], ["label", names.on], ["adapt", player.adaptive], ["touch", player.points], ["push", player.arrows], ["tick", sound.on]]) put($(id), "aria-pressed", String(on));
  const followed = player.chosen >= 0 && view.anchor !== null;
  $("release").hidden = !followed;
  if (followed) write($("release"), `Following ${spaced(data.bodies[player.chosen].name)} ✕`);
  for (const chip of chips) {
    put(chip.button, "aria-pressed", String(player.faded.has(chip.b)));
    write(chip.value, chip.read ? chip.read(player.t) : "");
  }
};

// A button for every part: its colour, its name, what it reads now.
const MANY = 60;
let chips = [];
const chipOf = (body, b) => {
  const button = document.createElement("button"), square = document.createElement("i"), value = document.createElement("small"), rows = motion.rows[b];
  button.type = "button"; button.title = `Fade ${spaced(body.name)}`;
  square.style.background = body.fill; square.style.borderColor = body.line;
  button.append(square, spaced(body.name), value);
  button.addEventListener("click", () => player.fade(b));
  $("parts").append(button);
  if (!rows) { value.remove(); return { b, button, value }; }
  const slide = body.motion === "slide", k = body.motion === "free" ? 2 : 0, factor = slide ? 1e3 : DEGREES;
  const within = (angle) => (body.round ? ((angle % 360) + 360) % 360 : angle), unit = slide ? " mm" : body.round ? "° mod 360°" : "°";
  return { b, button, value, read: (t) => `${minus(within(factor * rows.at(t, k, 0)).toFixed(slide ? 3 : body.round ? 1 : 2))}${unit}` };
};

// The outlines of what a page compares with, over those of the run that it shows.
const spook = (on) => {
  scenery.ghost = [];
  if (on && data.ghost) scenery.haunt({ ...data.ghost, parts: data.ghost.parts.map((part) => ({ ...part, path: pathOf(part) })) });
  dirty = true;
};

// Show a run in place of the one before, if there is one: time, view, what is chosen and pressed stay as they are.
const open = (told) => {
  const old = player && { data, view, player, plots, sound, solids, names };
  if (old) { for (const panel of plots.panels) panel.chart.destroy(); strip.box.remove(); }
  if (old && solids.gl) $("solid").replaceWith($("solid").cloneNode()); // what the card holds goes with its canvas
  data = told;
  motion = new Motion(data); view = new View(data); scenery = new Scenery(data); contacts = new Contacts(data); clock = new Clock(data);
  sound = new Sound(data); solids = new Solids(data, $("solid")); names = new Names(data);
  spook(true);
  player = new Player(data, { motion, view, scenery, solids, names, contacts, clock, sound });
  player.changed = () => { dirty = true; };
  curves = new Curves(data, motion, contacts, view);
  const seek = (t) => { player.toggle(false); player.seek(t); };
  plots = new Plots($("plots"), data, curves, seek); strip = new Strip($("plots"), data, sound, seek);
  span = player.end - player.start; trackKey = shownAt = announced = "";
  $("parts").replaceChildren(); $("whose").replaceChildren();
  chips = data.bodies.slice(0, MANY).map(chipOf);
  for (const b of curves.movers) $("whose").add(new Option(spaced(data.bodies[b].name), String(b)));
  $("space").disabled = !solids.any; $("label").disabled = !names.any; $("adapt").disabled = !clock.uneven;
  $("push").disabled = !contacts.known; $("tick").disabled = !sound.any; $("back").disabled = $("next").disabled = !data.events.length;
  readLook();
  unseen = !old;
  resize();
  const shown = old && old.data.bodies[old.plots.body], first = data.bodies.findIndex((body, b) => shown && body.name === shown.name && motion.rows[b]);
  const usual = first >= 0 ? first : data.ranks.find((b) => motion.rows[b]) ?? curves.movers[0];
  document.querySelector(".plots").hidden = usual === undefined;
  if (usual !== undefined) showPlots(usual);
  if (old) resume(old);
};

// Time counts from the end, which is where a longer run is shown, too; parts are known by their names.
const resume = ({ data: before, view: sight, player: was, plots: charts, sound: heard, solids: solid, names: named }) => {
  const now = (b) => data.bodies.findIndex((body) => body.name === (before.bodies[b] || {}).name), later = player.end - was.end;
  player.t = clamp(was.t + later, player.start, player.end);
  Object.assign(player, { playing: was.playing, points: was.points, arrows: was.arrows, chosen: now(was.chosen), faded: new Set([...was.faded].map(now)) });
  player.setSpeed(was.speedIndex); player.setAdaptive(was.adaptive || !was.clock.uneven);
  plots.range = charts.range.map((t) => clamp(t + later, player.start, player.end));
  if (!(plots.range[1] > plots.range[0]) || charts.range[1] - charts.range[0] >= was.end - was.start) plots.all();
  Object.assign(sound, { on: heard.on, context: heard.context, noise: heard.noise, latest: heard.latest });
  names.on = named.on && names.any;
  if (solid.on && solids.any && solids.turn(true)) Object.assign(solids, { tilt: solid.tilt, yaw: solid.yaw });
  const anchor = sight.anchor && [now(sight.anchor[0]), ...sight.anchor.slice(1)];
  Object.assign(view, { turn: sight.turn, zoom: sight.scale / view.base, anchor: anchor && anchor[0] >= 0 ? anchor : null });
  if (view.anchor || view.data.follow) view.shift = sight.shift.slice();
  else { view.aim(motion.poses(player.t)); view.shift = [sight.centre[0] - view.centre[0], sight.centre[1] - view.centre[1]]; }
  plots.stale(); dirty = true;
};

const showPlots = (b) => {
  if (!motion.rows[b]) return;
  plots.show(b, look);
  $("whose").value = String(b);
  readLook(); plots.stale(); dirty = true;
};

let unseen = false; // a frame of a notebook may have no size yet when the player starts in it
const resize = () => {
  const ratio = window.devicePixelRatio || 1, width = stage.clientWidth, height = stage.clientHeight;
  if (!width || !height || !view) return;
  stage.width = Math.round(width * ratio); stage.height = Math.round(height * ratio);
  view.resize(width, height, ratio);
  if (unseen) { unseen = false; view.open(); }
  plots.stale(); dirty = true;
};

let last = 0, trackKey = "", changed = 0, coarse = false, cursor; // ms of the last frame in which something was new; was it drawn as one of many?
let told = 0; // ms of the last frame that wrote numbers
const READ = 50; // ms between numbers while playing: nobody reads faster, and to set letters takes as long as to draw
const STILL = 250; // ms without news after which the solids are drawn as finely as they can be
const frame = (now) => {
  const seconds = Math.min((now - last) / 1000, 0.1);
  if (last && now > last) fps = 0.95 * fps + 0.05 * (1000 / (now - last));
  last = now;
  if (!player || !view.sized) { requestAnimationFrame(frame); return; }
  const moving = player.playing || (dirty && now - changed < STILL);
  if (player.tick(seconds)) dirty = true;
  if (player.t !== cursor) { plots.hold(player.t); cursor = player.t; } // stepped or played out of what the plots show
  if (coarse && !moving && now - changed > STILL) dirty = true;
  if (dirty || plots.dirty) {
    dirty = plots.dirty = false;
    const begun = performance.now();
    if (solids.on && moving && coarse) solids.pace.frame(now - changed, drawn);
    changed = now; coarse = solids.on && moving;
    const key = `${plots.range}|${look.dark}|${$("track").clientWidth}|${window.devicePixelRatio}`, due = !player.playing || now - told >= READ;
    if (key !== trackKey) { trackKey = key; drawTrack(); }
    player.draw(ctx, look, moving);
    strip.draw(player.t, look, plots.range);
    plots.draw(player.t, look, due);
    if (due) { told = now; words(); } // last: sizes are read above, before the page is laid out anew
    drawn = performance.now() - begun;
  }
  requestAnimationFrame(frame);
};

// Fingers and mouse on the picture: drag moves, two fingers or the wheel zoom, a tap chooses a part.
const held = new Map();
let moved = 0;
const place = (event) => { const box = stage.getBoundingClientRect(); return [event.clientX - box.left, event.clientY - box.top]; };
stage.addEventListener("pointerdown", (event) => { stage.setPointerCapture(event.pointerId); held.set(event.pointerId, place(event)); moved = held.size > 1 ? 99 : 0; });
stage.addEventListener("pointermove", (event) => {
  const before = held.get(event.pointerId);
  if (!before) return;
  const now = place(event), others = [...held].filter(([id]) => id !== event.pointerId).map(([, at]) => at);
  held.set(event.pointerId, now);
  moved += Math.abs(now[0] - before[0]) + Math.abs(now[1] - before[1]);
  if (moved < 5) return;
  if (others.length) {
    const [ox, oy] = others[0], apart = ([x, y]) => Math.max(Math.hypot(x - ox, y - oy), 10);
    view.pan((now[0] - before[0]) / 2, (now[1] - before[1]) / 2);
    view.zoomAt(apart(now) / apart(before), 0.5 * (now[0] + ox), 0.5 * (now[1] + oy));
  } else shift(now[0] - before[0], now[1] - before[1], event.shiftKey);
  dirty = true;
});
stage.addEventListener("pointerup", (event) => {
  held.delete(event.pointerId);
  if (moved >= 5) return;
  const poses = motion.poses(player.t), [x, y] = place(event);
  view.aim(poses);
  const b = solids.on ? solids.hit(view, poses, { ...look, faded: player.faded, chosen: -1 }, x, y) : scenery.hit(ctx, view, poses, x, y, player.faded);
  if (b < 0) { release(); return; }
  const at = view.world(x, y);
  player.choose(b, view.within(poses, b, at));
  showPlots(b);
});
stage.addEventListener("pointercancel", (event) => held.delete(event.pointerId));
stage.addEventListener("wheel", (event) => { event.preventDefault(); view.zoomAt(0.9982 ** event.deltaY, ...place(event)); dirty = true; }, { passive: false });

// The picture stays where it is when a part is let go.
const release = () => {
  const at = view.centre.slice();
  player.choose(-1);
  view.aim(motion.poses(player.t));
  view.shift = [at[0] - view.centre[0], at[1] - view.centre[1]];
};
const followNext = () => {
  const movers = curves.movers, b = movers[(movers.indexOf(player.chosen) + 1) % movers.length];
  if (b === undefined) return;
  player.choose(b, [0, 0]);
  showPlots(b);
};
const zoomBy = (factor) => { view.zoomAt(factor, 0.5 * view.width, 0.5 * view.height); dirty = true; };
// Everything; where that is in sight already, what touches.
const fit = () => { const whole = view.zoom === 1 && !view.anchor; view.reset(); solids.level(); player.chosen = -1; resize(); if (whole) view.open(); };
// Dragging moves the flat picture and turns the solids, which Shift moves.
const shift = (x, y, moves = false) => { if (solids.on && !moves) solids.orbit(x, y); else view.pan(x, y); dirty = true; };
const nudge = (way) => { player.toggle(false); player.seek(player.t + (way * (plots.range[1] - plots.range[0])) / 500); };

const toggles = {
  label: () => { names.on = names.any && !names.on; dirty = true; },
  space: () => { if (!solids.turn(!solids.on)) $("space").disabled = true; dirty = true; },
  adapt: () => player.setAdaptive(!player.adaptive),
  touch: () => { player.points = !player.points; dirty = true; },
  push: () => { player.arrows = !player.arrows; dirty = true; },
  tick: () => { sound.turn(!sound.on); dirty = true; },
  theme: () => setTheme(look.dark ? "light" : "dark"),
};
const presses = {
  ...toggles, play: () => player.toggle(), back: () => player.step(-1), next: () => player.step(1), closer: () => zoomBy(1.5), wider: () => zoomBy(1 / 1.5), fit,
  release, print: () => window.print(), narrow: () => plots.zoom(0.5, player.t), broad: () => plots.zoom(2, player.t), whole: () => plots.all(),
};
for (const [id, act] of Object.entries(presses)) $(id).addEventListener("click", act);

const keys = {
  " ": () => player.toggle(), ",": () => player.step(-1), ".": () => player.step(1), "[": () => player.stepPhase(-1), "]": () => player.stepPhase(1), "<": () => player.setSpeed(player.speedIndex - 1), ">": () => player.setSpeed(player.speedIndex + 1),
  Home: () => player.seek(player.start), End: () => player.seek(player.end), "+": () => zoomBy(1.25), "=": () => zoomBy(1.25), "-": () => zoomBy(0.8), "\u2212": () => zoomBy(0.8), 0: fit,
  n: followNext, Escape: release, x: () => player.chosen >= 0 && player.fade(player.chosen), a: toggles.adapt, c: toggles.touch, f: toggles.push, s: toggles.tick, t: toggles.theme, 3: toggles.space, l: toggles.label, g: () => spook(!scenery.ghost.length),
};
const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
document.addEventListener("keydown", (event) => {
  const target = event.target, typing = target instanceof HTMLSelectElement || (target instanceof HTMLInputElement && target.id !== "scrub");
  if (!player || event.ctrlKey || event.metaKey || typing) return;
  const on = target instanceof HTMLButtonElement && (event.key === " " || event.key === "Enter");
  const direction = arrows[event.key];
  if (direction) {
    const inPicture = target === stage, inScrub = target.id === "scrub";
    if (event.altKey && inPicture) shift(-40 * direction[0], 40 * direction[1]);
    else if ((inPicture || target === document.body || inScrub) && direction[0]) nudge(direction[0] * (event.shiftKey ? 10 : 1));
    else return;
    event.preventDefault();
    return;
  }
  const inPage = target !== stage && target.id !== "scrub" && (event.key === "Home" || event.key === "End" || (event.key === " " && target !== document.body));
  const act = event.altKey || on || inPage ? null : keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
  if (act) { act(); event.preventDefault(); }
});
$("scrub").addEventListener("input", () => { player.toggle(false); player.seek(player.start + (span * Number($("scrub").value)) / 10000); });
SPEEDS.forEach((speed, k) => { const option = new Option(k === SPEEDS.length - 1 ? "real time" : speedText(speed), String(k)); $("speed").add(option); });
$("speed").addEventListener("change", () => player.setSpeed(Number($("speed").value)));
$("whose").addEventListener("change", () => showPlots(Number($("whose").value)));

// Paper: the still picture takes the poses of the instant shown, and dark pages are printed light.
let themeBefore = null;
const toPaper = () => {
  themeBefore = root.dataset.theme;
  setTheme("light");
  const poses = motion.poses(player.t);
  for (const group of document.querySelectorAll("#poster [data-part]")) {
    const b = 3 * data.parts[Number(group.dataset.part)].body, c = Math.cos(poses[b + 2]), s = Math.sin(poses[b + 2]);
    group.setAttribute("transform", `matrix(${c} ${s} ${-s} ${c} ${1e3 * poses[b]} ${1e3 * poses[b + 1]})`);
  }
  for (const strip of document.querySelectorAll("#poster [data-coil]")) strip.setAttribute("d", scenery.coils[Number(strip.dataset.coil)].pathData(poses));
  for (const line of document.querySelectorAll("#poster [data-zigzag]")) line.setAttribute("d", scenery.zigzags[Number(line.dataset.zigzag)].pathData(view, poses));
  root.classList.add("paper"); // the plots take the size that they have there
  plots.draw(player.t, look); strip.draw(player.t, look, plots.range);
};
const toScreen = () => {
  root.classList.remove("paper");
  if (themeBefore) setTheme(themeBefore);
  themeBefore = null;
};
window.addEventListener("beforeprint", toPaper);
window.addEventListener("afterprint", toScreen);

const preferred = window.matchMedia("(prefers-color-scheme: dark)");
preferred.addEventListener("change", () => { if (!themeBefore) setTheme(preferred.matches ? "dark" : "light"); });
setTheme(preferred.matches ? "dark" : "light");
// For scripts that drive a page: seek to an instant, set the view (in space too), ask where a point of a body is seen (CSS pixels).
window.watchsim = {
  get window() { return data.window; },
  seek: (t) => { player.toggle(false); player.seek(t); player.draw(ctx, look); },
  space: (tilt, yaw) => { solids.turn(true); Object.assign(solids, { tilt, yaw }); dirty = true; },
  mark: (points, forces) => { player.points = points; player.arrows = forces; dirty = true; },
  look: (centre, scale, turn) => { view.turn = turn; view.zoom = scale / view.base; view.anchor = null; view.shift = [0, 0]; view.aim(motion.poses(player.t)); view.shift = [centre[0] - view.centre[0], centre[1] - view.centre[1]]; dirty = true; },
  seen: (name, points) => { const poses = motion.poses(player.t), b = data.bodies.findIndex((body) => body.name === name); view.aim(poses); return points.map(([x, y]) => view.screen(...view.point(poses, b, x, y))); },
  closed: (t) => { const poses = motion.poses(t); return contacts.all.filter((one) => one.holds(t)).map((one) => ({ name: one.name, force: one.press(t), place: one.touch(view, poses).slice(0, 2) })); },
  value: (plot, t) => curves.of(plots.body)[plot].lines[0].value(t),
  limits: (plot) => plots.panels[plot].limits.map((value) => value * plots.panels[plot].factor),
  names: () => { const poses = motion.poses(player.t); view.aim(poses); return names.placed(ctx, solids.on ? solids.sight(view) : view, poses, look, false); },
  numbered: (only) => { solids.draw(view, motion.poses(player.t), { ...look, faded: new Set(data.bodies.map((_, b) => b).filter((b) => only !== undefined && b !== only)), chosen: -1 }, false, true); return $("solid").toDataURL(); },
  corner: () => view.corner,
  coils: () => { const poses = motion.poses(player.t); return scenery.coils.map((coil) => coil.pathData(poses)); },
  zigzags: () => { const poses = motion.poses(player.t); return scenery.zigzags.map((one) => one.pathData(view, poses)); },
  parts: () => scenery.parts.map(({ body, layer, pale }) => ({ body, layer, pale: Boolean(pale) })),
  ghost: () => scenery.ghost.length,
  pace: () => ({ fps, drawn }),
  fineness: () => solids.pace,
};
new ResizeObserver(resize).observe($("picture"));
window.addEventListener("resize", resize);
resize();
requestAnimationFrame(frame);
const whole = JSON.parse($("data").textContent);
if (whole) { open(whole); offerFiles($("files"), data); } else document.querySelector("main").classList.add("waiting");
