// Numbers of the modes as the program prints them (drivers/mode_report.cpp).

import { fixed, general, scientific } from "./format.js";

const hasRate = (modes, m) => modes.motion[m] === "growing" || modes.motion[m] === "decaying";
const isKnown = (modes, m) => hasRate(modes, m) || modes.motion[m] === "rigid-body" || !modes.rough[m];
const isZero = (modes, m) => modes.motion[m] === "rigid-body" || modes.real[m] === 1;

/** Frequency of a picture [Hz]: 0 where the exponent has none. */
export function frequencyOf(modes, m) {
  return isZero(modes, m) ? 0 : modes.frequency_hz[m];
}

function percentOf(modes, m, value) {
  if (isZero(modes, m) || modes.frequency_hz[m] === 0 || !isKnown(modes, m)) return { value: NaN, text: "-" };
  return hasRate(modes, m) ? { value: 100 * value, text: fixed(100 * value, 3) } : { value: 0, text: "0.000" };
}

function growthOf(modes, m) {
  if (!hasRate(modes, m)) return isKnown(modes, m) ? { value: 0, text: "0" } : { value: NaN, text: "-" };
  const value = modes.growth[m];
  return { value, text: (modes.motion[m] === "growing" ? "+" : "") + scientific(value, 2) };
}

/** True if the mode grows by more than its error, is resolved and is known well enough. */
export function grows(modes, m) {
  return modes.resolved[m] === 1 && modes.motion[m] === "growing" && !modes.rough[m];
}

function partsOf(modes, m) {
  const count = modes.part.length;
  const shares = modes.part.map((part, p) => ({ part, share: modes.part_share[m * count + p] }));
  const seen = shares.filter(({ share }) => share >= 0.05).sort((a, b) => b.share - a.share).slice(0, 3);
  return seen.map(({ part, share }) => `${part} ${fixed(100 * share, 0)}`).join(" ");
}

/** The columns that a set of modes has: name, unit, description, and value and text of each mode. */
export function columnsOf(modes) {
  const turns = modes.rotor_speed / (2 * Math.PI);
  const numberOf = (value, text) => ({ value, text });
  const columns = [
    { key: "number", name: "#", of: (m) => numberOf(m + 1, String(m + 1)) },
    { key: "label", name: "mode", isText: true, of: (m) => numberOf(modes.label[m], modes.label[m]) },
    { key: "frequency", name: "frequency", unit: "Hz",
      of: (m) => numberOf(frequencyOf(modes, m), fixed(frequencyOf(modes, m), 4)) },
  ];
  if (modes.fixed_frame_frequency_hz)
    columns.push({ key: "fixed_frame", name: "fixed frame", unit: "Hz", of: (m) => {
      const value = modes.motion[m] === "rigid-body" ? NaN : modes.fixed_frame_frequency_hz[m];
      return numberOf(value, Number.isFinite(value) ? fixed(value, 4) : "-");
    } });
  columns.push(
    { key: "damping", name: "damping ratio", unit: "%", of: (m) => percentOf(modes, m, modes.damping_ratio[m]) },
    { key: "growth", name: "growth", unit: "1/s", of: (m) => growthOf(modes, m) },
    { key: "error_growth", name: "its error", unit: "1/s",
      of: (m) => numberOf(modes.error_growth[m], scientific(modes.error_growth[m], 1)) });
  if (modes.harmonic)
    columns.push({ key: "harmonic", name: "harmonic", unit: "k",
                   of: (m) => numberOf(modes.harmonic[m], String(modes.harmonic[m])) });
  columns.push({ key: "parts", name: "energy in", unit: "%", isText: true,
                 of: (m) => numberOf(partsOf(modes, m), partsOf(modes, m)) },
               { key: "remark", name: modes.harmonic ? "other k, remark" : "remark", isText: true,
                 of: (m) => numberOf(modes.remark[m], modes.remark[m]) },
               { key: "decrement", name: "log decrement", unit: "%",
                 of: (m) => percentOf(modes, m, -2 * Math.PI * modes.growth[m] / modes.omega[m]) });
  if (modes.rotor_speed > 0)
    columns.push({ key: "per_rev", name: "per revolution", unit: "-",
                   of: (m) => numberOf(frequencyOf(modes, m) / turns, fixed(frequencyOf(modes, m) / turns, 4)) });
  return columns;
}

/** Lines on growth and on the modes that are known, of the modes in the file alone. */
export function wordsOn(modes) {
  const all = modes.label.map((_, m) => m);
  const growing = all.filter((m) => grows(modes, m)).sort((a, b) => modes.growth[b] - modes.growth[a]);
  const named = growing.slice(0, 4).map((m) => `${modes.label[m]} (doubles in ${general(Math.LN2 / modes.growth[m], 3)} s)`);
  const lines = [growing.length === 0
    ? "No resolved mode grows by more than its estimated error."
    : `${growing.length} resolved ${growing.length === 1 ? "mode grows" : "modes grow"} by more than the estimated error: ` +
      named.join(", ") + (growing.length > 4 ? ` and ${growing.length - 4} more` : "") + "."];
  const resolved = all.filter((m) => modes.resolved[m] === 1);
  const air = resolved.filter((m) => modes.air[m] === 1).length;
  const rough = resolved.filter((m) => modes.rough[m] && modes.motion[m] !== "rigid-body").length;
  lines.push(`${resolved.length - air} modes are resolved` + (air ? `, and ${air} exponents of the air` : "") +
             `; ${all.length - resolved.length} are unresolved` +
             (Number.isFinite(modes.reach_hz) && modes.reach_hz !== null
               ? `; all below ${general(modes.reach_hz, 3)} Hz are resolved` : "") + ".");
  if (modes.states_deflated > 0)
    lines.push(`${modes.states_deflated} exponents that decay faster than ${general(modes.deflated_rate, 3)} 1/s are not known.`);
  if (rough > 0) lines.push(`${rough} resolved ${rough === 1 ? "mode has" : "modes have"} too large an error to count.`);
  if (Object.keys(modes.searched).length > 0)
    lines.push(`Searched from ${general(modes.searched.searched_from_hz, 3)} to ` +
               `${general(modes.searched.searched_to_hz, 3)} Hz; other modes are not known.`);
  return { isGrowing: growing.length > 0, lines };
}
