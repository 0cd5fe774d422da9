// First screen: the question, its answer, and the plot of run time against error.

import * as Plot from "@observablehq/plot";
import { legend, put, type Chart, type Point } from "./chart";
import { look, name, page, type Ask } from "./data";
import { h, select } from "./dom";
import { change, isOff, listen, state, toggle, WITHIN } from "./state";
import { duration, percent, whole } from "./text";

/** Smallest number of runs with a front. */
const FRONT = 3;

export const asked = (): Ask | undefined =>
  page.asks.find((a) => a.case === state.case && a.what === state.what && a.repeated === (state.clock === "loop") && !a.kernels);

/** Points of a question: one line for each method that is not switched off. */
export function lines(ask: Ask, off: (label: string) => boolean = isOff): Point[][] {
  const points = (line: Ask["lines"][number]) => line.seconds.map((x, i) =>
    ({ label: line.label, x, y: Math.max(line.error[i], page.floor), exact: line.error[i], run: line.run[i], spread: line.spread[i], estimate: line.estimate[i], counts: Math.max(line.counts[i], page.floor) }));
  return ask.lines.filter((line) => !off(name(line.label))).map(points);
}

/** Fastest run of each method whose effective error is within `error`, fastest first. */
export function within(all: Point[][], error: number): Point[] {
  const best = all.map((points) => points.filter((p) => p.counts! <= error).sort((a, b) => a.x - b.x)[0]);
  return best.filter(Boolean).sort((a, b) => a.x - b.x);
}

const run = (p: Point) => `${p.run === null ? "" : `${whole(page.runs.nodes[p.run])} nodes, `}${duration(p.x)}`;

/** Answer to a question, as one sentence. */
export function answer(ask: Ask, all: Point[][], error: number): string {
  const found = within(all, error);
  const what = `${percent(error, 1)} of ${ask.what} on ${ask.title}`;
  const meshfree = (p: Point) => look(p.label).family === "efg";
  if (!found.length) {
    const nearest = all.flat().sort((a, b) => a.counts! - b.counts!)[0];
    if (!nearest) return `${what}: every method is switched off.`;
    const chance = nearest.counts! > nearest.y ? `, but counts with ${percent(nearest.counts!)} because of its displacement` : "";
    return `${what}: no run reaches it. Nearest is ${name(nearest.label)}, ${run(nearest)}, with ${percent(nearest.exact!)}${chance}.`;
  }
  const [best, next] = found;
  const other = found.find((p) => meshfree(p) !== meshfree(best));
  let text = `${what}: ${name(best.label)}, ${run(best)}`;
  if (next) text += `; next ${name(next.label)}, ${run(next)}`;
  if (other && other !== next) text += `; the fastest ${meshfree(other) ? "cloud" : "finite element"} is ${name(other.label)}, ${run(other)}`;
  else if (!other && all.some((l) => l.some((p) => meshfree(p) !== meshfree(best)))) text += `; no ${meshfree(best) ? "finite element" : "cloud"} reaches it`;
  return `${text}.`;
}

/** Runs that are within an error by chance: their effective error is larger. */
const lucky = (all: Point[][], error: number) => all.flat().filter((p) => p.y <= error && p.counts! > error);

/** Runs on the Pareto front of time and effective error, fastest first. */
function best(all: Point[][]): Point[] {
  let least = Infinity;
  return all.flat().sort((a, b) => a.x - b.x || a.counts! - b.counts!).filter((p) => {
    const better = p.counts! < least;
    least = Math.min(least, p.counts!);
    return better;
  });
}

/** Chart of a question. `error` is the error asked for, or `null`. */
export function chart(ask: Ask, error: number | null, off?: (label: string) => boolean): Chart {
  const all = lines(ask, off);
  const times = all.flat().map((p) => p.x);
  const near = ask.repeated ? page.deadlines.filter((d) => d[2] > Math.min(...times) / 10 && d[2] < Math.max(...times) * 10) : [];
  const stairs = times.length < FRONT ? [] : best(all);
  const found = error === null ? [] : within(all, error).slice(0, 1);
  return {
    title: `${ask.what} of ${ask.title}: run time against error`,
    x: ask.time, y: ask.error,
    lines: all,
    joined: !ask.kernels,
    see: { x: near.map((d) => d[2]), y: error === null ? [] : [error] },
    under: (x, y) => [
      ask.band ? Plot.rect([0], { x1: x[0], x2: x[1], y1: y[0], y2: Math.max(y[0], Math.min(ask.band, y[1])), fill: "currentColor", fillOpacity: 0.05 }) : null,
      ask.band && ask.band > y[0] ? Plot.text(["within the reference's own uncertainty"], { x: x[0], y: ask.band, textAnchor: "start", dy: 9, dx: 4, fill: "var(--soft)" }) : null,
      error === null ? null : Plot.ruleY([error], { stroke: "currentColor", strokeOpacity: 0.6, strokeDasharray: "4 3" }),
      error === null ? null : Plot.text([percent(error, 1)], { x: x[1], y: error, textAnchor: "end", dy: -7, dx: -2, fill: "var(--soft)" }),
      Plot.ruleX(near, { x: (d) => d[2], stroke: "currentColor", strokeOpacity: 0.5, strokeDasharray: "2 3" }),
      Plot.text(near, { x: (d) => d[2], text: (d) => `${d[0]} (${d[1]})`, frameAnchor: "bottom", dy: -6, dx: 4, textAnchor: "start", fill: "var(--soft)" }),
      Plot.line(stairs.flatMap((p, i) => [[p.x, i ? stairs[i - 1].counts! : y[1]], [p.x, p.counts!]]).concat(stairs.length ? [[x[1], stairs[stairs.length - 1].counts!]] : [])
        .map(([a, b]) => [a, Math.min(b, y[1])]), { stroke: "currentColor", strokeOpacity: 0.16, strokeWidth: 5, strokeLinejoin: "round", className: "front" }),
    ],
    over: (x) => {
      // In the right half of the plot, the name is to the left of its marker, so that it is not cut off.
      const left = found.some((p) => p.x > Math.sqrt(x[0] * x[1]));
      return [
        Plot.dot(found, { x: "x", y: "y", r: 9, stroke: "var(--accent)", strokeWidth: 2.2 }),
        Plot.text(found, { x: "x", y: "y", text: (p: Point) => name(p.label), dx: left ? -13 : 13, dy: -11, textAnchor: left ? "end" : "start",
          fontWeight: "bold", fill: "currentColor", stroke: "var(--paper)", strokeWidth: 4 }),
      ];
    },
    height: error === null ? 300 : Math.max(340, Math.min(480, window.innerHeight - 430)),
  };
}

/** Fills the first screen. */
export function question(place: HTMLElement) {
  if (!page.asks.length) {
    const trials = page.maps.flatMap((m) => m.cells.map((c) => c[2]));
    const count = (verdict: string) => trials.filter((t) => t === verdict).length;
    place.append(h("h1", { class: "question" }, trials.length ? "Where do methods bend and break?" : "Results"), h("p", { class: "answer", id: "answer" }, trials.length
      ? `Of ${whole(trials.length)} trials on ${page.maps.length} axes ${whole(count("holds"))} hold, ${whole(count("bends"))} bend, ${whole(count("wrong, warned"))} are wrong with a warning, `
        + `${whole(count("refused"))} are refused, and ${whole(count("wrong, silent"))} are wrong without a warning.`
      : "No two runs here have both a time and an error, so there is no front to draw."));
    return;
  }
  const line = h("h1", { class: "question" });
  const sentence = h("p", { class: "answer", id: "answer", "aria-live": "polite" });
  const note = h("p", { class: "soft small" });
  const chips = h("div");
  const plot = h("div", { id: "front" });
  place.append(line, sentence, chips, plot, note);
  let redraw: (() => void) | null = null;
  const fill = () => {
    const ask = asked();
    const error = Number(state.within);
    line.replaceChildren(...choices());
    if (!ask) {
      sentence.textContent = "This was not measured: choose another question.";
      plot.hidden = chips.hidden = true;
      return;
    }
    plot.hidden = chips.hidden = false;
    const all = lines(ask);
    sentence.textContent = answer(ask, all, error);
    chips.replaceChildren(legend(ask.lines.map((l) => l.label), isOff, toggle));
    const chance = lucky(all, error);
    note.textContent = [
      "Each line joins the sizes of a method. "
        + (all.flat().length < FRONT ? "Fewer than three runs have no front." : "The grey staircase is the front: no run is both faster and more accurate."),
      ask.lines.some((l) => l.spread.some((s) => s)) && "Bars span the middle half of the repeats.",
      ask.estimated && "The scene has no reference: errors are those that the runs estimated for themselves.",
      ask.lines.some((l) => l.estimate.some((e) => e)) && "Dotted lines end at the error that the run estimated for itself.",
      ask.scalar && "A single number can be right by chance: a run counts with at least a third of its displacement's error, at the top of the thin line.",
      chance.length && `Right by chance, not counted at ${percent(error, 1)}: ${[...new Set(chance.map((p) => name(p.label)))].join(", ")}.`,
      ask.reference && `The reference is ${ask.reference}.`,
      page.machine.quiet === false && `The machine was not quiet: ${ask.cpu ? "runs are compared by CPU time" : "times may be too long"}.`,
    ].filter(Boolean).join(" ");
    const make = () => chart(asked()!, Number(state.within));
    if (redraw) redraw(); else redraw = put(plot, make);
  };
  fill();
  listen((changed) => {
    if (changed.some((key) => ["case", "what", "within", "clock", "off", "method"].includes(key))) fill();
  });
}

/** Question as a sentence with drop-down lists. */
function choices(): (Node | string)[] {
  const asks = page.asks.filter((a) => !a.kernels);
  const cases = [...new Set(asks.map((a) => a.case))].sort();
  const of = asks.filter((a) => a.case === state.case);
  const whats = [...new Set(of.map((a) => a.what))];
  const clocks: [string, string][] = [["once", "once"], ["loop", "in a loop"]];
  const offered = clocks.filter(([clock]) => of.some((a) => a.what === state.what && a.repeated === (clock === "loop")));
  const go = (to: Partial<typeof state>) => {
    const next = { ...state, ...to };
    const here = asks.filter((a) => a.case === next.case);
    if (!here.some((a) => a.what === next.what)) next.what = here[0].what;
    if (!here.some((a) => a.what === next.what && a.repeated === (next.clock === "loop"))) next.clock = next.clock === "loop" ? "once" : "loop";
    change({ case: next.case, what: next.what, clock: next.clock, off: to.case ? "" : state.off });
  };
  return [
    "Which method has the ", select("quantity", whats.map((w) => [w, w]), state.what, (what) => go({ what })),
    " of ", select("case", cases.map((c) => [c, c]), state.case, (to) => go({ case: to })),
    " within ", select("error wanted", WITHIN.map((w) => [String(w), percent(w, 1)]), state.within, (to) => change({ within: to })),
    offered.length > 1 ? ", solved " : "", offered.length > 1 ? select("clock", offered, state.clock, (clock) => go({ clock })) : "", "?",
  ];
}
