// Map of where methods bend and break: a row for each method, and a column for each value of an axis.

import type { StabilityMap } from "./data";
import { h } from "./dom";
import { fits, listen, state } from "./state";
import { digits } from "./text";

const VERDICTS = ["holds", "bends", "wrong, warned", "refused", "wrong, silent"];

function number(error: number | null): string {
  if (error === null) return "—";
  const e = 100 * error;
  return e < 1e-3 ? "0" : e >= 1e4 ? ">9999" : e >= 100 ? e.toFixed(0) : digits(e, 2);
}

/** Number of classes of wrong or missing results, which come last. The classes before them are ranges of the
 * error. */
const BAD = 3;
const kind = (of: StabilityMap, place: number) =>
  (place < of.classes.length - BAD ? `good${of.classes.length - BAD - 1 - place}` : `bad${place - of.classes.length + BAD}`);

export function map(of: StabilityMap): HTMLElement {
  const made = h("div", { class: "map" });
  const about = h("p", { class: "card", "aria-live": "polite" });
  const draw = () => {
    const cell = (row: number, column: number) => {
      const found = of.cells.find((c) => c[0] === row && c[1] === column);
      if (!found) return h("td", {});
      const [, , verdict, error, why, place] = found;
      const text = `${of.methods[row]} at ${of.values[column]}${of.unit && ` ${of.unit}`}: ${verdict}${error === null ? "" : `, ${of.judge.replace(" [1]", "")} ${number(error)} %`}${why && `. ${why}`}`;
      const tell = () => (about.textContent = text);
      return h("td", { class: `${kind(of, place)} ${verdict}`, title: text, pointerenter: tell, click: tell }, number(error));
    };
    const rows = of.methods.map((method, row) => (fits(method, state.method)
      ? h("tr", {}, h("th", { scope: "row" }, method), ...of.values.map((_, column) => cell(row, column))) : null));
    made.replaceChildren(
      h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": `${of.case}: ${of.name}` }, h("table", {},
        h("thead", {}, h("tr", {}, h("th", {}, of.unit ? `${of.name} [${of.unit}]` : of.name), ...of.values.map((v) => h("th", { scope: "col" }, v)))),
        h("tbody", {}, ...rows))),
      about);
  };
  draw();
  listen((changed) => { if (made.isConnected && changed.includes("method")) draw(); });
  return made;
}

/** Legend of the colours of a map. */
export const mapKey = (of: StabilityMap): HTMLElement => h("p", { class: "mapkey small" },
  ...of.classes.map((name, place) => h("span", { class: kind(of, place) }, name)), h("b", {}, "bold"), " bends");

/** Number of a map's trials with each verdict, worst verdict first. */
export function tally(of: StabilityMap): string {
  const count = (verdict: string) => of.cells.filter((c) => c[2] === verdict).length;
  return [...VERDICTS].reverse().map((v) => [count(v), v] as const).filter(([n]) => n).map(([n, v]) => `${n} ${v}`).join(", ");
}
