// The mode that is chosen, known to all parts of the page.

export class Selection extends EventTarget {
  constructor() {
    super();
    this.label = null;
    this.result = null; // its number, or null: any result
    this.mode = null;
  }

  /** Chooses a mode of a result, or by its name alone, which the first result that has it provides. */
  choose(choice) {
    Object.assign(this, { result: null, mode: null, label: null }, choice);
    this.dispatchEvent(new Event("change"));
  }
}

/** Number of the result and the mode with a name, or null. */
export function findMode(results, label) {
  for (const [result, { modes }] of results.entries()) {
    const mode = modes ? modes.label.indexOf(label) : -1;
    if (mode >= 0) return { result, mode, label };
  }
  return null;
}

export function canMove(section, mode) {
  return Boolean(section.geometry && section.modes?.motions?.series[mode]);
}
