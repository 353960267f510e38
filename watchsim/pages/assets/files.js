// The files that the page holds, as one archive and each by itself.
const save = (name, type, content) => {
  const link = document.createElement("a"), address = URL.createObjectURL(new Blob([content], { type }));
  link.href = address; link.download = name.split("/").pop();
  document.body.append(link); link.click(); link.remove();
  setTimeout(() => URL.revokeObjectURL(address), 60000);
};
const unpacked = (packed) => new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate-raw"))).arrayBuffer();
const sizeText = (size) => (size < 1000 ? `${size} B` : size < 1e6 ? `${(size / 1e3).toFixed(size < 1e4 ? 1 : 0)} kB` : `${(size / 1e6).toFixed(1)} MB`);

const offerFiles = (host, data) => {
  const { entries, data: text } = data.files, button = (name, size, act) => {
    const made = document.createElement("button"), small = document.createElement("small");
    made.type = "button"; made.textContent = name; small.textContent = size; made.append(" ", small);
    made.addEventListener("click", act); host.append(made);
    return made;
  };
  const stem = data.title.replace(/[^\p{L}\p{N}_-]+/gu, "_").replace(/^_+|_+$/g, "").slice(0, 60) || "watch";
  if (entries.length) button("Everything", `zip, ${sizeText(0.75 * text.length)}`, () => save(`${stem}.zip`, "application/zip", bytesOf(text))).className = "first";
  button("This picture", "png", () => document.getElementById("stage").toBlob((blob) => blob && save(`${stem}.png`, "image/png", blob)));
  if (typeof DecompressionStream === "undefined") return;
  for (const one of entries) {
    button(one.name, sizeText(one.size), async () => save(one.name, one.type, await unpacked(bytesOf(text).slice(one.from, one.to))));
  }
};
