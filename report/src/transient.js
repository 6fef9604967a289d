// Places of the nodes in a time series.

/** Number of the last of rising times that is not after t, at least 0. */
export function rowAt(times, t) {
  let [low, high] = [0, times.length - 1];
  while (low < high) {
    const middle = Math.ceil((low + high) / 2);
    if (times[middle] <= t) low = middle; else high = middle - 1;
  }
  return low;
}

/** A unit quaternion [x, y, z, w] of a rotation vector times a factor. */
function quaternion([x, y, z], factor = 1) {
  const angle = factor * Math.hypot(x, y, z);
  const share = angle === 0 ? 0.5 * factor : Math.sin(0.5 * angle) * factor / angle;
  return [share * x, share * y, share * z, Math.cos(0.5 * angle)];
}

function vectorOf([x, y, z, w]) {
  const sine = Math.hypot(x, y, z);
  const share = sine === 0 ? 2 : 2 * Math.atan2(w < 0 ? -sine : sine, Math.abs(w)) / sine;
  return [share * x, share * y, share * z];
}

/** The second turn, then the first one. */
function product([a, b, c, d], [e, f, g, h]) {
  return [d * e + a * h + b * g - c * f, d * f + b * h + c * e - a * g, d * g + c * h + a * f - b * e,
          d * h - a * e - b * f - c * g];
}

const inverse = ([x, y, z, w]) => [-x, -y, -z, w];

function turn(q, [x, y, z]) { return product(product(q, [x, y, z, 0]), inverse(q)).slice(0, 3); }

/** On the way from the first to the second turn, about one axis. */
const between = (first, second, part) => product(first, quaternion(vectorOf(product(inverse(first), second)), part));

export class TransientMotion {
  constructor(section) {
    this.geometry = section.geometry;
    this.nodes = this.geometry.part.length;
  }

  get begin() { return this.geometry.time[0]; }
  get end() { return this.geometry.time.at(-1); }

  /** Times spread over the series. */
  times(count) { return [...Array(count).keys()].map((i) => this.begin + (this.end - this.begin) * i / Math.max(1, count - 1)); }

  /** Places and axes at a time: between two frames as samara.shapes.Transient has them, or else those of the earlier one. */
  steady(t) {
    const { geometry, nodes } = this;
    const { time } = geometry;
    const row = Math.min(rowAt(time, t), Math.max(0, time.length - 2));
    const next = Math.min(row + 1, time.length - 1);
    let part = next > row ? Math.min(Math.max(0, (t - time[row]) / (time[next] - time[row])), 1) : 0;
    if (!geometry.is_even) part = Math.floor(part);
    const at = (array, frame, n) => {
      const first = 3 * (frame * nodes + n);
      return [array[first], array[first + 1], array[first + 2]];
    };
    const turns = (n) => [row, next].map((frame) => quaternion(at(geometry.rotation, frame, n)));
    const mix = (a, b) => a.map((value, i) => value * (1 - part) + b[i] * part);
    const placeOf = (n) => [row, next].map((frame) => at(geometry.place, frame, n));
    const hubs = placeOf(geometry.hub);
    const hubTurns = turns(geometry.hub);
    const hub = mix(...hubs);
    const hubTurn = between(...hubTurns, part);
    const place = new Float64Array(3 * nodes);
    const axes = new Float64Array(9 * nodes);
    for (let n = 0; n < nodes; ++n) {
      const ends = placeOf(n);
      if (part > 0 && part < 1 && geometry.on_rotor[n]) {
        const arms = [0, 1].map((i) => turn(inverse(hubTurns[i]), ends[i].map((value, k) => value - hubs[i][k])));
        place.set(turn(hubTurn, mix(...arms)).map((value, k) => hub[k] + value), 3 * n);
      } else place.set(mix(...ends), 3 * n);
      const own = between(...turns(n), part);
      for (let axis = 0; axis < 3; ++axis)
        axes.set(turn(own, [axis === 0, axis === 1, axis === 2].map(Number)), 9 * n + 3 * axis);
    }
    return { place, axes };
  }
}
