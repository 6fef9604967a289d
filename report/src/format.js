// Numbers and elements of the page.

export function fixed(value, digits) {
  const text = value.toFixed(digits);
  return Number(text) === 0 ? (0).toFixed(digits) : text;
}

/** 2.72e-01, as the program prints rates. */
export function scientific(value, digits) {
  return value.toExponential(digits).replace(/e([+-])(\d)$/, "e$10$2");
}

/** As many significant digits as asked for, without trailing zeros: %.3g. */
export function general(value, digits) {
  if (!Number.isFinite(value)) return "-";
  if (value === 0) return "0";
  const power = Math.floor(Math.log10(Math.abs(value)));
  if (power < -4 || power >= Math.max(digits, 6)) {
    const [mantissa, exponent] = scientific(value, digits - 1).split("e");
    return `${mantissa.includes(".") ? mantissa.replace(/\.?0+$/, "") : mantissa}e${exponent}`;
  }
  const text = value.toPrecision(digits);
  const plain = text.includes("e") ? String(Number(text)) : text;
  return plain.includes(".") ? plain.replace(/\.?0+$/, "") : plain;
}

/** An element with attributes, properties (on...), and children: elements or text. */
export function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
    else if (value === true) element.setAttribute(key, "");
    else if (value !== false && value !== undefined && value !== null) element.setAttribute(key, value);
  }
  element.append(...children.flat(2).filter((child) => child !== null && child !== undefined));
  return element;
}

let labels = 0;

/** A control with its label before it, or after it for a box to tick. */
export function labelled(text, control, className = "") {
  control.id ||= `control-${++labels}`;
  const label = make("label", { for: control.id }, text);
  const isBox = control.type === "checkbox" || control.type === "radio";
  return make("div", { class: `field ${isBox ? "box" : ""} ${className}` }, isBox ? [control, label] : [label, control]);
}

export function section(id, title, ...children) {
  return make("section", { id, "aria-labelledby": `${id}-title` }, make("h2", { id: `${id}-title` }, title), ...children);
}

export function colourOf(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

/** Colours of Okabe and Ito, which the colour-blind distinguish, with dashes beside them. */
const LINES = ["--line-0", "--line-1", "--line-2", "--line-3", "--line-4", "--line-5", "--line-6"];
const DASHES = [[], [7, 4], [2, 3], [9, 3, 2, 3]];

export function styleOf(number) {
  return { colour: () => colourOf(LINES[number % LINES.length]),
           variable: LINES[number % LINES.length],
           dash: DASHES[Math.floor(number / LINES.length) % DASHES.length] };
}
