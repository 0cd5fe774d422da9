// A study over commits: plots of errors and times, and the steps that exceed the noise.

import * as Plot from "@observablehq/plot";
import type { Chart, Point } from "./chart";
import { name, page, type Axis, type Commit } from "./data";
import { h } from "./dom";
import { isOff } from "./state";
import { digits, duration } from "./text";

interface Measure { title: string; axis: string; value: (c: Commit) => number | null; moved: (c: Commit) => boolean }

export const MEASURES: Measure[] = [
  { title: "Errors over commits", axis: "mean error relative to the first commit", value: (c) => c.error, moved: (c) => c.errors_moved },
  { title: "Times over commits", axis: "CPU time relative to the first commit", value: (c) => c.time, moved: (c) => c.times_moved },
];

const QUIET = new Map([[true, "machine quiet"], [false, "machine not quiet"], [null, "not known whether the machine was quiet"]]);

const linear = (name: string, unit: string): Axis => ({ name, unit, log: false, shows: "numbers" });

/** Largest number of characters of a label below an axis. */
const LONGEST = 24;

const about = (c: Commit, value: number, axis: string) =>
  `commit ${c.name}\n${axis}: ${digits(value, 4)}\n${c.runs} runs, ${duration(c.seconds)}\n${QUIET.get(c.quiet)}${c.moved && `\n${c.moved}`}`;

/** Short form of a name: the first seven digits of a commit, or at most `LONGEST` characters of a label. */
const short = (name: string) => (/^[0-9a-f]{12}\+?$/.test(name) ? name.slice(0, 7) : name.length > LONGEST ? `${name.slice(0, LONGEST - 1)}…` : name);

/** Chart of a measure: a line for each trend, and a ring around each step that exceeds the noise. */
export function over(measure: Measure): Chart {
  const shown = page.trends.filter((t) => !isOff(name(t.label)));
  const points = (all: Commit[], label: number) => all.flatMap((c, x): (Point & { moved: boolean })[] => {
    const y = measure.value(c);
    return y === null ? [] : [{ label, x, y, run: null, about: about(c, y, measure.axis), moved: measure.moved(c) }];
  });
  const lines = shown.map((t) => points(t.commits, t.label));
  const longest = page.trends.reduce((a, b) => (b.commits.length > a.commits.length ? b : a));
  return {
    title: measure.title, x: linear("commit", ""), y: linear(measure.axis, "1"), lines, height: 300,
    named: longest.commits.map((c) => short(c.name)),
    see: { x: [0, longest.commits.length - 1], y: [1] },
    under: () => [Plot.ruleY([1], { stroke: "currentColor", strokeOpacity: 0.4, strokeDasharray: "4 3" })],
    over: () => [Plot.dot(lines.flat().filter((p) => p.moved), { x: "x", y: "y", r: 9, stroke: "var(--accent)", strokeWidth: 2.2 })],
  };
}

/** List of the steps that exceed the noise, newest first, with the changes at each. */
export function steps(): HTMLElement {
  const all = page.trends.flatMap((t) => t.commits.map((c, at) => ({ t, c, before: t.commits[at - 1] })).reverse());
  const found = all.filter(({ c }) => c.moved);
  if (!found.length) return h("p", {}, "No step is beyond the noise.");
  return h("ul", { class: "steps" }, ...found.map(({ t, c, before }) => h("li", {},
    h("b", {}, `${before.name} to ${c.name}`), `: ${c.moved}${page.trends.length > 1 ? ` (${name(t.label)})` : ""}${c.quiet === false ? "; the machine was not quiet" : ""}`,
    h("ul", { class: "soft small" }, ...c.changes.map((change) => h("li", {}, change))))));
}
