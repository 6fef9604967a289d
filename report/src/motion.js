// Places of the nodes at a time: the steady state, and a mode about it.

import { decodeOnce } from "./data.js";

/** A series over the azimuth: mean, cos 1, sin 1, ... at an angle, added to `values` times a factor. */
function addSeries(series, angle, factor, values) {
  const width = values.length;
  const rows = series.length / width;
  for (let row = 0; row < rows; ++row) {
    const k = Math.ceil(row / 2);
    const weight = factor * (row === 0 ? 1 : row % 2 === 1 ? Math.cos(k * angle) : Math.sin(k * angle));
    for (let i = 0; i < width; ++i) values[i] += weight * series[row * width + i];
  }
}

/** Between two states of a path, by their number. */
function addStates(states, at, factor, values) {
  const width = values.length;
  const last = states.length / width - 1;
  const first = Math.min(Math.max(0, Math.floor(at)), Math.max(0, last - 1));
  const part = last > 0 ? at - first : 0;
  for (let i = 0; i < width; ++i)
    values[i] += factor * (states[first * width + i] * (1 - part) + (part ? states[(first + 1) * width + i] * part : 0));
}

export class Motion {
  constructor(section) {
    this.geometry = section.geometry;
    this.modes = section.modes;
    this.nodes = this.geometry.part.length;
  }

  /** Angle that the rotor has turned since t = 0, at an azimuth of blade 1. */
  turnedAt(azimuth) { return azimuth - this.geometry.azimuth[0]; }

  /** Places and axes of the steady state, its deflection magnified. `at`: angle since t = 0, or number of a state. */
  steady(at, magnification = 1) {
    const { geometry } = this;
    const place = new Float64Array(3 * this.nodes);
    const axes = new Float64Array(9 * this.nodes);
    const add = geometry.kind === "path" ? addStates : addSeries;
    add(geometry.place, at, magnification, place);
    if (magnification !== 1) add(geometry.undeformed, at, 1 - magnification, place);
    add(geometry.axes, at, 1, axes);
    return { place, axes };
  }

  undeformed(at) {
    const place = new Float64Array(3 * this.nodes);
    (this.geometry.kind === "path" ? addStates : addSeries)(this.geometry.undeformed, at, 1, place);
    return place;
  }

  /**
   * Displacements and rotations of the nodes [node, 6]: Re{exp(i phase) sum over d of c_d exp(i d angle)}, d counted from
   * the identified harmonic. `phase` is the frequency of the mode times the time.
   */
  mode(m, phase, angle) {
    const entry = this.modes.motions.series[m];
    const values = decodeOnce(entry, "values");
    const width = 6 * this.nodes;
    const found = new Float64Array(width);
    for (const [row, d] of entry.offset.entries()) {
      const [c, s] = [Math.cos(phase + d * angle), Math.sin(phase + d * angle)];
      for (let i = 0, at = 2 * row * width; i < width; ++i, at += 2) found[i] += values[at] * c - values[at + 1] * s;
    }
    return found;
  }

  /** Largest displacement and rotation of a mode over a cycle at some azimuths. */
  largest(m) {
    let [displacement, rotation] = [0, 0];
    const angles = this.geometry.kind === "periodic" ? 12 : 1;
    for (let a = 0; a < angles; ++a)
      for (let p = 0; p < 8; ++p) {
        const motion = this.mode(m, p * Math.PI / 8, 2 * Math.PI * a / angles);
        for (let i = 0; i < motion.length; i += 6) {
          displacement = Math.max(displacement, Math.hypot(motion[i], motion[i + 1], motion[i + 2]));
          rotation = Math.max(rotation, Math.hypot(motion[i + 3], motion[i + 4], motion[i + 5]));
        }
      }
    return { displacement, rotation };
  }

  /** The steady state moved by a mode times a scale. */
  moved(m, phase, angle, scale) {
    const { place, axes } = this.steady(angle);
    const motion = this.mode(m, phase, angle);
    for (let n = 0; n < this.nodes; ++n) {
      for (let i = 0; i < 3; ++i) place[3 * n + i] += scale * motion[6 * n + i];
      rotate(axes, 9 * n, motion.subarray(6 * n + 3, 6 * n + 6), scale);
    }
    return { place, axes };
  }
}

/** Rotates three axes by a vector times a scale (Rodrigues). */
function rotate(axes, first, vector, scale) {
  const angle = scale * Math.hypot(vector[0], vector[1], vector[2]);
  if (angle === 0) return;
  const [x, y, z] = Array.from(vector, (value) => value * scale / angle);
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  for (let i = first; i < first + 9; i += 3) {
    const [a, b, d] = [axes[i], axes[i + 1], axes[i + 2]];
    const along = (x * a + y * b + z * d) * (1 - c);
    axes[i] = a * c + (y * d - z * b) * s + x * along;
    axes[i + 1] = b * c + (z * a - x * d) * s + y * along;
    axes[i + 2] = d * c + (x * b - y * a) * s + z * along;
  }
}
