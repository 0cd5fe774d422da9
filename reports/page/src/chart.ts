// Plots of lines and markers; every plot of the page is one of these.

import * as Plot from "@observablehq/plot";
import { look, name, page, type Axis } from "./data";
import { h } from "./dom";
import { colour, key, symbol } from "./look";
import { duration, digits, linearTicks, logTicks, percent, tick, whole } from "./text";

export interface Point {
  label: number; x: number; y: number; run: number | null;
  /** Exact value of y, if the marker is drawn at another value. */
  exact?: number;
  /** Half-width of the uncertainty bar along x, in the unit of x. */
  spread?: number | null;
  /** Error that the run estimated for itself, at the end of a dotted line. */
  estimate?: number | null;
  /** Upper end of a thin vertical line from the marker: the effective error of the run. */
  counts?: number;
  /** Description shown in place of the run and its numbers. */
  about?: string;
}

export interface Chart {
  title: string;
  x: Axis; y: Axis;
  lines: Point[][];
  bands?: { label: number; points: [number, number, number][] }[];
  /** Marks below and above the lines, for the given ranges of the axes. */
  under?: (x: [number, number], y: [number, number]) => Plot.Markish[];
  over?: (x: [number, number], y: [number, number]) => Plot.Markish[];
  /** Values that the axes must include. */
  see?: { x?: number[]; y?: number[] };
  joined?: boolean;
  /** Labels of x = 0, 1, 2, ... in place of numbers. */
  named?: string[];
  height?: number;
}

function range(values: number[], axis: Axis): [number, number] {
  const usable = values.filter((v) => Number.isFinite(v) && (!axis.log || v > 0));
  let [low, high] = [Math.min(...usable), Math.max(...usable)];
  if (!usable.length) return axis.log ? [0.1, 1] : [0, 1];
  if (axis.log) {
    const margin = Math.max(1.15, (high / low) ** 0.06);
    return [low / margin, high * margin];
  }
  low = Math.min(0, low);
  const span = high - low || 1;
  return [low < 0 ? low - 0.06 * span : low, high + 0.06 * span];
}

function ticks(axis: Axis, ends: [number, number], room: number): number[] {
  return axis.log ? logTicks(...ends, Math.max(3, room)) : linearTicks(...ends, Math.max(3, room));
}

const poisson = (spread: number) => String(Number((0.5 - 0.5 / spread).toPrecision(4)));

function tickText({ log, shows }: Axis): (value: number) => string {
  switch (shows) {
    case "poisson-ratios": return poisson;
    case "times": return (v) => duration(v, 1).replace(/\.0+ /, " ");
    case "relative-errors": return (v) => (v > 0.99e-6 ? `${tick(100 * v)} %` : tick(v));
    case "numbers": return log ? tick : (v) => digits(v, 3).replace(/(\.\d*?)0+$/, "$1").replace(/\.$/, "");
  }
}

/** Name of an axis, with the unit if the tick labels have none. */
const axisName = ({ name, unit, shows }: Axis) => (shows === "numbers" && unit ? `${name} [${unit}]` : name);

function value({ shows, unit }: Axis, v: number): string {
  switch (shows) {
    case "poisson-ratios": return poisson(v);
    case "times": return duration(v);
    case "relative-errors": return percent(v, 3);
    case "numbers": return unit && unit !== "1" ? `${digits(v, 4)} ${unit}` : digits(v, 4);
  }
}

/** Lines of a point's tooltip. */
function said(point: Point, chart: Chart): string {
  if (point.about) return `${name(point.label)}\n${point.about}`;
  const run = point.run;
  const nodes = run === null ? "" : `\n${whole(page.runs.nodes[run])} nodes`;
  const around = point.spread ? ` ± ${duration(point.spread, 2)}` : "";
  const estimated = point.estimate ? `, estimated ${value(chart.y, point.estimate)}` : "";
  const short = (axis: Axis) => axis.name.split(",")[0];
  return `${name(point.label)}${nodes}\n${short(chart.x)} ${value(chart.x, point.x)}${around}\n${short(chart.y)} ${value(chart.y, point.exact ?? point.y)}${estimated}`;
}

/** Description of a point's run, shown below the plot: its numbers and the place of its records. */
function card(point: Point): (Node | string)[] {
  const r = page.runs;
  const at = point.run;
  if (at === null) return [h("b", {}, name(point.label)), point.about ? `: ${point.about.replaceAll("\n", ", ")}` : ""];
  const errors = Object.entries(r.errors)
    .filter(([, { values }]) => values[at] !== null)
    .map(([quantity, { unit, values }]) => `${quantity} ${unit === "1" ? percent(values[at]!, 3) : `${digits(values[at]!, 2)} ${unit}`}`);
  const clock = page.asks.find((a) => a.case === r.case[at] && !a.repeated)?.time.name.split(",")[0] ?? "run time";
  const facts = [
    `${whole(r.nodes[at])} nodes`, `${whole(r.elements[at])} cells`, `${whole(r.dofs[at])} unknowns`, r.settings[at],
    r.solver[at] && `solved by ${r.solver[at]}`, r.seconds[at] !== null && `${clock} ${duration(r.seconds[at]!)}`,
    r.first_use[at] !== null && `${duration(r.first_use[at]!)} in the first use of its memory`,
    r.memory[at] !== null && `memory ${digits(r.memory[at]! / 2 ** 20, 3)} MiB`,
  ].filter(Boolean);
  const record = page.records
    ? h("a", { href: page.records }, `run ${r.id[at]} in records.csv`)
    : h("span", {}, `run ${r.id[at]} in records.csv`);
  return [h("b", {}, name(point.label)), ` of ${r.case[at]} (${r.method[at]}): ${facts.join(", ")}. Errors: ${errors.join(", ") || "none"}. `, record,
    ...(page.study ? ["; run again by ", h("code", {}, `tissuebench reproduce results ${r.id[at]}`)] : [])];
}

function marks(chart: Chart, x: [number, number], y: [number, number]): Plot.Markish[] {
  const inside = (p: Point) => Number.isFinite(p.x) && Number.isFinite(p.y) && (!chart.y.log || p.y > 0);
  const out: Plot.Markish[] = [];
  for (const band of chart.bands ?? [])
    if (band.points.length > 1)
      out.push(Plot.areaY(band.points, { x: (b) => b[0], y1: (b) => b[1], y2: (b) => b[2], fill: colour(band.label), fillOpacity: 0.18 }));
  for (const points of chart.lines) {
    const own = points.filter(inside);
    if (!own.length) continue;
    const { dash, open } = look(own[0].label);
    const stroke = colour(own[0].label);
    if (chart.joined !== false && own.length > 1)
      out.push(Plot.line(own, { x: "x", y: "y", stroke, strokeWidth: 1.5, strokeDasharray: dash.join(" ") }));
    out.push(Plot.ruleX(own.filter((p) => p.counts! > p.y), {
      x: "x", y1: "y", y2: (p: Point) => Math.min(p.counts!, y[1]), stroke, strokeWidth: 0.8 }));
    const estimated = own.filter((p) => p.estimate && p.estimate >= y[0] && p.estimate <= y[1]);
    out.push(Plot.ruleX(estimated, { x: "x", y1: "y", y2: "estimate", stroke, strokeWidth: 1.2, strokeDasharray: "1 2" }));
    out.push(Plot.dot(estimated, { x: "x", y: "estimate", r: 2.5, stroke, strokeWidth: 1.2, fill: "var(--paper)" }));
    out.push(Plot.ruleY(own.filter((p) => p.spread), {
      y: "y", x1: (p: Point) => Math.max(p.x - p.spread!, x[0]), x2: (p: Point) => p.x + p.spread!, stroke, strokeWidth: 2.5, strokeOpacity: 0.45 }));
    const few = own.length > 24 ? own.filter((_, i) => i % Math.ceil(own.length / 12) === 0) : own;
    out.push(Plot.dot(few, { x: "x", y: "y", r: 4.5, symbol: symbol(own[0].label), stroke: open ? stroke : "var(--paper)",
      strokeWidth: open ? 1.6 : 0.6, fill: open ? "var(--paper)" : stroke }));
  }
  return out;
}

function drawn(chart: Chart, width: number): SVGSVGElement | HTMLElement {
  const points = chart.lines.flat();
  const ends = (chart.bands ?? []).flatMap((b) => b.points);
  const x = range([...points.map((p) => p.x), ...(chart.see?.x ?? [])], chart.x);
  const y = range([...points.flatMap((p) => [p.y, p.estimate ?? p.y]), ...ends.flatMap((b) => [b[1], b[2]]), ...(chart.see?.y ?? [])], chart.y);
  const height = chart.height ?? 340;
  const axis = (a: Axis, ends: [number, number]) => ({ type: (a.log ? "log" : "linear") as "log" | "linear", domain: ends, axis: null });
  const named = chart.named;
  const breadth = Math.max(95, ...(named ?? []).map((text) => 7 * text.length + 16));
  const every = named ? Math.ceil(named.length / Math.max(1, Math.floor(width / breadth))) : 1;
  const across = named ? named.flatMap((_, at) => (at % every ? [] : [at])) : ticks(chart.x, x, width / 95);
  const up = ticks(chart.y, y, height / 60);
  const near = { x: "x", y: "y", maxRadius: 40 } as const;
  return Plot.plot({
    width, height, marginLeft: 62, marginBottom: 42, marginTop: 26, marginRight: 18, ariaLabel: chart.title, className: "plot",
    style: { background: "none", fontSize: "12px", fontFamily: "inherit", overflow: "visible" },
    x: axis(chart.x, x), y: axis(chart.y, y),
    marks: [
      Plot.gridX(across, { strokeOpacity: 0.09 }), Plot.gridY(up, { strokeOpacity: 0.09 }),
      Plot.axisX(across, { text: named ? (at: number) => named[at] : tickText(chart.x), tickSize: 3, label: null }), Plot.axisY(up, { text: tickText(chart.y), tickSize: 3, label: null }),
      Plot.text([axisName(chart.y)], { frameAnchor: "top-left", dx: -58, dy: -22, textAnchor: "start", fill: "var(--soft)" }),
      Plot.text([axisName(chart.x)], { frameAnchor: "bottom-right", dy: 36, fill: "var(--soft)" }),
      ...(chart.under?.(x, y) ?? []), ...marks(chart, x, y), ...(chart.over?.(x, y) ?? []),
      Plot.dot(points, Plot.pointer({ ...near, r: 8, stroke: "currentColor", strokeWidth: 1.4 })),
      Plot.tip(points, Plot.pointer({ ...near, title: (p: Point) => said(p, chart), fill: "var(--card)", stroke: "var(--rule)", fontSize: 12 })),
    ],
  });
}

/** Draws a chart into an element and returns a function that draws it again. The chart follows the width of
 * the element and describes the point under the pointer or reached with the arrow keys. */
export function put(place: HTMLElement, make: () => Chart): () => void {
  const frame = h("div", { class: "chart", tabindex: 0, role: "group", "aria-label": "Plot: arrow keys move from point to point" });
  const about = h("p", { class: "card", "aria-live": "polite" });
  place.replaceChildren(frame, about);
  let chart = make();
  let at = -1;
  const show = (point: Point | null) => about.replaceChildren(...(point ? card(point) : []));
  const redraw = () => {
    const width = Math.floor(frame.clientWidth || place.clientWidth || 640);
    const svg = drawn(chart, width);
    svg.addEventListener("input", () => (svg as unknown as { value: Point | null }).value && show((svg as unknown as { value: Point }).value));
    frame.replaceChildren(svg);
  };
  frame.addEventListener("keydown", (event) => {
    const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
    if (!step) return;
    event.preventDefault();
    const sorted = chart.lines.flat().sort((a, b) => a.x - b.x);
    at = (at + step + sorted.length) % sorted.length;
    show(sorted[at]);
    ring(frame, sorted[at]);
  });
  let width = 0;
  new ResizeObserver(() => {
    if (Math.abs(frame.clientWidth - width) > 2) { width = frame.clientWidth; redraw(); }
  }).observe(frame);
  redraw();
  return () => { chart = make(); at = -1; show(null); redraw(); };
}

/** Circles the point reached with the arrow keys. */
function ring(frame: HTMLElement, point: Point) {
  const svg = frame.querySelector("svg.plot, .plot svg") as (SVGSVGElement & Plot.Plot) | null;
  const scales = svg && ((svg as unknown as Plot.Plot).scale ? (svg as unknown as Plot.Plot) : null);
  if (!svg || !scales) return;
  svg.querySelector(".reached")?.remove();
  const circle = document.createElementNS("http://www.w3.org/2000/svg", "circle");
  const place = { cx: scales.scale("x")!.apply(point.x), cy: scales.scale("y")!.apply(point.y), r: 9 };
  for (const [key, value] of Object.entries(place)) circle.setAttribute(key, String(value));
  circle.setAttribute("class", "reached");
  svg.append(circle);
}

/** Legend with a button for each label that switches its method off or on. */
export function legend(labels: number[], off: (label: string) => boolean, click: (label: string) => void): HTMLElement {
  const chip = (label: number) =>
    h("button", { type: "button", class: "chip", "aria-pressed": String(!off(name(label))), "data-label": name(label), click: () => click(name(label)) },
      key(label), name(label));
  return h("div", { class: "legend", role: "group", "aria-label": "Methods shown" }, ...labels.map(chip));
}
