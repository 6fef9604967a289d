// The results: how they were made, the turbine, and the behaviour of the modes.

import { fixed, general, make, section } from "./format.js";
import { wordsOn } from "./modes.js";

function facts(entries) {
  const list = make("dl", {});
  for (const [name, text] of entries) if (text) list.append(make("dt", {}, name), make("dd", {}, text));
  return list;
}

export const massText = (mass) => general(mass, 7);

function massTable(model) {
  const order = (name) => (name === "turbine" ? 2 : name === "rotor" ? 1 : 0);
  const rows = [...model.masses].sort((a, b) => order(a.part) - order(b.part));
  return make("table", { class: "masses" },
    make("caption", {}, "Masses"),
    make("thead", {}, make("tr", {}, make("th", { scope: "col" }, "part"), make("th", { scope: "col" }, "mass [kg]"))),
    make("tbody", {}, rows.map(({ part, mass }) =>
      make("tr", {}, make("th", { scope: "row" }, part), make("td", { "data-part": part }, massText(mass))))));
}

/** The verdicts in the file, and the values of the sweep that have them. */
function stabilityOf({ key, unit, value, stability }) {
  const words = [...new Set(stability.map((word) => word.split(":")[0]))];
  const at = (word) => [...value].filter((_, i) => stability[i].split(":")[0] === word);
  const text = words.map((word) => {
    const values = at(word);
    const shown = values.slice(0, 8).map((number) => general(number, 6)).join(", ") + (values.length > 8 ? ", ..." : "");
    return words.length === 1 ? `${word} at all ${value.length} points` : `${word} at ${shown}`;
  }).join("; ");
  return `${key}${unit ? ` [${unit}]` : ""}: ${text}.`;
}

const massesOf = (result) => JSON.stringify(result.model?.masses ?? []);

function card(result, number, results) {
  const { model, modes, trim } = result;
  const before = results.slice(0, number).find((other) => model?.masses.length && massesOf(other) === massesOf(result));
  const entries = [["Command", make("code", {}, result.command_line)], ["Case", result.case_path],
                   ["Program", result.program], ["Run", result.time.replace("T", " ").replace("Z", " UTC")]];
  const sizes = [];
  if (model) {
    if (model.rotor_speed !== null)
      sizes.push(["Rotor speed", model.rotor_speed === 0 ? "0" :
        `${fixed(model.rotor_speed, 5)} rad/s, ${fixed(model.rotor_speed * 30 / Math.PI, 4)} rpm`]);
    sizes.push(["Degrees of freedom", model.degrees_of_freedom === null ? "" : String(model.degrees_of_freedom)],
               ["Unknowns", model.unknowns === null ? "" : String(model.unknowns)],
               ["Blades", model.blades === null ? "" : String(model.blades)]);
    if (model.rotor_inertia !== undefined)
      sizes.push(["Rotor inertia", `${general(model.rotor_inertia, 6)} kg m²`]);
  }
  if (trim?.imbalance !== undefined && trim.imbalance !== null)
    sizes.push(["Steady state", `${trim.harmonics > 0 ? `${trim.harmonics} harmonics, ` : ""}` +
                                `residual ${general(trim.imbalance, 2)} of the largest load`]);
  if (before) sizes.push(["Masses", `as in ${before.file}`]);
  const isAlone = new Set(results.map(({ title }) => title)).size === 1;
  const withMasses = model?.masses.length > 0 && !before;
  const parts = [make("h3", {}, isAlone ? result.file : `${result.file}: ${result.title}`),
                 make("div", { class: `columns ${withMasses ? "three" : ""}` }, facts(entries), make("div", {}, facts(sizes)),
                      withMasses ? massTable(model) : null)];
  if (modes) {
    const { isGrowing, lines } = wordsOn(modes);
    parts.push(make("div", { class: `verdict ${isGrowing ? "grows" : ""}` }, lines.map((line) => make("p", {}, line))));
  }
  if (result.campbell) {
    const isGrowing = result.campbell.stability.includes("unstable");
    parts.push(make("div", { class: `verdict ${isGrowing ? "grows" : ""}` }, make("p", {}, stabilityOf(result.campbell))));
  }
  parts.push(make("details", {}, make("summary", {}, "Case as run"),
                  make("pre", { tabindex: "0", role: "region", "aria-label": `Case of result ${number + 1}` }, result.case)));
  return make("article", { class: "card" }, parts);
}

export function summary(results) {
  return section("results", results.length > 1 ? "Results" : "Result", make("div", { class: `cards ${results.length > 1 ? "many" : ""}` }, results.map(card)));
}
