// Choices of the reader. They are part of the address, so a copied link shows the same view.

import { page } from "./data";

export interface State {
  /** Question: the case, the quantity, the error and the kind of time. */
  case: string; what: string; within: string; clock: string;
  /** Filters of the whole page: the case, the words for methods, and the search. */
  only: string; method: string; find: string;
  /** Labels that are switched off, separated by commas. */
  off: string;
  /** Section to scroll to. */
  at: string;
}

/** Errors to choose from, in descending order. */
export const WITHIN = [0.3, 0.2, 0.1, 0.05, 0.03, 0.02, 0.01, 0.005, 0.003, 0.001];

const first = [...page.asks].filter((a) => !a.kernels).sort((a, b) => compare(b.rank, a.rank))[0];

function compare(a: (boolean | number)[], b: (boolean | number)[]): number {
  const k = a.findIndex((value, i) => value !== b[i]);
  return k < 0 ? 0 : Number(a[k]) - Number(b[k]);
}

/** Error of the question when the page opens: the smallest choice, not below `page.wanted`, that a run of the
 * first question is within. */
function opening(): number {
  const counts = first?.lines.flatMap((l) => l.counts) ?? [];
  return WITHIN.filter((error) => error >= page.wanted && counts.some((c) => c <= error)).pop() ?? page.wanted;
}

const usual: State = {
  case: first?.case ?? "", what: first?.what ?? "", within: String(opening()), clock: "once", only: "", method: "", find: "", off: "", at: "",
};

export const state: State = { ...usual };
const listeners: ((changed: (keyof State)[]) => void)[] = [];

export const listen = (listener: (changed: (keyof State)[]) => void) => listeners.push(listener);

/** Changes the state and the address, and passes the names of the changed entries to the listeners. */
export function change(to: Partial<State>) {
  const changed = (Object.keys(to) as (keyof State)[]).filter((key) => state[key] !== to[key]);
  Object.assign(state, to);
  history.replaceState(null, "", address({}));
  if (changed.length) listeners.forEach((listener) => listener(changed));
}

/** Address of the present state with the given changes. */
export function address(to: Partial<State>): string {
  const all = { ...state, ...to };
  const kept = (Object.keys(usual) as (keyof State)[]).filter((key) => all[key] !== usual[key]);
  return `#${new URLSearchParams(kept.map((key) => [key, all[key]]))}`;
}

function read(): State {
  const said = new URLSearchParams(location.hash.slice(1));
  const out = { ...usual };
  for (const key of Object.keys(usual) as (keyof State)[]) out[key] = said.get(key) ?? usual[key];
  return out;
}

Object.assign(state, read());
window.addEventListener("hashchange", () => change(read()));

/** Whether a text contains all words of a filter. A word that begins with `-` must be absent. */
export function fits(text: string, filter: string): boolean {
  const lower = text.toLowerCase();
  return filter.toLowerCase().split(/\s+/).filter(Boolean)
    .every((word) => (word.startsWith("-") && word.length > 1 ? !lower.includes(word.slice(1)) : lower.includes(word)));
}

export const isOff = (label: string): boolean => state.off.split(",").includes(label) || !fits(label, state.method);

export function toggle(label: string) {
  const off = state.off.split(",").filter(Boolean);
  change({ off: (off.includes(label) ? off.filter((l) => l !== label) : [...off, label]).join(",") });
}
