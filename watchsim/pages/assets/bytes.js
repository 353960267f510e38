// Arrays out of the page's own text.
const bytesOf = (text) => {
  const raw = atob(text), found = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i++) found[i] = raw.charCodeAt(i);
  return found;
};
const doubles = (text) => new Float64Array(bytesOf(text).buffer);
const floats = (text) => new Float32Array(bytesOf(text).buffer);

// How many of the sorted values are not above x.
const upTo = (values, x) => {
  let low = 0, high = values.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (values[middle] <= x) low = middle + 1; else high = middle;
  }
  return low;
};
const clamp = (x, low, high) => Math.min(Math.max(x, low), high);
// Words of an element, and its attributes, touched only where they change: what is touched is laid out and painted anew.
const write = (element, text) => { if (element.textContent !== text) element.textContent = text; };
const put = (element, name, value) => { if (element.getAttribute(name) !== value) element.setAttribute(name, value); };
// The name of a body as a label has it.
const spaced = (name) => name.replaceAll("_", " ");
