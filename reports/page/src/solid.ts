// Bodies in three dimensions. The reader can turn, zoom and cut them, and compare two under one camera. The
// script is evaluated on first use.

import {
  AmbientLight, BufferAttribute, BufferGeometry, Color, DirectionalLight, DoubleSide, Float32BufferAttribute, Group, IcosahedronGeometry,
  InstancedMesh, LineBasicMaterial, LineSegments, Matrix4, Mesh, MeshBasicMaterial, MeshLambertMaterial, PerspectiveCamera, Plane,
  Raycaster, Scene, Vector2, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { face } from "./cut";
import { h, select } from "./dom";
import { digits } from "./text";

/** Unit quaternion (x, y, z, w). */
type Turn = [number, number, number, number];
const UNTURNED: Turn = [0, 0, 0, 1];

/** Body of a method at the recorded states of its run. Arrays are base64 of little-endian numbers; lengths
 * are in metres, stresses in pascals. */
export interface Body {
  method: string; title: string; points: string; faces: { nodes: number; indices: string }[];
  tools: { points: string; quads: string; along: [number, number, number] }[];
  states: { time: number; u: string; tools: [number, number, number][]; turns?: Turn[]; touching: string; deepest_node: number; values: [string, string, string] | null }[];
  left_out: number;
  /** Distance of each point from its position in the reference or exact solution at the end; empty if neither
   * is known. */
  off: string;
  source?: string;
  /** Cells, and points on no face, at the same states; shown by a cut. */
  inside: { points: string; cells: { nodes: number; indices: string }[]; states: { u: string; values: [string, string, string] | null }[] } | null;
  /** Positions of a cloud's nodes at the end. */
  cloud: string;
  /** Method of an earlier body with the same points and faces, which are stored there. */
  like?: string;
  /** Method of an earlier body with the same tools, which are stored there. */
  tools_like?: string;
  /** Methods whose bodies were left out of the page; stored with the first body of a case. */
  without?: string[];
}

const bytes = (text: string): ArrayBuffer => Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer;
const floats = (text: string) => new Float32Array(bytes(text));
const joined = (a: Float32Array, b: Float32Array) => Float32Array.from([...a, ...b]);
const whole = (text: string) => new Uint32Array(bytes(text));

/** Number of straight pieces along an edge of a curved face. */
const PIECES = 5;

/** Shape functions of a face with 3, 4, 6 or 8 nodes, at a point of the unit triangle or square. */
function shapes(nodes: number, a: number, b: number): number[] {
  if (nodes === 3) return [1 - a - b, a, b];
  if (nodes === 4) return [(1 - a) * (1 - b), a * (1 - b), a * b, (1 - a) * b];
  if (nodes === 6) {
    const l = [1 - a - b, a, b];
    return [...l.map((x) => x * (2 * x - 1)), 4 * l[0] * l[1], 4 * l[1] * l[2], 4 * l[2] * l[0]];
  }
  const [x, y] = [2 * a - 1, 2 * b - 1];
  const corner = (p: number, q: number) => ((1 + x * p) * (1 + y * q) * (x * p + y * q - 1)) / 4;
  return [corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1),
    ((1 - x * x) * (1 - y)) / 2, ((1 + x) * (1 - y * y)) / 2, ((1 - x * x) * (1 + y)) / 2, ((1 - x) * (1 - y * y)) / 2];
}

/** Division of a face into triangles: the weights of the face's nodes at each point, and the indices of the
 * points of each triangle and of each piece of an edge. */
interface Pattern { weights: number[][]; triangles: number[]; edges: number[] }

function pattern(nodes: number): Pattern {
  const n = nodes > 4 ? PIECES : 1;
  const isTriangle = nodes % 3 === 0;
  const at = new Map<string, number>();
  const out: Pattern = { weights: [], triangles: [], edges: [] };
  for (let j = 0; j <= n; j++)
    for (let i = 0; i <= (isTriangle ? n - j : n); i++) {
      at.set(`${i},${j}`, out.weights.length);
      out.weights.push(shapes(nodes, i / n, j / n));
    }
  const p = (i: number, j: number) => at.get(`${i},${j}`)!;
  for (let j = 0; j < n; j++)
    for (let i = 0; i < (isTriangle ? n - j : n); i++) {
      out.triangles.push(p(i, j), p(i + 1, j), p(i, j + 1));
      if (at.has(`${i + 1},${j + 1}`)) out.triangles.push(p(i + 1, j), p(i + 1, j + 1), p(i, j + 1));
    }
  for (let k = 0; k < n; k++) {
    out.edges.push(p(k, 0), p(k + 1, 0), p(0, k), p(0, k + 1));
    if (isTriangle) out.edges.push(p(n - k, k), p(n - k - 1, k + 1));
    else out.edges.push(p(k, n), p(k + 1, n), p(n, k), p(n, k + 1));
  }
  return out;
}

const FIELDS: [string, string, string, number][] = [
  ["u", "displacement", "mm", 1e3], ["e", "difference to the reference", "mm", 1e3], ["s", "source of the error", "times the mean", 1], ["d", "depth of contact points", "mm", 1e3], ["p", "pressure", "kPa", 1e-3], ["m", "von Mises stress", "kPa", 1e-3], ["j", "volume ratio J", "", 1],
];

// The rising scale goes from pale to dark, so that most of a body is bright; it follows ColorBrewer's yellow,
// green and blue. The signed scale is ColorBrewer's, from blue over white to red.
const RISING = ["#fdf6c9", "#dcecb2", "#a5d8b5", "#5fbcc0", "#3494c2", "#3f64b0", "#552b8c"];
const SIGNED = ["#2166ac", "#4393c3", "#92c5de", "#f7f7f7", "#f4a582", "#d6604d", "#b2182b"];
const isSigned = (field: string) => field === "p" || field === "j";
/** Fraction of the values that lies beyond each end of a scale; these values have the colour of the end. */
const CLIPPED = 0.02;

/** Field at the contact points. The surface is transparent while it is shown. */
const OF_POINTS = "d";
const GREY = new Color(0xb0b0b0);
const DOT = new Color(0x101010);
const NODE = new Color(0xd6604d);

/** Body of one method in its own three.js scene. */
class Solid {
  readonly scene = new Scene();
  readonly reference: Float32Array;
  private readonly faces: { indices: Uint32Array; nodes: number; pattern: Pattern }[];
  private readonly surface = new BufferGeometry();
  private readonly lines = new BufferGeometry();
  private readonly edges: LineSegments;
  private readonly tools = new Group();
  private readonly points: InstancedMesh;
  private readonly cloud: Float32Array;
  private readonly cells: { nodes: number; indices: Uint32Array }[];
  private readonly cap = new Mesh(new BufferGeometry(), new MeshBasicMaterial({ vertexColors: true, side: DoubleSide }));
  private readonly skin: Mesh;
  /** Positions of the nodes at the state shown, and the field at them. */
  private places = new Float32Array();
  private field: Float32Array | null = null;
  /** Field at the drawn vertices of the surface and of the cut face. */
  private readonly drawn = { skin: new Float32Array(), cap: new Float32Array() };
  readonly material = new MeshLambertMaterial({ vertexColors: true, side: DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
  readonly wire = new LineBasicMaterial({ color: 0x101010, transparent: true, opacity: 0.3 });
  readonly dots = new MeshBasicMaterial();

  /** Creates the scene of a body; `grain` is the radius at which contact points and nodes are drawn, m. */
  constructor(readonly body: Body, grain: number) {
    this.reference = joined(floats(body.points), floats(body.inside?.points ?? ""));
    this.cells = (body.inside?.cells ?? []).map((c) => ({ nodes: c.nodes, indices: whole(c.indices) }));
    this.faces = body.faces.map((f) => ({ indices: whole(f.indices), nodes: f.nodes, pattern: pattern(f.nodes) }));
    const triangles: number[] = [];
    const edges: number[] = [];
    let first = 0;
    for (const { indices, nodes, pattern } of this.faces)
      for (let face = 0; face < indices.length / nodes; face++) {
        for (const k of pattern.triangles) triangles.push(first + k);
        for (const k of pattern.edges) edges.push(first + k);
        first += pattern.weights.length;
      }
    const places = new BufferAttribute(new Float32Array(3 * first), 3);
    this.surface.setAttribute("position", places).setAttribute("color", new BufferAttribute(new Float32Array(3 * first), 3)).setIndex(triangles);
    this.lines.setAttribute("position", places).setIndex(edges);
    this.edges = new LineSegments(this.lines, this.wire);
    const light = new DirectionalLight(0xffffff, 1.1);
    light.position.set(1.5, -0.7, 2);
    const back = new DirectionalLight(0xffffff, 0.6);
    back.position.set(-1.5, 1, -0.5);
    this.skin = new Mesh(this.surface, this.material);
    this.drawn.skin = new Float32Array(first);
    this.scene.add(new AmbientLight(0xffffff, 2.3), light, back, this.skin, this.cap, this.edges, this.tools);
    this.cloud = floats(body.cloud);
    const most = Math.max(...body.states.map((_, k) => this.touching(k).length / 4)) + this.cloud.length / 3;
    this.points = new InstancedMesh(new IcosahedronGeometry(grain, 1), this.dots, most);
    this.points.frustumCulled = false;
    this.scene.add(this.points);
    for (const tool of body.tools) {
      const shape = new BufferGeometry();
      shape.setAttribute("position", new BufferAttribute(floats(tool.points), 3));
      const quads = whole(tool.quads);
      const index: number[] = [];
      for (let q = 0; q < quads.length; q += 4) index.push(quads[q], quads[q + 1], quads[q + 2], quads[q], quads[q + 2], quads[q + 3]);
      shape.setIndex(index);
      shape.computeVertexNormals();
      this.tools.add(new Mesh(shape, new MeshLambertMaterial({ color: 0x9aa0a6, transparent: true, opacity: 0.45, side: DoubleSide })));
    }
  }

  get triangles(): number {
    return this.surface.index!.count / 3;
  }

  /** Contact points within a tool at a state: x, y, z and depth of each, m. */
  touching(state: number): Float32Array {
    return floats(this.body.states[state].touching);
  }

  isEnd(state: number): boolean {
    return state === this.body.states.length - 1;
  }

  depths(state: number): Float32Array {
    return this.touching(state).filter((_, k) => k % 4 === 3);
  }

  private moved(state: number): Float32Array {
    return joined(floats(this.body.states[state].u), floats(this.body.inside?.states[state]?.u ?? ""));
  }

  /** Field at each node at a state, on the surface and then inside; `null` if the body lacks the field. */
  values(field: string, state: number): Float32Array | null {
    const { body } = this;
    if (field === OF_POINTS) return null;
    if (field === "e") return body.off && this.isEnd(state) ? floats(body.off) : null;
    // Without an inside, only the values of the points on faces are drawn.
    if (field === "s") return body.source && this.isEnd(state) ? floats(body.source).slice(0, this.reference.length / 3) : null;
    if (field === "u") {
      const u = this.moved(state);
      return Float32Array.from({ length: u.length / 3 }, (_, k) => Math.hypot(u[3 * k], u[3 * k + 1], u[3 * k + 2]));
    }
    const of = (values: [string, string, string] | null | undefined) => floats(values?.["pmj".indexOf(field)] ?? "");
    const own = of(body.states[state].values);
    // Results of an earlier version have a value for each face; these values are not shown.
    return 3 * own.length === floats(body.points).length ? joined(own, of(body.inside?.states[state]?.values)) : null;
  }

  /** Moves the body to a state and colours it by a field. */
  show(field: string, state: number, colour: (value: number) => Color, view: { mesh: boolean; dots: boolean; cloud: boolean }) {
    const u = this.moved(state);
    this.places = this.reference.map((x, k) => x + u[k]);
    this.field = this.values(field, state);
    const places = this.surface.getAttribute("position").array as Float32Array;
    const colours = this.surface.getAttribute("color").array as Float32Array;
    let at = 0;
    for (const { indices, nodes, pattern } of this.faces)
      for (let start = 0; start < indices.length; start += nodes)
        for (const weights of pattern.weights) {
          let value = 0;
          const place = [0, 0, 0];
          for (let k = 0; k < nodes; k++) {
            const node = indices[start + k];
            for (let axis = 0; axis < 3; axis++) place[axis] += weights[k] * this.places[3 * node + axis];
            value += weights[k] * (this.field?.[node] ?? NaN);
          }
          const c = Number.isNaN(value) ? GREY : colour(value);
          places.set(place, 3 * at);
          colours.set([c.r, c.g, c.b], 3 * at);
          this.drawn.skin[at++] = value;
        }
    this.surface.getAttribute("position").needsUpdate = this.surface.getAttribute("color").needsUpdate = true;
    this.surface.computeVertexNormals();
    this.surface.computeBoundingSphere();
    this.edges.visible = view.mesh;
    const ofPoints = field === OF_POINTS;
    const cloud = view.cloud && this.isEnd(state) ? this.cloud : new Float32Array();
    // The marked points lie within the body, or between it and a tool, so the surface becomes transparent.
    this.material.transparent = ofPoints || cloud.length > 0;
    this.material.opacity = this.material.transparent ? 0.3 : 1;
    this.material.depthWrite = !this.material.transparent;
    const marked = ofPoints || view.dots ? this.touching(state) : new Float32Array();
    let count = 0;
    const mark = (x: number, y: number, z: number, c: Color) => {
      this.points.setMatrixAt(count, new Matrix4().setPosition(x, y, z));
      this.points.setColorAt(count++, c);
    };
    for (let k = 0; k < marked.length; k += 4) mark(marked[k], marked[k + 1], marked[k + 2], ofPoints ? colour(marked[k + 3]) : DOT);
    for (let k = 0; k < cloud.length; k += 3) mark(cloud[k], cloud[k + 1], cloud[k + 2], NODE);
    this.points.count = count;
    this.points.instanceMatrix.needsUpdate = true;
    if (this.points.instanceColor) this.points.instanceColor.needsUpdate = true;
    this.tools.children.forEach((tool, k) => {
      const [x, y, z] = this.body.states[state].tools[k] ?? [0, 0, 0];
      tool.position.set(x, y, z);
      tool.quaternion.set(...(this.body.states[state].turns?.[k] ?? UNTURNED));
    });
  }

  get cutTriangles(): number {
    return this.drawn.cap.length / 3;
  }

  get hasInside(): boolean {
    return this.cells.length > 0;
  }

  /** Draws the cut face at the coordinate `at` along an axis, coloured by the field; removes the face if the
   * axis is negative. */
  slice(axis: number, at: number, colour: (value: number) => Color) {
    const { points, values } = axis < 0 ? { points: [], values: [] } : face(this.cells, this.places, this.field, axis, at);
    this.drawn.cap = Float32Array.from(values);
    const colours = values.flatMap((value) => { const c = Number.isNaN(value) ? GREY : colour(value); return [c.r, c.g, c.b]; });
    this.cap.geometry.dispose();
    this.cap.geometry = new BufferGeometry();
    this.cap.geometry.setAttribute("position", new Float32BufferAttribute(points, 3)).setAttribute("color", new Float32BufferAttribute(colours, 3));
    this.cap.visible = points.length > 0 && !this.material.transparent;
  }

  /** Nearest point of a ray on the cut face or on the surface where `isSeen` holds, with the field there. */
  met(ray: Raycaster, isSeen: (place: Vector3) => boolean): { place: Vector3; value: number } | null {
    const found = ray.intersectObjects(this.cap.visible ? [this.skin, this.cap] : [this.skin], false)
      .find((hit) => hit.object === this.cap || isSeen(hit.point));
    if (!found?.face || !found.barycoord) return null;
    const values = found.object === this.cap ? this.drawn.cap : this.drawn.skin;
    const { face: { a, b, c }, barycoord: { x, y, z } } = found;
    return { place: found.point, value: x * values[a] + y * values[b] + z * values[c] };
  }
}

/** Draws the bodies of a case into an element. */
export function show(place: HTMLElement, packed: Body[]) {
  const of = (method: string | undefined, body: Body) => packed.find((b) => b.method === method) ?? body;
  const bodies = packed.map((b) => {
    const { points, faces } = of(b.like, b);
    const shared = of(b.like, b).inside;
    const inside = b.inside && shared && { ...b.inside, points: shared.points, cells: shared.cells };
    return { ...b, points, faces, inside, tools: of(b.tools_like, b).tools };
  });
  const renderer = new WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
  renderer.setPixelRatio(Math.min(2, devicePixelRatio));
  renderer.setScissorTest(true);
  renderer.localClippingEnabled = true;
  const canvas = renderer.domElement;
  canvas.tabIndex = 0;
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", "The deformed body: drag or use the arrow keys to turn it");
  const camera = new PerspectiveCamera(28, 1, 1e-4, 100);
  // z is up, as in the scene.
  camera.up.set(0, 0, 1);
  const controls = new OrbitControls(camera, canvas);
  const plane = new Plane(new Vector3(-1, 0, 0), 0);
  const low = new Vector3(Infinity, Infinity, Infinity);
  const high = new Vector3(-Infinity, -Infinity, -Infinity);
  const points = floats(bodies[0].points);
  for (let k = 0; k < points.length; k += 3) {
    const p = new Vector3(points[k], points[k + 1], points[k + 2]);
    low.min(p);
    high.max(p);
  }
  const middle = low.clone().add(high).multiplyScalar(0.5);
  const size = high.clone().sub(low).length();
  const made = new Map<string, Solid>();
  const solid = (method: string) => {
    if (!made.has(method)) made.set(method, new Solid(bodies.find((b) => b.method === method)!, 0.006 * size));
    return made.get(method)!;
  };
  // The first body has curved faces if there are any, because this view draws them curved.
  const best = [...bodies].sort((a, b) => Math.max(...b.faces.map((f) => f.nodes)) - Math.max(...a.faces.map((f) => f.nodes)));
  const view = { left: best[0].method, right: "", field: "u", part: 1, axis: "", cut: 0.5, mesh: true, dots: false, cloud: false };
  const shown = () => [view.left, view.right].filter(Boolean).map(solid);
  const stateOf = (s: Solid) => Math.round(view.part * (s.body.states.length - 1));

  const bar = h("div", { class: "scale" });
  const here = h("span", { class: "here", "aria-live": "polite" });
  const said = h("p", { class: "soft small" });
  const label = h("span", { class: "small" });

  /** Ends of the colour scale, and whether values lie beyond them. */
  function range(): { low: number; high: number; clipped: boolean } {
    if (view.field === OF_POINTS) return { low: 0, high: Math.max(...shown().flatMap((s) => [...s.depths(stateOf(s))]), 0) || 1, clipped: false };
    let [low, high, most, least] = [Infinity, -Infinity, -Infinity, Infinity];
    for (const s of shown()) {
      const sorted = s.values(view.field, stateOf(s))?.slice().sort();
      if (!sorted?.length) continue;
      const last = sorted.length - 1;
      [low, high] = [Math.min(low, sorted[Math.floor(CLIPPED * last)]), Math.max(high, sorted[Math.ceil((1 - CLIPPED) * last)])];
      [least, most] = [Math.min(least, sorted[0]), Math.max(most, sorted[last])];
    }
    if (!(high >= low)) return { low: 0, high: 1, clipped: false };
    const middle = view.field === "j" ? 1 : 0;
    const off = Math.max(middle - low, high - middle, view.field === "j" ? 1e-6 : 0) || 1;
    low = isSigned(view.field) ? middle - off : 0;
    high = middle + off;
    return { low, high, clipped: most > high || (isSigned(view.field) && least < low) };
  }

  const isKnown = (s: Solid) => view.field === OF_POINTS || !!s.values(view.field, stateOf(s));

  /** Sentence on contact: the number of points, and the depths of the deepest point and the deepest node. */
  function marks(s: Solid): string {
    const [at, depths] = [s.body.states[stateOf(s)], s.depths(stateOf(s))];
    if (!depths.length) return "";
    const mm = (metres: number) => `${digits(1e3 * metres, 2)} mm`;
    return `Contact acts at ${depths.length} points${view.dots || view.field === OF_POINTS ? " (marked)" : ""}${view.right ? ` on ${s.body.method}` : ""}, at most ${mm(Math.max(...depths))} deep in a tool; `
      + (at.deepest_node ? `the deepest node is ${mm(at.deepest_node)} deep. ` : "no node is in a tool. ");
  }

  let scale = { low: 0, high: 1, clipped: false };
  const mixed = new Color();
  const ramps = [RISING, SIGNED].map((ramp) => ramp.map((c) => new Color(c)));
  const colour = (value: number) => {
    const table = ramps[Number(isSigned(view.field))];
    const at = Math.min(0.9999, Math.max(0, (value - scale.low) / (scale.high - scale.low || 1))) * (table.length - 1);
    return mixed.copy(table[Math.floor(at)]).lerp(table[Math.floor(at) + 1], at % 1);
  };

  function update() {
    scale = range();
    for (const s of shown()) {
      s.show(view.field, stateOf(s), colour, view);
      s.material.clippingPlanes = s.wire.clippingPlanes = s.dots.clippingPlanes = view.axis ? [plane] : [];
    }
    cut();
    const [, name, unit, times] = FIELDS.find((f) => f[0] === view.field)!;
    const gradient = h("span", { class: "ramp" });
    gradient.style.background = `linear-gradient(to right,${(isSigned(view.field) ? SIGNED : RISING).join(",")})`;
    bar.replaceChildren(h("span", {}, `${name}: ${digits(scale.low * times, 3)}`), gradient,
      h("span", {}, `${digits(scale.high * times, 3)} ${unit}${scale.clipped ? "; 2 % lie beyond" : ""}`), here);
    const first = solid(view.left);
    const state = first.body.states[stateOf(first)];
    label.textContent = first.body.states.length > 1 ? `state ${stateOf(first) + 1} of ${first.body.states.length}, at ${digits(state.time, 3)}` : "";
    const states = shown().filter((s) => s.body.left_out > 0).map((s) => `${s.body.left_out} of ${s.body.left_out + s.body.states.length} states of ${s.body.method}`);
    const lost = [...states, ...(bodies[0].without ?? [])];
    said.textContent = `${shown().map((s) => s.body.title).join(" and ")}. The deformation is not magnified; the faces of quadratic elements are curved. `
      + [...new Set(shown().map(marks))].join("")
      + (shown().some((s) => !isKnown(s)) ? "Grey: the field is not known at this state. " : "")
      + (view.axis && shown().some((s) => !s.hasInside) ? `The inside of ${shown().filter((s) => !s.hasInside).map((s) => s.body.method).join(" and ")} is not stored. ` : "")
      + (lost.length ? `Left out to keep the page small: ${lost.join(", ")}.` : "");
    canvas.dataset.triangles = String(shown().reduce((n, s) => n + s.triangles, 0));
    draw();
  }

  function draw() {
    const [width, height] = [place.clientWidth, Math.max(260, Math.min(520, place.clientWidth * 0.62))];
    if (canvas.clientWidth !== width || canvas.clientHeight !== height) renderer.setSize(width, height);
    const sides = shown();
    sides.forEach((s, k) => {
      const part = width / sides.length;
      camera.aspect = part / height;
      camera.updateProjectionMatrix();
      renderer.setViewport(k * part, 0, part, height);
      renderer.setScissor(k * part, 0, part, height);
      renderer.render(s.scene, camera);
    });
  }

  function home() {
    controls.target.copy(middle);
    // The view is across the travel of a horizontal tool, or else towards the longer side of the body.
    const up = new Vector3(0, 0, 1);
    const tool = new Vector3(...(bodies[0].tools[0]?.along ?? [0, 0, 1])).setZ(0);
    const across = tool.length() > 0.5 ? tool : high.x - low.x > high.y - low.y ? new Vector3(1, 0, 0) : new Vector3(0, 1, 0);
    const side = across.clone().normalize().cross(up);
    // A narrow window needs more distance.
    const away = 1.6 * Math.max(1, 1.25 / camera.aspect);
    camera.position.copy(middle).addScaledVector(side, away * size).addScaledVector(across, 0.5 * size).addScaledVector(up, 0.5 * size);
    camera.near = 0.01 * size;
    camera.far = 20 * size;
    controls.update();
  }
  function cut() {
    const k = "xyz".indexOf(view.axis);
    const at = k < 0 ? 0 : low.getComponent(k) + view.cut * (high.getComponent(k) - low.getComponent(k));
    if (k >= 0) plane.set(new Vector3().setComponent(k, -1), at);
    for (const s of shown()) s.slice(k, at, colour);
    canvas.dataset.cut = String(shown().reduce((n, s) => n + s.cutTriangles, 0));
  }

  /** Shows the field under the pointer. */
  function point(event: PointerEvent) {
    const box = canvas.getBoundingClientRect();
    const sides = shown();
    const part = (sides.length * (event.clientX - box.left)) / box.width;
    const s = sides[Math.min(sides.length - 1, Math.floor(part))];
    const ray = new Raycaster();
    ray.setFromCamera(new Vector2(2 * (part % 1) - 1, 1 - (2 * (event.clientY - box.top)) / box.height), camera);
    const met = s.met(ray, (place) => !view.axis || plane.distanceToPoint(place) >= 0);
    const [, , unit, times] = FIELDS.find((f) => f[0] === view.field)!;
    here.textContent = met && Number.isFinite(met.value)
      ? `${digits(met.value * times, 3)} ${unit} at ${met.place.toArray().map((x) => digits(Math.abs(x) < 1e-6 * size ? 0 : 1e3 * x, 3)).join(", ")} mm` : "";
  }

  const methods: [string, string][] = bodies.map((b) => [b.method, b.title]);
  const slider = (name: string, value: number, input: (value: number) => void) =>
    h("input", { type: "range", min: 0, max: 1, step: 0.01, value, "aria-label": name, input: (e) => input(Number((e.target as HTMLInputElement).value)) });
  const depth = slider("position of the cut", 0.5, (to) => { view.cut = to; cut(); draw(); });
  depth.hidden = true;
  const check = (name: string, checked: boolean, take: (on: boolean) => void) => {
    const box = h("input", { type: "checkbox", checked, change: () => { take(box.checked); update(); } });
    return h("label", { class: "small" }, box, ` ${name}`);
  };
  const has = (field: string) =>
    field === "u" || (field === OF_POINTS ? touched : bodies.some((b) => (field === "e" ? b.off : field === "s" ? b.source : b.states.some((s) => s.values))));
  const touched = bodies.some((b) => b.states.some((s) => s.touching));
  place.replaceChildren(
    h("div", { class: "toolbar" },
      select("body", methods, view.left, (to) => { view.left = to; update(); }),
      select("second body", [["", "no second body"], ...methods], "", (to) => { view.right = to; update(); }),
      select("field", FIELDS.filter((f) => has(f[0])).map((f) => [f[0], f[1]]), view.field, (to) => { view.field = to; update(); }),
      ...(bodies.some((b) => b.states.length > 1) ? [h("label", { class: "small slid" }, "load", slider("load step", 1, (to) => { view.part = to; update(); })), label] : []),
      select("cut", [["", "no cut"], ["x", "cut along x"], ["y", "cut along y"], ["z", "cut along z"]], "", (to) => { view.axis = to; depth.hidden = !to; cut(); update(); }),
      depth,
      check("mesh", true, (on) => { view.mesh = on; }),
      ...(touched ? [check("contact points", false, (on) => { view.dots = on; })] : []),
      ...(bodies.some((b) => b.cloud) ? [check("nodes of clouds", false, (on) => { view.cloud = on; })] : []),
      h("button", { type: "button", class: "quiet", click: () => { home(); draw(); } }, "reset view")),
    canvas, bar, said);
  controls.listenToKeyEvents(canvas);
  controls.addEventListener("change", draw);
  canvas.addEventListener("pointermove", point);
  new ResizeObserver(draw).observe(place);
  update();
  home();
  draw();
}

Object.assign(window, { showBodies: show });
