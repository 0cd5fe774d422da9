// What the reader chose. It lives in the address, so that a link shows what its sender saw.

import { page } from "./data";

export interface State {
  /** The question. */
  case: string; what: string; within: string; clock: string;
  /** Filters that hold for the whole page. */
  only: string; method: string; find: string;
  /** Labels switched off. */
  off: string;
  /** The section to be read. */
  at: string;
}

/** Errors to choose from, falling. */
export const WITHIN = [0.3, 0.2, 0.1, 0.05, 0.03, 0.02, 0.01, 0.005, 0.003, 0.001];

const first = [...page.asks].filter((a) => !a.kernels).sort((a, b) => compare(b.rank, a.rank))[0];

function compare(a: (boolean | number)[], b: (boolean | number)[]): number {
  const k = a.findIndex((value, i) => value !== b[i]);
  return k < 0 ? 0 : Number(a[k]) - Number(b[k]);
}

/** The error that a page asks for at first: the least from the wanted one on that any run of the first question is within. */
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

/** Changes the state and the address, and says what changed. */
export function change(to: Partial<State>) {
  const changed = (Object.keys(to) as (keyof State)[]).filter((key) => state[key] !== to[key]);
  Object.assign(state, to);
  history.replaceState(null, "", address({}));
  if (changed.length) listeners.forEach((listener) => listener(changed));
}

/** The address of a state that differs from this one. */
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

/** Whether a text has all words that a filter is made of; one that begins with `-` must be missing. */
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
