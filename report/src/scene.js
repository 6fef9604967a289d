// The turbine in three dimensions: swept sections along beams, simple solids for bodies.

import { AmbientLight, BufferAttribute, BufferGeometry, BoxGeometry, Color, CylinderGeometry, DirectionalLight, DoubleSide,
         GridHelper, Group, LineBasicMaterial, LineSegments, Matrix4, Mesh, MeshLambertMaterial, PerspectiveCamera,
         Scene, SphereGeometry, Vector3, WebGLRenderer } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

import { colourOf } from "./format.js";

const AROUND = 20; // points of a section
const BETWEEN = 4; // steps between two nodes
const UP = new Vector3(0, 1, 0);

function pointOf(place, n, target = new Vector3()) { return target.set(place[3 * n], place[3 * n + 1], place[3 * n + 2]); }

/** Runs of nodes with a size that lines join one after the other, each a beam. */
function beamsOf(geometry) {
  const isSized = (n) => geometry.width[n] > 0;
  const beams = [];
  for (const [a, b] of geometry.lines) {
    if (!isSized(a) || !isSized(b) || geometry.part[a] !== geometry.part[b]) continue;
    const last = beams.at(-1);
    if (last && last.at(-1) === a) last.push(b);
    else beams.push([a, b]);
  }
  return beams;
}

/** Cubic through four values (Catmull and Rom) between the second and the third. */
function between(a, b, c, d, t) {
  return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
}

class Beam {
  constructor(nodes, geometry, material) {
    this.nodes = nodes;
    this.geometry = geometry;
    this.sections = (nodes.length - 1) * BETWEEN + 1;
    this.positions = new Float32Array(3 * AROUND * this.sections);
    const faces = [];
    for (let i = 0; i + 1 < this.sections; ++i)
      for (let j = 0; j < AROUND; ++j) {
        const [a, b] = [i * AROUND + j, i * AROUND + ((j + 1) % AROUND)];
        faces.push(a, b, a + AROUND, b, b + AROUND, a + AROUND);
      }
    this.surface = new BufferGeometry();
    this.surface.setAttribute("position", new BufferAttribute(this.positions, 3));
    this.surface.setIndex(faces);
    this.mesh = new Mesh(this.surface, material);
    this.mesh.frustumCulled = false;
  }

  move({ place, axes }) {
    const { nodes, geometry } = this;
    const last = nodes.length - 1;
    const value = (array, width, n, i) => array[width * nodes[Math.min(Math.max(n, 0), last)] + i];
    // Beyond the ends the line goes on straight.
    const at = (array, width, n, i) => (n < 0 ? 2 * value(array, width, 0, i) - value(array, width, 1, i)
      : n > last ? 2 * value(array, width, last, i) - value(array, width, last - 1, i) : value(array, width, n, i));
    for (let section = 0; section < this.sections; ++section) {
      const n = Math.min(Math.floor(section / BETWEEN), last - 1);
      const t = section / BETWEEN - n;
      const curve = (i) => between(at(place, 3, n - 1, i), at(place, 3, n, i), at(place, 3, n + 1, i), at(place, 3, n + 2, i), t);
      const straight = (array, width, i) => value(array, width, n, i) * (1 - t) + value(array, width, n + 1, i) * t;
      const centre = [curve(0), curve(1), curve(2)];
      const wide = 0.5 * straight(geometry.width, 1, 0);
      const thick = 0.5 * straight(geometry.thickness, 1, 0);
      const [second, third] = [3, 6].map((from) => [0, 1, 2].map((i) => straight(axes, 9, from + i)));
      for (let j = 0; j < AROUND; ++j) {
        const angle = 2 * Math.PI * j / AROUND;
        const [c, s] = [wide * Math.cos(angle), thick * Math.sin(angle)];
        for (let i = 0; i < 3; ++i)
          this.positions[3 * (section * AROUND + j) + i] = centre[i] + c * second[i] + s * third[i];
      }
    }
    this.surface.attributes.position.needsUpdate = true;
    this.surface.computeVertexNormals();
  }
}

/** A rod between two nodes. */
class Rod {
  constructor([from, to], radius, material) {
    Object.assign(this, { from, to });
    this.mesh = new Mesh(new CylinderGeometry(radius, radius, 1, 14), material);
  }

  move({ place }) {
    const [a, b] = [pointOf(place, this.from), pointOf(place, this.to)];
    const along = b.clone().sub(a);
    const length = along.length();
    this.mesh.visible = length > 0;
    if (length === 0) return;
    this.mesh.position.copy(a).addScaledVector(along, 0.5);
    this.mesh.scale.set(1, length, 1);
    this.mesh.quaternion.setFromUnitVectors(UP, along.divideScalar(length));
  }
}

/** A body that stands at a node and turns with its axes. */
class Body {
  constructor(node, shape, offset, material) {
    this.node = node;
    this.offset = offset;
    this.mesh = new Mesh(shape, material);
  }

  move({ place, axes }) {
    const column = (i) => new Vector3().fromArray(axes, 9 * this.node + 3 * i).normalize();
    const [x, y] = [column(0), column(1)];
    const z = x.clone().cross(y);
    const turn = new Matrix4().makeBasis(x, y, z);
    this.mesh.quaternion.setFromRotationMatrix(turn);
    this.mesh.position.copy(pointOf(place, this.node)).add(this.offset.clone().applyMatrix4(turn));
  }
}

/** A turbine of one geometry in the scene. */
class Turbine {
  constructor(geometry, rest, materialOf) {
    this.group = new Group();
    this.parts = [];
    const add = (part) => { this.parts.push(part); this.group.add(part.mesh); };
    const beams = beamsOf(geometry);
    for (const nodes of beams) add(new Beam(nodes, geometry, materialOf(geometry.part[nodes[0]])));
    const inBeam = new Set(beams.flatMap((nodes) => nodes.slice(1).map((n, i) => `${nodes[i]} ${n}`)));
    const nodesOf = (part) => geometry.part.map((name, n) => (name === part ? n : -1)).filter((n) => n >= 0);
    const size = geometry.size;
    const [tower, hub, shaft, nacelle] = ["tower", "hub", "shaft", "nacelle"].map(nodesOf);
    const widthOf = (n) => (n === undefined ? 0 : geometry.width[n]);
    const bound = (value, least, largest) => Math.min(Math.max(value, least * size), largest * size);
    const thin = bound(0.3 * widthOf(geometry.part.findIndex((name) => name.startsWith("blade"))), 0.002, 0.012);
    for (const [a, b] of geometry.lines)
      if (!inBeam.has(`${a} ${b}`)) add(new Rod([a, b], thin, materialOf(geometry.part[a])));
    if (hub.length > 0) {
      const apex = hub.at(-1);
      const roots = geometry.lines.filter(([a, b]) => a === apex && geometry.part[b].startsWith("blade")).map(([, b]) => b);
      const nearest = Math.min(...roots.map((n) => pointOf(rest.place, n).distanceTo(pointOf(rest.place, apex))), Infinity);
      const radius = bound(Number.isFinite(nearest) && nearest > 0 ? 0.9 * nearest : 0, 0.008, 0.02);
      add(new Body(apex, new SphereGeometry(radius, 24, 16), new Vector3(), materialOf("hub")));
    }
    if (nacelle.length > 0 && shaft.length > 0) {
      const overhang = pointOf(rest.place, shaft.at(-1)).sub(pointOf(rest.place, nacelle.at(-1)));
      const local = (i) => overhang.dot(new Vector3().fromArray(rest.axes, 9 * nacelle.at(-1) + 3 * i));
      const length = overhang.length();
      if (length > 0) {
        const high = bound(Math.max(0.5 * length, 1.5 * widthOf(tower.at(-1))), 0.015, 0.03);
        // From near the hub to as far behind the bearing.
        add(new Body(nacelle.at(-1), new BoxGeometry(1.7 * length, high, high), new Vector3(-0.05 * local(0), 0, 0),
                     materialOf("nacelle")));
      }
    }
  }

  move(pose) { for (const part of this.parts) part.move(pose); }

  dispose() { for (const { mesh } of this.parts) mesh.geometry.dispose(); }
}

export class View {
  /** Throws where the browser has no WebGL. */
  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, antialias: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(32, 1, 0.1, 1000);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.addEventListener("change", () => { this.isStale = true; });
    this.scene.add(new AmbientLight(0xffffff, 1.6));
    const sun = new DirectionalLight(0xffffff, 2.2);
    sun.position.set(-2, -3, 4);
    const fill = new DirectionalLight(0xffffff, 0.8);
    fill.position.set(3, 2, 1);
    this.scene.add(sun, fill);
    this.materials = new Map();
    this.ghost = new Group();
    this.ghostMaterial = new LineBasicMaterial({ transparent: true, opacity: 0.8 });
    this.scene.add(this.ghost);
    this.isStale = true;
  }

  materialOf(part) {
    const name = part.startsWith("blade") ? (part === "blade 1" ? "--blade-1" : "--blade") : "--body";
    if (!this.materials.has(name)) this.materials.set(name, new MeshLambertMaterial({ side: DoubleSide }));
    return this.materials.get(name);
  }

  /** Another turbine: its parts, at rest, and the box of all its places. */
  setGeometry(geometry, rest, places) {
    if (this.turbine) { this.scene.remove(this.turbine.group); this.turbine.dispose(); }
    this.turbine = new Turbine(geometry, rest, (part) => this.materialOf(part));
    this.scene.add(this.turbine.group);
    this.outline = new BufferGeometry();
    this.outline.setAttribute("position", new BufferAttribute(new Float32Array(3 * geometry.part.length), 3));
    this.outline.setIndex(geometry.lines.flat());
    this.ghost.clear();
    const lines = new LineSegments(this.outline, this.ghostMaterial);
    lines.frustumCulled = false;
    this.ghost.add(lines);
    const [low, high] = [new Vector3(Infinity, Infinity, Infinity), new Vector3(-Infinity, -Infinity, -Infinity)];
    for (const place of places)
      for (let n = 0; n < geometry.part.length; ++n) {
        const p = pointOf(place, n);
        const half = 0.5 * geometry.width[n];
        low.min(p.clone().subScalar(half));
        high.max(p.addScalar(half));
      }
    this.centre = low.clone().add(high).multiplyScalar(0.5);
    this.reach = 0.5 * high.distanceTo(low) || 1;
    if (this.grid) { this.scene.remove(this.grid); this.grid = null; }
    if (geometry.part.includes("tower")) {
      this.grid = new GridHelper(2 * this.reach, 20);
      this.grid.rotation.x = Math.PI / 2;
      this.grid.position.set(this.centre.x, this.centre.y, low.z);
      this.scene.add(this.grid);
    }
    this.colour();
    this.resetCamera();
  }

  resetCamera() {
    const [width, height] = [this.canvas.clientWidth || 1, this.canvas.clientHeight || 1];
    const narrow = Math.min(1, width / height);
    const distance = 1.06 * this.reach / Math.sin(0.5 * this.camera.fov * Math.PI / 180) / narrow;
    this.camera.near = 0.01 * distance;
    this.camera.far = 10 * distance;
    this.camera.position.copy(this.centre).addScaledVector(new Vector3(-1, -0.85, 0.22).normalize(), distance);
    this.controls.target.copy(this.centre);
    this.controls.update();
    this.isStale = true;
  }

  colour() {
    this.scene.background = new Color(colourOf("--scene"));
    for (const [name, material] of this.materials) material.color.set(colourOf(name));
    this.ghostMaterial.color.set(colourOf("--muted"));
    if (this.grid) {
      this.grid.material.dispose();
      this.grid.material = new LineBasicMaterial({ color: colourOf("--grid") });
    }
    this.isStale = true;
  }

  /** Turns and approaches by keys: angles [rad], and a factor of the distance. */
  orbit(azimuth, elevation, nearer = 1) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const length = offset.length() * nearer;
    const now = Math.asin(offset.z / offset.length());
    const tilt = Math.min(1.5, Math.max(-1.5, now + elevation));
    const heading = Math.atan2(offset.y, offset.x) + azimuth;
    offset.set(Math.cos(tilt) * Math.cos(heading), Math.cos(tilt) * Math.sin(heading), Math.sin(tilt)).multiplyScalar(length);
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.isStale = true;
  }

  move(pose, undeformed) {
    this.turbine.move(pose);
    this.ghost.visible = undeformed !== null;
    if (undeformed) {
      this.outline.attributes.position.array.set(undeformed);
      this.outline.attributes.position.needsUpdate = true;
    }
    this.isStale = true;
  }

  /** Draws a frame, where something has changed. */
  render() {
    const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight];
    if (width === 0 || height === 0) return;
    if (width !== this.width || height !== this.height) {
      Object.assign(this, { width, height });
      this.renderer.setSize(width, height, false);
      this.camera.aspect = width / height;
      this.camera.updateProjectionMatrix();
      this.isStale = true;
    }
    if (!this.isStale) return;
    this.isStale = false;
    this.renderer.render(this.scene, this.camera);
  }
}
