// A page that follows a scene: what the server says is shown, and what is changed here goes back to the scene's file.
const desk = $("desk"), header = document.querySelector("header"), token = desk.dataset.token;
const news = new EventSource(`events?token=${encodeURIComponent(token)}`);
const heard = (kind, act) => news.addEventListener(kind, (event) => act(JSON.parse(event.data)));
const tag = (name, text = "", more = {}) => Object.assign(document.createElement(name), { textContent: text, ...more });
const faulty = tag("div", "", { className: "faulty", hidden: true });
let order = 0, shownOrder = 0, reference = null, ghosts = true, numbersIn = "";
$("picture").append(faulty);
document.querySelector("main").classList.add("bench");
root.classList.add("desktop");

const ask = async (what, body = {}) => {
  try {
    const answer = await fetch(what, { method: "POST", headers: { "Content-Type": "application/json", "X-Token": token }, body: JSON.stringify(body) });
    return answer.ok ? "" : (await answer.json()).refused || "This could not be saved.";
  } catch { return "watchsim live does not answer."; }
};
const doing = (text) => { $("doing").textContent = text; };
const secondsText = (seconds) => `${seconds.toFixed(seconds < 10 ? 2 : 0)} s`;

heard("status", (received) => {
  if (received.order > order) { doing("Computing …"); $("outcome").classList.add("old"); }
  order = received.order;
  $("undo").disabled = !received.undo;
  $("hold").setAttribute("aria-pressed", String(received.hold));
});
heard("scene", (received) => {
  $("faults").hidden = faulty.hidden = true;
  root.classList.remove("faulted");
  document.title = document.querySelector("h1").textContent = received.title;
  drawers(received);
});
heard("progress", (received) => doing(`${numbersIn}${Number(received.done.toPrecision(3))} of ${Number(received.whole.toPrecision(3))} s simulated …`));
heard("numbers", (received) => {
  numbersIn = `Numbers after ${secondsText(received.seconds)}, `;
  doing(`${numbersIn}motion follows …`);
  $("outcome").classList.remove("old");
  showOutcome(received);
});
heard("motion", (received) => {
  doing(`${numbersIn}motion after ${secondsText(received.seconds)}`);
  numbersIn = "";
  if (received.order === shownOrder) return; // heard again after an interruption
  shownOrder = received.order;
  const held = $("hold").getAttribute("aria-pressed") === "true" && reference;
  reference = held || scenery || null;
  document.querySelector("main").classList.remove("waiting");
  $("poster")?.remove();
  $("picture").insertAdjacentHTML("afterbegin", received.places.poster);
  document.querySelector(".lead").textContent = received.places.lead;
  document.querySelector("footer").textContent = received.places.made;
  root.classList.add("dated"); // the timing sheet follows
  open(received.data);
  haunt();
});
heard("sheet", (received) => {
  root.classList.remove("dated");
  document.querySelector(".verdict")?.remove();
  header.insertAdjacentHTML("beforeend", received.verdict);
  for (const section of document.querySelectorAll("#sheet > section:not(.live)")) section.remove();
  $("sheet").insertAdjacentHTML("afterbegin", received.sheet);
});
heard("faults", (received) => {
  const box = $("faults"), count = received.faults.length;
  numbersIn = "";
  doing(count === 1 ? "A fault; no result." : `${count} faults; no result.`);
  root.classList.add("faulted");
  box.replaceChildren(tag("b", "Nothing can be computed of what was saved:"), ...received.faults.map((text) => tag("pre", text)));
  for (const one of received.drawings) {
    const list = document.createElement("ol");
    list.append(...one.faults.map(([place, text]) => tag("li", place ? `${place}: ${text}` : text)));
    box.append(tag("b", one.name), list);
  }
  box.hidden = false;
  faulty.replaceChildren(...received.drawings.map((one) => tag("img", "", { src: `data:image/png;base64,${one.picture}`, alt: `${one.name}: its faults in numbered circles` })));
  if (!received.drawings.length) faulty.append(tag("p", "No motion: the faults are listed beside."));
  faulty.hidden = false;
});
news.onerror = () => { if (news.readyState === EventSource.CLOSED || !order) doing("watchsim live does not answer."); else doing("watchsim live has ended or is out of reach; what is shown stays."); };
news.onopen = () => { if (order && order === shownOrder) doing("Connected again."); };

// What changed, and what came of it; the first time there is nothing to compare with.
const showOutcome = (received) => {
  const tableOf = (caption, head, rows) => {
    const made = document.createElement("table"), body = made.createTBody(), top = made.createTHead().insertRow();
    made.className = "numbers";
    for (const text of head) top.append(tag("th", text, { scope: "col" }));
    for (const [first, ...rest] of rows) { const row = body.insertRow(); row.append(tag("th", first, { scope: "row" }), ...rest.map((text, k) => tag("td", text, { className: k === 2 && /[1-9]/.test(text) ? "more" : "" }))); }
    const frame = tag("div", "", { className: "scroll", tabIndex: 0 });
    frame.setAttribute("role", "region"); frame.setAttribute("aria-label", caption); frame.append(made);
    return frame;
  };
  const results = received.first ? received.results.map(([name, , value]) => [name, value]) : received.results;
  const parts = received.changed.length ? [tableOf("In the scene", ["changed", "before", "now"], received.changed)] : [];
  parts.push(tableOf("Result", received.first ? ["result", "now"] : ["result", "before", "now", "difference", received.off], results));
  if (received.message) parts.push(tag("p", received.message));
  $("outcome").replaceChildren(...parts);
};

const haunt = () => {
  if (scenery && reference && ghosts) scenery.haunt(reference); else if (scenery) scenery.ghost = [];
  dirty = true;
};

// Dimensions as sliders within their limits, all other numbers as they are written; each goes to the file when it is left.
const fields = new Map();
const drawers = (received) => {
  const wanted = [...received.knobs.map((one) => one.key), ...received.values.map(([key]) => key)];
  if (wanted.join() !== [...fields.keys()].join()) {
    const focus = document.activeElement?.dataset?.key;
    fields.clear();
    $("knobs").replaceChildren(...received.knobs.map(knob));
    $("values").replaceChildren(...received.values.map(([key]) => field(key, key, tag("input", "", { type: "text", spellcheck: false, autocomplete: "off" }))));
    if (focus && fields.has(focus)) fields.get(focus).input.focus();
  }
  for (const one of received.knobs) fields.get(one.key).show(one.value);
  for (const [key, value] of received.values) fields.get(key).show(value);
  $("knobs").parentElement.hidden = !received.knobs.length;
  $("values").parentElement.hidden = !received.values.length;
};
const field = (key, name, input, slider = null, unit = "") => {
  const row = tag("div", "", { className: slider ? "knob" : "knob value" }), words = tag("label", name), refused = tag("small", "", { hidden: true, id: `no-${key}` });
  let saved = "";
  input.id = `in-${key}`; words.htmlFor = input.id; input.dataset.key = key;
  row.append(words, ...(slider ? [slider] : []), input, ...(slider ? [tag("span", unit, { className: "unit" })] : []), refused);
  const refuse = (text) => { refused.textContent = text; refused.hidden = !text; input.setAttribute("aria-invalid", String(Boolean(text))); input.setAttribute("aria-describedby", text ? refused.id : ""); };
  const show = (value) => {
    saved = String(value); refuse("");
    if (input !== document.activeElement || input.value === "" || !row.dataset.typing) { input.value = saved; if (slider) slider.value = saved; }
  };
  const send = async () => { delete row.dataset.typing; if (input.value !== saved) refuse(await ask("set", { key, value: unit && input.value !== "" ? `${input.value} ${unit}` : input.value })); };
  input.addEventListener("input", () => { row.dataset.typing = "1"; if (slider) slider.value = input.value; });
  input.addEventListener("change", send);
  input.addEventListener("keydown", (event) => { if (event.key === "Escape") { delete row.dataset.typing; show(saved); } });
  if (slider) {
    slider.addEventListener("input", () => { input.value = String(Number(Number(slider.value).toPrecision(5))); });
    slider.addEventListener("change", send);
  }
  fields.set(key, { input, show });
  return row;
};
const knob = ({ key, name, meaning, unit, low, high, count }) => {
  const limits = { min: String(low), max: String(high) };
  const slider = tag("input", "", { type: "range", ...limits, step: count ? "1" : String(Number(((high - low) / 500).toPrecision(1))) });
  slider.setAttribute("aria-label", `${name}, ${low} to ${high} ${unit}`.trim());
  const input = tag("input", "", { type: "number", ...limits, step: count ? "1" : "any" });
  const row = field(key, name, input, slider, unit);
  row.title = `${meaning}; ${low} to ${high}${unit ? ` ${unit}` : ""}`;
  return row;
};

const acts = {
  undo: async () => { const refused = await ask("undo"); if (refused) doing(refused); },
  hold: () => ask("hold", { hold: $("hold").getAttribute("aria-pressed") !== "true" }),
  ghosts: () => { ghosts = !ghosts; $("ghosts").setAttribute("aria-pressed", String(ghosts)); haunt(); },
};
for (const [id, act] of Object.entries(acts)) $(id).addEventListener("click", act);
Object.assign(keys, { z: () => $("undo").disabled || acts.undo(), h: acts.hold, g: acts.ghosts });
window.addEventListener("pagehide", () => news.close());
window.watchsim.live = () => ({ order, shown: shownOrder, t: player?.t, centre: view?.centre, scale: view?.scale, ghost: scenery?.ghost.length ?? 0 });
