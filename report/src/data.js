// Arrays of the page's data: base64 of little-endian numbers, with their shape.

const KINDS = { f4: Float32Array, f8: Float64Array };

function decode(packed) {
  const bytes = Uint8Array.from(atob(packed.base64), (letter) => letter.charCodeAt(0));
  const values = new KINDS[packed.type](bytes.buffer);
  values.shape = packed.shape;
  return values;
}

/** The same object with its arrays decoded. Motions of modes stay packed until `decodeOnce` asks for them. */
export function unpack(value) {
  if (Array.isArray(value)) return typeof value[0] === "object" ? value.map(unpack) : value;
  if (value === null || typeof value !== "object") return value;
  if ("base64" in value) return decode(value);
  const found = {};
  for (const [key, entry] of Object.entries(value)) found[key] = key === "motions" ? entry : unpack(entry);
  return found;
}

/** The array of a packed entry, decoded at the first call. */
export function decodeOnce(holder, key) {
  if ("base64" in holder[key]) holder[key] = decode(holder[key]);
  return holder[key];
}

export function readData() {
  return unpack(JSON.parse(document.getElementById("data").textContent));
}
