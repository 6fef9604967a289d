// The time in a time series that the turbine and the diagrams show.

export class Clock extends EventTarget {
  constructor() {
    super();
    this.result = null; // its number
    this.time = null; // [s]
  }

  #set(result, time, event) {
    Object.assign(this, { result, time });
    this.dispatchEvent(new Event(event));
  }

  /** The turbine stands as at this time; without a result it moves in something else. */
  show(result, time) { this.#set(result, time, "shown"); }

  /** The reader wants to see the turbine at this time. */
  choose(result, time) { this.#set(result, time, "chosen"); }
}
